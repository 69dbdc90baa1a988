// Does the file hold as many bytes as its header promises? ITK reads a shortened raw file without a
// word, so the headers of MetaImage, NRRD and NIfTI are compared with the data's size before ITK
// sees them.
#pragma once

#include <cstdint>
#include <string>

namespace cavum {

/// Bytes of the files that hold the volume: `path`, and the data file that it names. Throws Error
/// when that is missing or no ordinary file, and when the data are spread over several files.
[[nodiscard]] std::uint64_t bytes_of_volume(const std::string& path);
/// Throws Error naming the data file when it is too short, packed ones included. DICOM has
/// check_dicom_bytes; PNG and NRRD in text or packed by bzip2 pass, for their own readers notice.
void check_volume_bytes(const std::string& path);
/// Throws Error when ITK would read another file than the one that is named: of X.nii.gz and X.nii
/// it takes the latter, whichever is asked for.
void require_no_neighbour(const std::string& path);

}  // namespace cavum
