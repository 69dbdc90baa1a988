#include "grading/perforation/breakthrough.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace cavum::grading {
namespace {

/// A made-up recording: every part adds ticks of straight motion with a force that runs to a given
/// value.
class Tape {
 public:
  explicit Tape(std::uint64_t seed, double noise_n = 0.02, double tremor_mm = 0.01)
      : random_(seed), noise_n_(noise_n), tremor_mm_(tremor_mm) {}

  /// `ticks` of motion at `speed` (mm/s); the force goes evenly to `force_n`, pushing along
  /// -`into`.
  Tape& run(int ticks, Vec3 speed, double force_n, bool turning = true, Vec3 into = {0, 0, -1}) {
    const double from = force_n_;
    for (int i = 1; i <= ticks; ++i) {
      tip_ += speed * k_tick_s;
      force_n_ = from + (force_n - from) * i / ticks;
      TickInput in;
      const Vec3 p =
          tip_ + Vec3{random_.normal(), random_.normal(), random_.normal()} * tremor_mm_ * 0.1;
      in.tip_nm = {static_cast<int>(p.x * 1e6), static_cast<int>(p.y * 1e6),
                   static_cast<int>(p.z * 1e6)};
      in.flags = k_stylus_fresh | k_pedal_fresh;
      in.pedal_q16 = turning ? 60000 : 0;
      TickRecord r;
      const Vec3 f = into * -(force_n_ > 0 ? force_n_ + noise_n_ * random_.normal() : 0.0);
      r.rendered_un = {static_cast<int>(f.x * 1e6), static_cast<int>(f.y * 1e6),
                       static_cast<int>(f.z * 1e6)};
      r.rpm = turning ? 180000 : 0;
      inputs_.push_back(in);
      records_.push_back(r);
    }
    return *this;
  }
  [[nodiscard]] std::int64_t now() const { return static_cast<std::int64_t>(inputs_.size()); }
  [[nodiscard]] std::vector<Breakthrough> events() const {
    return find_breakthroughs(inputs_, records_);
  }

 private:
  Random random_;
  double noise_n_, tremor_mm_;
  Vec3 tip_{0, 0, 1};
  double force_n_ = 0;
  std::vector<TickInput> inputs_;
  std::vector<TickRecord> records_;
};

/// In air, contact, and a second and a half of steady cutting downwards.
Tape cutting(std::uint64_t seed, double force_n = 0.9, double feed_mm_s = 0.25) {
  Tape t(seed);
  t.run(200, {0, 0, -2}, 0).run(100, {0, 0, -1}, force_n).run(1500, {0, 0, -feed_mm_s}, force_n);
  return t;
}

TEST(Breakthrough, SeesABreakthroughAndDatesItToTheFallTo80Percent) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    const double feed = random.uniform(0.1, 0.5), level = random.uniform(0.4, 2.0);
    Tape t = cutting(seed, level, feed);
    const int fall = static_cast<int>(random.uniform(30, 250));
    const double expected = static_cast<double>(t.now()) + fall * 0.2 / 0.98;  // of an even fall
    t.run(fall, {0, 0, -6}, 0.02 * level).run(400, {0, 0, 0}, 0.02 * level).run(200, {0, 0, 5}, 0);
    const auto events = t.events();
    ASSERT_EQ(events.size(), 1u) << "seed " << seed;
    EXPECT_NEAR(static_cast<double>(events[0].tick), expected, 25) << "seed " << seed;
    EXPECT_GT(events[0].force_before_n, events[0].force_after_n) << "seed " << seed;
    EXPECT_GE(events[0].seen_tick, events[0].tick);
  }
}

TEST(Breakthrough, IsSilentInSteadyCutting) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed);
    t.run(3000, {0, 0, -0.25}, 0.7).run(3000, {0, 0, -0.2}, 1.3);
    EXPECT_TRUE(t.events().empty()) << "seed " << seed;
  }
}

TEST(Breakthrough, IsSilentWhenTheBurIsLiftedOff) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed);
    t.run(80, {0, 0, 4}, 0).run(500, {0, 0, 2}, 0);
    EXPECT_TRUE(t.events().empty()) << "seed " << seed;
  }
}

TEST(Breakthrough, IsSilentWhenThePedalIsReleased) {
  Tape t = cutting(3);
  t.run(150, {0, 0, -0.2}, 0.05, false).run(500, {0, 0, -2}, 0, false);
  EXPECT_TRUE(t.events().empty());
}

TEST(Breakthrough, IsSilentWhenTheBurSlipsSideways) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed);
    t.run(80, {8, 0, -1}, 0.02).run(400, {2, 0, 0}, 0);
    EXPECT_TRUE(t.events().empty()) << "seed " << seed;
  }
}

TEST(Breakthrough, IsSilentWhenTheBurMillsAWallAway) {
  // the same push and fall, once along the handle and once across it: there a wall ends, and the
  // next one is met or not
  const auto told = [](std::uint64_t seed, Vec3 into) {
    Tape t(seed);
    t.run(200, into * 2, 0, true, into)
        .run(100, into * 1, 0.9, true, into)
        .run(1500, into * 0.25, 0.9, true, into);
    t.run(60, into * 6, 0.02, true, into).run(400, {}, 0.02, true, into);
    return t.events().size();
  };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_EQ(told(seed, {0, 0, -1}), 1u) << "seed " << seed;
    EXPECT_EQ(told(seed, {0.8, 0, -0.6}), 1u) << "aslant, seed " << seed;
    EXPECT_EQ(told(seed, {0.6, -0.8, 0}), 0u) << "seed " << seed;
  }
}

TEST(Breakthrough, IsSilentBetweenEnamelAndDentin) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed, 1.0);
    t.run(300, {0, 0, -0.4}, 0.7).run(1000, {0, 0, -0.4}, 0.7);
    EXPECT_TRUE(t.events().empty()) << "seed " << seed;
  }
}

TEST(Breakthrough, IsSilentWhenTheHandEasesOff) {
  // the force of a spring of 0.8 N/mm falls because the tip comes back
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed, 1.0);
    t.run(400, {0, 0, 0.9 / 0.8 / 0.4 - 0.25}, 0.1).run(1000, {0, 0, -0.05}, 0.1);
    EXPECT_TRUE(t.events().empty()) << "seed " << seed;
  }
}

TEST(Breakthrough, SeesABreakthroughUnderAHandThatKeepsItsPace) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed, 0.95, 0.5);
    const double expected = static_cast<double>(t.now()) + 400 * 0.2 * 0.95 / (0.95 - 0.2);
    t.run(400, {0, 0, -0.5}, 0.2).run(400, {0, 0, -0.3}, 0.05);
    const auto events = t.events();
    ASSERT_EQ(events.size(), 1u) << "seed " << seed;
    EXPECT_NEAR(static_cast<double>(events[0].tick), expected, 40) << "seed " << seed;
  }
}

TEST(Breakthrough, RemembersWhereTheTipHasBeen) {
  // down into a hole and out; later, cutting a thin wall aside, the bur falls back into that hole
  Tape t(5);
  t.run(200, {0, 0, -2}, 0).run(100, {0, 0, -1}, 0.9).run(2000, {0, 0, -0.5}, 0.9);
  t.run(250, {0, 0, 4}, 0).run(250, {0, 0, 4}, 0);
  t.run(100, {0, 0, -4}, 0.0)
      .run(100, {0, 0, -3}, 0.9)
      .run(800, {0, 0, -0.05}, 0.9)
      .run(80, {0, 0, -5}, 0.02)
      .run(300, {0, 0, 0}, 0.02);
  EXPECT_TRUE(t.events().empty());
}

TEST(Breakthrough, IsSilentWhenTheHandPausesAndTheCutCatchesUp) {
  // the tip stays, the surface recedes from it: the force decays with tau
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed, 1.0);
    for (const double left : {0.61, 0.37, 0.22, 0.14, 0.08, 0.05, 0.02})
      t.run(1000, {0, 0, 0}, left);
    EXPECT_TRUE(t.events().empty()) << "seed " << seed;
  }
}

TEST(Breakthrough, IsSilentInChatter) {
  // the mean force vanishes, for it swings to and fro
  Tape t = cutting(4, 0.8);
  for (int i = 0; i < 80; ++i)
    t.run(1, {0, 0, -0.5}, 0.8)
        .run(4, {0, 0, -0.5}, 0.8)
        .run(1, {0, 0, -0.5}, 0.8, true, {0, 0, 1})
        .run(4, {0, 0, -0.5}, 0.8, true, {0, 0, 1});
  t.run(500, {0, 0, -0.25}, 0.8);
  EXPECT_TRUE(t.events().empty());
}

TEST(Breakthrough, IsSilentWhenABoundBurIsPulledOut) {
  Tape t(6);
  t.run(200, {0, 0, -2}, 0).run(100, {0, 0, -1}, 0.9).run(1500, {0, 0, -0.25}, 0.9);
  t.run(300, {0, 0, 4}, 0)
      .run(900, {0, 0, 0.3}, 0.9, true, {0, 0, 1})
      .run(60, {0, 0, 5}, 0.02, true, {0, 0, 1})
      .run(300, {0, 0, 5}, 0);
  EXPECT_TRUE(t.events().empty());
}

TEST(Breakthrough, IsSilentInALesionOfAThirdOfTheResistance) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tape t = cutting(seed, 1.0);
    t.run(150, {0, 0, -0.5}, 0.35).run(2000, {0, 0, -0.3}, 0.35);
    EXPECT_TRUE(t.events().empty()) << "seed " << seed;
  }
}

TEST(Breakthrough, IsLessSureInANoisierForce) {
  const auto probability = [](double noise_n) {
    Tape t(8, noise_n);
    t.run(200, {0, 0, -2}, 0)
        .run(100, {0, 0, -1}, 0.12)
        .run(1500, {0, 0, -0.25}, 0.12)
        .run(80, {0, 0, -4}, 0.001)
        .run(400, {0, 0, 0}, 0.001);
    const auto events = t.events();
    return events.empty() ? 0.0 : events[0].probability;
  };
  EXPECT_GT(probability(0.0), probability(0.1));
}

TEST(Breakthrough, SeesTheSecondBreakthroughToo) {
  Tape t = cutting(9);
  t.run(100, {0, 0, -4}, 0.03)
      .run(600, {0, 0, -1}, 0.0)
      .run(100, {0, 0, -1}, 0.9)
      .run(1500, {0, 0, -0.25}, 0.9);
  const std::int64_t second = t.now();
  t.run(100, {0, 0, -4}, 0.03).run(300, {0, 0, 0}, 0.0);
  const auto events = t.events();
  ASSERT_EQ(events.size(), 2u);
  EXPECT_NEAR(static_cast<double>(events[1].tick), static_cast<double>(second), 50);
}

}  // namespace
}  // namespace cavum::grading
