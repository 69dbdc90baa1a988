// Is a DICOM slice whole? GDCM pads the picture of a file that was cut off with zeros and says
// nothing, so the file is walked here first, element by element, by the rules of DICOM PS3.5
// chapter 7: explicit and implicit value representations, either byte order, sequences of any kind.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

namespace cavum {

/// What the slices of one series must have in common, and what each claims.
struct DicomSlice {
  std::uint64_t rows = 0, columns = 0, frames = 1;
  std::map<std::string, std::string> common;  ///< by name: the fields that say how the picture's
                                              ///< bytes are to be read and where they lie
};

/// True for a file that says it is DICOM: "DICM" behind 128 bytes.
[[nodiscard]] bool says_dicom(std::span<const std::uint8_t> file) noexcept;
/// Walks up to the end of the picture. Throws Error at `where` when the file ends before it, when
/// an element cannot be, or when there is no picture or it has fewer bytes than its own rows,
/// columns, frames and bits need. A compressed picture must have all its pieces and the mark of
/// their end.
[[nodiscard]] DicomSlice check_dicom_bytes(std::span<const std::uint8_t> file,
                                           const std::string& where);

}  // namespace cavum
