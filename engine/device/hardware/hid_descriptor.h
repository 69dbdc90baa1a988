// What a HID device says of its input reports: where in a report each axis and button lies. Parsed
// from the report descriptor (Device Class Definition for HID 1.11, section 6.2.2), because pedals
// publish no other description of themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace cavum {

/// One number in an input report.
struct HidField {
  std::uint8_t report_id = 0;         ///< 0 = the device does not number its reports
  std::uint16_t page = 0, usage = 0;  ///< HID Usage Tables: 0x01/0x30 = generic desktop, X
  std::uint32_t first_bit = 0;       ///< in the report as it is read; the byte of its number counts
  std::uint32_t bits = 0;            ///< 1..32, least significant first
  std::int32_t least = 0, most = 0;  ///< logical range; least < most for an axis
  bool relative = false;             ///< says changes, not positions

  /// A position that a foot can set: X to wheel of the generic desktop, or a simulation control,
  /// absolute and finer than 4 bits.
  [[nodiscard]] bool is_axis() const noexcept;
};

struct HidLayout {
  std::vector<HidField> fields;  ///< variable input fields, in order; constants and arrays left out
  bool numbered = false;         ///< every report begins with its number

  /// Bytes of a report as it is read; 0 = there is no such report.
  [[nodiscard]] std::size_t report_bytes(std::uint8_t report_id) const noexcept;
  /// Bytes of the longest one.
  [[nodiscard]] std::size_t longest_bytes() const noexcept;
  [[nodiscard]] std::vector<HidField> axes() const;

  std::vector<std::pair<std::uint8_t, std::uint32_t>>
      report_bits;  ///< number and length of each report, its number's byte left out
};

/// Longest descriptor that Linux hands out.
inline constexpr std::size_t k_hid_descriptor_most_bytes = 4096;

/// Throws Error when the bytes are no report descriptor: an item cut off, a range or size that
/// cannot be, unbalanced stacks, more than 4096 fields, or more than 4096 bytes.
[[nodiscard]] HidLayout parse_hid_descriptor(std::span<const std::uint8_t> descriptor);

/// The field's number in a report as it was read; nothing when it is another report or too short.
[[nodiscard]] std::optional<std::int32_t> hid_value(const HidField& field, bool numbered,
                                                    std::span<const std::uint8_t> report) noexcept;

}  // namespace cavum
