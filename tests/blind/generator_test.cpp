// The generator of the blind test keeps its word: checked against closed forms and by reading the
// written file again.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/blind/rate.h"
#include "tests/blind/recording.h"
#include "tests/blind/verdict.h"

namespace cavum::blind {
namespace {

struct Folder {
  std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) /
      ("cavum-blind-test-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
       ::testing::UnitTest::GetInstance()->current_test_info()->name());
  ~Folder() { std::filesystem::remove_all(path); }
};

TEST(BlindRate, BinomialTailsAreExact) {
  EXPECT_NEAR(binomial_at_most(1, 2, 0.5), 0.75, 1e-12);
  EXPECT_NEAR(binomial_at_most(0, 10, 0.1), std::pow(0.9, 10), 1e-12);
  EXPECT_NEAR(binomial_at_most(8, 10, 0.9), 1.0 - 10 * std::pow(0.9, 9) * 0.1 - std::pow(0.9, 10),
              1e-12);
  EXPECT_EQ(least_expected(10, 0.0), 0);
  EXPECT_EQ(least_expected(10, 1.0), 10);
  EXPECT_EQ(least_expected(10, 0.9), 5);  // 4 of 10 or fewer: 0.00015; 5 or fewer: 0.0016
}

TEST(BlindMotion, HasWhatTheProtocolAsksFor) {
  Draw draw(1);
  const Motion m = six_sessions(draw);
  EXPECT_NEAR(static_cast<double>(m.size()) * k_step_s, 280.0, 30.0);
  EXPECT_EQ(m.session.back(), 6);
  EXPECT_EQ(m.site.back(), m.site.front());
  std::size_t deepening_in_air = 0, rising_in_air = 0, turning_in_air = 0, still_in_contact = 0;
  double x = m.x_mm[0];
  for (std::size_t i = 1; i < m.size(); ++i) {
    deepening_in_air += !m.touching(i) && m.v_mm_s[i] > 0.2;
    rising_in_air += !m.touching(i) && m.v_mm_s[i] < -0.2;
    turning_in_air += !m.touching(i) && m.spindle_rpm[i] > 0.0;
    still_in_contact += m.touching(i) && m.v_mm_s[i] == 0.0;
    x = m.session[i] == m.session[i - 1] ? x + 0.5 * (m.v_mm_s[i] + m.v_mm_s[i - 1]) * k_step_s
                                         : m.x_mm[i];
    ASSERT_NEAR(x, m.x_mm[i], 1e-6);
  }
  for (const std::size_t count :
       {deepening_in_air, rising_in_air, turning_in_air, still_in_contact})
    EXPECT_GT(count, 5000u);
}

TEST(BlindEffect, EveryMechanismReachesItsSizeWhateverTheDraw) {
  for (std::size_t n = 0; n < mechanisms().size(); ++n) {
    const std::string& name = mechanisms()[n];
    if (name == "gain_error") continue;
    const Folder folder;
    const Hidden h = write_recording({Kind::single, {name}, 1.0, 0.0, 100 + n}, folder.path);
    EXPECT_TRUE(h.reached) << name;
    EXPECT_NEAR(h.effect_n, h.noise_n, 0.02 * h.noise_n) << name;
  }
}

TEST(BlindEffect, AForceThatKAndCMakeHasNoSize) {
  Draw draw(2);
  const Motion m = six_sessions(draw);
  const Base base{0.8, 0.5};
  EXPECT_LT(beyond_k_and_c_n(m, base, base_force_n(m, base)), 1e-6);
  EXPECT_LT(beyond_k_and_c_n(m, base, make_effect("gain_error", draw, m, base).force_n(0.2)), 1e-6);
  EXPECT_GT(beyond_k_and_c_n(m, base, m.v_mm_s), 0.1);  // in air too
}

TEST(BlindEffect, ALagOfARampIsItsSlopeTimesTau) {
  Motion m;
  for (int i = 0; i < 2000; ++i) {
    m.session.push_back(1);
    m.t_s.push_back(i * k_step_s);
    m.x_mm.push_back(0.001 + i * k_step_s);
    m.v_mm_s.push_back(1.0);
  }
  Draw draw(3);
  const Base base{1.0, 0.0};
  for (const char* name : {"low_pass", "delay"})
    EXPECT_NEAR(make_effect(name, draw, m, base).force_n(0.05).back(), -0.05, 1e-9) << name;
  const Effect spring = make_effect("series_compliance", draw, m, base);
  EXPECT_NEAR(spring.force_n(1.0).back(), -0.5 * m.x_mm.back(), 1e-3);  // two equal springs
  const Effect play = make_effect("backlash", draw, m, base);
  EXPECT_NEAR(play.force_n(0.2).back(), -0.1, 1e-9);
}

TEST(BlindEffect, AnOffsetOfTheSurfaceIsKTimesItInContactAndBeginsContactElsewhere) {
  Motion m;
  for (int session = 1; session <= 2; ++session)
    for (int i = 0; i < 2000; ++i) {
      m.session.push_back(session);
      m.t_s.push_back(i * k_step_s);
      m.x_mm.push_back(-0.99950 + i * k_step_s);
      m.v_mm_s.push_back(1.0);
    }
  Draw draw(4);
  const Base base{2.0, 0.5};
  const Effect effect = make_effect("contact_offset", draw, m, base);
  const std::vector<double> force = effect.force_n(0.2);
  const std::vector<Parameter> truth = effect.truth(0.2);
  ASSERT_EQ(truth.size(), 2u);
  for (std::size_t s = 0; s < 2; ++s) {
    const double delta = truth[s].value;
    EXPECT_EQ(truth[s].names, "delta_" + std::to_string(s + 1) + "_mm");
    EXPECT_TRUE(std::abs(delta) >= 0.06 && std::abs(delta) <= 0.2) << delta;
    EXPECT_DOUBLE_EQ(force[s * 2000], 0.0);  // in air
    EXPECT_NEAR(force[s * 2000 + 1999], 2.0 * delta,
                1e-12);  // deep in contact: k delta, whatever the depth
    EXPECT_NEAR(force[s * 2000 + 1500], 2.0 * delta, 1e-12);
    double first = 0.0;  // contact begins where x = -delta, with c v at once
    for (std::size_t i = s * 2000; i < s * 2000 + 2000 && first == 0.0; ++i)
      if (force[i] + base_force_n(m, base)[i] > 0.0) first = m.x_mm[i];
    EXPECT_NEAR(first, -delta, 1.1 * k_step_s);
  }
}

TEST(BlindRecording, TheSameRequestWritesTheSameBytes) {
  const Folder folder;
  const Request request{Kind::pair, {"wear", "bias"}, 0.6, 0.01, 7};
  write_recording(request, folder.path);
  const std::string first = text_of(folder.path / "recording.csv"),
                    rig = text_of(folder.path / "rig.toml");
  write_recording(request, folder.path);
  EXPECT_EQ(first, text_of(folder.path / "recording.csv"));
  EXPECT_EQ(rig, text_of(folder.path / "rig.toml"));
  EXPECT_NE(first.find("removed_mm3,bur_id"), std::string::npos);
}

}  // namespace
}  // namespace cavum::blind
