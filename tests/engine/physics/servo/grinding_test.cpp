// Cutting by pressure as the whole step applies it, against Preston's integral in closed form; the
// handpiece under load against its drive's line.
#include "engine/physics/servo/grinding.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/base/det_math.h"
#include "engine/physics/contact/tuning.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

constexpr double k_radius_mm = 0.5, k_free_rpm = 200000.0, k_omega = k_free_rpm * 2 * k_pi / 60;

/// The clinical set with another drive; torque 0: speed holds.
ForceModel clinical(double torque_n_mm = 0.0, double slip_rpm = 1.0) {
  ForceModel model = shipped_model("clinical");
  model.drive = {torque_n_mm, slip_rpm};
  return model;
}
double wear_mm2_per_n(const char* tissue) {
  return shipped_model("clinical").materials.find(tissue)->second.wear_mm3_per_n_m / 1000;
}

const Tooth& block_of(const std::string& tissue) {
  static std::map<std::string, Tooth> made;
  auto found = made.find(tissue);
  if (found == made.end())
    found = made.emplace(tissue, make_block({2.4, 2.4, 3.0}, {{tissue, 3.0}}, 0.05)).first;
  return found->second;
}

/// A weight on a bur that turns: the tip is put where k X = load.
struct Weight {
  Rig rig;
  double load_n, z;
  Weight(const Tooth& tooth, const ForceModel& force, double load,
         const char* bur = "cylinder-flat-1.0", double dt_s = k_tick_s)
      : rig(tooth, {shipped_bur(bur)}, force, {0, 0, 0.02}, dt_s), load_n(load), z(0.02) {
    rig.spin_up({0, 0, 0.02});
  }
  TickOutput tick(double pedal = 1.0) {
    const TickOutput out = rig.tick({0, 0, z}, pedal);
    z = out.contact && out.stiffness_n_per_mm > 0
            ? std::max(z - 1e-2, -depth_mm() - load_n / out.stiffness_n_per_mm)
            : z - 1e-3;
    return out;
  }
  [[nodiscard]] double depth_mm() const {
    return std::max(0.0, rig.state.recession.pending_mm) - rig.state.contact.proxy_mm.z;
  }
  /// Mean speed of recession, mm/s, between two depths.
  double speed_mm_s(double from_mm, double to_mm) {
    int ticks = 0;
    double first = 0;
    for (int i = 0; i < 300000 && depth_mm() < to_mm; ++i) {
      (void)tick();
      if (depth_mm() < from_mm) continue;
      if (ticks++ == 0) first = depth_mm();
    }
    return (depth_mm() - first) / ((ticks - 1) * rig.tick_s);
  }
};

/// Preston for a rigid flat end: pressure p = h/(K ω r) over the disk, F = ∫ p 2πr dr = 2π h R/(K
/// ω), so h = K (F/A) v with A = πR² and v = ωR/2.
double preston_mm_s(double wear, double load_n) {
  return wear * load_n / (k_pi * k_radius_mm * k_radius_mm) * (k_omega * k_radius_mm / 2);
}

/// S K and Q K of the end as it is felt (contact_tool.h): places within 0.08 mm of its edge lie on
/// a fillet, with the area of the sharp edge; those further than 0.2 leaves from the floor touch
/// less and less up to 0.7; within 0.05 mm of the axis the coating counts as 0.05 mm from it.
struct FeltEnd {
  double per_turn = 0, sliding = 0;
  explicit FeltEnd(double leaf_mm = 0.05) {
    constexpr double k_d = 1e-5, k_edge = tuning::k_edge_radius_mm;
    const auto add = [&](double area, double aside, double cosine) {
      const double r = k_radius_mm - k_edge + aside, gap = k_edge * (1 - cosine);
      const double seen =
          area * cosine * std::clamp(1 - (gap - 0.2 * leaf_mm) / (0.5 * leaf_mm), 0.0, 1.0);
      per_turn += seen * cosine / std::max(r, 0.05);
      sliding += seen;
    };
    for (double r = k_d / 2; r < k_radius_mm - k_edge; r += k_d)
      add(2 * k_pi * r * k_d, r - k_radius_mm + k_edge, 1.0);
    for (double t = k_d / 2; t < k_edge;
         t += k_d) {  // t: from the corner, along the floor and up the side
      const double length_mm = std::sqrt((k_edge - t) * (k_edge - t) + k_edge * k_edge);
      add(2 * k_pi * (k_radius_mm - t) * k_d, k_edge * (k_edge - t) / length_mm,
          k_edge / length_mm);
      add(2 * k_pi * k_radius_mm * k_d, k_edge * k_edge / length_mm, (k_edge - t) / length_mm);
    }
  }
};

TEST(Grinding, AFlatEndSinksInAtPrestonsRate) {
  for (const char* tissue : {"enamel", "dentin", "lesion"})
    for (const double load_n : {0.35, 0.65, 1.05}) {
      if (tissue != std::string("enamel") && load_n != 0.65) continue;
      Weight weight(block_of(tissue), clinical(), load_n);
      const double speed = weight.speed_mm_s(0.1, 0.3),
                   sharp = preston_mm_s(wear_mm2_per_n(tissue), load_n),
                   felt = sharp * 2 * k_pi * k_radius_mm / FeltEnd().per_turn;
      std::printf("%s, %.2f N: %.5f mm/s, Preston %.5f, with the felt edge %.5f\n", tissue, load_n,
                  speed, sharp, felt);
      EXPECT_NEAR(speed / felt, 1.0, 0.05)
          << "26 samples stand for this end; " << tissue << " " << load_n;
      EXPECT_NEAR(speed / sharp, 1.0, 0.10) << tissue << " " << load_n;
    }
}

TEST(Grinding, ABallInItsHoleSinksInAtPrestonsRate) {
  // F = ∫ h cos²θ/(K ω r) dA = 2π R h/(K ω) ∫ cos²θ dθ to a right angle; within r = 0.05 mm, sinθ0
  // = 0.1, 1/r is that of 0.05 mm
  const double inner = std::asin(0.1), angles = k_pi / 4 - (inner / 2 + std::sin(2 * inner) / 4) +
                                                (1 - std::pow(std::cos(inner), 3)) / (3 * 0.1);
  Weight weight(block_of("dentin"), clinical(), 0.65, "round-1.0");
  const double speed = weight.speed_mm_s(0.6, 0.8),
               closed =
                   wear_mm2_per_n("dentin") * k_omega * 0.65 / (2 * k_pi * k_radius_mm * angles);
  std::printf("ball in dentin: %.5f mm/s, closed form %.5f\n", speed, closed);
  EXPECT_NEAR(speed / closed, 1.0, 0.03);
}

TEST(Grinding, SpeedOfRecessionGoesWithTheSpeedOfTheHandpiece) {
  double speed[2] = {};
  for (const int half : {0, 1}) {
    Weight weight(block_of("dentin"), clinical(), 0.65);
    weight.rig.model.config.max_rpm = half ? 100000.0 : 200000.0;
    for (int i = 0; i < 2000; ++i) (void)weight.rig.tick({0, 0, 0.02}, 1.0);
    speed[half] = weight.speed_mm_s(0.1, 0.3);
  }
  EXPECT_NEAR(speed[0] / speed[1], 2.0, 0.02);
}

TEST(Grinding, TheRateDoesNotDependOnTheLengthOfATick) {
  Weight coarse(block_of("dentin"), clinical(), 0.65),
      fine(block_of("dentin"), clinical(), 0.65, "cylinder-flat-1.0", 0.00025);
  EXPECT_NEAR(fine.speed_mm_s(0.1, 0.3) / coarse.speed_mm_s(0.1, 0.3), 1.0, 0.01);
}

TEST(Grinding, HalfOverAVoidAtTheSameForceThePressureDoubles) {
  const auto half = [](Vec3 at) { return at.x < 0 ? k_dentin : k_pulp; };
  const auto plane = [](Vec3 at) { return at.z; };
  const Tooth over = tooth_of(plane, {-1.2, -1.2, -1.0}, {1.2, 1.2, 0.3}, 0.05, half);
  const Tooth solid =
      tooth_of(plane, {-1.2, -1.2, -1.0}, {1.2, 1.2, 0.3}, 0.05, [](Vec3) { return k_dentin; });
  // Under X/τ too: k falls with the area that bears, so X grows as the pressure does. The laws
  // differ in tissue, bur, speed and torque.
  for (const bool by_pressure : {true, false}) {
    const ForceModel model = by_pressure ? clinical() : shipped_model("consistent");
    Weight on_half(over, model, 0.3), on_all(solid, model, 0.3);
    const double fast = on_half.speed_mm_s(0.1, 0.3), slow = on_all.speed_mm_s(0.1, 0.3);
    std::printf("%s: half over a void %.5f mm/s, whole %.5f: %.3f times\n", model.name.c_str(),
                fast, slow, fast / slow);
    EXPECT_NEAR(fast / slow, 2.0, 0.12) << "a leaf of the border is felt ahead";
  }
}

TEST(Grinding, AHeadOnTwoTissuesIsHeldByTheHarderOne) {
  const Tooth both = tooth_of([](Vec3 at) { return at.z; }, {-1.2, -1.2, -1.0}, {1.2, 1.2, 0.3},
                              0.05, [](Vec3 at) { return at.x < 0 ? k_enamel : k_dentin; });
  Weight weight(both, clinical(), 0.65);
  const double mean = 0.5 / wear_mm2_per_n("enamel") + 0.5 / wear_mm2_per_n("dentin"),
               speed = weight.speed_mm_s(0.1, 0.25);
  EXPECT_NEAR(speed / (preston_mm_s(1 / mean, 0.65) * 2 * k_pi * k_radius_mm / FeltEnd().per_turn),
              1.0, 0.06);
}

TEST(Grinding, UnderLoadTheSpeedIsOnTheDrivesLine) {
  // A sharp flat end bears at R/2 in the mean, T = μ F R/2; the felt one at Q/S. Turbine: rpm =
  // free − slip T/torque.
  const FeltEnd felt;
  EXPECT_NEAR(felt.sliding / felt.per_turn / (k_radius_mm / 2), 1.0, 0.2);
  const double ratio = shipped_model("clinical").force_ratio;
  for (const auto& [torque, slip] : {std::pair{1.4, 400000.0}, {0.3, 400000.0}, {6.0, 2000.0}})
    for (const double load_n : {0.35, 1.05}) {
      Weight weight(block_of("enamel"), clinical(torque, slip), load_n);
      double rpm = 0, load = 0;
      for (int i = 0; i < 6000; ++i) {
        const TickOutput out = weight.tick();
        if (i < 5000) continue;
        rpm += out.rpm / 1000;
        load += weight.rig.state.handpiece.load_n_mm / 1000;
      }
      const double line = std::max(
          0.0, k_free_rpm - slip * ratio * load_n * (felt.sliding / felt.per_turn) / torque);
      std::printf("torque %.1f N mm, slip %.0f, %.2f N: %.0f rpm, line %.0f\n", torque, slip,
                  load_n, rpm, line);
      EXPECT_NEAR((k_free_rpm - rpm) / (slip * load / torque), 1.0, 0.01) << "its own torque";
      EXPECT_NEAR((k_free_rpm - rpm) / (k_free_rpm - line), 1.0, 0.12)
          << "the closed form's; 26 samples stand for this end";
    }
}

TEST(Grinding, AWeakTurbineStallsCutsNothingAndRunsAgainWhenLifted) {
  Weight weight(block_of("enamel"), clinical(0.1, 400000.0), 1.05);
  for (int i = 0; i < 4000; ++i) (void)weight.tick();
  EXPECT_EQ(weight.rig.state.handpiece.rpm, 0.0);
  const auto edit = weight.rig.state.tooth.edit_hash();
  for (int i = 0; i < 2000; ++i) {
    const TickOutput out = weight.tick();
    ASSERT_FALSE(out.cutting);
    ASSERT_NEAR(out.model_force_n, 1.05, 0.02) << "a drill that stands is felt";
  }
  EXPECT_EQ(weight.rig.state.tooth.edit_hash(), edit);
  for (int i = 0; i < 3000; ++i) (void)weight.rig.tick({0, 0, 0.3}, 1.0);
  EXPECT_NEAR(weight.rig.state.handpiece.rpm, k_free_rpm, 100.0);
}

TEST(Grinding, AnElectricMotorSpinsUpUnderItsWholeTorque) {
  Rig rig(block_of("enamel"), {shipped_bur("round-1.0")}, clinical(6.0, 2000.0), {0, 0, 0.5});
  for (int i = 0; i < 75; ++i) (void)rig.tick({0, 0, 0.5}, 1.0);
  EXPECT_NEAR(rig.state.handpiece.rpm, 100000.0, 2000.0) << "half of spin_up_s";
  for (int i = 0; i < 200; ++i) (void)rig.tick({0, 0, 0.5}, 1.0);
  EXPECT_NEAR(rig.state.handpiece.rpm, 200000.0, 1.0);
}

TEST(Grinding, ATouchOfNoAreaGoesNoFurtherThanItsForce) {
  const GrindingSums sums{.per_turn_n_per_mm = 1e-9, .sliding_n = 1e-9, .head_share = 1.0};
  EXPECT_NEAR(ground_mm_s(sums, 0.8 * 0.2, 0.8, 200000, 1e-3) * 1e-3, 0.2, 1e-6)
      << "a tick's recession is X at most";
  EXPECT_EQ(ground_mm_s({}, 1.0, 0.8, 200000, 1e-3), 0.0);
  EXPECT_EQ(ground_mm_s(sums, 1.0, 0.8, 0, 1e-3), 0.0);
  EXPECT_EQ(grinding_torque_n_mm({}, 1.0, 0.4), 0.0);
}

TEST(Grinding, TheSameInputGivesTheSameStateAndTheLoadIsInItsHash) {
  std::uint64_t hash[2] = {};
  for (auto& h : hash) {
    Weight weight(block_of("dentin"), shipped_model("clinical"), 0.65);
    for (int i = 0; i < 3000; ++i) (void)weight.tick();
    h = state_hash(weight.rig.state);
    weight.rig.state.handpiece.load_n_mm += 1e-9;
    EXPECT_NE(state_hash(weight.rig.state), h);
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST(Grinding, ASolidTissueWithoutAWearRateIsRefusedByName) {
  ForceModel force = clinical();
  force.materials.find("enamel")->second.wear_mm3_per_n_m = 0;
  EXPECT_TRUE(tells(thrown_by([&] {
                      (void)make_servo_model(block_of("enamel"), {shipped_bur("round-1.0")}, force,
                                             {});
                    }),
                    "wear_mm3_per_n_m"));
}

}  // namespace
}  // namespace cavum
