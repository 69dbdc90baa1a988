#include "engine/lab/explain/model/mechanism.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cavum::explain {
namespace {

/// A scene on a path given by formula, without uncertainty: k = 0.8, c = 0.
struct PathScene {
  Recording recording;
  Scene scene;
  explicit PathScene(const std::function<double(double)>& x, Base base = {0.8, 0.0},
                     double length_s = 10.0) {
    const double dt = 0.005;
    const auto n = static_cast<Eigen::Index>(length_s / dt);
    recording.t_s = Series::LinSpaced(n, 0.0, dt * static_cast<double>(n - 1));
    recording.sessions = {{"1", 0, n}};
    Motion m;
    m.x_mm = recording.t_s.unaryExpr(x);
    m.v_mm_s =
        recording.t_s.unaryExpr([&](double t) { return (x(t + 1e-5) - x(t - 1e-5)) / 2e-5; });
    m.a_mm_s2 = m.sd_x_mm = m.sd_v_mm_s = Series::Zero(n);
    recording.x_mm = m.x_mm;
    recording.f_n = Series::Zero(n);
    scene = make_scene(recording, m, base, 0.0, 0.0);
  }
  [[nodiscard]] Columns columns(const char* name, const std::vector<double>& shape) const {
    return mechanism_at(find_mechanism(name)).columns(scene, shape);
  }
};

TEST(Mechanisms, EachHasItsTexts) {
  EXPECT_FALSE(mechanisms().empty());
  for (const auto& m : mechanisms()) {
    EXPECT_GT(std::string(m.equation).size(), 0u) << m.name;
    EXPECT_GT(std::string(m.separate).size(), 0u) << m.name;
  }
  EXPECT_EQ(find_mechanism("magic"), -1);
}

TEST(Mechanisms, RelaxationDecaysInAHoldAsOneExponential) {
  const PathScene s([](double t) { return t < 1 ? 0.5 * t : 0.5; });
  const Series z = s.columns("relaxation", {2.0, 0.0, 1.0, 0.0}).own[0];
  // loading at 0.5 mm/s for 1 s gives 0.5·2·(1 − e^(−1/2)), then it decays with 2 s
  const double at_one = 0.5 * 2.0 * (1 - std::exp(-0.5));
  EXPECT_NEAR(z[200], at_one, 2e-3);
  EXPECT_NEAR(z[1000], at_one * std::exp(-4.0 / 2.0), 2e-3);
}

TEST(Mechanisms, CarriedRelaxationRemembersThePressBeforeAsMuchAsItFadedInAir) {
  // in at 1 mm/s for a second and out at once, a second of air, in again
  const auto x = [](double t) { return t < 1 ? t : t < 2 ? 1e-9 - (t - 1) : t - 2; };
  const PathScene s(x);
  const double tau = 2.0, at_one = tau * (1 - std::exp(-1.0 / tau)),
               left = (at_one - 1.0) * std::exp(-1.0 / tau);
  const Series fresh = s.columns("relaxation", {tau, 0.0, 1.0, 0.0}).own[0],
               carried = s.columns("relaxation", {tau, 0.0, 1.0, 1.0}).own[0];
  const Eigen::Index again = 500;  // half a second into the second press
  EXPECT_NEAR(fresh[again], tau * (1 - std::exp(-0.5 / tau)), 3e-3);
  EXPECT_NEAR(carried[again] - fresh[again], left * std::exp(-0.5 / tau), 3e-3);
}

TEST(Mechanisms, LowPassAnswersAStepWithAnExponential) {
  const PathScene s([](double t) { return t < 1 ? 1e-6 : 1.0; });
  const Series change = s.columns("low_pass", {0.25}).spring;
  EXPECT_NEAR(change[250] + s.scene.spring_mm[250], 1 - std::exp(-0.25 / 0.25), 0.02);
}

TEST(Mechanisms, DelayShiftsARampByTauTimesItsSpeed) {
  const PathScene s([](double t) { return 0.1 + 0.2 * t; });
  const Series change = s.columns("delay", {0.033}).spring;
  EXPECT_NEAR(change[1000], -0.2 * 0.033, 1e-9);
}

TEST(Mechanisms, BacklashStandsStillForTwiceItsRadiusAfterAReversal) {
  const double b = 0.05;
  const PathScene s([](double t) { return t < 5 ? 0.1 + 0.1 * t : 0.6 - 0.1 * (t - 5); });
  const Series y = s.columns("backlash", {0, b}).spring + s.scene.spring_mm;
  EXPECT_NEAR(y[800], 0.5 - b, 1e-6);   // behind by b on the way in
  EXPECT_NEAR(y[1190], y[1000], 1e-3);  // 0.95 s after the turn: still within the play of 0.1 mm
  EXPECT_NEAR(y[1600], 0.6 - 0.3 + b, 2e-3);  // ahead by b on the way out
}

TEST(Mechanisms, DahlLoopEndsAtItsDistance) {
  const PathScene s([](double t) { return 0.1 * t + 1e-3; });
  const Series z = s.columns("hysteresis", {1, 0.05}).own[0];
  EXPECT_NEAR(z[1999], 0.05, 1e-3);
  EXPECT_NEAR(z[100], 0.05 * (1 - std::exp(-0.05 / 0.05)),
              1e-3);  // z = d (1 − e^(−X/d)), X = 0.05 mm
}

TEST(Mechanisms, HiddenLayerAndPowerAreClosedForms) {
  const PathScene s([](double t) { return 0.1 * t + 1e-3; });
  EXPECT_NEAR(s.columns("hidden_layer", {0.3}).own[0][1000], 0.501 - 0.3, 1e-9);
  EXPECT_NEAR(s.columns("nonlinear_stiffness", {1.5}).spring[1000], std::pow(0.501, 1.5) - 0.501,
              1e-9);
  EXPECT_NEAR(s.columns("graded_stiffness", {}).own[0][1000], 0.501 * 0.501, 1e-9);
}

TEST(Mechanisms, AnOffsetOfTheSurfaceIsKDeltaInContactAndMovesTheFirstContact) {
  for (const double delta : {0.1, -0.1}) {
    const PathScene s([](double t) { return -0.5 + 0.1 * t; }, {0.8, 0.2});
    std::vector<double> shape(12, 0.0);
    shape[0] = delta;
    const Columns c = s.columns("contact_offset", shape);
    EXPECT_TRUE(c.own.empty());
    const auto force = [&](Eigen::Index i) {
      return 0.8 * (s.scene.spring_mm[i] + c.spring[i]) +
             0.2 * (s.scene.damper_mm_s[i] + c.damper[i]);
    };
    EXPECT_NEAR(force(1900), 0.8 * (0.45 + delta) + 0.2 * 0.1, 1e-9);  // t = 9.5 s, X = 0.45 mm
    EXPECT_NEAR(c.damper[1900], 0.0, 1e-12);
    const auto first = static_cast<Eigen::Index>(std::ceil((0.5 - delta) / 0.1 / 0.005));
    EXPECT_DOUBLE_EQ(force(first - 2), 0.0);
    EXPECT_NEAR(force(first + 2), 0.2 * 0.1, 2e-3);
  }
}

TEST(Mechanisms, AnOffsetOfTheSurfaceScalesWithTheTissueAndOneOfTheForceDoesNot) {
  PathScene s([](double t) { return -0.5 + 0.1 * t; });
  s.recording.relative_k = Series::Ones(s.recording.rows());
  s.recording.relative_k.tail(200) = 3.0;
  const Scene scene = make_scene(s.recording, s.scene.motion, s.scene.base, 0.0, 0.0);
  std::vector<double> shape(12, 0.0);
  shape[0] = 0.04;
  const Series spring = mechanism_at(find_mechanism("contact_offset")).columns(scene, shape).spring;
  EXPECT_NEAR(spring[1700], 0.04, 1e-9);
  EXPECT_NEAR(spring[1900], 3.0 * 0.04, 1e-9);
}

TEST(Mechanisms, AnOffsetOfTheSurfaceNeedsFreeMotionBeforeContact) {
  const auto starts_on = [](double from_mm) {
    PathScene s([=](double t) { return from_mm + 0.1 * t; });
    s.scene.left_n = Series::Constant(s.recording.rows(), 0.0);
    for (Eigen::Index i = 0; i < s.recording.rows(); ++i)
      s.scene.left_n[i] = 0.8 * (std::max(0.0, s.scene.motion->x_mm[i] + 0.07) -
                                 std::max(0.0, s.scene.motion->x_mm[i]));
    return starts(mechanism_at(find_mechanism("contact_offset")), s.scene);
  };
  EXPECT_TRUE(starts_on(0.01).empty());  // in contact from first to last: an offset of the load
                                         // cell would look the same
  const auto found = starts_on(-0.5);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found.back()[0], 0.07, 0.005);
  EXPECT_EQ(found.back()[1], 0.0);  // one session, one offset
}

TEST(Mechanisms, FrictionFlipsWithTheMotionInAirToo) {
  const PathScene s([](double t) { return -1 + 0.2 * std::sin(t); });
  const Series f = s.columns("coulomb_friction", {0.01}).own[0];
  EXPECT_NEAR(f[0], 1.0, 1e-6);
  EXPECT_NEAR(f[628], -1.0, 1e-6);  // t = pi
}

TEST(Mechanisms, FrictionThatPushesMakesNoSense) {
  const auto& m = mechanism_at(find_mechanism("coulomb_friction"));
  const double pushes = -0.1, resists = 0.1;
  EXPECT_FALSE(makes_sense(m, &pushes, 1));
  EXPECT_TRUE(makes_sense(m, &resists, 1));
}

}  // namespace
}  // namespace cavum::explain
