// The cut through a tooth in words, tables and JSON.
#include <nlohmann/json.hpp>

#include "engine/lab/rig/tooth_rig.h"

namespace cavum {
namespace {

using nlohmann::json;

json to_json(const MeanSd& m) { return {{"mean", m.mean}, {"sd", m.sd}}; }

json to_json(const std::vector<BandPoint>& band) {
  json out = json::array();
  for (const auto& p : band)
    out.push_back(
        {{"t_s", p.t_s}, {"mean_n", p.force_n.mean}, {"sd_n", p.force_n.sd}, {"runs", p.runs}});
  return out;
}

/// The first few by name; all are in the JSON.
void add_left_out(const ToothRigResult& r, Lines& out) {
  constexpr int k_named = 3;
  int n = 0;
  for (std::size_t i = 0; i < r.runs.size(); ++i) {
    const ToothRun& run = r.runs[i];
    if ((run.reached_pulp && !run.held) || ++n > k_named) continue;
    const Number x = as_mm(run.x_mm, 4), y = as_mm(run.y_mm, 4);
    out.add(
        run.held
            ? msg("Left out: run {}, x = {}, y = {}: the head is held in its hole, X passed twice V τ, a fault of the simulation.",
                  i + 1, x, y)
            : msg("Left out: run {}, x = {}, y = {}: the pulp was not reached.", i + 1, x, y));
  }
  if (n > k_named)
    out.add(msgn("{} more run: --json names all", "{} more runs: --json names all", n - k_named,
                 n - k_named));
}

}  // namespace

Lines to_text(const ToothRigResult& r) {
  const auto& o = r.options;
  Lines out;
  out.add(msg("{}, force model '{}', {}, crosshead {}", r.tooth, r.model, Term{r.bur},
              as_unit(o.machine.speed_mm_s, Unit::mm_per_s, 2)));
  out.add(msgn("{} run within {} of x = {}, y = {}; seed {}",
               "{} runs within {} of x = {}, y = {}; seed {}", o.runs, o.runs,
               as_mm(o.spread_mm, 2), as_mm(o.at_mm->first, 2), as_mm(o.at_mm->second, 2),
               std::to_string(o.seed)));
  out.add(load_cell_words(o.machine));
  out.gap();
  out.row({msg("tissue before the tip"), msg("begins"), msg("ends"), msg("mean force")}, 2);
  for (const auto& l : r.layers)
    out.row({msg("{}", Term{l.tissue}), msg("{}", as_s(l.from_s.mean, 2, l.from_s.sd)),
             msg("{}", as_s(l.to_s.mean, 2, l.to_s.sd)),
             msg("{}", as_n(l.force_n.mean, 3, l.force_n.sd))},
            2);
  out.add(
      msg("(times from the first contact, of the runs counted; the first mean contains the rise of the force, the pulp's its fall)"),
      2);
  out.gap();
  add_left_out(r, out);
  if (r.counted > 0) {
    out.add(msg("Pulp reached in {} of {} runs, {} after contact.", r.counted, o.runs,
                as_s(r.pulp_s.mean, 2, r.pulp_s.sd)));
    out.add(msg(
        "Force {} before, {} after: a fall of {}, from 90 to 10 % of it within {}. Joint friction is {} of all these.",
        as_n(r.before_n.mean, 3, r.before_n.sd), as_n(r.after_n.mean, 3, r.after_n.sd),
        as_percent(100.0 * (1.0 - r.after_n.mean / r.before_n.mean)),
        as_s(r.fall_s.mean, 2, r.fall_s.sd), as_n(o.machine.omni.coulomb_n, 2)));
  } else {
    out.add(msg("The pulp was reached in no run."));
  }
  out.add(msg(
      "From the paper's formulae: c = 2 h √k at k = {}, h = {} is {} N s/mm (the paper rounds to 1.79).",
      as_unit(k_paper_k_n_per_mm, Unit::n_per_mm, 1), as_number(k_paper_damping_h, 0),
      as_number(paper_damping_n_s_per_mm(k_paper_k_n_per_mm), 3)));
  out.add(msg(
      "A real tooth took {} on average; eq. 6 turned round gives k = {} (the paper prints 0.789, and uses {}).",
      as_n(k_paper_tooth_n, 3),
      as_unit(paper_stiffness_n_per_mm(k_paper_tooth_n), Unit::n_per_mm, 3),
      as_number(k_paper_k_n_per_mm, 1)));
  return out;
}

json to_json(const ToothRigResult& r) {
  const auto& o = r.options;
  json runs = json::array(), layers = json::array();
  for (const auto& run : r.runs) {
    json tissues;
    for (const auto& [name, mean] : run.tissue_mean_n) tissues[name] = mean;
    runs.push_back({{"x_mm", run.x_mm},
                    {"y_mm", run.y_mm},
                    {"reached_pulp", run.reached_pulp},
                    {"held", run.held},
                    {"pulp_s", run.pulp_s},
                    {"before_n", run.before_n},
                    {"after_n", run.after_n},
                    {"fall_s", run.fall_s},
                    {"tissue_mean_n", tissues},
                    {"safety_notices", run.notices}});
  }
  for (const auto& l : r.layers)
    layers.push_back({{"tissue", l.tissue},
                      {"from_s", to_json(l.from_s)},
                      {"to_s", to_json(l.to_s)},
                      {"force_n", to_json(l.force_n)}});
  return {{"experiment", "tooth"},
          {"tooth", r.tooth},
          {"model", r.model},
          {"bur", r.bur},
          {"crosshead_mm_s", o.machine.speed_mm_s},
          {"seed", o.seed},
          {"at_mm", {o.at_mm->first, o.at_mm->second}},
          {"spread_mm", o.spread_mm},
          {"friction_n", o.machine.omni.coulomb_n},
          {"counted", r.counted},
          {"pulp_s", to_json(r.pulp_s)},
          {"before_n", to_json(r.before_n)},
          {"after_n", to_json(r.after_n)},
          {"fall_s", to_json(r.fall_s)},
          {"layers", layers},
          {"from_contact", to_json(r.from_contact)},
          {"around_pulp", to_json(r.around_pulp)},
          {"paper",
           {{"c_at_k_0_8_n_s_per_mm", paper_damping_n_s_per_mm(k_paper_k_n_per_mm)},
            {"tooth_n", k_paper_tooth_n},
            {"k_of_tooth_n_per_mm", paper_stiffness_n_per_mm(k_paper_tooth_n)}}},
          {"runs", runs}};
}

}  // namespace cavum
