// Is a TIFF file whole? libtiff takes a file whose chain of pages breaks off for one of fewer
// pages, so the chain is walked here first.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace cavum {

/// Throws Error at `where` when a page, or the pixels of one, lie beyond the end, when the chain of
/// pages does not end, or when it is no TIFF. Classic TIFF and BigTIFF, either byte order; strips
/// and tiles.
void check_tiff_bytes(std::span<const std::uint8_t> file, const std::string& where);

}  // namespace cavum
