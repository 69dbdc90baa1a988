// What the probe finds of simulated styluses whose friction, weight and encoder are known.
#include "engine/device/hardware/stylus_probe.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/device/device_error.h"
#include "engine/device/simulated_stylus.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::code_of;

constexpr HandModel k_nobody{.mass_kg = 0.0, .stiffness_n_per_mm = 0.0, .damping_n_s_per_mm = 0.0};

/// A stylus that lies free, and whose own weight pulls at it.
class Free final : public Stylus {
 public:
  Free(const OmniModel& omni, Vec3 weight_n)
      : stylus_(omni, k_nobody, 1e-3, [](double) { return HandIntent{}; }), weight_n_(weight_n) {}
  [[nodiscard]] DeviceReading read(double elapsed_s) override {
    DeviceReading r = stylus_.read(elapsed_s);
    if (++reads_ > silent_after) r.flags = 0;
    return r;
  }
  void send_force(Vec3 force_n) override {
    largest_n = std::max(largest_n, length(force_n));
    last_n = force_n;
    stylus_.send_force(force_n + weight_n_);
  }
  void cut_force() noexcept override {
    last_n = {};
    stylus_.cut_force();
  }
  [[nodiscard]] const StylusFacts& facts() const noexcept override { return stylus_.facts(); }
  [[nodiscard]] StylusHealth health() const override { return stylus_.health(); }
  double largest_n = 0.0;
  Vec3 last_n;
  std::int64_t silent_after = 1LL << 40;

 private:
  SimulatedStylus stylus_;
  Vec3 weight_n_;
  std::int64_t reads_ = 0;
};

TEST(StylusProbe, FindsFrictionWeightQuantumAndRate) {
  std::mt19937_64 random(testing_basics::drawn_seed("StylusProbe"));
  std::uniform_real_distribution<double> friction(0.1, 0.5), quantum(0.02, 0.08);
  for (int round = 0; round < 10; ++round) {
    OmniModel omni;
    omni.coulomb_n = round == 0 ? 0.26 : friction(random);
    omni.quantum_mm = round == 0 ? 0.055 : quantum(random);
    const double weight = 0.3 * omni.coulomb_n;
    Free stylus(omni, {0, 0, -weight});
    const StylusProbe probe = probe_stylus(stylus, {.real_time = false});
    EXPECT_FALSE(probe.friction_problem);
    // The push goes on growing while it begins to move: m x'' = ramp t gives 0.02 N for 0.12 mm and
    // 45 g.
    EXPECT_NEAR(probe.friction_n, omni.coulomb_n, 0.035);
    EXPECT_GE(probe.friction_n, omni.coulomb_n - 0.002)
        << "nothing moves before its friction is overcome";
    EXPECT_NEAR(probe.axes[2].bias_n(), -weight, 0.01);
    EXPECT_NEAR(probe.axes[0].bias_n(), 0.0, 0.01);
    EXPECT_NEAR(probe.quantum_mm, omni.quantum_mm, 1e-9);
    EXPECT_NEAR(probe.rate_hz, 1000.0, 1.0);
    EXPECT_LE(stylus.largest_n, 1.0);
    EXPECT_EQ(stylus.last_n, Vec3{}) << "no force is left";
    if (round == 0)
      std::printf("simulated Omni: friction %.3f N found, %.3f N set\n", probe.friction_n,
                  omni.coulomb_n);
  }
}

TEST(StylusProbe, SaysWhenItCannotKnow) {
  OmniModel stuck;
  stuck.coulomb_n = 2.0;
  Free in_its_inkwell(stuck, {});
  EXPECT_EQ(code_of(probe_stylus(in_its_inkwell, {.real_time = false}).friction_problem),
            DeviceError::stuck);
  EXPECT_LE(in_its_inkwell.largest_n, 1.0);
  Free falling({}, {0, 0, -0.6});
  const StylusProbe falls = probe_stylus(falling, {.real_time = false});
  EXPECT_EQ(code_of(falls.friction_problem), DeviceError::moves_unpushed);
  EXPECT_EQ(falls.friction_n, 0.0);
  Free silent({}, {});
  silent.silent_after = 1000;
  EXPECT_EQ(code_of([&] { static_cast<void>(probe_stylus(silent, {.real_time = false})); }),
            DeviceError::silent);
  EXPECT_EQ(silent.last_n, Vec3{});
}

}  // namespace
}  // namespace cavum
