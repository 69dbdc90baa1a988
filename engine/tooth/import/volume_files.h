// Does the file hold as many bytes as its header promises? ITK reads a shortened raw file without a word, so
// the headers of MetaImage, NRRD and NIfTI are compared with the data's size before ITK sees them.
#pragma once

#include <string>

namespace cavum {

/// Throws Error naming the data file when it is missing or too short. Formats and encodings whose size cannot
/// be told from the header (compressed data, DICOM, TIFF) pass; their own readers notice.
void check_volume_bytes(const std::string& path);

}  // namespace cavum
