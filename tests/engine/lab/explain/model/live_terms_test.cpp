// One implementation for both uses: the column that explain fits is the force that the engine's
// term gives on the same motion.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/lab/explain/report/model_file.h"

namespace cavum::explain {
namespace {

using Given = std::vector<std::pair<std::string, double>>;

/// Two sessions of strokes in air and presses, known exactly, with every column that a mechanism
/// asks for.
struct Stage {
  Recording recording;
  Scene scene;
  Base base{0.8, 0.05};

  Stage() {
    constexpr double k_dt = 0.004;
    constexpr Eigen::Index k_rows = 6000;
    Series t(2 * k_rows), x(2 * k_rows), v(2 * k_rows), rpm(2 * k_rows), wet(2 * k_rows),
        angle(2 * k_rows), removed(2 * k_rows), warm(2 * k_rows);
    for (int s = 0; s < 2; ++s)
      for (Eigen::Index i = 0; i < k_rows; ++i) {
        const Eigen::Index at = s * k_rows + i;
        const double u = k_dt * static_cast<double>(i), w = 0.7 + 0.2 * s;
        t[at] = u;
        x[at] = -0.3 + 0.5 * (1 - std::cos(w * u)) - 0.05 * std::cos(4.1 * u) + 0.05;
        v[at] = 0.5 * w * std::sin(w * u) + 0.05 * 4.1 * std::sin(4.1 * u);
        rpm[at] = std::fmod(u, 5.0) < 3.5 ? 20000.0 : 0.0;
        wet[at] = std::fmod(u, 4.0) < 2.0 ? 1.0 : 0.0;
        angle[at] = 20.0 + 10.0 * u;
        removed[at] = 0.1 * u;
        warm[at] = 23.0 + std::sin(0.2 * u);
      }
    recording.t_s = t;
    recording.x_mm = x;
    recording.v_mm_s = v;
    recording.f_n = Series::Zero(2 * k_rows);
    recording.sessions = {{"1", 0, k_rows}, {"2", k_rows, 2 * k_rows}};
    recording.columns = {{"spindle_rpm", rpm},
                         {"wet", wet},
                         {"approach_deg", angle},
                         {"removed_mm3", removed},
                         {"temperature_c", warm}};
    Motion m;
    m.x_mm = x;
    m.v_mm_s = v;
    m.a_mm_s2 = m.sd_x_mm = m.sd_v_mm_s = Series::Zero(2 * k_rows);
    scene = make_scene(recording, m, base, 0.0, 0.0);
  }

  /// What a mechanism adds with these coefficients.
  [[nodiscard]] Series column_n(const char* name, const std::vector<double>& shape,
                                const std::vector<double>& own) const {
    const Columns c = mechanism_at(find_mechanism(name)).columns(scene, shape);
    EXPECT_EQ(c.own.size(), own.size()) << name;
    Series f = Series::Zero(scene.force_n.size());
    for (std::size_t i = 0; i < own.size(); ++i) f += own[i] * c.own[i];
    if (c.spring.size() > 0) f += base.k_n_per_mm * c.spring;
    if (c.damper.size() > 0) f += base.c_n_s_per_mm * c.damper;
    return f;
  }
  [[nodiscard]] Series term_n(const char* name, const Given& parameters) const {
    return terms_force_n({make_force_term(name, parameters, "test")},
                         {base.k_n_per_mm, base.c_n_s_per_mm}, scene);
  }
};

TEST(LiveTerms, ColumnsOfExplainAreTheForcesOfTheEngine) {
  const Stage stage;
  const double turn = 0.15 * 2 * 3.14159265358979323846;
  // the same phase in both sessions
  const std::vector<double> line{0.1 * std::cos(turn), 0.1 * std::sin(turn), 0.1 * std::cos(turn),
                                 0.1 * std::sin(turn)};
  const struct {
    const char* name;
    std::vector<double> shape, own;
    Given term;
    double tolerance = 1e-12;
  } cases[] = {
      {"coulomb_friction", {0.07}, {0.2}, {{"fc_n", 0.2}, {"v0_mm_s", 0.07}}},
      {"stribeck_friction",
       {0.4, 0.03},
       {0.2, 0.15},
       {{"fc_n", 0.2}, {"fs_n", 0.35}, {"vs_mm_s", 0.4}, {"v0_mm_s", 0.03}}},
      {"viscous_friction", {}, {0.1}, {{"b_n_s_per_mm", 0.1}}},
      {"backlash", {1, 0.03}, {}, {{"b_mm", 0.03}}},
      {"backlash", {2, 0.03}, {}, {{"b_mm", 0.03}, {"ahead_mm", 0.0}}},
      {"hysteresis", {0, 0.1}, {0.3}, {{"alpha_n_per_mm", 0.3}, {"d_mm", 0.1}, {"gamma", 0.5}}},
      {"hysteresis", {1, 0.1}, {0.3}, {{"alpha_n_per_mm", 0.3}, {"d_mm", 0.1}}},
      {"series_compliance", {0.9, 0.0}, {}, {{"softening_force_n", 0.9}}},
      {"nonlinear_stiffness", {1.4}, {}, {{"m", 1.4}}},
      {"hidden_layer", {0.3}, {0.5}, {{"dk_n_per_mm", 0.5}, {"d0_mm", 0.3}}},
      {"graded_stiffness", {}, {-0.4}, {{"alpha_per_mm", 0.5}}},
      {"anisotropy",
       {0},
       {0.2 * std::cos(turn), 0.2 * std::sin(turn)},
       {{"epsilon", 0.2}, {"phi0_deg", 27.0}}},
      {"anisotropy",
       {1},
       {0.2 * std::cos(turn), 0.2 * std::sin(turn)},
       {{"amplitude_n", 0.2}, {"phi0_deg", 27.0}}},
      {"relaxation",
       {0.5, 4.0, 1.0, 0.0},
       {0.3, 0.2},
       {{"k1_n_per_mm", 0.3}, {"tau1_s", 0.5}, {"k2_n_per_mm", 0.2}, {"tau2_s", 4.0}}},
      {"relaxation",
       {0.5, 0.0, 2.0, 0.0},
       {0.3},
       {{"k1_n_per_mm", 0.3}, {"tau1_s", 0.5}, {"exponent", 2.0}}},
      {"relaxation",
       {0.5, 0.0, 1.0, 1.0},
       {0.3},
       {{"k1_n_per_mm", 0.3}, {"tau1_s", 0.5}, {"carried", 1.0}}},
      {"feed_power_law",
       {0.8},
       {},
       {{"n", 0.8}},
       5e-5},  // explain takes speeds below 1e-4 mm/s for rest
      {"edge_force", {}, {0.12}, {{"edge_n", 0.12}}},
      {"wear", {0}, {0.05}, {{"per_mm3", 0.05}}},
      {"wear", {1}, {0.05}, {{"per_mm3", 0.05}, {"carried", 1.0}}},
      {"run_out",
       {0, 1},
       line,
       {{"amplitude_n", 0.1}, {"phase_turns", 0.15}, {"by_clock", 1.0}},
       1e-9},
      {"run_out", {1, 1}, line, {{"amplitude_n", 0.1}, {"phase_turns", 0.15}}, 1e-9},
      {"chatter",
       {31.7, 0},
       line,
       {{"amplitude_n", 0.1}, {"frequency_hz", 31.7}, {"phase_turns", 0.15}},
       1e-9},
      {"coolant", {}, {-0.2}, {{"fraction", -0.2}}},
      {"thermal_softening", {}, {0.03}, {{"per_k", 0.03}}},
  };
  for (const auto& c : cases) {
    const Series column = stage.column_n(c.name, c.shape, c.own),
                 term = stage.term_n(c.name, c.term);
    // where the sum would pull, the engine's is cut off and explain's has no weight
    Series gap = (column - term).abs();
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (std::fabs(stage.recording.x_mm[i]) < 1e-4)
        gap[i] = 0.0;  // explain knows the surface to 1e-5 mm
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (stage.scene.touching[i] > 0.5 &&
          (stage.scene.active[i] < 0.5 || stage.scene.force_n[i] + term[i] < 1e-9))
        gap[i] = 0.0;
    EXPECT_LT(gap.maxCoeff(), c.tolerance) << c.name;
    EXPECT_GT(term.abs().maxCoeff(), 0.002) << c.name << " must act";
  }
}

}  // namespace
}  // namespace cavum::explain
