#include "engine/session/chunk_codec.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/session/session.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

// Mostly extremes and small steps, the rest anything.
template <class T>
T draw(Random& random, T before) {
  switch (random.below(4)) {
    case 0:
      return std::numeric_limits<T>::max();
    case 1:
      return std::numeric_limits<T>::min();
    case 2:
      return static_cast<T>(static_cast<std::uint64_t>(before) + random.below(5) - 2);
    default:
      return static_cast<T>(random.next());
  }
}

TickInput draw_input(Random& random, const TickInput& b) {
  TickInput in;
  for (std::size_t i = 0; i < 3; ++i) in.tip_nm[i] = draw(random, b.tip_nm[i]);
  for (std::size_t i = 0; i < 4; ++i) in.rotation_q30[i] = draw(random, b.rotation_q30[i]);
  in.pedal_q16 = draw(random, b.pedal_q16);
  in.flags = draw(random, b.flags);
  in.bur = draw(random, b.bur);
  return in;
}

TickRecord draw_record(Random& random, const TickRecord& b) {
  TickRecord r;
  for (std::size_t i = 0; i < 3; ++i) r.rendered_un[i] = draw(random, b.rendered_un[i]);
  for (std::size_t i = 0; i < 3; ++i) r.proxy_nm[i] = draw(random, b.proxy_nm[i]);
  r.model_un = draw(random, b.model_un);
  r.penetration_nm = draw(random, b.penetration_nm);
  r.rpm = draw(random, b.rpm);
  r.removed = draw(random, b.removed);
  r.notices = draw(random, b.notices);
  return r;
}

RemovedTicks draw_removed(Random& random, std::size_t ticks) {
  RemovedTicks removed;
  RemovedLeaf b;
  for (std::size_t i = 0; i < ticks; ++i) {
    removed.counts.push_back(random.below(3) == 0 ? static_cast<std::uint32_t>(random.below(60))
                                                  : 0);
    for (std::uint32_t k = 0; k < removed.counts.back(); ++k) {
      b = {draw(random, b.x), draw(random, b.y), draw(random, b.z),
           static_cast<std::uint8_t>(random.next()), 0};
      removed.leaves.push_back(b);
    }
  }
  return removed;
}

TEST(ChunkCodec, ReturnsEveryValueExactlyExtremesIncluded) {
  Random random(test::drawn_seed("ReturnsEveryValueExactlyExtremesIncluded"));
  for (int run = 0; run < 60; ++run) {
    const std::size_t n = run < 4 ? static_cast<std::size_t>(run) : 1 + random.below(k_chunk_ticks);
    std::vector<TickInput> inputs;
    std::vector<TickRecord> records;
    for (std::size_t i = 0; i < n; ++i) {
      inputs.push_back(draw_input(random, i > 0 ? inputs.back() : TickInput{}));
      records.push_back(draw_record(random, i > 0 ? records.back() : TickRecord{}));
    }
    const RemovedTicks removed = draw_removed(random, n);
    const auto ticks = static_cast<std::int64_t>(n);
    ASSERT_EQ(unpack_inputs(pack_inputs(inputs), ticks, "test"), inputs);
    ASSERT_EQ(unpack_records(pack_records(records), ticks, "test"), records);
    ASSERT_EQ(unpack_removed(pack_removed(removed), ticks, "test"), removed);
  }
}

TEST(ChunkCodec, SmoothMotionShrinksAtLeastSixfold) {
  std::vector<TickInput> inputs;
  for (std::int64_t i = 0; i < k_chunk_ticks; ++i) inputs.push_back(test::motion_at(i));
  EXPECT_LT(pack_inputs(inputs).size(),
            inputs.size() * 36 / 6);  // 36 bytes a tick as plain columns
}

TEST(ChunkCodec, RefusesAnyOtherNumberOfTicks) {
  std::vector<TickInput> inputs(10);
  const Bytes packed = pack_inputs(inputs);
  for (const std::int64_t ticks : {0L, 9L, 11L, -1L, 1001L, std::numeric_limits<long>::max()})
    EXPECT_THROW((void)unpack_inputs(packed, ticks, "test"), Error) << ticks;
  const Bytes removed = pack_removed({{1, 0}, {RemovedLeaf{1, 2, 3, 4, 0}}});
  for (const std::int64_t ticks : {0L, 1L, 3L, 1001L})
    EXPECT_THROW((void)unpack_removed(removed, ticks, "test"), Error) << ticks;
}

TEST(ChunkCodec, ArbitraryBytesGiveAnErrorOrValuesButNeverMore) {
  Random random(test::drawn_seed("ArbitraryBytesGiveAnErrorOrValuesButNeverMore"));
  const RemovedTicks removed = draw_removed(random, 300);
  std::vector<TickRecord> records(300);
  for (auto& r : records) r = draw_record(random, {});
  const Bytes good_removed = pack_removed(removed), good_records = pack_records(records);
  int errors = 0;
  for (int run = 0; run < 4000; ++run) {
    Bytes bytes;
    if (run % 2 == 0) {
      bytes.resize(random.below(400));
      for (auto& b : bytes) b = static_cast<std::uint8_t>(random.next());
      if (bytes.size() > 4 && run % 4 == 0)
        std::copy(good_removed.begin(), good_removed.begin() + 4,
                  bytes.begin());  // zstd's magic number
    } else {
      bytes = run % 4 == 1 ? good_removed : good_records;
      bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1u << random.below(8));
      if (random.below(4) == 0) bytes.resize(random.below(bytes.size()));
    }
    const auto attempt = [&](auto unpack) {
      try {
        unpack();
      } catch (const Error&) {
        ++errors;
      }
    };
    attempt([&] { EXPECT_EQ(unpack_inputs(bytes, 300, "test").size(), 300u); });
    attempt([&] { EXPECT_EQ(unpack_records(bytes, 300, "test").size(), 300u); });
    attempt([&] { EXPECT_EQ(unpack_removed(bytes, 300, "test").counts.size(), 300u); });
  }
  EXPECT_GT(errors, 8000);
}

}  // namespace
}  // namespace cavum
