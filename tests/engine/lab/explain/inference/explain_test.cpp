#include "engine/lab/explain/inference/explain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/lab/explain/report/model_file.h"
#include "engine/lab/explain/report/protocol.h"
#include "tests/engine/lab/explain/made_recording.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum::explain {
namespace {

std::string first_cause(const Explanation& e) {
  return e.causes.empty() ? "" : mechanism_at(e.causes.front().term.mechanism).name;
}

const Interval& parameter(const Explanation& e, const std::string& name) {
  for (const auto& [n, i] : e.causes.at(0).parameters)
    if (n == name) return i;
  throw std::runtime_error("no parameter " + name);
}

TEST(Explain, ARecordingOfTheLawItselfIsClean) {
  for (const double quantum : {0.0, 0.01, 0.055}) {
    made::Options o;
    o.quantum_mm = quantum;
    const Explanation e = explain(made::recording(o));
    EXPECT_EQ(e.verdict, Verdict::clean) << quantum << "\n" << english_text(to_text(e));
    EXPECT_NEAR(e.base.k_n_per_mm, made::k_k, 0.02);
    EXPECT_NEAR(e.gain.noise_floor_n, 0.02, 0.003);
  }
}

TEST(Explain, FrictionIsNamedAndItsModelLeavesNothing) {
  made::Options o;
  const Recording r =
      made::recording(o, [](const made::Row& q) { return 0.03 * std::tanh(q.v_mm_s / 0.05); });
  const Explanation e = explain(r);
  ASSERT_EQ(e.verdict, Verdict::named) << english_text(to_text(e));
  EXPECT_EQ(first_cause(e), "coulomb_friction");
  EXPECT_NEAR(parameter(e, "fc_n").value, 0.03, 0.003);
  EXPECT_LT(parameter(e, "fc_n").low, 0.03);
  EXPECT_GT(parameter(e, "fc_n").high, 0.03);
  EXPECT_GT(e.gain.percent.low, 0.0);

  const ForceModel extended = parse_force_model(
      extended_model_toml(e, testing_engine::shipped_model("paper")), "extended.toml");
  ASSERT_EQ(extended.terms.size(), 1u);
  EXPECT_NEAR(extended.materials.at("dentin").voigt.stiffness_n_per_mm, made::k_k, 0.02);
  const Series added = added_force_n(extended, "dentin", r, "extended.toml");
  ExplainOptions on_top;
  on_top.fixed_n = &added;
  EXPECT_EQ(explain(r, on_top).verdict, Verdict::clean);
}

TEST(Explain, ABiasStaysInTheMeasurementAndIsTakenOff) {
  const Recording r = made::recording({}, [](const made::Row&) { return -0.02; });
  const Explanation e = explain(r);
  ASSERT_EQ(first_cause(e), "bias") << english_text(to_text(e));
  EXPECT_NEAR(parameter(e, "bias_n").value, -0.02, 0.002);
  const ForceModel extended = parse_force_model(
      extended_model_toml(e, testing_engine::shipped_model("paper")), "extended.toml");
  EXPECT_TRUE(extended.terms.empty());
  ASSERT_EQ(extended.measurement.size(), 1u);
  const Series added = added_force_n(extended, "dentin", r, "extended.toml");
  EXPECT_NEAR(added[10], parameter(e, "bias_n").value, 1e-9);
}

/// What it adds that the surface of session `s` lies `delta_mm[s]` nearer than the recording has
/// it.
std::function<double(const made::Row&)> surface_off_by(std::vector<double> delta_mm) {
  return [delta_mm, s = -1](const made::Row& q) mutable {
    if (q.first) ++s;
    const double x = q.x_mm + delta_mm[static_cast<std::size_t>(s)];
    return (x > 0.0 ? std::max(0.0, made::k_k * x + made::k_c * q.v_mm_s) : 0.0) - q.base_n;
  };
}

TEST(Explain, ASurfaceThatLiesElsewhereInEachSessionIsNamedWithEachOffset) {
  const std::vector<double> delta{0.08, -0.05, 0.03, 0.06, -0.07, 0.02};
  for (const double quantum : {0.0, 0.01}) {
    made::Options o;
    o.quantum_mm = quantum;
    const Explanation e = explain(made::recording(o, surface_off_by(delta)));
    ASSERT_EQ(first_cause(e), "contact_offset") << quantum << english_text(to_text(e));
    EXPECT_EQ(e.verdict, Verdict::named) << english_text(to_text(e));
    for (std::size_t s = 0; s < delta.size(); ++s) {
      const Interval& found = parameter(e, "delta_" + std::to_string(s + 1) + "_mm");
      EXPECT_NEAR(found.value, delta[s], 0.01) << s;
      EXPECT_LT(found.low, delta[s]);
      EXPECT_GT(found.high, delta[s]);
    }
    EXPECT_NEAR(e.base.k_n_per_mm, made::k_k, 0.02);
  }
}

TEST(Explain, AnOffsetOfTheForceInEachSessionIsNotTakenForOneOfTheSurface) {
  const std::vector<double> offset_n{0.05, -0.04, 0.02, 0.04, -0.05, 0.01};
  int s = -1;
  const Explanation e = explain(made::recording({}, [&](const made::Row& q) {
    if (q.first) ++s;
    return offset_n[static_cast<std::size_t>(s)];  // in air too
  }));
  for (const auto& c : e.causes)
    EXPECT_STRNE(mechanism_at(c.term.mechanism).name, "contact_offset") << english_text(to_text(e));
}

TEST(Explain, WhatNoMechanismDescribesIsLaidToItsVariable) {
  made::Options o;
  Recording r = made::recording(o);
  Series humidity(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    humidity[i] =
        std::sin(0.013 * static_cast<double>(i)) + 0.5 * std::sin(0.0041 * static_cast<double>(i));
  r.f_n += 0.02 * humidity;
  r.columns.emplace_back("humidity", humidity);
  const Explanation e = explain(r);
  EXPECT_EQ(e.verdict, Verdict::unexplained) << english_text(to_text(e));
  ASSERT_TRUE(e.unexplained);
  EXPECT_EQ(e.unexplained->variable, "humidity");
}

TEST(Explain, OneDirectionNeverNamesFrictionBiasOrEdgeForceAlone) {
  made::Options o;
  o.one_way = true;
  for (int kind = 0; kind < 3; ++kind) {
    const Explanation e = explain(made::recording(
        o, [&](const made::Row& q) { return kind == 2 && q.x_mm <= 0 ? 0.0 : 0.26; }));
    EXPECT_TRUE(e.verdict == Verdict::alias || e.verdict == Verdict::not_testable)
        << english_text(to_text(e));
    EXPECT_FALSE(e.next_experiment.empty());
  }
}

TEST(Explain, ALineKeepsItsAmplitudeWhenEverySessionHasItsPhase) {
  double phase = 0.0;
  const Recording r = made::recording({}, [&](const made::Row& q) {
    if (q.first) phase += 2.0;
    return q.x_mm > 0 ? 0.03 * std::sin(2 * 3.14159265358979 * 7.3 * q.t_s + phase) : 0.0;
  });
  const Explanation e = explain(r);
  ASSERT_EQ(first_cause(e), "chatter") << english_text(to_text(e));
  EXPECT_EQ(e.causes.size(), 1u);
  EXPECT_NEAR(parameter(e, "amplitude_n").value, 0.03, 0.002);
  EXPECT_NEAR(parameter(e, "frequency_hz").value, 7.3, 0.01);
  EXPECT_GT(e.gain.percent.low, 10.0);  // in sessions that were left out too
}

TEST(Explain, AnIntervalHoldsTheTruthOfAStiffnessThatGrows) {
  const Recording r = made::recording({}, [](const made::Row& q) {
    if (q.x_mm <= 0) return 0.0;
    return std::max(0.0, made::k_k * std::pow(q.x_mm, 1.6) + made::k_c * q.v_mm_s) -
           q.base_n;  // neither of the two laws pulls
  });
  const Explanation e = explain(r);
  ASSERT_EQ(first_cause(e), "nonlinear_stiffness") << english_text(to_text(e));
  EXPECT_LT(parameter(e, "m").low, 1.6);
  EXPECT_GT(parameter(e, "m").high, 1.6);
  EXPECT_LT(parameter(e, "m").high - parameter(e, "m").low, 0.2);
}

TEST(Explain, WithoutSurrogatesAPlainRuleAnswersAndSaysSo) {
  ExplainOptions plain;
  plain.surrogates = 0;
  const Explanation e = explain(
      made::recording({}, [](const made::Row& q) { return 0.03 * std::tanh(q.v_mm_s / 0.05); }),
      plain);
  EXPECT_EQ(first_cause(e), "coulomb_friction") << english_text(to_text(e));
  EXPECT_FALSE(e.notes.empty());
}

TEST(Explain, TheSameSeedGivesTheSameAnswer) {
  made::Options o;
  o.quantum_mm = 0.01;
  const Recording r =
      made::recording(o, [](const made::Row& q) { return q.x_mm > 0 && q.rpm > 0 ? 0.03 : 0.0; });
  const auto first = to_json(explain(r)), second = to_json(explain(r));
  EXPECT_EQ(first.dump(), second.dump());
  EXPECT_EQ(first["causes"][0]["mechanism"], "edge_force");
}

TEST(Explain, FaultyDataGiveNoCause) {
  Recording r = made::recording({});
  std::swap(r.t_s[10], r.t_s[11]);
  const auto j = to_json(explain(r));
  EXPECT_EQ(j["verdict"], "data_fault");
  ASSERT_EQ(j["data_faults"].size(), 1u);
  EXPECT_EQ(j["data_faults"][0]["kind"], "time_stamps");
  EXPECT_EQ(j["next_experiment"]["values"]["fault"], "time_stamps");
}

TEST(Explain, MeatUnderTheIndenterRelaxesWithTwoTimeConstants) {
  const std::string path =
      std::string(CAVUM_SOURCE_DIR) + "/../shared/measured/zwick_relaxation/recording.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  const Explanation e = explain(read_recording(path));
  ASSERT_EQ(first_cause(e), "relaxation") << english_text(to_text(e));
  EXPECT_GT(parameter(e, "tau1_s").value, 0.2);
  EXPECT_LT(parameter(e, "tau1_s").value, 0.8);
  EXPECT_GT(parameter(e, "tau2_s").value, 2.5);
  EXPECT_LT(parameter(e, "tau2_s").value, 7.0);
  EXPECT_GT(e.gain.percent.low, 50.0);
}

TEST(Protocol, TheMotionIsContinuousAndGoesBothWaysInAirAndInContact) {
  const Recording r = parse_recording(protocol_motion_csv(), "p.csv",
                                      {{"x_mm", "z_mm"}, {"f_n", "pedal"}, {"lateral", "x_mm"}});
  double fastest = 0, in_air_back = 0, in_contact_back = 0;
  for (Eigen::Index i = 1; i < r.rows(); ++i) {
    const double v = -(r.x_mm[i] - r.x_mm[i - 1]) / (r.t_s[i] - r.t_s[i - 1]);
    fastest = std::max(fastest, std::fabs(v));
    (r.x_mm[i] > 0 ? in_air_back : in_contact_back) += v < -0.01;
  }
  EXPECT_LT(fastest, 1.05);
  EXPECT_GT(in_air_back, 100);
  EXPECT_GT(in_contact_back, 100);
}

}  // namespace
}  // namespace cavum::explain
