// How much of the computer one volume may take, by the bytes of its files: a small file may unpack
// to much, but not to everything.
#pragma once

#include <algorithm>
#include <cstdint>

namespace cavum {

/// Voxels of a volume whose files hold `bytes` bytes. Import needs some 30 bytes and 0.28 us a
/// voxel: 16 million (256 x 256 x 256) stay below 1 GB and 5 s. A larger volume has to bring a byte
/// for each four of its voxels, as packed CT and unpacked files do, and at most 512 million voxels.
[[nodiscard]] constexpr std::uint64_t most_voxels(std::uint64_t bytes) noexcept {
  return std::min<std::uint64_t>(std::uint64_t{512} << 20,
                                 std::max<std::uint64_t>(std::uint64_t{16} << 20, 4 * bytes));
}
/// The same of a CT volume, whose gray is looked at in many ways, up to 50 bytes and 0.4 us a
/// voxel; a label map is not.
[[nodiscard]] constexpr std::uint64_t most_gray_voxels(std::uint64_t bytes) noexcept {
  return std::min(most_voxels(bytes),
                  std::max<std::uint64_t>(std::uint64_t{12} << 20, 4 * bytes / 3));
}
/// Seconds of the processor for reading them: ten times what sound files take.
[[nodiscard]] constexpr std::uint64_t most_read_seconds(std::uint64_t bytes) noexcept {
  return 4 + (bytes >> 23);
}
/// Bytes of address space for reading them: libraries, the file's own numbers (up to 8 bytes each)
/// and ours (4).
[[nodiscard]] constexpr std::uint64_t most_read_memory(std::uint64_t bytes) noexcept {
  return (std::uint64_t{448} << 20) + 12 * most_voxels(bytes);
}

inline constexpr std::uint64_t k_max_slice_files = 20'000;  ///< in one folder
inline constexpr std::uint64_t k_largest_slice = std::uint64_t{1}
                                                 << 30;  ///< bytes of one slice's file
inline constexpr int k_longest_read_s = 600;  ///< by the clock, for a disk that does not answer

}  // namespace cavum
