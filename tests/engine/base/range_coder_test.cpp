#include "engine/base/range_coder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

/// Bits with contexts: each says which of the models it belongs to.
struct Sent {
  std::vector<bool> bit;
  std::vector<std::size_t> model;
};
constexpr std::size_t k_models = 5;

Bytes encoded(const Sent& message) {
  std::vector<AdaptiveBit> models(k_models);
  RangeEncoder out;
  for (std::size_t i = 0; i < message.bit.size(); ++i)
    out.code(models[message.model[i]], message.bit[i]);
  return out.finish();
}

std::vector<bool> decoded(const Bytes& bytes, const std::vector<std::size_t>& model) {
  std::vector<AdaptiveBit> models(k_models);
  ByteReader in(bytes, "coded");
  RangeDecoder from(in);
  std::vector<bool> bit;
  for (const std::size_t m : model) bit.push_back(from.code(models[m]));
  EXPECT_EQ(in.left(), 0u);
  return bit;
}

Sent random_message(Random& random, std::size_t length) {
  Sent message;
  const double chance[k_models] = {0.5, 0.02, 0.9, 0.0, 1.0};
  for (std::size_t i = 0; i < length; ++i) {
    message.model.push_back(random.below(k_models));
    message.bit.push_back(random.uniform() < chance[message.model.back()]);
  }
  return message;
}

TEST(RangeCoder, ReadsBackEveryBitAndTakesAllBytes) {
  Random random(drawn_seed("RangeCoder.ReadsBackEveryBitAndTakesAllBytes"));
  for (int round = 0; round < 200; ++round) {
    const Sent message = random_message(random, random.below(3000));
    ASSERT_EQ(decoded(encoded(message), message.model), message.bit);
  }
}

TEST(RangeCoder, TakesTheRoomThatTheEntropyAsksFor) {
  Random random(drawn_seed("RangeCoder.TakesTheRoomThatTheEntropyAsksFor"));
  for (const double chance : {0.5, 0.3, 0.1, 0.05}) {
    constexpr std::size_t k_bits = 400000;
    std::vector<AdaptiveBit> model(1);
    RangeEncoder out;
    double ones = 0;
    for (std::size_t i = 0; i < k_bits; ++i) ones += out.code(model[0], random.uniform() < chance);
    const double p = ones / double(k_bits),
                 entropy_bytes =
                     -double(k_bits) * (p * std::log2(p) + (1 - p) * std::log2(1 - p)) / 8;
    const double bytes = static_cast<double>(out.finish().size());
    EXPECT_GT(bytes, 0.999 * entropy_bytes) << "chance " << chance;
    EXPECT_LT(bytes, 1.02 * entropy_bytes) << "chance " << chance;
  }
}

// Skewed bytes: 8 models of bits must find the entropy of the bytes.
TEST(RangeCoder, BytesTakeTheRoomOfTheirEntropyToo) {
  Random random(drawn_seed("RangeCoder.BytesTakeTheRoomOfTheirEntropyToo"));
  std::array<AdaptiveBit, 256> to_model{}, from_model{};
  Bytes bytes(200000);
  std::array<double, 256> count{};
  for (auto& b : bytes) {
    b = static_cast<std::uint8_t>(128 + 6 * random.normal());
    ++count[b];
  }
  double entropy_bytes = 0;
  for (const double n : count)
    if (n > 0) entropy_bytes -= n * std::log2(n / static_cast<double>(bytes.size())) / 8;
  RangeEncoder out;
  for (const auto b : bytes) code_byte(out, to_model, b);
  const Bytes packed = out.finish();
  EXPECT_LT(static_cast<double>(packed.size()), 1.02 * entropy_bytes);
  ByteReader in(packed, "coded");
  RangeDecoder from(in);
  for (const auto b : bytes) ASSERT_EQ(code_byte(from, from_model, 0), b);
}

TEST(RangeCoder, WhatIsCertainCostsNextToNothing) {
  AdaptiveBit model;
  RangeEncoder out;
  for (int i = 0; i < 1000000; ++i) out.code(model, true);
  EXPECT_LT(out.finish().size(), 50u);
}

TEST(RangeCoder, EveryTruncationIsAnError) {
  Random random(drawn_seed("RangeCoder.EveryTruncationIsAnError"));
  const Sent message = random_message(random, 2000);
  const Bytes bytes = encoded(message);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
    ASSERT_THROW((void)decoded(cut, message.model), Error) << n << " bytes";
  }
}

TEST(RangeCoder, BytesOnDiskStayTheSame) {
  Sent message;
  for (std::size_t i = 0; i < 64; ++i) {
    message.bit.push_back(i % 3 == 0);
    message.model.push_back(i % 2);
  }
  EXPECT_EQ(to_hex(encoded(message)), "75d6a443a6614c09186c6300");
}

}  // namespace
}  // namespace cavum
