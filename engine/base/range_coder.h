// Adaptive binary range coder: writes a bit in -log2(chance) bits, where the chance comes from the
// bits seen before in the same place (its AdaptiveBit). Whole numbers only, so that every build
// reads what any build wrote. Encoder and decoder have the same `code`, so that one walk over the
// data, as a template over the coder, both writes and reads a format.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "engine/base/bytes.h"

namespace cavum {

/// The chance of a one, learned from what came before: quickly at first, then over the last 250
/// bits or so.
class AdaptiveBit {
 public:
  /// Chance of a one in 1/65536, 1..65535.
  [[nodiscard]] std::uint32_t chance() const noexcept { return std::max(state_ >> 16, 1u); }
  void learn(bool one) noexcept {
    const std::int64_t before = state_ >> k_count_bits, wanted = one ? k_certain - 1 : 0;
    const std::uint32_t seen = state_ & ((1u << k_count_bits) - 1);
    state_ = static_cast<std::uint32_t>(before + ((wanted - before) * k_rate[seen] >> 16))
                 << k_count_bits |
             std::min<std::uint32_t>(seen + 1, k_rate.size() - 1);
  }

 private:
  static constexpr int k_count_bits = 10;
  static constexpr std::int64_t k_certain = 1 << 22;
  static constexpr std::array<std::int32_t, 250> k_rate = [] {  // 65536 / (n + 1.6) after n bits
    std::array<std::int32_t, 250> rate{};
    for (std::size_t n = 0; n < rate.size(); ++n)
      rate[n] = static_cast<std::int32_t>(655360 / (10 * n + 16));
    return rate;
  }();
  std::uint32_t state_ = 1u << 31;  // 22 bits of chance above 10 of how many bits were seen
};

class RangeEncoder {
 public:
  static constexpr bool k_decodes = false;
  /// Writes `bit` and returns it.
  bool code(AdaptiveBit& model, bool bit) {
    const std::uint32_t middle =
        low_ + static_cast<std::uint32_t>(std::uint64_t{high_ - low_} * model.chance() >> 16);
    if (bit)
      high_ = middle;
    else
      low_ = middle + 1;
    model.learn(bit);
    while ((low_ ^ high_) >> 24 == 0) {
      out_.push_back(static_cast<std::uint8_t>(low_ >> 24));
      low_ <<= 8;
      high_ = high_ << 8 | 255;
    }
    return bit;
  }
  /// The bytes written; the encoder is used up.
  [[nodiscard]] Bytes finish() {
    for (int shift = 24; shift >= 0; shift -= 8)
      out_.push_back(static_cast<std::uint8_t>(low_ >> shift));
    return std::move(out_);
  }

 private:
  std::uint32_t low_ = 0, high_ = ~0u;
  Bytes out_;
};

/// Reads what RangeEncoder wrote, given the same models in the same order. Throws as `in` does when
/// it would need more bytes than there are: damaged data end in an error at the latest there. Takes
/// exactly the bytes that were written.
class RangeDecoder {
 public:
  static constexpr bool k_decodes = true;
  explicit RangeDecoder(ByteReader& in) : in_(in) {
    for (int i = 0; i < 4; ++i) value_ = value_ << 8 | in_.get<std::uint8_t>();
  }
  /// Reads a bit. The second argument is there for the encoder alone.
  bool code(AdaptiveBit& model, bool /*bit*/ = false) {
    const std::uint32_t middle =
        low_ + static_cast<std::uint32_t>(std::uint64_t{high_ - low_} * model.chance() >> 16);
    const bool bit = value_ <= middle;
    if (bit)
      high_ = middle;
    else
      low_ = middle + 1;
    model.learn(bit);
    while ((low_ ^ high_) >> 24 == 0) {
      low_ <<= 8;
      high_ = high_ << 8 | 255;
      value_ = value_ << 8 | in_.get<std::uint8_t>();
    }
    return bit;
  }

 private:
  ByteReader& in_;
  std::uint32_t low_ = 0, high_ = ~0u, value_ = 0;
};

/// A byte as eight bits, highest first, each in the context of those before it.
template <class Coder>
std::uint8_t code_byte(Coder& coder, std::array<AdaptiveBit, 256>& model, std::uint8_t byte) {
  std::uint32_t path = 1;
  for (int i = 7; i >= 0; --i)
    path = path << 1 | static_cast<std::uint32_t>(coder.code(model[path], (byte >> i & 1) != 0));
  return static_cast<std::uint8_t>(path);
}

}  // namespace cavum
