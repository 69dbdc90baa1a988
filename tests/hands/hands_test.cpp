// Some sessions of each hand, every time: that the truth is right whatever the detector says. The
// whole table: hand_campaign, and README.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "engine/tooth/void_map.h"
#include "tests/engine/support/basics.h"
#include "tests/hands/table.h"

namespace cavum::hands {
namespace {

/// No void tissue within 0.4 mm of anything that was removed.
bool stayed_clear(const Drilled& d) {
  const VoidMap voids(d.before->octree);
  return std::all_of(d.removed.begin(), d.removed.end(), [&](const RemovedAt& r) {
    return voids.clear_mm(d.before->octree.centre_mm(r.leaf.leaf())) >= 0.4;
  });
}

TEST(Hands, NothingIsMissingWhereNoCavityIsNearAndWhatIsOpenedShows) {
  std::uint64_t seed = testing_basics::drawn_seed("Hands");
  std::vector<Examined> all;
  int clear = 0, opened = 0;
  for (const HandKind& kind : all_hands())
    for (int i = 0; i < 3; ++i, ++seed) {
      const Drilled d = drill(kind, seed);
      ASSERT_LT(d.inputs.size(), 60000u) << kind.name << " hangs, seed " << seed;
      const Examined e = examine(d);
      all.push_back(e);
      if (stayed_clear(d)) {
        ++clear;
        const grading::MissingForce missing = grading::missing_force(
            d.filled_model, make_servo_state(d.filled_model, d.filled, d.first_tip_mm), d.inputs,
            d.true_records);
        EXPECT_EQ(missing.felt_n, missing.filled_n) << kind.name << ", seed " << seed;
        EXPECT_LT(e.opened_tick, 0);
      }
      if (e.opened_tick >= 0) {
        ++opened;
        EXPECT_GT(e.area_mm2, 0.0) << kind.name << ", seed " << seed;
        EXPECT_GE(e.drop.missing_n, 0.0);
      }
    }
  std::cout << table(all);
  EXPECT_GT(clear, 3);
  EXPECT_GT(opened, 0);
}

}  // namespace
}  // namespace cavum::hands
