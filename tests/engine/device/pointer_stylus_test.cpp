// Mouse and keyboard as a stylus: the simulated Omni goes where they want it, at a hand's pace, and
// what they say is taken whole or not at all.
#include "engine/device/pointer_stylus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

namespace cavum {
namespace {

constexpr double k_tick = 1e-3;

OmniModel smooth_omni() {
  OmniModel omni;
  omni.coulomb_n = 0.0;
  omni.quantum_mm = 0.0;
  return omni;
}

PointerIntent at(Vec3 tip, double pedal = 0.0) {
  PointerIntent intent;
  intent.tip_mm = tip;
  intent.pedal = pedal;
  return intent;
}

TEST(PointerStylus, GoesWhereItIsWantedNoFasterThanAHand) {
  PointerStylus stylus(smooth_omni(), HandModel{}, k_tick, at({0, 0, 5}));
  const Vec3 goal{12, -5, 2};
  Vec3 before = stylus.read(k_tick).pose.tip_mm;
  double fastest = 0;
  for (int i = 0; i < 2000; ++i) {
    stylus.want(at(goal));
    const Vec3 now = stylus.read(k_tick).pose.tip_mm;
    stylus.send_force({});
    fastest = std::max(fastest, length(now - before) / k_tick);
    before = now;
  }
  EXPECT_NEAR(length(before - goal), 0.0, 1e-3);
  EXPECT_GT(fastest, 0.5 * PointerStylus::k_fastest_mm_s);
  EXPECT_LT(fastest, 1.3 * PointerStylus::k_fastest_mm_s) << "the mass may swing over a little";
}

TEST(PointerStylus, AForceHoldsItBackByTheStiffnessOfTheHand) {
  const HandModel hand;
  PointerStylus stylus(smooth_omni(), hand, k_tick, at({0, 0, 0}));
  const Vec3 force{0, 0, 1.5};
  Vec3 tip;
  for (int i = 0; i < 3000; ++i) {
    stylus.want(at({0, 0, 0}));
    tip = stylus.read(k_tick).pose.tip_mm;
    stylus.send_force(force);
  }
  EXPECT_NEAR(tip.z, force.z / hand.stiffness_n_per_mm, 1e-3);
  stylus.cut_force();
  for (int i = 0; i < 3000; ++i) {
    stylus.want(at({0, 0, 0}));
    tip = stylus.read(k_tick).pose.tip_mm;
  }
  EXPECT_NEAR(tip.z, 0.0, 1e-3);
}

TEST(PointerStylus, ASilentWindowMakesThePedalUnknown) {
  PointerStylus stylus(OmniModel{}, HandModel{}, k_tick, at({0, 0, 5}, 1.0));
  EXPECT_EQ(stylus.read(k_tick).flags & k_pedal_fresh, 0) << "nobody has spoken yet";
  stylus.want(at({0, 0, 5}, 1.0));
  int fresh = 0;
  for (int i = 0; i < 1000; ++i) fresh += (stylus.read(k_tick).flags & k_pedal_fresh) != 0 ? 1 : 0;
  EXPECT_NEAR(fresh * k_tick, PointerStylus::k_silent_s, 2 * k_tick);
  EXPECT_NE(stylus.read(k_tick).flags & k_stylus_fresh, 0) << "the simulated stylus itself goes on";
  stylus.want(at({0, 0, 5}, 0.5));
  const DeviceReading again = stylus.read(k_tick);
  EXPECT_NE(again.flags & k_pedal_fresh, 0);
  EXPECT_EQ(again.pedal, 0.5);
}

TEST(PointerStylus, NonsenseLeavesTheLastIntentAsItWas) {
  PointerStylus stylus(OmniModel{}, HandModel{}, k_tick, at({0, 0, 5}));
  stylus.want(at({1, 0, 5}, 0.25));
  EXPECT_EQ(stylus.read(k_tick).pedal, 0.25);
  stylus.want(at({std::nan(""), 0, 5}, 0.75));
  stylus.want(at({0, 0, 5}, INFINITY));
  EXPECT_EQ(stylus.read(k_tick).pedal, 0.25);
}

TEST(PointerStylus, AnIntentIsTakenWholeOrNotAtAll) {
  // pedal and direction are tied to one number by the writer; no reading may hold those of two
  PointerStylus stylus(OmniModel{}, HandModel{}, k_tick, at({0, 0, 5}));
  std::atomic<bool> stop{false};
  std::thread window([&] {
    for (std::uint32_t i = 0; !stop.load(); ++i) {
      const double p = (i % 1000) / 1000.0;
      PointerIntent intent = at({0, 0, 5}, p);
      intent.rotation = {p, std::sqrt(1 - p * p), 0, 0};
      intent.button_1 = p > 0.5;
      stylus.want(intent);
    }
  });
  int moved = 0;
  double last = -1;
  for (int i = 0; i < 50000000 && moved < 300;
       ++i) {  // a busy computer may keep the writer waiting
    const DeviceReading r = stylus.read(0.0);
    if (i == 0 || last < 0) {
      last = r.pedal;
      continue;
    }
    if (r.pedal != last) ++moved;
    last = r.pedal;
    if (moved == 0) continue;  // the first intent of all has no such tie
    ASSERT_NEAR(r.pose.rotation.w, r.pedal, 1e-12);
    ASSERT_EQ((r.flags & k_button_1) != 0, r.pedal > 0.5);
  }
  stop = true;
  window.join();
  EXPECT_GT(moved, 0);
}

}  // namespace
}  // namespace cavum
