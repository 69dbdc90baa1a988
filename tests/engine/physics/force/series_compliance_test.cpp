#include <gtest/gtest.h>

#include "engine/physics/force/term_laws.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/closed_loop.h"

namespace cavum {
namespace {

using namespace testing_engine;

ForceModel compliant(double k, double c, double ks) {
  return with_terms(hard_model(k, c), {{"series_compliance", {{"ks_n_per_mm", ks}}}});
}

/// Two springs in series, solved by halving: where both carry the same force.
double in_series_n(double k, double ks, double x_mm) {
  double low = 0, high = x_mm;  // compression of the tissue
  for (int i = 0; i < 200; ++i) {
    const double tissue = 0.5 * (low + high);
    (k * tissue < ks * (x_mm - tissue) ? low : high) = tissue;
  }
  return k * low;
}

TEST(SeriesCompliance, IsTwoSpringsInSeries) {
  Random random(drawn_seed("SeriesCompliance.IsTwoSpringsInSeries"));
  for (int i = 0; i < 2000; ++i) {
    const double k = random.uniform(0, 2), ks = random.uniform(0.05, 20),
                 x = random.uniform(0.001, 2);
    const ForceTerms terms = compliant(0.8, 0, ks).terms;
    TermMemory memory{};
    const TermInput in{true, x, 0, 0, k, 0, 0, 0, 0, 0.001};
    const double f = force_along_feed_n(terms, in, {&memory, 1});
    ASSERT_NEAR(f, in_series_n(k, ks, x), 1e-9);
    ASSERT_NEAR(f, k * x / (1 + k / ks), 1e-12);
    ASSERT_EQ(memory, TermMemory{});
  }
}

TEST(SeriesCompliance, LeavesTheDamperAndTheAirAsTheyAre) {
  const ForceTerms terms = compliant(0.8, 1.79, 2).terms;
  TermMemory memory{};
  TermInput in{true, 0.5, 0.25, 0, 0.8, 1.79, 0, 0, 0, 0.001};
  EXPECT_NEAR(force_along_feed_n(terms, in, {&memory, 1}), 0.8 * 0.5 / 1.4 + 1.79 * 0.25, 1e-12);
  in.approach_mm_s = -1;
  EXPECT_EQ(force_along_feed_n(terms, in, {&memory, 1}), 0.0) << "tissue never pulls";
  in.touching = false;
  EXPECT_EQ(force_along_feed_n(terms, in, {&memory, 1}), 0.0);
}

TEST(SeriesCompliance, AtRestTheServoRendersItWithin1Percent) {
  for (const double ks : {0.3, 0.8, 5.0}) {
    Rig rig(make_cube(4, "dentin", 0.1), {shipped_bur("round-1.0")}, compliant(0.8, 1.79, ks),
            {0, 0, 0.05});
    (void)rig.travel({0, 0, 0.05}, {0, 0, -0.8}, 2.0);
    TickOutput out;
    for (int i = 0; i < 20000; ++i) out = rig.tick({0, 0, -0.8}, 0);
    const double law = in_series_n(0.8, ks, out.penetration_mm);
    EXPECT_NEAR(out.model_force_n / law, 1.0, 1e-6) << ks;
    EXPECT_NEAR(out.rendered_force_n.z / law, 1.0, 0.01) << ks;
    EXPECT_EQ(out.drag_n, Vec3{});
  }
}

}  // namespace
}  // namespace cavum
