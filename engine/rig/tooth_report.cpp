// The cut through a tooth in words, tables and JSON.
#include <nlohmann/json.hpp>

#include "engine/base/print.h"
#include "engine/rig/tooth_rig.h"

namespace cavum {
namespace {

using nlohmann::json;

json to_json(const MeanSd& m) { return {{"mean", m.mean}, {"sd", m.sd}}; }

json to_json(const std::vector<BandPoint>& band) {
  json out = json::array();
  for (const auto& p : band) out.push_back({{"t_s", p.t_s}, {"mean_n", p.force_n.mean}, {"sd_n", p.force_n.sd}, {"runs", p.runs}});
  return out;
}

std::string constants_from_the_paper() {
  return printed("From the paper's formulae: c = 2 h √k at k = %.1f N/mm, h = %.0f is %.3f N s/mm (the paper rounds to 1.79).\n", k_paper_k_n_per_mm,
                 k_paper_damping_h, paper_damping_n_s_per_mm(k_paper_k_n_per_mm)) +
         printed(
             "A real tooth took %.3f N on average; eq. 6 turned round gives k = (%.3f - %.3f)/%.3f = %.3f N/mm (the paper prints 0.789, and uses "
             "%.1f).\n",
             k_paper_tooth_n, k_paper_tooth_n, k_paper_intercept_n, k_paper_slope_mm, paper_stiffness_n_per_mm(k_paper_tooth_n), k_paper_k_n_per_mm);
}

/// The first few by name; all are in the JSON.
std::string left_out_lines(const ToothRigResult& r) {
  constexpr int k_named = 3;
  std::string out;
  int n = 0;
  for (std::size_t i = 0; i < r.runs.size(); ++i) {
    const ToothRun& run = r.runs[i];
    if ((run.reached_pulp && !run.held) || ++n > k_named) continue;
    out += printed("Left out: run %zu, x %.4f, y %.4f mm: %s.\n", i + 1, run.x_mm, run.y_mm,
                   run.held ? "the head is held in its hole, X passed twice V tau, a fault of the simulation" : "the pulp was not reached");
  }
  if (n > k_named) out += printed("and %d more (--json names all).\n", n - k_named);
  return out;
}

}  // namespace

std::string to_text(const ToothRigResult& r) {
  const auto& o = r.options;
  std::string out = printed("%s, force model '%s', %s, crosshead %.2f mm/s, %d runs within %.2f mm of x %.2f, y %.2f mm, seed %llu\n",
                            r.tooth.c_str(), r.model.c_str(), r.point.c_str(), o.machine.speed_mm_s, o.runs, o.spread_mm, o.at_mm->first,
                            o.at_mm->second, static_cast<unsigned long long>(o.seed));
  out += printed("Load cell: joint friction %.2f N; noise %.3f N and a zero error of %.3f N for each run (both assumed); encoder %.3f mm.\n\n",
                 o.machine.omni.coulomb_n, o.machine.noise_n, o.machine.zero_n, o.machine.omni.quantum_mm);
  out += "  tissue before the tip   from s         to s         mean force N\n";
  for (const auto& l : r.layers)
    out += printed("  %-18s %8.2f ± %-5.2f %6.2f ± %-5.2f %8.3f ± %.3f\n", l.tissue.c_str(), l.from_s.mean, l.from_s.sd, l.to_s.mean, l.to_s.sd,
                   l.force_n.mean, l.force_n.sd);
  out += "  (times from the first contact, of the runs counted; the first mean contains the rise of the force, the pulp's its fall)\n\n";
  out += left_out_lines(r);
  if (r.counted > 0) {
    out +=
        printed("Pulp reached in %d of %d runs, %.2f ± %.2f s after contact: force %.3f ± %.3f N before, %.3f ± %.3f N after, a fall of %.0f %%,\n",
                r.counted, o.runs, r.pulp_s.mean, r.pulp_s.sd, r.before_n.mean, r.before_n.sd, r.after_n.mean, r.after_n.sd,
                100.0 * (1.0 - r.after_n.mean / r.before_n.mean));
    out += printed("from 90 to 10 %% within %.2f ± %.2f s. Joint friction is %.2f N of all these.\n", r.fall_s.mean, r.fall_s.sd,
                   o.machine.omni.coulomb_n);
  } else {
    out += "The pulp was reached in no run.\n";
  }
  return out + constants_from_the_paper();
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
    layers.push_back({{"tissue", l.tissue}, {"from_s", to_json(l.from_s)}, {"to_s", to_json(l.to_s)}, {"force_n", to_json(l.force_n)}});
  return {{"experiment", "tooth"},
          {"tooth", r.tooth},
          {"model", r.model},
          {"point", r.point},
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
