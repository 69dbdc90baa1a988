#include "engine/device/hardware/hid_descriptor.h"

#include <algorithm>

#include "engine/device/device_error.h"

namespace cavum {
namespace {

constexpr std::size_t k_max_fields = 4096;
constexpr std::uint32_t k_max_report_bits = 8 * 4096;
constexpr std::size_t k_max_stacked = 16, k_deepest = 64;

[[noreturn]] void refuse(std::size_t at, const Message& what) {
  throw Error(DeviceError::bad_descriptor, msg("HID report descriptor, byte {}", at), what,
              msg("unplug the device and plug it in again; if it stays so, use another pedal"));
}

/// Bits 2 and 3 of an item's first byte (HID 1.11, 6.2.2.2).
enum class ItemType : std::uint8_t { main = 0x00, global = 0x04, local = 0x08, reserved = 0x0c };
constexpr std::uint8_t k_long_item = 0xfe;

struct Item {
  std::size_t start;  // its first byte in the descriptor
  std::uint8_t tag;   // the first byte without the size
  std::size_t size;   // bytes of its value: 0, 1, 2 or 4
  std::uint32_t value;

  [[nodiscard]] std::int32_t as_signed() const noexcept {
    if (size == 1) return static_cast<std::int8_t>(value);
    if (size == 2) return static_cast<std::int16_t>(value);
    return static_cast<std::int32_t>(value);
  }
};

/// Items that hold until they are changed.
struct Globals {
  std::uint16_t page = 0;
  std::int32_t least = 0, most = 0;
  std::uint32_t most_unsigned = 0;  // the same bytes as `most`
  std::uint32_t size_bits = 0, count = 0;
  std::uint8_t report_id = 0;
};

/// Items that hold until the next main item.
struct Locals {
  std::vector<std::uint32_t> usages;  // page in the upper half when the item gave one
  std::optional<std::uint32_t> usage_from, usage_to;
};

class Parser {
 public:
  explicit Parser(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  HidLayout parse() {
    if (bytes_.size() > k_hid_descriptor_most_bytes)
      refuse(k_hid_descriptor_most_bytes,
             msg("the descriptor is longer than any that Linux hands out"));
    while (at_ < bytes_.size()) read_item();
    if (depth_ != 0) refuse(bytes_.size(), msg("a collection is not closed"));
    if (layout_.fields.empty()) refuse(bytes_.size(), msg("no input field is described"));
    return std::move(layout_);
  }

 private:
  void read_item() {
    Item item{
        .start = at_, .tag = static_cast<std::uint8_t>(bytes_[at_] & 0xfc), .size = 0, .value = 0};
    const std::uint8_t prefix = bytes_[at_++];
    if (prefix == k_long_item) {
      skip_long_item(item.start);
      return;
    }
    item.size = (prefix & 3) == 3 ? 4 : prefix & 3;
    if (bytes_.size() - at_ < item.size) refuse(item.start, msg("an item is cut off"));
    for (std::size_t i = 0; i < item.size; ++i)
      item.value |= static_cast<std::uint32_t>(bytes_[at_ + i]) << 8 * i;
    at_ += item.size;
    switch (static_cast<ItemType>(prefix & 0x0c)) {
      case ItemType::main:
        take_main(item);
        break;
      case ItemType::global:
        take_global(item);
        break;
      case ItemType::local:
        take_local(item);
        break;
      case ItemType::reserved:
        break;
    }
  }

  /// Nothing that 1.11 defines is long.
  void skip_long_item(std::size_t start) {
    if (bytes_.size() - at_ < 2 || bytes_.size() - at_ - 2 < bytes_[at_])
      refuse(start, msg("a long item is cut off"));
    at_ += 2u + bytes_[at_];
  }

  void take_main(const Item& item) {
    switch (item.tag) {
      case 0x80:
        input(item.start, item.value);
        break;
      case 0x90:
      case 0xb0:
        break;  // output and feature reports
      case 0xa0:
        if (++depth_ > k_deepest) refuse(item.start, msg("collections are more than 64 deep"));
        break;
      case 0xc0:
        if (depth_ == 0) refuse(item.start, msg("a collection is closed that was never opened"));
        --depth_;
        break;
      default:
        return;  // reserved
    }
    locals_ = {};
  }

  void take_global(const Item& item) {
    switch (item.tag) {
      case 0x04:
        now_.page = static_cast<std::uint16_t>(item.value);
        break;
      case 0x14:
        now_.least = item.as_signed();
        break;
      case 0x24:
        now_.most = item.as_signed();
        now_.most_unsigned = item.value;
        break;
      case 0x74:
        if (item.value > k_max_report_bits)
          refuse(item.start, msg("a field of {} bits cannot be", item.value));
        now_.size_bits = item.value;
        break;
      case 0x84:
        if (item.value == 0 || item.value > 255)
          refuse(item.start, msg("report number {} is none of 1 to 255", item.value));
        now_.report_id = static_cast<std::uint8_t>(item.value);
        layout_.numbered = true;
        break;
      case 0x94:
        if (item.value > k_max_report_bits)
          refuse(item.start, msg("{} fields in one report cannot be", item.value));
        now_.count = item.value;
        break;
      case 0xa4:
        if (stack_.size() >= k_max_stacked)
          refuse(item.start, msg("items are pushed more than 16 deep"));
        stack_.push_back(now_);
        break;
      case 0xb4:
        if (stack_.empty()) refuse(item.start, msg("items are popped that were never pushed"));
        now_ = stack_.back();
        stack_.pop_back();
        break;
      default:
        break;  // units, physical ranges and what is reserved
    }
  }

  void take_local(const Item& item) {
    switch (item.tag) {
      case 0x08:
        if (locals_.usages.size() < k_max_fields)
          locals_.usages.push_back(with_page(item.value, item.size));
        break;
      case 0x18:
        locals_.usage_from = with_page(item.value, item.size);
        break;
      case 0x28:
        locals_.usage_to = with_page(item.value, item.size);
        break;
      default:
        break;  // strings, designators, delimiters and what is reserved
    }
  }

  [[nodiscard]] std::uint32_t with_page(std::uint32_t value, std::size_t size) const noexcept {
    return size == 4 ? value : static_cast<std::uint32_t>(now_.page) << 16 | value;
  }

  [[nodiscard]] std::uint32_t usage_of(std::uint32_t i) const noexcept {
    if (!locals_.usages.empty())
      return locals_.usages[std::min<std::size_t>(i, locals_.usages.size() - 1)];
    if (!locals_.usage_from) return static_cast<std::uint32_t>(now_.page) << 16;
    const std::uint32_t from = *locals_.usage_from,
                        to = std::max(locals_.usage_to.value_or(from), from);
    return from + std::min(i, to - from);
  }

  std::uint32_t& bits_of_report() {
    for (auto& [id, bits] : layout_.report_bits)
      if (id == now_.report_id) return bits;
    layout_.report_bits.emplace_back(now_.report_id, 0);
    return layout_.report_bits.back().second;
  }

  void input(std::size_t start, std::uint32_t flags) {
    constexpr std::uint32_t k_constant = 1, k_variable = 2, k_relative = 4;
    std::uint32_t& bits = bits_of_report();
    const std::uint64_t all = static_cast<std::uint64_t>(now_.size_bits) * now_.count;
    if (bits + all > k_max_report_bits)
      refuse(start, msg("a report of more than 4096 bytes cannot be"));
    if ((flags & k_constant) == 0 && (flags & k_variable) != 0 && now_.size_bits >= 1 &&
        now_.size_bits <= 32) {
      if (layout_.fields.size() + now_.count > k_max_fields)
        refuse(start, msg("more than 4096 fields are described"));
      // A range 0..255 in one byte reads as 0..-1: a positive least means that the largest is
      // positive, too.
      const std::int32_t most =
          now_.least >= 0 && now_.most < now_.least
              ? static_cast<std::int32_t>(std::min<std::uint32_t>(now_.most_unsigned, 0x7fffffffu))
              : now_.most;
      for (std::uint32_t i = 0; i < now_.count; ++i) {
        const std::uint32_t usage = usage_of(i);
        layout_.fields.push_back(
            {.report_id = now_.report_id,
             .page = static_cast<std::uint16_t>(usage >> 16),
             .usage = static_cast<std::uint16_t>(usage),
             .first_bit = bits + i * now_.size_bits + (layout_.numbered ? 8u : 0u),
             .bits = now_.size_bits,
             .least = now_.least,
             .most = most,
             .relative = (flags & k_relative) != 0});
      }
    }
    bits += static_cast<std::uint32_t>(all);
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0, depth_ = 0;
  Globals now_;
  Locals locals_;
  std::vector<Globals> stack_;
  HidLayout layout_;
};

}  // namespace

bool HidField::is_axis() const noexcept {
  constexpr std::uint16_t k_desktop = 0x01, k_x = 0x30, k_wheel = 0x38, k_simulation = 0x02;
  return !relative && bits > 4 && least < most &&
         ((page == k_desktop && usage >= k_x && usage <= k_wheel) || page == k_simulation);
}

std::size_t HidLayout::report_bytes(std::uint8_t report_id) const noexcept {
  for (const auto& [id, bits] : report_bits)
    if (id == report_id) return (bits + 7) / 8 + (numbered ? 1 : 0);
  return 0;
}

std::size_t HidLayout::longest_bytes() const noexcept {
  std::size_t longest = 0;
  for (const auto& report : report_bits) longest = std::max(longest, report_bytes(report.first));
  return longest;
}

std::vector<HidField> HidLayout::axes() const {
  std::vector<HidField> found;
  std::copy_if(fields.begin(), fields.end(), std::back_inserter(found),
               [](const HidField& f) { return f.is_axis(); });
  return found;
}

HidLayout parse_hid_descriptor(std::span<const std::uint8_t> descriptor) {
  return Parser(descriptor).parse();
}

std::optional<std::int32_t> hid_value(const HidField& field, bool numbered,
                                      std::span<const std::uint8_t> report) noexcept {
  if (numbered && (report.empty() || report[0] != field.report_id)) return std::nullopt;
  if ((field.first_bit + field.bits + 7) / 8 > report.size()) return std::nullopt;
  std::uint64_t whole = 0;
  const std::uint32_t first = field.first_bit / 8,
                      last = (field.first_bit + field.bits - 1) / 8;  // at most five bytes
  for (std::uint32_t i = first; i <= last; ++i)
    whole |= static_cast<std::uint64_t>(report[i]) << 8 * (i - first);
  whole = whole >> field.first_bit % 8 & ((1ULL << field.bits) - 1);
  if (field.least < 0 && (whole >> (field.bits - 1) & 1) != 0)
    whole |= ~0ULL << field.bits;  // two's complement
  return static_cast<std::int32_t>(
      std::min<std::int64_t>(static_cast<std::int64_t>(whole), 0x7fffffff));
}

}  // namespace cavum
