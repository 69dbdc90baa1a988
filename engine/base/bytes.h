// Little-endian bytes for our file formats. The reader never runs past the end: it throws instead,
// so a truncated or damaged file is an error and not a crash.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/where.h"

namespace cavum {

static_assert(std::endian::native == std::endian::little,
              "file formats are written on little-endian machines");

using Bytes = std::vector<std::uint8_t>;

/// Appends plain values to a growing buffer.
class ByteWriter {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    const auto* p = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), p, p + sizeof(T));
  }
  void put_bytes(std::span<const std::uint8_t> b) {
    bytes_.insert(bytes_.end(), b.begin(), b.end());
  }
  /// Length as u32, then the characters.
  void put_string(const std::string& s) {
    put(static_cast<std::uint32_t>(s.size()));
    bytes_.insert(bytes_.end(), s.begin(), s.end());
  }
  /// Unsigned LEB128.
  void put_varint(std::uint64_t v) {
    while (v >= 0x80) {
      bytes_.push_back(static_cast<std::uint8_t>(v | 0x80));
      v >>= 7;
    }
    bytes_.push_back(static_cast<std::uint8_t>(v));
  }
  void put_signed_varint(std::int64_t v) {
    put_varint((static_cast<std::uint64_t>(v) << 1) ^ static_cast<std::uint64_t>(v >> 63));
  }
  [[nodiscard]] const Bytes& bytes() const noexcept { return bytes_; }
  [[nodiscard]] Bytes take() noexcept { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Reads what ByteWriter wrote. Throws Error(`where`, ...) at the end of the data.
class ByteReader {
 public:
  ByteReader(std::span<const std::uint8_t> bytes, Where where)
      : bytes_(bytes), where_(std::move(where)) {}

  template <class T>
  [[nodiscard]] T get() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    const auto b = get_bytes(sizeof(T));
    std::memcpy(&value, b.data(), sizeof(T));
    return value;
  }
  [[nodiscard]] std::span<const std::uint8_t> get_bytes(std::size_t n) {
    if (n > bytes_.size() - at_) fail(msg("the data end too early"));
    const auto b = bytes_.subspan(at_, n);
    at_ += n;
    return b;
  }
  [[nodiscard]] std::string get_string() {
    const auto b = get_bytes(get<std::uint32_t>());
    return {reinterpret_cast<const char*>(b.data()), b.size()};
  }
  [[nodiscard]] std::uint64_t get_varint() {
    std::uint64_t v = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      const auto b = get<std::uint8_t>();
      v |= static_cast<std::uint64_t>(b & 0x7f) << shift;
      if ((b & 0x80) != 0) continue;
      if (b == 0 && shift > 0) fail(msg("a number is written longer than it is"));
      return v;
    }
    fail(msg("a number is too long"));
  }
  [[nodiscard]] std::int64_t get_signed_varint() {
    const auto v = get_varint();
    return static_cast<std::int64_t>(v >> 1) ^ -static_cast<std::int64_t>(v & 1);
  }
  [[nodiscard]] std::size_t left() const noexcept { return bytes_.size() - at_; }
  [[noreturn]] void fail(const Message& what) const {
    throw Error(where_, what, msg("the file is damaged or incomplete: use an intact copy"));
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  Where where_;
};

}  // namespace cavum
