#include "engine/physics/cutting/carve_head.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

std::vector<RemovedLeaf> room() {
  std::vector<RemovedLeaf> removed;
  removed.reserve(200000);
  return removed;
}

/// A whole carve in one call; false when room ran out.
bool carve(Octree& tooth, const Bur& bur, const CarvedHead& head, HeadCarving& carving,
           std::vector<RemovedLeaf>& removed) {
  begin_carving(carving, head);
  return go_on_carving(carving, tooth, bur, k_at_once, removed) == CarvingStep::done;
}

// The head is tabulated (head_field.h): what lies within 4 micrometres of its surface may fall
// either way.
TEST(CarveHead, RemovesTheLeavesWhoseCentreTheHeadHeldAndNoOther) {
  Random random(drawn_seed("CarveHead.RemovesTheLeavesWhoseCentreTheHeadHeldAndNoOther"));
  for (const auto& name : bur_names()) {
    const Bur bur = shipped_bur(name);
    Tooth tooth = make_block({2, 2, 2}, {{"enamel", 1}, {"dentin", 1}}, 0.1);
    const TissueGrid before = tooth.octree.to_grid();
    tooth.octree.reserve_edits(20000);
    auto removed = room();
    std::vector<Pose> poses;
    HeadCarving carving;
    Quat turned = random_rotation(random);
    Vec3 tip{random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(-1.5, -0.5)},
        way = random_direction(random) * 0.02;
    for (int i = 0; i < 40; ++i) {  // straight runs with one rotation, now and then a turn: the
                                    // leading side alone is carved
      if (random.below(8) == 0) way = random_direction(random) * 0.02;
      if (random.below(12) == 0) turned = random_rotation(random);
      tip += way;
      poses.push_back({tip, turned});
      ASSERT_TRUE(carve(tooth.octree, bur, {tip, rotation(turned), 0}, carving, removed));
    }
    const TissueGrid after = tooth.octree.to_grid();
    std::size_t gone = 0;
    for (std::int32_t z = 0; z < before.size.z; ++z)
      for (std::int32_t y = 0; y < before.size.y; ++y)
        for (std::int32_t x = 0; x < before.size.x; ++x) {
          const auto i = before.index({x, y, z});
          double nearest = 1e9;
          for (const auto& p : poses)
            nearest = std::min(
                nearest,
                bur.head_distance_mm(
                    rotation(p.rotation).transposed(before.centre_mm({x, y, z}) - p.tip_mm)));
          gone += before.tissue[i] != after.tissue[i];
          if (std::fabs(nearest) < 0.004) continue;
          ASSERT_EQ(after.tissue[i], nearest < 0 ? std::uint8_t{k_air} : before.tissue[i])
              << name << " leaf " << x << ' ' << y << ' ' << z << " distance " << nearest;
        }
    EXPECT_EQ(gone, removed.size()) << name << ": every removed leaf is listed once";
    EXPECT_GT(gone, 0u) << name;
  }
}

TEST(CarveHead, TheLeadingSideAloneGivesTheToothOfTheWholeHeadToOneCode) {
  Random random(drawn_seed("CarveHead.TheLeadingSideAloneGivesTheToothOfTheWholeHeadToOneCode"));
  for (const auto& name : bur_names())
    for (int round = 0; round < 3; ++round) {
      const Bur bur = shipped_bur(name);
      Tooth one = make_block({2, 2, 2}, {{"enamel", 2}}, 0.05);
      one.octree.reserve_edits(20000);
      Tooth two;
      two.octree = one.octree;
      auto removed_one = room(), removed_two = room();
      HeadCarving carving;
      const Mat3 turned = rotation(random_rotation(random));
      Vec3 tip{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1.5, 0.3)};
      for (int i = 0; i < 30; ++i) {
        tip += random_direction(random) * random.uniform(0.002, 0.05);
        ASSERT_TRUE(carve(one.octree, bur, {tip, turned, 0}, carving, removed_one));
        HeadCarving anew;
        ASSERT_TRUE(carve(two.octree, bur, {tip, turned, 0}, anew, removed_two));
      }
      const TissueGrid a = one.octree.to_grid(), b = two.octree.to_grid();
      ASSERT_EQ(a.tissue, b.tissue) << name;
      for (std::size_t i = 0; i < a.distance.size(); ++i)
        ASSERT_LE(std::abs(a.distance[i] - b.distance[i]), 1)
            << name << " at leaf index " << i << " (127 codes are 2 leaves)";
    }
}

void spread_over_many_ticks(std::uint64_t seed) {
  Random random(seed);
  int all_calls = 0, carves = 0;
  for (const auto& name : bur_names()) {
    const Bur bur = shipped_bur(name);
    Tooth one = make_block({2, 2, 2}, {{"enamel", 1}, {"dentin", 1}}, 0.05);
    one.octree.reserve_edits(20000);
    Tooth two;
    two.octree = one.octree;
    auto removed_one = room(), removed_two = room();
    HeadCarving at_once, spread;
    const Mat3 turned = rotation(random_rotation(random));
    Vec3 tip{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1.5, 0.3)};
    int calls = 0;
    for (int i = 0; i < 6; ++i) {
      tip += random_direction(random) * random.uniform(0.002, 0.05);
      ASSERT_TRUE(carve(one.octree, bur, {tip, turned, 0}, at_once, removed_one));
      begin_carving(spread, {tip, turned, 0});
      const auto before = two.octree.edit_hash();
      const auto listed = removed_two.size();
      for (CarvingStep step = CarvingStep::under_way; step == CarvingStep::under_way; ++calls) {
        ASSERT_TRUE(two.octree.edit_hash() == before || spread.plan.progress() >> 32 > 0 ||
                    spread.worked_out)
            << "edited before anything was worked out";
        if (two.octree.edit_hash() == before) {
          ASSERT_EQ(removed_two.size(), listed);
        }
        step = go_on_carving(spread, two.octree, bur, static_cast<int>(random.below(600)) + 1,
                             removed_two);
        ASSERT_NE(step, CarvingStep::no_room);
        ASSERT_LT(calls, 100000) << "it never ends";
      }
      ASSERT_EQ(one.octree.edit_hash(), two.octree.edit_hash()) << name << " carve " << i;
    }
    all_calls += calls;
    carves += 6;
    ASSERT_EQ(removed_one, removed_two) << name;
    const TissueGrid a = one.octree.to_grid(), b = two.octree.to_grid();
    ASSERT_EQ(a.tissue, b.tissue) << name;
    ASSERT_EQ(a.distance, b.distance) << name;
  }
  EXPECT_GT(all_calls, 3 * carves) << "hardly ever spread: two calls are the least";
}

TEST(CarveHead, SpreadOverManyTicksItGivesTheSameBitsAndNothingBeforeTheLast) {
  spread_over_many_ticks(
      drawn_seed("CarveHead.SpreadOverManyTicksItGivesTheSameBitsAndNothingBeforeTheLast"));
}
TEST(CarveHead, APlanThatIsAppliedInPartsGivesTheSameBits) {
  spread_over_many_ticks(70199232396505137);
}  // drawn once

TEST(CarveHead, WhatIsDroppedWasNeverCarved) {
  const Bur bur = shipped_bur("round-1.0");
  Tooth tooth = make_block({2, 2, 2}, {{"enamel", 2}}, 0.05);
  tooth.octree.reserve_edits(20000);
  auto removed = room();
  HeadCarving carving;
  const auto before = tooth.octree.edit_hash();
  begin_carving(carving, {{0, 0, -0.5}, Mat3{}, 0});
  ASSERT_EQ(go_on_carving(carving, tooth.octree, bur, 1000, removed), CarvingStep::under_way);
  drop_carving(carving);
  EXPECT_FALSE(carving.under_way());
  EXPECT_EQ(tooth.octree.edit_hash(), before);
  EXPECT_TRUE(removed.empty());
  EXPECT_EQ(carving.last.bur, -1);
}

TEST(CarveHead, FullRoomIsToldAndTheNextCarveMakesUpForIt) {
  const Bur bur = shipped_bur("round-1.0");
  Tooth tooth = make_block({2, 2, 2}, {{"enamel", 2}}, 0.05);
  tooth.octree.reserve_edits(20000);
  std::vector<RemovedLeaf> little;
  little.reserve(10);
  HeadCarving carving;
  EXPECT_FALSE(carve(tooth.octree, bur, {{0, 0, -0.5}, Mat3{}, 0}, carving, little));
  EXPECT_LE(little.size(), little.capacity());
  EXPECT_EQ(little.capacity(), 10u) << "it grew";
  EXPECT_EQ(carving.last.bur, -1) << "an unfinished carve must not count as done";
  auto removed = room();
  EXPECT_TRUE(carve(tooth.octree, bur, {{0, 0, -0.5}, Mat3{}, 0}, carving, removed));
  const double expected = 2.0 / 3.0 * k_pi * 0.125;  // half a ball
  EXPECT_NEAR(static_cast<double>(removed.size() + little.size()) * 1.25e-4 / expected, 1.0, 0.02);
}

}  // namespace
}  // namespace cavum
