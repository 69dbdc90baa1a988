// Why a disk did not take what was to be written: the kind, and the system's own number. A
// recording that went on elsewhere keeps it.
#pragma once

#include <array>
#include <cstdint>

#include "engine/base/message.h"

namespace cavum {

enum class DiskFault : std::uint8_t {
  full,
  input_output,
  held,
  not_opened,
  read_only,
  damaged,
  other
};
inline constexpr std::array k_disk_faults{"full",      "input_output", "held", "not_opened",
                                          "read_only", "damaged",      "other"};
static_assert(k_disk_faults.size() == static_cast<std::size_t>(DiskFault::other) + 1);
[[nodiscard]] constexpr auto names_of(DiskFault) { return k_disk_faults; }

struct DiskRefusal {
  DiskFault fault = DiskFault::other;
  std::int32_t error = 0;  ///< errno; 0: the system gave none
  friend bool operator==(const DiskRefusal&, const DiskRefusal&) = default;
};
/// "the disk is full (there is no space left)"
[[nodiscard]] Message in_words(const DiskRefusal& refusal);

}  // namespace cavum
