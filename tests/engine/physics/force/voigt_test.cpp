#include "engine/physics/force/voigt.h"

#include <gtest/gtest.h>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(Voigt, NeverPullsAndIsSpringAndDamperOtherwise) {
  Random random(drawn_seed("Voigt.NeverPullsAndIsSpringAndDamperOtherwise"));
  int clipped = 0;
  for (int i = 0; i < 20000; ++i) {
    const Viscoelastic tissue{random.uniform(0, 2), random.uniform(0, 2)};
    const double x = random.uniform(0, 2), v = random.uniform(-5, 5);
    const double f = voigt_force_n(tissue, x, v),
                 law = tissue.stiffness_n_per_mm * x + tissue.damping_n_s_per_mm * v;
    ASSERT_GE(f, 0.0);
    if (law >= 0) {
      ASSERT_DOUBLE_EQ(f, law);
    } else {
      ASSERT_EQ(f, 0.0);
      ++clipped;
    }
  }
  EXPECT_GT(clipped, 1000);
}

TEST(Voigt, GivesNothingOutOfContactWhateverTheSpeed) {
  EXPECT_EQ(voigt_force_n({0.8, 1.79}, 0.0, 10), 0.0);
  EXPECT_EQ(voigt_force_n({0.8, 1.79}, -0.1, 10), 0.0);
  EXPECT_EQ(voigt_force_n({0.8, 1.79}, NAN, 10), 0.0);
}

TEST(Voigt, GivesThePapersCutForceOfARealTooth) {  // 1.071 N at X = 0.505 mm needs k X + c V, or k
                                                   // X + 0.673 N with k = 0.789
  EXPECT_NEAR(voigt_force_n({0.789, 0}, 0.505, 0.25) + 0.673, 1.071, 0.001);
}

}  // namespace
}  // namespace cavum
