#include "grading/perforation/drop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>
#include <vector>

#include "engine/tooth/fill.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum::grading {
namespace {

using namespace testing_engine;

constexpr double k_k = 0.8, k_c = 0.012, k_tau_s = 2.02, k_roof_mm = 1.0;

std::array<bool, 256> pulp_only() {
  std::array<bool, 256> out{};
  out[k_pulp] = true;
  return out;
}

/// A flat bur of 1 mm goes down into a block at a constant speed, and rests at `deepest_mm`.
struct Descent {
  Tooth tooth =
      make_block({4, 4, 3}, {{"dentin", k_roof_mm}, {"pulp", 0.8}, {"dentin", 1.2}}, 0.05);
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  std::vector<std::int64_t> opened;
  MissingForce missing;

  Descent(double speed_mm_s, double deepest_mm, double rest_s) {
    const double top = tooth.octree.origin_mm().z + tooth.octree.size().z * tooth.octree.leaf_mm();
    const Vec3 start{0, 0, top + 0.05};
    const std::vector<Bur> tray{shipped_bur("cylinder-flat-1.0")};
    Rig rig(tooth, tray, hard_model(k_k, k_c, k_tau_s), start);
    const auto go = [&](Vec3 tip) {
      const TickOutput out = rig.tick(tip, 1.0);
      for (const auto& leaf : rig.state.removed)
        if (leaf.tissue == k_pulp) opened.push_back(static_cast<std::int64_t>(inputs.size()));
      inputs.push_back(rig.input);
      records.push_back(make_tick_record(out));
    };
    for (int i = 0; i < 1500; ++i) go(start);
    const auto ticks = static_cast<int>((deepest_mm + 0.05) / speed_mm_s * 1000.0);
    for (int i = 1; i <= ticks; ++i) go(start - Vec3{0, 0, i * speed_mm_s * 1e-3});
    for (int i = 0; i < static_cast<int>(rest_s * 1000.0); ++i)
      go(start - Vec3{0, 0, ticks * speed_mm_s * 1e-3});
    const Tooth solid = filled_tooth(tooth, pulp_only());
    Rig again(solid, tray, hard_model(k_k, k_c, k_tau_s), start);
    missing = missing_force(again.model, again.state, inputs, records);
  }
};

TEST(ForceDrop, ThroughAWideRoofAllOfTheForceGoesAndTheFilledToothKeepsMaxwellsForce) {
  const double v = 0.2;
  const Descent d(v, k_roof_mm + 0.7, 0.0);
  ASSERT_FALSE(d.opened.empty());
  const ForceDrop drop = find_drop(d.missing, d.opened);
  ASSERT_TRUE(drop.felt());
  // the filled tooth: a Maxwell element pressed at v, F = k v tau (1 - exp(-t/tau)) + c v
  const double t = static_cast<double>(d.inputs.size()) * 1e-3 - 1.5 - 0.05 / v,
               expected = k_k * v * k_tau_s * (1.0 - std::exp(-t / k_tau_s)) + k_c * v;
  EXPECT_NEAR(d.missing.filled_n.back(), expected, 0.05 * expected);
  EXPECT_NEAR(d.missing.felt_n.back(), 0.0, 0.02 * expected);
  EXPECT_GT(drop.share, 0.7);
  EXPECT_LE(drop.missing_n, 1.05 * expected);
  EXPECT_GT(drop.felt_tick, d.opened.front() - 500)
      << "tissue is felt a leaf and a half ahead, 0.4 s at this speed";
  EXPECT_LT(drop.felt_tick, d.opened.front() + 1500);
}

TEST(ForceDrop, NothingIsMissingToTheLastBitWhereNothingWasOpened) {
  const Descent d(0.2, k_roof_mm - 0.45, 1.0);
  ASSERT_TRUE(d.opened.empty());
  ASSERT_GT(*std::max_element(d.missing.felt_n.begin(), d.missing.felt_n.end()), 0.1);
  for (std::size_t i = 0; i < d.missing.felt_n.size(); ++i)
    ASSERT_EQ(d.missing.felt_n[i], d.missing.filled_n[i]) << i;
  EXPECT_EQ(find_drop(d.missing, d.opened).from_tick, -1);
}

TEST(ForceDrop, BeforeTheCavityIsNearNothingIsMissing) {
  const Descent d(0.2, k_roof_mm + 0.7, 0.0);
  const auto near = static_cast<std::size_t>((1.5 + (0.05 + k_roof_mm - 0.5) / 0.2) *
                                             100);  // the tip half a millimetre before the roof
  for (std::size_t i = 0; i < near; ++i) ASSERT_EQ(d.missing.felt_n[i], d.missing.filled_n[i]) << i;
}

/// Frames of 10 ms: what the filled tooth gives, and what is felt of it.
MissingForce story(std::initializer_list<std::pair<double, std::pair<double, double>>> parts) {
  MissingForce out;
  for (const auto& [seconds, force] : parts)
    for (int i = 0; i < static_cast<int>(seconds * 100.0 + 0.5); ++i)
      out.filled_n.push_back(force.first), out.felt_n.push_back(force.second);
  return out;
}

TEST(ForceDrop, WhoComesBackToAnOpenCavityHasLostNothing) {
  const std::vector<std::int64_t> opened{3000};
  EXPECT_FALSE(
      find_drop(story({{2, {0.6, 0.6}}, {1, {0.0, 0.0}}, {2, {0.6, 0.02}}}), opened).felt());
  EXPECT_TRUE(find_drop(story({{3, {0.6, 0.6}}, {2, {0.6, 0.02}}}), opened).felt())
      << "but whoever presses on has";
}

TEST(ForceDrop, WhatGoesOverTwentySecondsIsNotFelt) {
  MissingForce slow;
  std::vector<std::int64_t> opened;
  for (int i = 0; i < 2000; ++i)
    slow.filled_n.push_back(0.6), slow.felt_n.push_back(0.6 * (1.0 - i / 2000.0)),
        opened.push_back(i * 10);
  const ForceDrop drop = find_drop(slow, opened);
  EXPECT_FALSE(drop.felt());
  EXPECT_NEAR(drop.missing_n, 0.6 * 150 / 2000.0, 1e-9) << "1.5 s of it";
  EXPECT_NEAR(drop.share, 150 / 2000.0, 1e-9);
  EXPECT_EQ(drop.severity(), DropSeverity::not_felt);
}

TEST(ForceDrop, SeverityIsWhatWasFeltAndHowLongTheCavityWasOpenedFurther) {
  std::vector<std::int64_t> opened{2990};
  const auto quick = story({{3, {0.6, 0.6}}, {2, {0.6, 0.1}}});
  EXPECT_EQ(find_drop(quick, opened).severity(), DropSeverity::felt);
  for (std::int64_t t = 3100; t < 4000; ++t) opened.push_back(t);
  const ForceDrop on = find_drop(quick, opened);
  EXPECT_EQ(on.severity(), DropSeverity::felt_and_cut_on);
  EXPECT_NEAR(on.cut_on_s, 0.9, 1e-9);
  EXPECT_EQ(on.felt_tick, 3009);
  EXPECT_NEAR(on.missing_n, 0.5, 1e-9);
  EXPECT_EQ(find_drop(story({{3, {0.6, 0.6}}, {2, {0.6, 0.5}}}), {opened.data(), 1}).severity(),
            DropSeverity::faint);
}

TEST(ForceDrop, FarFromAnOpeningALossIsNoDrop) {
  const std::vector<std::int64_t> opened{10000};
  EXPECT_FALSE(find_drop(story({{3, {0.6, 0.6}}, {9, {0.6, 0.1}}}), opened).felt());
}

}  // namespace
}  // namespace cavum::grading
