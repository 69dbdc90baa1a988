// The sets that cut by penetration give the bits that they gave when physics version 1 was made.
#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

/// Down through enamel and dentin into pulp, swaying, tilted, with a pedal that is half released on
/// the way.
std::uint64_t drilled_hash(const std::string& set, const std::string& bur) {
  static const Tooth block = make_block(
      {3.0, 3.0, 2.4}, {{"enamel", 0.8}, {"dentin", 0.8}, {"pulp", 0.4}, {"dentin", 0.4}}, 0.05);
  Rig rig(block, {shipped_bur(bur)}, shipped_model(set), {0.2, 0, 0.05});
  rig.spin_up({0.2, 0, 0.05});
  for (int i = 0; i < 9000; ++i) {
    const SinCos sway = det_sincos(2 * k_pi * 0.7e-3 * i);
    const Quat turned = normalized(Quat{1.0, 0.05 * sway.sin, 0.03 * sway.cos, 0.0});
    (void)rig.tick({0.2 * sway.cos, 0.3 * sway.sin, 0.05 - 0.35e-3 * i},
                   i / 1000 % 3 == 2 ? 0.5 : 1.0, turned);
  }
  return rig.state.trace_hash ^ rig.state.tooth.edit_hash();
}

TEST(SameBits, SetsThatCutByPenetrationAreWhatTheyWere) {
  EXPECT_EQ(drilled_hash("paper", "round-1.0"), 1925890764242302917u);
  EXPECT_EQ(drilled_hash("consistent", "round-1.0"), 17436531992316821440u);
  EXPECT_EQ(drilled_hash("paper", "cylinder-flat-1.0"), 4527802908054652925u);
  EXPECT_EQ(drilled_hash("consistent", "inverted-cone-1.0"), 2004263203736063552u);
}

}  // namespace
}  // namespace cavum
