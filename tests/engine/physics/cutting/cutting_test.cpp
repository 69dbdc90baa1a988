// The law of cutting as the whole step applies it: steady penetration, swept volume, and when
// nothing is cut.
#include <gtest/gtest.h>

#include <map>

#include "engine/base/det_math.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr double k_tau = 2.02, k_feed = 0.25;

/// A block of enamel 3 mm high, made once for each leaf.
const Tooth& block(double leaf_mm) {
  static std::map<double, Tooth> made;
  auto found = made.find(leaf_mm);
  if (found == made.end())
    found = made.emplace(leaf_mm, make_block({2.4, 2.4, 3.4}, {{"enamel", 3.4}}, leaf_mm)).first;
  return found->second;
}

/// X(t) of a surface that recedes at X/τ under a feed that began at the surface at t = 0.
double closed_x_mm(double t_s, double feed_mm_s = k_feed, double tau_s = k_tau) {
  return feed_mm_s * tau_s * (1 - std::exp(-t_s / tau_s));
}

struct Plunge {
  double mean_x = 0, least_x = 1e9, most_x = 0, worst_from_closed = 0, removed_mm3 = 0,
         depth_mm = 0;
};

/// Lifts off at once and waits until what was owed is carved.
void lift_off(Rig& rig, Vec3 tip) {
  const int ticks = static_cast<int>(0.1 / rig.model.config.tick_s);
  for (int i = 0; i < ticks; ++i) (void)rig.tick(tip, 1.0);
}

/// Feeds round-1.0 straight down from the surface for `t_s`, and lifts off; X over the last second.
Plunge plunge(double k, double leaf, double dt, double t_s) {
  const Tooth& tooth = block(leaf);
  Rig rig(tooth, {shipped_bur("round-1.0")}, hard_model(k, 2 * std::sqrt(k)), {0, 0, 0.05}, dt);
  rig.spin_up({0, 0, 0.05});
  Plunge p;
  const double lead = 0.05 / k_feed;
  const int n = static_cast<int>((t_s + lead) / dt + 0.5), last = static_cast<int>(1.0 / dt);
  for (int i = 1; i <= n; ++i) {
    const double t = i * dt - lead;
    const TickOutput out = rig.tick({0, 0, -k_feed * t}, 1.0);
    if (t > 0.1)
      p.worst_from_closed =
          std::max(p.worst_from_closed, std::fabs(out.penetration_mm - closed_x_mm(t)));
    if (i > n - last) {
      p.mean_x += out.penetration_mm / last;
      p.least_x = std::min(p.least_x, out.penetration_mm);
      p.most_x = std::max(p.most_x, out.penetration_mm);
    }
  }
  lift_off(rig, {0, 0, 0.3});
  p.removed_mm3 = removed_mm3(tooth.octree, rig.state.tooth);
  p.depth_mm = k_feed * t_s - closed_x_mm(t_s);
  return p;
}

TEST(Cutting, SteadyPenetrationIs0_505MmWhateverStiffnessLeafAndTick) {
  double least = 1e9, most = 0, off = 0, volume = 0;
  for (const double leaf : {0.05, 0.025})
    for (const double dt : {0.001, 0.00025})
      for (const double k : {0.2, 0.8, 1.2}) {
        if (k == 0.8 && dt < 0.001) continue;
        const Plunge p = plunge(k, leaf, dt, 12.0);
        least = std::min(least, p.least_x), most = std::max(most, p.most_x),
        off = std::max(off, p.worst_from_closed);
        EXPECT_NEAR(p.mean_x, 0.505, 0.01) << "k " << k << " leaf " << leaf << " tick " << dt;
        EXPECT_GE(p.least_x, 0.495) << "k " << k << " leaf " << leaf << " tick " << dt;
        EXPECT_LE(p.most_x, 0.515) << "k " << k << " leaf " << leaf << " tick " << dt;
        EXPECT_LE(p.worst_from_closed, 0.01)
            << "from V tau (1 - exp(-t/tau)); k " << k << " leaf " << leaf << " tick " << dt;
        const double swept = k_pi * 0.25 * (p.depth_mm - 0.5) + 2.0 / 3.0 * k_pi * 0.125;
        volume = std::max(volume, std::fabs(p.removed_mm3 / swept - 1) * 100);
        EXPECT_NEAR(p.removed_mm3 / swept, 1.0, 0.02)
            << "volume; k " << k << " leaf " << leaf << " tick " << dt;
      }
  std::printf(
      "plunge: X %.4f .. %.4f mm in the last second, at most %.4f mm from the closed form; volume within %.2f %%\n",
      least, most, off, volume);
}

TEST(Cutting, NoHeadIsHeldInTheHoleItCuts) {
  Random random(drawn_seed("Cutting.NoHeadIsHeldInTheHoleItCuts"));
  for (const char* name : {"round-0.8", "round-1.0", "round-1.4", "pear-1.0", "taper-round-1.2",
                           "cylinder-flat-1.0", "inverted-cone-1.0"}) {
    double most = 0;
    for (int i = 0; i < 8; ++i) {  // anywhere within a leaf: a width of whole leaves once let both
                                   // walls hold the head
      const double x = random.uniform(-0.05, 0.05),
                   y = i % 2 == 0 ? 0.0 : random.uniform(-0.05, 0.05),
                   quantum = i % 4 < 2 ? 0.055 : 0.0;
      Rig rig(block(0.05), {shipped_bur(name)}, hard_model(0.8, 0), {x, y, 0.05});
      rig.spin_up({x, y, 0.05});
      for (int t = 1; t <= 10000; ++t) {
        const double z = 0.05 - k_feed * 1e-3 * t;
        const TickOutput out =
            rig.tick({x, y, quantum > 0 ? std::floor(z / quantum) * quantum : z}, 1.0);
        most = std::max(most, out.penetration_mm - quantum);
      }
    }
    EXPECT_LE(most, k_feed * k_tau + 0.01) << name;
  }
}

TEST(Cutting, RemovalDoesNotDependOnTheLengthOfATick) {
  const Plunge a = plunge(0.8, 0.05, 0.002, 6.0);
  for (const double dt : {0.001, 0.0005, 0.00025}) {
    const Plunge b = plunge(0.8, 0.05, dt, 6.0);
    EXPECT_NEAR(b.removed_mm3 / a.removed_mm3, 1.0, 0.01) << dt;
    EXPECT_NEAR(b.mean_x / a.mean_x, 1.0, 0.01) << dt;
  }
}

TEST(Cutting, WhatIsOwedAtLiftOffIsCarvedWhereItWasOwed) {
  // A tool that jumps out of a deep hole touches its walls on the way: that must not push aside
  // what is owed at the bottom. 0.003 mm: what gathers by its long way to the device until it is
  // out, and the least that is carved.
  for (const double dt : {0.001, 0.00025})
    for (double t_s = 5.9; t_s < 6.17; t_s += 0.05) {
      Rig rig(block(0.05), {shipped_bur("round-1.0")}, hard_model(0.8, 0), {0, 0, 0.05}, dt);
      rig.spin_up({0, 0, 0.05});
      const double lead = 0.05 / k_feed;
      const int n = static_cast<int>((t_s + lead) / dt + 0.5);
      for (int i = 1; i <= n; ++i) (void)rig.tick({0, 0, -k_feed * (i * dt - lead)}, 1.0);
      lift_off(rig, {0, 0, 0.3});
      EXPECT_NEAR(-rig.state.carving.last.tip_mm.z, k_feed * t_s - closed_x_mm(t_s), 0.003)
          << "after " << t_s << " s, tick " << dt;
    }
}

TEST(Cutting, ASlotHasTheVolumeAndTheWallsOfItsSweep) {
  const double half = 1.2, depth = 0.8, r = 0.5;
  for (const double leaf : {0.05, 0.025}) {
    const Tooth& tooth = block(leaf);
    Rig rig(tooth, {shipped_bur("cylinder-flat-1.0")}, hard_model(0.8, 0, 0.2), {-2, 0, -depth});
    rig.spin_up({-2, 0, -depth});
    const TickOutput out = rig.travel({-2, 0, -depth}, {0.4, 0, -depth}, 1.0, 1.0);
    EXPECT_NEAR(out.penetration_mm, 0.2, 0.01) << "X = V tau";
    EXPECT_NEAR(rig.state.carving.last.tip_mm.x, 0.4 - out.penetration_mm, 0.04)
        << "before it lifts off a step may be owed";
    (void)rig.travel({0.4, 0, -depth}, {0.1, 0, -depth}, 1.0,
                     1.0);  // X' = -V - X/tau from V tau on: it lets go after tau ln 2
    lift_off(rig, {0.1, 0, -depth});
    const double reached = rig.state.carving.last.tip_mm.x;
    EXPECT_NEAR(reached, 0.4 - 0.2 * std::log(2.0), 0.004);
    const double swept = depth * (2 * r * (reached + half) + k_pi * r * r / 2),
                 removed = removed_mm3(tooth.octree, rig.state.tooth);
    // walls and floor, away from both ends, against the sweep
    Octree::Cursor cursor;
    double worst = 0, sum2 = 0;
    int n = 0;
    for (double x = -half + 0.2; x < reached - 0.2; x += 0.007)
      for (double s = 0.15; s < 0.65; s += 0.05) {
        for (const Vec3 at : {Vec3{x, r, -s}, Vec3{x, -r, -s}, Vec3{x, s - 0.4, -depth}}) {
          const double d = rig.state.tooth.sample(at, cursor).distance_mm;
          worst = std::max(worst, std::fabs(d));
          sum2 += d * d;
          ++n;
        }
      }
    std::printf(
        "slot, leaf %.3f mm: volume %+.2f %%, walls and floor at most %.4f mm from the sweep, %.4f mm rms\n",
        leaf, (removed / swept - 1) * 100, worst, std::sqrt(sum2 / n));
    EXPECT_NEAR(removed / swept, 1.0, 0.02) << leaf;
    EXPECT_LE(worst, 0.5 * leaf) << "roughness of a straight cut";
  }
}

TEST(Cutting, ManyShortPecksCutAsDeepAsOneLongPress) {
  // Held 0.3 mm into the tooth, the surface recedes by X (1 - exp(-t/tau)): in each peck of its
  // own, or in one press
  const double press_mm = 0.3;
  for (const double leaf : {0.05, 0.025})
    for (const int pecks : {1, 4, 20}) {
      Rig rig(block(leaf), {shipped_bur("cylinder-flat-1.0")}, hard_model(0.8, 0, k_tau),
              {0, 0, 0.05});
      rig.spin_up({0, 0, 0.05});
      const int ticks = 800 / pecks;
      double depth = 0;
      for (int i = 0; i < pecks; ++i) {
        for (int t = 0; t < ticks; ++t) (void)rig.tick({0, 0, -depth - press_mm}, 1.0);
        lift_off(rig, {0, 0, 0.05});
        depth += press_mm * (1 - std::exp(-ticks * 1e-3 / k_tau));
      }
      const double reached = -rig.state.carving.last.tip_mm.z;
      std::printf("leaf %.3f, %2d pecks of %3d ms: %.4f mm deep, %.4f by the law\n", leaf, pecks,
                  ticks, reached, depth);
      EXPECT_NEAR(reached, depth, 0.03 * depth + 0.001) << pecks << " pecks";
    }
}

TEST(Cutting, NoTickOfSteadyDrillingLooksUpMoreThanAPart) {
  // What a carve changed is gathered anew over a few ticks, and not together with the means.
  for (const double leaf : {0.05, 0.025}) {
    Rig rig(block(leaf), {shipped_bur("round-1.0")}, hard_model(0.8, 0), {0, 0, 0.05});
    rig.spin_up({0, 0, 0.05});
    int most = 0;
    for (int t = 1; t <= 8000; ++t) {
      (void)rig.tick({0, 0, 0.05 - k_feed * 1e-3 * t}, 1.0);
      if (t > 400) most = std::max(most, rig.state.scratch.looked_up);
    }
    std::printf("leaf %.3f: at most %d places in a tick\n", leaf, most);
    EXPECT_LE(most, 320);
  }
}

TEST(Cutting, ACarveIsMadeLongBeforeTheNextIsDueThoughATickDoesLittleOfIt) {
  for (const char* name : {"round-1.4", "endo-access-1.0"}) {
    Rig rig(block(0.025), {shipped_bur(name)}, hard_model(0.8, 0), {0, 0, 0.05});
    rig.spin_up({0, 0, 0.05});
    int longest = 0, now = 0, carves = 0;
    double most_mm = 0;
    for (int t = 1; t <= 8000; ++t) {
      (void)rig.tick({0, 0, 0.05 - k_feed * 1e-3 * t}, 1.0);
      const bool ends = !rig.state.carving.under_way() && now > 0;
      carves += ends;
      now = rig.state.carving.under_way() ? now + 1 : 0;
      longest = std::max(longest, now);
      most_mm = std::max(most_mm, rig.state.recession.pending_mm);
    }
    std::printf("%s, leaf 0.025: %d carves, at most %d ticks each, %.4f mm owed\n", name, carves,
                longest + 1, most_mm);
    EXPECT_GT(longest, 1) << name << ": it should not be made in a single tick";
    EXPECT_LE(longest, 50) << name << ": half of the time to the next one at 0.25 mm/s";
    EXPECT_LE(most_mm, 1.5 * 0.025) << name << ": at 3 steps recession is lost";
  }
}

TEST(Cutting, RecessionIsProportionalToTheSpeedOfTheHandpiece) {
  for (const double pedal : {0.25, 0.5}) {
    Rig rig(block(0.05), {shipped_bur("round-1.0")}, hard_model(0.8, 0, 0.5), {0, 0, 0.05});
    for (int i = 0; i < 2000; ++i) (void)rig.tick({0, 0, 0.05}, pedal);
    const TickOutput out = rig.travel({0, 0, 0.05}, {0, 0, -2.5}, 0.25, pedal);
    EXPECT_NEAR(out.penetration_mm, 0.25 * 0.5 / pedal, 0.01) << pedal;
  }
}

TEST(Cutting, NothingIsRemovedWithTheHandpieceStillThePedalUnknownOrOutOfContact) {
  const std::uint16_t stylus_only = k_stylus_fresh;
  const struct {
    const char* what;
    double pedal, z;
    std::uint16_t flags;
  } cases[] = {{"pedal released", 0.0, -0.3, k_stylus_fresh | k_pedal_fresh},
               {"pedal in its dead travel", 0.015, -0.3, k_stylus_fresh | k_pedal_fresh},
               {"pedal not fresh", 1.0, -0.3, stylus_only},
               {"pedal NaN", NAN, -0.3, k_stylus_fresh | k_pedal_fresh},
               {"pedal above 1", 1.5, -0.3, k_stylus_fresh | k_pedal_fresh},
               {"out of contact", 1.0, 0.01, k_stylus_fresh | k_pedal_fresh}};
  for (const auto& c : cases) {
    Rig rig(block(0.05), {shipped_bur("round-1.0")}, hard_model(0.8, 0), {0, 0, 0.3});
    const auto untouched = rig.state.tooth.edit_hash();
    for (int i = 0; i < 1500; ++i) {
      const double z = std::max(c.z, 0.3 - i * 0.005);
      const TickOutput out = rig.tick({0.0005 * (i % 100), 0, z}, c.pedal, {}, c.flags);
      ASSERT_EQ(out.removed_count, 0u) << c.what;
      ASSERT_FALSE(out.cutting) << c.what;
    }
    EXPECT_EQ(rig.state.tooth.edit_hash(), untouched) << c.what;
    EXPECT_EQ(removed_mm3(block(0.05).octree, rig.state.tooth), 0.0) << c.what;
  }
  Rig control(block(0.05), {shipped_bur("round-1.0")}, hard_model(0.8, 0), {0, 0, 0.3});
  control.spin_up({0, 0, 0.3});
  (void)control.travel({0, 0, 0.3}, {0, 0, -0.3}, 0.5, 1.0);
  EXPECT_GT(removed_mm3(block(0.05).octree, control.state.tooth), 0.0)
      << "the same press with the pedal down does cut";
}

TEST(Cutting, ALostPedalStopsTheHandpieceInTheSameTick) {
  Rig rig(block(0.05), {shipped_bur("round-1.0")}, hard_model(0.8, 0), {0, 0, 0.1});
  rig.spin_up({0, 0, 0.1});
  (void)rig.travel({0, 0, 0.1}, {0, 0, -0.5}, 0.5, 1.0);
  ASSERT_NEAR(rig.state.handpiece.rpm, 200000, 10);
  const auto edits = rig.state.tooth.edit_hash();
  for (int i = 0; i < 1000; ++i) {
    const TickOutput out = rig.tick({0, 0, -0.5}, 1.0, {}, k_stylus_fresh);
    ASSERT_EQ(out.rpm, 0.0);
    ASSERT_EQ(out.removed_count, 0u);
    ASSERT_NE(out.notices & k_notice_no_pedal, 0);
  }
  EXPECT_EQ(rig.state.tooth.edit_hash(), edits);
}

TEST(Cutting, RemovedLeavesAreListedOnceAndWereSolid) {
  Rig rig(block(0.05), {shipped_bur("round-1.0")}, hard_model(0.8, 0, 0.3), {0, 0, 0.1});
  rig.spin_up({0, 0, 0.1});
  std::size_t listed = 0;
  for (int i = 0; i < 2000; ++i) {
    const TickOutput out = rig.tick({0.0002 * i, 0, 0.1 - 0.0005 * i}, 1.0);
    ASSERT_EQ(out.removed_count, rig.state.removed.size());
    for (const auto& leaf : rig.state.removed) {
      ASSERT_EQ(block(0.05).octree.tissue(leaf.leaf()), leaf.tissue);
      ASSERT_EQ(leaf.tissue, k_enamel);
      ASSERT_EQ(rig.state.tooth.tissue(leaf.leaf()), k_air);
    }
    listed += rig.state.removed.size();
  }
  EXPECT_NEAR(static_cast<double>(listed) * 1.25e-4,
              removed_mm3(block(0.05).octree, rig.state.tooth), 1e-9);
}

}  // namespace
}  // namespace cavum
