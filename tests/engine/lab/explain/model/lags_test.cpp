#include "engine/lab/explain/model/lags.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cavum::explain {
namespace {

/// The tool comes down at 1 mm/s and touches at 0.1003 s, between two rows of 5 ms.
struct Press {
  static constexpr double k_touch_s = 0.1003, k_speed_mm_s = 1.0;
  Recording recording;
  Scene scene;
  explicit Press(Base base) {
    const Eigen::Index n = 200;
    recording.t_s = Series::LinSpaced(n, 0.0, 0.005 * static_cast<double>(n - 1));
    recording.sessions = {{"1", 0, n}};
    Motion m;
    m.x_mm = k_speed_mm_s * (recording.t_s - k_touch_s);
    m.v_mm_s = Series::Constant(n, k_speed_mm_s);
    m.a_mm_s2 = m.sd_x_mm = m.sd_v_mm_s = Series::Zero(n);
    recording.x_mm = m.x_mm;
    recording.f_n = Series::Zero(n);
    scene = make_scene(recording, m, base, 0.0, 0.0);
  }
};

TEST(Lags, ADelayedContactBeginsBetweenTheRows) {
  const Press p({0.8, 0.5});
  const double tau_s = 0.0121;
  const Series damper = delayed(p.scene, tau_s).damper + p.scene.damper_mm_s;
  for (Eigen::Index i = 0; i < damper.size(); ++i)
    EXPECT_NEAR(damper[i], p.recording.t_s[i] - tau_s > Press::k_touch_s ? 1.0 : 0.0, 1e-9)
        << "row " << i;
}

TEST(Lags, AFilterAnswersTheJumpAtContactFromTheInstantOfTouching) {
  const Press p({0.8, 0.5});
  const double tau_s = 0.004;
  const Series damper = lagged(p.scene, tau_s).damper + p.scene.damper_mm_s;
  for (Eigen::Index i = 0; i < damper.size(); ++i) {
    const double since = p.recording.t_s[i] - Press::k_touch_s;
    EXPECT_NEAR(damper[i], since > 0.0 ? 1.0 - std::exp(-since / tau_s) : 0.0, 1e-9) << "row " << i;
  }
}

TEST(Lags, ASpringInSeriesFollowsItsClosedForm) {
  const Base b{0.8, 0.5};
  const double e = 0.3, softer = 1.0 + b.k_n_per_mm * e, tau_s = b.c_n_s_per_mm * e / softer;
  const Press p(b);
  const Columns c = in_series(p.scene, e);
  const Series force = b.k_n_per_mm * (c.spring + p.scene.spring_mm) +
                       b.c_n_s_per_mm * (c.damper + p.scene.damper_mm_s);
  for (Eigen::Index i = 0; i < force.size(); ++i) {
    const double t =
        p.recording.t_s[i] - Press::k_touch_s;  // F + tau F' = (k t + c)/(1 + k e), F(0) = 0
    const double fades = std::exp(-t / tau_s);
    const double expected =
        t > 0.0
            ? (b.k_n_per_mm * (t - tau_s + tau_s * fades) + b.c_n_s_per_mm * (1.0 - fades)) / softer
            : 0.0;
    EXPECT_NEAR(force[i], expected, 1e-9) << "row " << i;
  }
}

TEST(Scene, ContactIsLostWhereItsForceWouldPull) {
  Press p({0.8, 0.5});
  Series pressed = Series::Ones(p.recording.rows());
  pressed.tail(50) = -1.0;
  never_pull(p.scene, &pressed);
  EXPECT_EQ(p.scene.active[149], 1.0);
  EXPECT_EQ(p.scene.active[150], 0.0);
  EXPECT_EQ(p.scene.damper_mm_s[150], 0.0);
  EXPECT_EQ(p.scene.active[0], 0.0);  // in air
  never_pull(p.scene, nullptr);
  EXPECT_EQ(p.scene.active[150], 1.0);
}

}  // namespace
}  // namespace cavum::explain
