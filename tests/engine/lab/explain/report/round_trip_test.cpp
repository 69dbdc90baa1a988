// What explain finds, written as a force model, is what it takes off when the model is loaded
// again: nothing is left then. And the same file is one that rig and exam load. Effects are added
// by formulae of this file.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "engine/base/file.h"
#include "engine/lab/explain/report/model_file.h"
#include "tests/engine/lab/explain/made_recording.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum::explain {
namespace {

constexpr double k_turn = 6.283185307179586;

/// Columns of the rig as functions of session and time.
double wet(int, double t) { return std::fmod(t, 20.0) < 9.0 ? 1.0 : 0.0; }
double approach_deg(int session, double) { return 45.0 * session; }
double removed_mm3(int, double t) { return 0.05 * t; }
double temperature_c(int, double t) {
  return 22.0 + 6.0 * (1.0 - std::exp(-t / 15.0)) + 2.0 * std::sin(0.31 * t);
}

struct Case {
  const char* name;
  bool live;
  /// Force added, N; `session` from 0. `memory` keeps a state and the depth of the row before; both
  /// are 0 at the start of a session.
  struct Memory {
    double z = 0, depth_mm = 0;
  };
  std::function<double(const made::Row&, int session, double dt_s, Memory& memory)> effect;
};

/// What a force of the tissue adds: the sum never pulls.
double inside(const made::Row& q, double tissue_n) {
  return q.x_mm > 0.0
             ? std::max(0.0, made::k_k * q.x_mm + made::k_c * q.v_mm_s + tissue_n) - q.base_n
             : 0.0;
}

std::vector<Case> cases() {
  return {
      {"coulomb_friction", true,
       [](const made::Row& q, int, double, Case::Memory&) {
         return 0.03 * std::tanh(q.v_mm_s / 0.05);
       }},
      {"stribeck_friction", true,
       [](const made::Row& q, int, double, Case::Memory&) {
         const double u = q.v_mm_s / 0.4;
         return (0.03 + 0.06 * std::exp(-u * u)) * std::tanh(q.v_mm_s / 0.02);
       }},
      {"viscous_friction", true,
       [](const made::Row& q, int, double, Case::Memory&) { return 0.08 * q.v_mm_s; }},
      {"hysteresis", true,
       [](const made::Row& q, int, double, Case::Memory& m) {  // Dahl, in small steps
         const double depth = std::max(0.0, q.x_mm), dx = (depth - m.depth_mm) / 50;
         for (int i = 0; i < 50; ++i) m.z += dx - std::fabs(dx) * m.z / 0.1;
         m.depth_mm = depth;
         if (depth == 0.0) m.z = 0.0;
         return inside(q, 0.5 * m.z);
       }},
      {"hidden_layer", true,
       [](const made::Row& q, int, double, Case::Memory&) {
         return inside(q, 0.5 * std::max(0.0, q.x_mm - 0.45));
       }},
      {"relaxation", true,
       [](const made::Row& q, int, double dt, Case::Memory& m) {  // in small steps
         const double depth = std::max(0.0, q.x_mm);
         for (int i = 0; i < 50; ++i)
           m.z = (m.z + (depth - m.depth_mm) / 50) / (1.0 + dt / 50 / 1.5);
         m.depth_mm = depth;
         if (depth == 0.0) m.z = 0.0;
         return inside(q, 0.25 * m.z);
       }},
      {"edge_force", true,
       [](const made::Row& q, int, double, Case::Memory&) {
         return q.x_mm > 0.0 && q.rpm > 0.0 ? inside(q, 0.05) : 0.0;
       }},
      {"anisotropy", true,
       [](const made::Row& q, int s, double, Case::Memory&) {
         return 0.15 * q.base_n * std::cos(2.0 * (approach_deg(s, 0.0) - 20.0) * k_turn / 360.0);
       }},
      {"wear", true,
       [](const made::Row& q, int s, double, Case::Memory&) {
         return 0.08 * q.base_n * removed_mm3(s, q.t_s);
       }},
      {"chatter", true,
       [](const made::Row& q, int, double, Case::Memory&) {
         return q.x_mm > 0.0 ? 0.04 * std::sin(k_turn * (7.3 * q.t_s + 0.2)) : 0.0;
       }},
      {"coolant", true,
       [](const made::Row& q, int s, double, Case::Memory&) {
         return -0.15 * q.base_n * wet(s, q.t_s);
       }},
      {"thermal_softening", true,
       [](const made::Row& q, int s, double, Case::Memory&) {
         return -0.03 * q.base_n * (temperature_c(s, q.t_s) - temperature_c(0, 0.0));
       }},
      {"bias", false, [](const made::Row&, int, double, Case::Memory&) { return -0.03; }},
      {"contact_offset", false,
       [](const made::Row& q, int s, double, Case::Memory&) {
         const double x = q.x_mm + (s % 2 == 0 ? 0.06 : -0.04) + 0.01 * s;
         return (x > 0.0 ? std::max(0.0, made::k_k * x + made::k_c * q.v_mm_s) : 0.0) - q.base_n;
       }},
      {"drift", false,
       [](const made::Row& q, int, double, Case::Memory&) { return 0.002 * q.t_s; }},
  };
}

Recording with(const Case& c, const made::Options& options) {
  int session = -1;
  Case::Memory memory;
  std::vector<double> sessions;
  Recording r = made::recording(options, [&](const made::Row& q) {
    if (q.first) ++session, memory = {};
    return c.effect(q, session, options.dt_s, memory);
  });
  const std::pair<const char*, double (*)(int, double)> columns[] = {
      {"wet", wet},
      {"approach_deg", approach_deg},
      {"removed_mm3", removed_mm3},
      {"temperature_c", temperature_c}};
  for (const auto& [name, value] : columns) {
    Series s(r.rows());
    for (std::size_t n = 0; n < r.sessions.size(); ++n)
      for (Eigen::Index i = r.sessions[n].begin; i < r.sessions[n].end; ++i)
        s[i] = value(static_cast<int>(n), r.t_s[i]);
    r.columns.emplace_back(name, s);
  }
  return r;
}

class RoundTrip : public ::testing::TestWithParam<std::size_t> {};

TEST_P(RoundTrip, TheExtendedModelLeavesNothing) {
  const Case c = cases()[GetParam()];
  const Recording r = with(c, {.dt_s = 0.04});  // half the rows, half the time
  const Explanation e = explain(r);
  ASSERT_EQ(e.causes.size(), 1u) << english_text(to_text(e));
  const std::string found = mechanism_at(e.causes[0].term.mechanism).name;
  const auto& aliases = e.causes[0].aliases;
  EXPECT_TRUE(found == c.name || std::find(aliases.begin(), aliases.end(), c.name) != aliases.end())
      << english_text(to_text(e));
  EXPECT_TRUE(std::none_of(e.not_testable.begin(), e.not_testable.end(), [&](const NotTestable& n) {
    return n.mechanism == found;
  })) << english_text(to_text(e));

  const std::string toml = extended_model_toml(e, testing_engine::shipped_model("paper"));
  const ForceModel extended = parse_force_model(toml, "extended.toml");
  if (found == c.name) {
    EXPECT_EQ(extended.terms.size(), c.live ? 1u : 0u) << toml;
    const bool phases =
        found ==
        "chatter";  // a term for exams, and beside it the phase of each session of this recording
    EXPECT_EQ(extended.measurement.size(), c.live && !phases ? 0u : 1u) << toml;
  }
  const Series added = added_force_n(extended, "dentin", r, "extended.toml");
  Recording again = r;
  again.rig.k_n_per_mm = extended.materials.at("dentin").voigt.stiffness_n_per_mm;
  again.rig.c_n_s_per_mm = extended.materials.at("dentin").voigt.damping_n_s_per_mm;
  ExplainOptions on_top;
  on_top.fixed_n = &added;
  const Explanation rest = explain(again, on_top);
  EXPECT_EQ(rest.verdict, Verdict::clean) << toml << english_text(to_text(rest));

  // written once more, nothing is lost
  const ForceModel twice = parse_force_model(extended_model_toml(rest, extended), "twice.toml");
  EXPECT_EQ(twice.terms.size(), extended.terms.size());
  EXPECT_EQ(twice.measurement.size(), extended.measurement.size());
  const Series gap = added_force_n(twice, "dentin", r, "twice.toml") - added;
  EXPECT_LT(
      std::sqrt(gap.square().mean()),
      0.004);  // k and c were fitted again: single rows at the ends of contact may differ more
}

INSTANTIATE_TEST_SUITE_P(Explain, RoundTrip, ::testing::Range<std::size_t>(0, cases().size()),
                         [](const auto& p) { return std::string(cases()[p.param].name); });

}  // namespace
}  // namespace cavum::explain
