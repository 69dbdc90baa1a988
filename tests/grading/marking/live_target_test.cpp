// What a step's condition sees of the target while the exam runs, against what is graded of the
// same cut.
#include <gtest/gtest.h>

#include <cstdio>

#include "engine/base/random.h"
#include "scenarios/exam/runner.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/carved.h"

namespace cavum::grading {
namespace {

using testing::Carved;

/// The exam's runner fed with what was carved.
struct Live {
  explicit Live(const Carved& c) : runner(c.scenario, c.zones, c.before, {"round-1.0"}) {}
  double percent(const Carved& c) {
    std::vector<RemovedLeaf> now;
    for (; fed < c.removed.size(); ++fed) now.push_back(c.removed[fed].leaf);
    runner.advance(state, {}, {}, now);
    for (std::size_t i = 0; i < runner.names().size(); ++i)
      if (runner.names()[i] == "target_removed_percent") return runner.values()[i];
    return -1;
  }
  scenarios::Runner runner;
  scenarios::RunnerState state;
  std::size_t fed = 0;
};

TEST(LiveTarget, IsTheGradedFigureWithinItsBoundWhateverIsCut) {
  Random random(
      testing_basics::drawn_seed("LiveTarget.IsTheGradedFigureWithinItsBoundWhateverIsCut"));
  double worst = 0, worst_share = 0;
  for (int round = 0; round < 5; ++round) {
    char target[200];
    std::snprintf(
        target, sizeof target,
        "[[zones.target]]\nshape = \"box\"\nat_mm = [%.4f, %.4f, -1]\nsize_mm = [%.4f, %.4f, 2.5]\nturn_deg = %.2f\n",
        random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(1.2, 3),
        random.uniform(1.2, 3), random.uniform(0, 90));
    Carved c(testing::scenario_text(target), testing::dentin_block(3, 4, 0.1));
    c.scenario.steps[0].complete_when = "time_s > 1000";
    Live live(c);
    for (std::int64_t tick = 0; tick < 8; ++tick) {
      const Vec3 at{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2.4, 0)};
      const double radius = random.uniform(0.4, 1.4);
      c.carve([=](Vec3 p) { return length(p - at) - radius; }, tick);
      const Result r = c.graded();
      const double apart = std::fabs(live.percent(c) - r.volumes.target_removed_percent);
      worst = std::max(worst, apart);
      if (r.volumes.target_removed_bound_percent > 0)
        worst_share = std::max(worst_share, apart / r.volumes.target_removed_bound_percent);
      // The bound counts whole leaves of the target: where none went it is 0, though the live
      // figure gives slivers of leaves on the border to it.
      const double leaf_percent = 100 * c.zones.leaf_volume_mm3() / r.volumes.target.mm3;
      EXPECT_LE(apart, r.volumes.target_removed_bound_percent + leaf_percent)
          << "round " << round << " tick " << tick;
    }
    // all of it
    c.carve([&](Vec3 p) { return c.zones.distance_mm(p) - 0.3; }, 8);
    const double graded = c.graded().volumes.target_removed_percent;
    EXPECT_NEAR(graded, 100, 1e-6);
    EXPECT_NEAR(live.percent(c), 100, 1e-3);
  }
  std::printf(
      "live and graded target_removed_percent: %.2f points apart at most, %.2f of the bound (leaf 0.1 mm)\n",
      worst, worst_share);
}

TEST(LiveTarget, CountsOfALeafOnTheBorderWhatLiesInTheTarget) {
  // The target is 11.2 leaves wide; cut along leaves, 1.6 of them go. Whole leaves would make that
  // 2 of 12, 16.7 %. (Edges of the box are rounded a little by the parts: 0.2 points.)
  Carved c(testing::scenario_text(
               "[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, -1]\nsize_mm = [1.12, 2, 2]\n"),
           testing::dentin_block(3, 4, 0.1));
  c.scenario.steps[0].complete_when = "time_s > 1000";
  Live live(c);
  c.carve([](Vec3 p) { return std::max({p.x + 0.4, std::fabs(p.y) - 1.5, -2.5 - p.z}); }, 0);
  EXPECT_NEAR(live.percent(c), 100 * 1.6 / 11.2, 0.3);
  EXPECT_NEAR(c.graded().volumes.target_removed_percent, 100 * 1.6 / 11.2, 0.3);
}

}  // namespace
}  // namespace cavum::grading
