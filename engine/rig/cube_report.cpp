// The cube experiment in words, tables and files.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/print.h"
#include "engine/base/text.h"
#include "engine/rig/cube_rig.h"

namespace cavum {
namespace {

using nlohmann::json;

constexpr double k_95 = 1.96;  // standard errors

/// Furthest from V·τ that the mean penetration of a row lies, relative.
double penetration_error(const CubeResult& r) {
  double worst = 0.0;
  for (const auto& set : r.sets)
    for (const auto& row : set.rows)
      if (row.left_out < static_cast<int>(row.runs.size()))
        worst = std::max(worst, std::fabs(row.penetration.mean / (r.options.machine.speed_mm_s * set.tau_s) - 1.0));
  return worst;
}

int left_out(const CubeResult& r) {
  int n = 0;
  for (const auto& set : r.sets)
    for (const auto& row : set.rows) n += row.left_out;
  return n;
}

double scatter_n(const CubeSet& set) {
  double worst = 0.0;
  for (const auto& row : set.rows) worst = std::max(worst, row.with.sd);
  return worst;
}

double friction_n(const CubeResult& r) {
  return r.options.machine.omni.coulomb_n + r.options.machine.omni.viscous_n_s_per_mm * r.options.machine.speed_mm_s;
}

/// More than the scatter of a run, and a √k term that is not nothing.
bool is_bent(const CubeSet& set) {
  const Fit& f = set.with.with_root;
  return f.solved && std::fabs(f.value[2]) > k_95 * f.error[2] && set.with.bend_n > scatter_n(set);
}

/// What c does in this set: the √k term found beside the one that c·V predicts, and the bend of the row of means.
std::string damping_sentence(const CubeResult& r, const CubeSet& set) {
  const double predicted = set.damping_ratio * r.options.machine.speed_mm_s;
  const Fit& f = set.with.with_root;
  if (!f.solved) return printed("%s: too few values of k for a √k term. ", set.name.c_str());
  const double found = f.value[2], error = k_95 * f.error[2];
  std::string s = printed("%s, c = %.3g √k: c V should add %.3f √k N (%.3f N at k = 0.8), the fit finds %.3f ± %.3f (95 %%). ", set.name.c_str(),
                          set.damping_ratio, predicted, predicted * std::sqrt(0.8), found, error);
  if (is_bent(set))
    s += printed("It is not a straight line: the means leave it by up to %.3f N, the scatter of a run is %.3f N, and the line has slope %.3f mm. ",
                 set.with.bend_n, scatter_n(set), set.with.line.value[0]);
  else
    s += printed("No bend is to be seen: the means leave the line by at most %.3f N, the scatter of a run is %.3f N; slope %.3f mm. ",
                 set.with.bend_n, scatter_n(set), set.with.line.value[0]);
  return s;
}

std::string friction_sentence(const CubeResult& r) {
  const double friction = friction_n(r);
  const CubeSet* like = nullptr;  // the set nearest to eq. 6 in slope
  for (const auto& set : r.sets)
    if (like == nullptr || std::fabs(set.with.line.value[0] - k_paper_slope_mm) < std::fabs(like->with.line.value[0] - k_paper_slope_mm)) like = &set;
  const double intercept = like->with.line.value[1], without = like->without.line.value[1], missing = k_paper_intercept_n - intercept;
  std::string s = printed("Joint friction of %.2f N lifts every row by %.3f N and bends nothing: intercept of '%s' %.3f N without, %.3f N with it; ",
                          friction, intercept - without, like->name.c_str(), without, intercept);
  if (missing > 0.05)
    s += printed("eq. 6 has %.3f N, so %.3f N of it are more than this friction explains. ", k_paper_intercept_n, missing);
  else
    s += printed("eq. 6 has %.3f N. ", k_paper_intercept_n);
  return s +
         "Nor do these data show that it is friction: the crosshead moves one way at one speed, and a bias of the load cell or a constant edge force "
         "of "
         "the same size gives the very same rows. Reversals and strokes in air would tell them apart.";
}

json to_json(const Fit& f, bool root) {
  if (!f.solved) return nullptr;
  json j{{"slope_mm", f.value[0]}, {"slope_error_mm", f.error[0]}, {"intercept_n", f.value[1]}, {"intercept_error_n", f.error[1]}, {"rms_n", f.rms}};
  if (root) {
    j["root_n"] = f.value[2];
    j["root_error_n"] = f.error[2];
  }
  return j;
}

json to_json(const CubeFit& f) { return {{"line", to_json(f.line, false)}, {"with_root", to_json(f.with_root, true)}, {"bend_n", f.bend_n}}; }

std::string fit_lines(const CubeFit& f, const char* what) {
  if (!f.line.solved) return printed("  %s: too few values of k for a line\n", what);
  std::string s = printed("  %-17s F = %.3f k %+.3f N, rms %.3f N", what, f.line.value[0], f.line.value[1], f.line.rms);
  if (f.with_root.solved)
    s += printed(";  with √k: F = %.3f k %+.3f √k %+.3f N, rms %.3f N", f.with_root.value[0], f.with_root.value[2], f.with_root.value[1],
                 f.with_root.rms);
  return s + "\n";
}

/// The first few by name; all are in the JSON.
std::string left_out_lines(const CubeSet& set) {
  constexpr int k_named = 3;
  std::string out;
  int n = 0;
  for (const auto& row : set.rows)
    for (std::size_t i = 0; i < row.runs.size(); ++i) {
      const CubeRun& run = row.runs[i];
      if (run.steady || ++n > k_named) continue;
      out += printed("  left out: k %.2f run %zu, tip at x %.4f, y %.4f mm: X %.3f mm, %.3f N\n", row.k_n_per_mm, i + 1, run.start_mm.x,
                     run.start_mm.y, run.penetration_mm, run.mean_n);
    }
  if (n > k_named) out += printed("  and %d more (--json names all)\n", n - k_named);
  return out;
}

}  // namespace

std::string cube_reading(const CubeResult& r) {
  for (const auto& set : r.sets)
    if (!set.with.line.solved) return "Too few values of k for a line: nothing can be said about slope, intercept or curvature.";
  const double off = penetration_error(r);
  std::string s;
  if (const int n = left_out(r); n > 0)
    s = printed("%d %s left out: the head was held in its hole and X did not settle, which is a fault of the simulation and not of the material. ", n,
                n == 1 ? "run is" : "runs are");
  if (off < 0.02)
    s += printed("The penetration settled within %.1f %% of V τ = %.3f mm at every k, so k X alone has the slope of eq. 6. ", 100 * off,
                 r.options.machine.speed_mm_s * r.sets.front().tau_s);
  else
    s += printed("The penetration did NOT settle at V τ: it is off by up to %.1f %%, so the slopes below are not those of a steady cut. ", 100 * off);
  const CubeSet* bent = nullptr;
  for (const auto& set : r.sets) {
    s += damping_sentence(r, set);
    if (is_bent(set) && (bent == nullptr || set.with.bend_n > bent->with.bend_n)) bent = &set;
  }
  if (std::fabs(r.options.machine.speed_mm_s * r.sets.front().tau_s / k_paper_slope_mm - 1.0) < 0.01)
    s += printed("Tau = %.2f s was itself taken from the slope of eq. 6, so a slope of %.3f mm proves nothing; the shape does tell. ",
                 r.sets.front().tau_s, k_paper_slope_mm);
  if (bent != nullptr)
    s += printed(
        "Whatever tau is, the c V of '%s' bends the row by %.2f N, and the paper reports a straight line: the figures speak against a force of c V "
        "with "
        "that c in the measured cubes. ",
        bent->name.c_str(), bent->with.bend_n);
  return s + friction_sentence(r);
}

std::string to_text(const CubeResult& r) {
  const CubeOptions& o = r.options;
  std::string out = printed("Virtual cubes of 10 mm, crosshead %.2f mm/s, %d runs each, seed %llu; F in N, k in N/mm, c in N s/mm\n",
                            o.machine.speed_mm_s, o.runs, static_cast<unsigned long long>(o.seed));
  double deepest = 0.0;
  for (const auto& set : r.sets)
    for (const auto& row : set.rows) deepest = std::max(deepest, row.depth_mm);
  out += printed("Cut only until steady, 6 times the slower of tau and c/Kvc: at most %.1f of the 10 mm; mean over the last 2 s.\n", deepest);
  out += printed("Load cell: joint friction %.2f N; noise %.3f N and a zero error of %.3f N for each run (both assumed); encoder %.3f mm.\n",
                 o.machine.omni.coulomb_n, o.machine.noise_n, o.machine.zero_n, o.machine.omni.quantum_mm);
  for (const auto& set : r.sets) {
    out += printed("\n%s  (c = %.4g √k)\n", set.name.c_str(), set.damping_ratio);
    out += "      k       c    X mm | with friction   sd | without    sd | k V tau + c V | eq. 6 | left out\n";
    for (const auto& row : set.rows) {
      out += printed("  %5.2f %7.4f  %6.3f | %13.3f %5.3f| %7.3f %5.3f | %13.3f | %5.3f | %3d%s\n", row.k_n_per_mm, row.c_n_s_per_mm,
                     row.penetration.mean, row.with.mean, row.with.sd, row.without.mean, row.without.sd, row.expected_n,
                     paper_force_n(row.k_n_per_mm), row.left_out, row.notices != 0 ? "  (safety stepped in)" : "");
    }
    out += left_out_lines(set);
    out += fit_lines(set.with, "with friction") + fit_lines(set.without, "without friction");
  }
  out += printed("  %-17s F = %.3f k %+.3f N\n\n", "paper, eq. 6", k_paper_slope_mm, k_paper_intercept_n);
  return out + wrapped(cube_reading(r));
}

json to_json(const CubeResult& r) {
  json sets = json::array();
  for (const auto& set : r.sets) {
    json rows = json::array();
    for (const auto& row : set.rows) {
      json runs = json::array();
      for (const auto& run : row.runs)
        runs.push_back({{"mean_n", run.mean_n},
                        {"penetration_mm", run.penetration_mm},
                        {"steady", run.steady},
                        {"start_mm", {run.start_mm.x, run.start_mm.y, run.start_mm.z}}});
      rows.push_back({{"k_n_per_mm", row.k_n_per_mm},
                      {"c_n_s_per_mm", row.c_n_s_per_mm},
                      {"penetration_mm", row.penetration.mean},
                      {"mean_n", row.with.mean},
                      {"sd_n", row.with.sd},
                      {"without_friction_mean_n", row.without.mean},
                      {"without_friction_sd_n", row.without.sd},
                      {"closed_form_n", row.expected_n},
                      {"eq_6_n", paper_force_n(row.k_n_per_mm)},
                      {"contact_s", row.seconds},
                      {"depth_mm", row.depth_mm},
                      {"trend_n_per_s", row.trend_n_per_s},
                      {"safety_notices", row.notices},
                      {"left_out", row.left_out},
                      {"runs", runs}});
    }
    sets.push_back({{"model", set.name},
                    {"c_over_root_k", set.damping_ratio},
                    {"tau_s", set.tau_s},
                    {"rows", rows},
                    {"with_friction", to_json(set.with)},
                    {"without_friction", to_json(set.without)}});
  }
  const MachineSettings& m = r.options.machine;
  return {{"experiment", "cube"},
          {"crosshead_mm_s", m.speed_mm_s},
          {"runs", r.options.runs},
          {"seed", r.options.seed},
          {"friction_n", m.omni.coulomb_n},
          {"noise_n", m.noise_n},
          {"zero_error_n", m.zero_n},
          {"position_quantum_mm", m.omni.quantum_mm},
          {"eq_6", {{"slope_mm", k_paper_slope_mm}, {"intercept_n", k_paper_intercept_n}}},
          {"sets", sets},
          {"reading", cube_reading(r)}};
}

std::string recordings_csv(const CubeResult& r) {
  std::string out;
  if (r.sets.empty()) return out;
  for (const auto& row : r.sets.front().rows)
    for (std::size_t i = 0; i < row.runs.size(); ++i) {
      if (!row.runs[i].steady) continue;
      for (const auto& s : row.runs[i].recording)
        out += printed("k%.2f-run%02zu,%.3f,%.6f,%.6f,%.6f,%.0f,%.6f\n", row.k_n_per_mm, i + 1, s.t_s, s.x_mm, s.f_n, s.v_mm_s, s.spindle_rpm,
                       s.removed_mm3);
    }
  return out.empty() ? out : "session,t_s,x_mm,f_n,v_mm_s,spindle_rpm,removed_mm3\n" + out;
}

std::string recordings_rig_toml(const CubeResult& r) {
  const MachineSettings& m = r.options.machine;
  std::string out = printed(
      "# Virtual testing machine, cubes cut at %.2f mm/s: model '%s' on a simulated Omni (joint friction %.2f N in f_n).\n"
      "# The surface recedes while it is cut: x_mm is the penetration into what is left, v_mm_s the way of the tip.\n",
      m.speed_mm_s, one_line(r.sets.front().name).c_str(), m.omni.coulomb_n);
  for (const auto& row : r.sets.front().rows)
    if (!row.runs.empty() && !row.runs.front().recording.empty())
      out += printed("k_n_per_mm = %.12g\nc_n_s_per_mm = %.12g\n", row.k_n_per_mm, row.c_n_s_per_mm);
  return out + printed("position_quantum_mm = %.12g\nforce_quantum_n = 0.000001\nforce_limit_n = %.12g\n", m.omni.quantum_mm, m.omni.saturation_n);
}

}  // namespace cavum
