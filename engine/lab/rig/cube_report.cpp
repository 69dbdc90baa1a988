// The cube experiment in words, tables and files.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/text.h"
#include "engine/lab/rig/cube_rig.h"

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
        worst = std::max(
            worst,
            std::fabs(row.penetration.mean / (r.options.machine.speed_mm_s * set.tau_s) - 1.0));
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
  return r.options.machine.omni.coulomb_n +
         r.options.machine.omni.viscous_n_s_per_mm * r.options.machine.speed_mm_s;
}

/// What c does in this set: the √k term found beside the one that c·V predicts, and the bend of the
/// row of means.
void add_damping(const CubeResult& r, const CubeSet& set, std::vector<Message>& out) {
  const double predicted = set.damping_ratio * r.options.machine.speed_mm_s;
  const Fit& f = set.with.with_root;
  if (!f.solved) {
    out.push_back(msg("{}: too few values of k for a √k term.", set.name));
    return;
  }
  out.push_back(msg(
      "{}, c = {} √k: c V should add {} √k N ({} at k = 0.8), the fit finds {} (95 %).", set.name,
      as_number(set.damping_ratio), as_number(predicted, 3), as_n(predicted * std::sqrt(0.8), 3),
      Number{f.value[2], Unit::none, 3, k_95 * f.error[2]}));
  const Number bend = as_n(set.with.bend_n, 3), scatter = as_n(scatter_n(set), 3),
               slope = as_mm(set.with.line.value[0], 3);
  out.push_back(
      is_bent(set)
          ? msg("It is not a straight line: the means leave it by up to {}, the scatter of a run is {}, and the line has slope {}.",
                bend, scatter, slope)
          : msg("No bend is to be seen: the means leave the line by at most {}, the scatter of a run is {}; slope {}.",
                bend, scatter, slope));
}

void add_friction(const CubeResult& r, std::vector<Message>& out) {
  const CubeSet* like = nullptr;  // the set nearest to eq. 6 in slope
  for (const auto& set : r.sets)
    if (like == nullptr || std::fabs(set.with.line.value[0] - k_paper_slope_mm) <
                               std::fabs(like->with.line.value[0] - k_paper_slope_mm))
      like = &set;
  const double intercept = like->with.line.value[1], without = like->without.line.value[1],
               missing = k_paper_intercept_n - intercept;
  out.push_back(msg(
      "Joint friction of {} lifts every row by {} and bends nothing: intercept of '{}' {} without it, {} with it.",
      as_n(friction_n(r), 2), as_n(intercept - without, 3), like->name, as_n(without, 3),
      as_n(intercept, 3)));
  out.push_back(missing > 0.05
                    ? msg("eq. 6 has {}, so {} of it are more than this friction explains.",
                          as_n(k_paper_intercept_n, 3), as_n(missing, 3))
                    : msg("eq. 6 has {}.", as_n(k_paper_intercept_n, 3)));
  out.push_back(msg(
      "Nor do these data show that it is friction: the crosshead moves one way at one speed, and a bias of the load cell or a constant "
      "edge force of the same size gives the very same rows."));
  out.push_back(msg("Reversals and strokes in air would tell them apart."));
}

json to_json(const Fit& f, bool root) {
  if (!f.solved) return nullptr;
  json j{{"slope_mm", f.value[0]},
         {"slope_error_mm", f.error[0]},
         {"intercept_n", f.value[1]},
         {"intercept_error_n", f.error[1]},
         {"rms_n", f.rms}};
  if (root) {
    j["root_n"] = f.value[2];
    j["root_error_n"] = f.error[2];
  }
  return j;
}

json to_json(const CubeFit& f) {
  return {{"line", to_json(f.line, false)},
          {"with_root", to_json(f.with_root, true)},
          {"bend_n", f.bend_n}};
}

void add_fit(const CubeFit& f, const Message& what, Lines& out) {
  const auto term = [](double v, Unit unit = Unit::none) { return Number{v, unit, 3, 0.0, true}; };
  if (!f.line.solved) {
    out.row({what, msg("too few values of k for a line"), {}, {}, {}}, 2);
    return;
  }
  const Fit& root = f.with_root;
  out.row(
      {what, msg("F = {} k {}", as_number(f.line.value[0], 3), term(f.line.value[1], Unit::newton)),
       msg("rms {}", as_n(f.line.rms, 3)),
       root.solved ? msg("with √k: F = {} k {} √k {}", as_number(root.value[0], 3),
                         term(root.value[2]), term(root.value[1], Unit::newton))
                   : Message(),
       root.solved ? msg("rms {}", as_n(root.rms, 3)) : Message()},
      2);
}

/// The first few by name; all are in the JSON.
void add_left_out(const CubeSet& set, Lines& out) {
  constexpr int k_named = 3;
  int n = 0;
  for (const auto& row : set.rows)
    for (std::size_t i = 0; i < row.runs.size(); ++i) {
      const CubeRun& run = row.runs[i];
      if (run.steady || ++n > k_named) continue;
      out.add(msg("left out: k = {}, run {}, tip at x = {}, y = {}: X is {}, the force {}",
                  as_unit(row.k_n_per_mm, Unit::n_per_mm, 2), i + 1, as_mm(run.start_mm.x, 4),
                  as_mm(run.start_mm.y, 4), as_mm(run.penetration_mm, 3), as_n(run.mean_n, 3)),
              2);
    }
  if (n > k_named)
    out.add(msgn("{} more run: --json names all", "{} more runs: --json names all", n - k_named,
                 n - k_named),
            2);
}

}  // namespace

bool is_bent(const CubeSet& set) {
  const Fit& f = set.with.with_root;
  return f.solved && std::fabs(f.value[2]) > k_95 * f.error[2] && set.with.bend_n > scatter_n(set);
}

std::vector<Message> cube_reading(const CubeResult& r) {
  for (const auto& set : r.sets)
    if (!set.with.line.solved)
      return {msg(
          "Too few values of k for a line: nothing can be said about slope, intercept or curvature.")};
  const double off = penetration_error(r);
  std::vector<Message> out;
  if (const int n = left_out(r); n > 0)
    out.push_back(msgn(
        "{} run is left out: the head was held in its hole and X did not settle, which is a fault of the simulation and not of the material.",
        "{} runs are left out: the head was held in its hole and X did not settle, which is a fault of the simulation and not of the material.",
        n, n));
  out.push_back(
      off < 0.02
          ? msg("The penetration settled within {} of V τ = {} at every k, so k X alone has the slope of eq. 6.",
                as_percent(100 * off, 1),
                as_mm(r.options.machine.speed_mm_s * r.sets.front().tau_s, 3))
          : msg("The penetration did NOT settle at V τ: it is off by up to {}, so the slopes are not those of a steady cut.",
                as_percent(100 * off, 1)));
  const CubeSet* bent = nullptr;
  for (const auto& set : r.sets) {
    add_damping(r, set, out);
    if (is_bent(set) && (bent == nullptr || set.with.bend_n > bent->with.bend_n)) bent = &set;
  }
  if (std::fabs(r.options.machine.speed_mm_s * r.sets.front().tau_s / k_paper_slope_mm - 1.0) <
      0.01)
    out.push_back(msg(
        "τ = {} was itself taken from the slope of eq. 6, so a slope of {} proves nothing; the shape does tell.",
        as_s(r.sets.front().tau_s, 2), as_mm(k_paper_slope_mm, 3)));
  if (bent != nullptr)
    out.push_back(msg(
        "Whatever τ is, the c V of '{}' bends the row by {}, and the paper reports a straight line: the figures speak against a force of "
        "c V with that c in the measured cubes.",
        bent->name, as_n(bent->with.bend_n, 2)));
  add_friction(r, out);
  return out;
}

Lines to_text(const CubeResult& r) {
  const CubeOptions& o = r.options;
  Lines out;
  out.add(msgn(
      "Virtual cubes of 10 mm, crosshead {}, {} run each, seed {}; F in N, k in N/mm, c in N s/mm",
      "Virtual cubes of 10 mm, crosshead {}, {} runs each, seed {}; F in N, k in N/mm, c in N s/mm",
      o.runs, as_unit(o.machine.speed_mm_s, Unit::mm_per_s, 2), o.runs, std::to_string(o.seed)));
  double deepest = 0.0;
  for (const auto& set : r.sets)
    for (const auto& row : set.rows) deepest = std::max(deepest, row.depth_mm);
  out.add(msg(
      "Cut only until steady, 6 times the slower of τ and c/Kvc: at most {} of the 10 mm; mean over the last 2 s.",
      as_mm(deepest, 1)));
  out.add(load_cell_words(o.machine));
  for (const auto& set : r.sets) {
    out.gap();
    out.add(msg("{}, c = {} √k", set.name, as_number(set.damping_ratio)));
    out.row({msg("k"),
             msg("c"),
             msg("X, mm"),
             msg("with friction"),
             msg("sd"),
             msg("without"),
             msg("sd"),
             msg("k V τ + c V"),
             msg("eq. 6"),
             msg("left out"),
             {}},
            2);
    for (const auto& row : set.rows)
      out.row(
          {msg("{}", as_number(row.k_n_per_mm, 2)), msg("{}", as_number(row.c_n_s_per_mm, 4)),
           msg("{}", as_number(row.penetration.mean, 3)), msg("{}", as_number(row.with.mean, 3)),
           msg("{}", as_number(row.with.sd, 3)), msg("{}", as_number(row.without.mean, 3)),
           msg("{}", as_number(row.without.sd, 3)), msg("{}", as_number(row.expected_n, 3)),
           msg("{}", as_number(paper_force_n(row.k_n_per_mm), 3)), msg("{}", row.left_out),
           row.notices != 0 ? msg("safety stepped in") : Message()},
          2);
    add_left_out(set, out);
    add_fit(set.with, msg("with friction"), out);
    add_fit(set.without, msg("without friction"), out);
  }
  out.add(msg("The paper, eq. 6: F = {} k {}", as_number(k_paper_slope_mm, 3),
              Number{k_paper_intercept_n, Unit::newton, 3, 0.0, true}),
          2);
  out.gap();
  for (const Message& sentence : cube_reading(r)) out.add(sentence);
  return out;
}

json to_json(const CubeResult& r) {
  std::string reading;
  for (const Message& sentence : cube_reading(r))
    reading += (reading.empty() ? "" : " ") + english_text(sentence);
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
          {"reading", reading}};
}

std::string recordings_csv(const CubeResult& r) {
  std::string out;
  if (r.sets.empty()) return out;
  for (const auto& row : r.sets.front().rows)
    for (std::size_t i = 0; i < row.runs.size(); ++i) {
      if (!row.runs[i].steady) continue;
      for (const auto& s : row.runs[i].recording)
        out += fmt::format("k{:.2f}-run{:02},{:.3f},{:.6f},{:.6f},{:.6f},{:.0f},{:.6f}\n",
                           row.k_n_per_mm, i + 1, s.t_s, s.x_mm, s.f_n, s.v_mm_s, s.spindle_rpm,
                           s.removed_mm3);
    }
  return out.empty() ? out : "session,t_s,x_mm,f_n,v_mm_s,spindle_rpm,removed_mm3\n" + out;
}

std::string recordings_rig_toml(const CubeResult& r) {
  const MachineSettings& m = r.options.machine;
  std::string out = fmt::format(
      "# Virtual testing machine, cubes cut at {:.2f} mm/s: model '{}' on a simulated Omni (joint friction {:.2f} N in f_n).\n"
      "# The surface recedes while it is cut: x_mm is the penetration into what is left, v_mm_s the way of the tip.\n",
      m.speed_mm_s, one_line(r.sets.front().name), m.omni.coulomb_n);
  for (const auto& row : r.sets.front().rows)
    if (!row.runs.empty() && !row.runs.front().recording.empty())
      out += fmt::format("k_n_per_mm = {:.12g}\nc_n_s_per_mm = {:.12g}\n", row.k_n_per_mm,
                         row.c_n_s_per_mm);
  return out +
         fmt::format(
             "position_quantum_mm = {:.12g}\nforce_quantum_n = 0.000001\nforce_limit_n = {:.12g}\n",
             m.omni.quantum_mm, m.omni.saturation_n);
}

}  // namespace cavum
