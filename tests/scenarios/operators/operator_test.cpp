#include "scenarios/operators/operator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace cavum::scenarios {
namespace {

struct Pressed {
  std::vector<double> force_n, handle_mm;  ///< by tick
};

/// A candidate who bores straight down into a half space that is nothing but a spring of `k` and
/// recedes at X/2.02 s, for 6 s.
Pressed bore(const Skill& skill, double k) {
  Operator hands(skill, {{{0, 0, 1}, false, false}, {{0, 0, -8}, true, false}}, {0, 0, 1}, 1);
  const OmniModel omni;
  OmniState device = make_omni_state(hands.start_mm());
  double surface_mm = 0;
  TickOutput seen;
  seen.proxy_mm = hands.start_mm();
  Pressed out;
  for (int tick = 0; tick < 6000; ++tick) {
    const Intent intent = hands.act(seen, k_tick_s);
    const Vec3 tip =
        advance_omni(omni, skill.hand, device, seen.rendered_force_n, intent.tip_mm, k_tick_s);
    const double deep_mm = std::max(0.0, surface_mm - tip.z);
    seen.contact = deep_mm > 0;
    seen.proxy_mm = {tip.x, tip.y, std::max(tip.z, surface_mm)};
    seen.penetration_mm = deep_mm;
    seen.rendered_force_n = {0, 0, k * deep_mm};
    surface_mm -= intent.pedal > 0.5 ? deep_mm / 2.02 * k_tick_s : 0.0;
    out.force_n.push_back(k * deep_mm);
    out.handle_mm.push_back(device.position_mm.z);
  }
  return out;
}

/// A hand feels a force; how far a bur has sunk into tissue it does not.
TEST(Operator, PressesWithTheSameForceWhateverTheStiffness) {
  for (const char* name : {"expert", "novice"}) {
    const Skill skill = make_skill(name, 3);
    for (const double k : {0.6, 0.8, 1.2}) {
      const Pressed pressed = bore(skill, k);
      double mean = 0;
      for (std::size_t i = 3000; i < 6000; ++i) mean += pressed.force_n[i] / 3000;
      EXPECT_NEAR(mean, skill.press_n, 0.1 * skill.press_n) << name << ", k = " << k;
    }
  }
}

/// What a hand does within 30 ms is tremor, not boring: an expert's handle keeps to its mean.
TEST(Operator, DoesNotChatter) {
  const Pressed pressed = bore(make_skill("expert", 3), 0.8);
  constexpr std::size_t k_half = 15;
  double most = 0;
  for (std::size_t i = 3000; i + k_half < pressed.handle_mm.size(); ++i) {
    double mean = 0;
    for (std::size_t j = i - k_half; j <= i + k_half; ++j)
      mean += pressed.handle_mm[j] / (2 * k_half + 1);
    most = std::max(most, std::abs(pressed.handle_mm[i] - mean));
  }
  EXPECT_LT(most, 0.05);
}

}  // namespace
}  // namespace cavum::scenarios
