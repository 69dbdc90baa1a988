// The closed-loop press in words, tables and JSON.
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/print.h"
#include "engine/rig/press_rig.h"

namespace cavum {
namespace {

using nlohmann::json;

bool same_wall(const PressCell& a, const PressCell& b) {
  return a.k_n_per_mm == b.k_n_per_mm && a.damping == b.damping && a.delay_ticks == b.delay_ticks;
}

std::string name(const PressCell& c) {
  return printed("k %.2f, c %s, delay %d, hand %.0f N/m, press %.1f N", c.k_n_per_mm, damping_name(c.damping), c.delay_ticks, 1000 * c.hand_n_per_mm,
                 c.press_n);
}

/// The worst of all hands and loads at one k, c and delay.
struct Worst {
  double sd_n = 0, generated_mj = 0, peak_n = 0;
  int out = 0, of = 0;
  void add(const PressOutcome& o) {
    sd_n = std::max(sd_n, o.sd_n);
    generated_mj = std::max({generated_mj, o.generated_mj, o.late_mj});
    peak_n = std::max(peak_n, o.peak_n);
    ++of;
    if (!o.steady || !o.passive) ++out;
  }
};

std::string wall_lines(const PressResult& r) {
  const auto& o = r.options;
  std::string head;
  for (const double v : o.contact_mm_s) head += printed(" %5.0f", v);
  std::string out =
      "                          |      ours: worst of all hands and loads  |    explicit k X + c V                   | bounces at mm/s, ours";
  out += fmt::format("\n    k  c           delay  |   sd N   given out mJ  peak N  out of  |   sd N   given out mJ  peak N  out of  |{} / explicit\n",
                     head);
  for (auto row = r.presses.begin(); row != r.presses.end();) {
    const PressCell wall = row->cell;
    Worst ours, other;
    for (; row != r.presses.end() && same_wall(row->cell, wall); ++row) {
      ours.add(row->ours);
      other.add(row->explicit_voigt);
    }
    std::string mine, theirs;
    for (const double v : o.contact_mm_s) {
      int a = 0, b = 0;
      for (const auto& c : r.contacts)
        if (same_wall(c.cell, wall) && c.speed_mm_s == v) {
          a = std::max(a, c.ours.bounces);
          b = std::max(b, c.explicit_voigt.bounces);
        }
      mine += printed(" %5d", a);
      theirs += printed(" %3d", b);
    }
    out += printed("  %4.2f %-11s %4d    | %7.4f %9.4f %9.2f  %2d/%-2d    | %7.4f %9.4f %9.2f  %2d/%-2d    |%s /%s\n", wall.k_n_per_mm,
                   damping_name(wall.damping), wall.delay_ticks, ours.sd_n, ours.generated_mj, ours.peak_n, ours.out, ours.of, other.sd_n,
                   other.generated_mj, other.peak_n, other.out, other.of, mine.c_str(), theirs.c_str());
  }
  return out;
}

std::string cell_lines(const PressResult& r) {
  std::string out = "\n    k  c          delay hand N/m press N | ours: mean     sd  given out | explicit: mean     sd  given out\n";
  for (const auto& row : r.presses)
    out += printed("  %4.2f %-11s %3d %8.0f %7.1f | %10.3f %6.4f %10.4f | %14.3f %6.4f %10.4f%s\n", row.cell.k_n_per_mm,
                   damping_name(row.cell.damping), row.cell.delay_ticks, 1000 * row.cell.hand_n_per_mm, row.cell.press_n, row.ours.mean_n,
                   row.ours.sd_n, std::max(row.ours.generated_mj, row.ours.late_mj), row.explicit_voigt.mean_n, row.explicit_voigt.sd_n,
                   std::max(row.explicit_voigt.generated_mj, row.explicit_voigt.late_mj), row.ours.steady && row.ours.passive ? "" : "  OUT");
  out += "\n    k  c          delay hand N/m  mm/s | bounces: ours, explicit | peak N: ours, explicit\n";
  for (const auto& row : r.contacts)
    out += printed("  %4.2f %-11s %3d %8.0f %5.0f  | %13d %9d | %12.2f %9.2f\n", row.cell.k_n_per_mm, damping_name(row.cell.damping),
                   row.cell.delay_ticks, 1000 * row.cell.hand_n_per_mm, row.speed_mm_s, row.ours.bounces, row.explicit_voigt.bounces, row.ours.peak_n,
                   row.explicit_voigt.peak_n);
  return out;
}

std::string summary(const PressResult& r) {
  int out = 0, not_passive = 0, by_encoder = 0, explicit_out = 0, bounced = 0, explicit_bounced = 0;
  double worst = 0, explicit_worst = 0;
  for (const auto& row : r.presses) {
    worst = std::max(worst, row.ours.sd_n);
    explicit_worst = std::max(explicit_worst, row.explicit_voigt.sd_n);
    if (!row.ours.steady || !row.ours.passive) ++out;
    if (!row.ours.passive) ++not_passive;
    if (row.exact && row.exact->steady && row.exact->passive) ++by_encoder;
    if (!row.explicit_voigt.steady || !row.explicit_voigt.passive) ++explicit_out;
  }
  for (const auto& row : r.contacts) {
    if (row.ours.bounces > 0) ++bounced;
    if (row.explicit_voigt.bounces > 0) ++explicit_bounced;
  }
  const int presses = static_cast<int>(r.presses.size()), contacts = static_cast<int>(r.contacts.size());
  std::string s = printed("Ours: %d of %d presses miss a limit, largest sd %.4f N (limit %.2f), %d with energy given out, %d of %d contacts bounce. ",
                          out, presses, worst, r.options.limit_sd_n, not_passive, bounced, contacts);
  s += printed("Explicit: %d of %d presses miss a limit, largest sd %.4f N, %d of %d contacts bounce. ", explicit_out, presses, explicit_worst,
               explicit_bounced, contacts);
  if (out > 0)
    s += printed(
        "Of our %d, %d are within the limits with an exact encoder: there the tip still creeps, as c lets go of its force, and each step of the "
        "encoder "
        "(%.3f mm) is a step of the force. ",
        out, by_encoder, r.options.omni.quantum_mm);
  return wrapped(s);
}

json to_json(const PressCell& c) {
  return {{"k_n_per_mm", c.k_n_per_mm},
          {"damping", damping_name(c.damping)},
          {"delay_ticks", c.delay_ticks},
          {"hand_n_per_m", 1000 * c.hand_n_per_mm},
          {"press_n", c.press_n}};
}

json to_json(const PressOutcome& o) {
  return {{"mean_n", o.mean_n},
          {"sd_n", o.sd_n},
          {"peak_n", o.peak_n},
          {"generated_mj", o.generated_mj},
          {"generated_last_half_second_mj", o.late_mj},
          {"encoder_steps", o.encoder_steps},
          {"safety_notices", o.notices},
          {"steady", o.steady},
          {"passive", o.passive}};
}

json to_json(const ContactOutcome& o) { return {{"bounces", o.bounces}, {"peak_n", o.peak_n}}; }

}  // namespace

std::string to_text(const PressResult& r, bool every_cell) {
  const auto& o = r.options;
  std::string out = printed(
      "A hand presses the simulated Omni (%.0f g, friction %.2f N, %.1f N s/m, encoder %.3f mm, peak %.1f N) on a block, handpiece still, 1 kHz.\n",
      1000 * o.omni.mass_kg, o.omni.coulomb_n, 1000 * o.omni.viscous_n_s_per_mm, o.omni.quantum_mm, o.omni.saturation_n);
  out += printed(
      "Hand %.0f g with damping ratio %.2f (assumed); down within 1 s, held for %.1f s. Limits: sd of the last half second %.2f N, energy given out "
      "none "
      "(under %g mJ).\n\n",
      1000 * o.hand_mass_kg, o.hand_damping_ratio, o.hold_s, o.limit_sd_n, o.limit_energy_mj);
  out += wall_lines(r);
  if (every_cell) out += cell_lines(r);
  std::string failing;
  for (const auto& row : r.presses) {
    if (row.ours.steady && row.ours.passive) continue;
    failing += fmt::format("  {}{}", name(row.cell), printed(": sd %.4f N", row.ours.sd_n));
    if (!row.ours.passive) failing += printed(", gives out %.4f mJ", std::max(row.ours.generated_mj, row.ours.late_mj));
    failing += printed("; %d encoder steps; with an exact encoder sd %.4f N\n", row.ours.encoder_steps, row.exact ? row.exact->sd_n : 0.0);
  }
  if (!failing.empty()) out += "\nOurs out of the limits:\n" + failing;
  return fmt::format("{}\n{}", out, summary(r));
}

json to_json(const PressResult& r) {
  const auto& o = r.options;
  json presses = json::array(), contacts = json::array();
  for (const auto& row : r.presses) {
    json j = to_json(row.cell);
    j["ours"] = to_json(row.ours);
    j["explicit"] = to_json(row.explicit_voigt);
    j["ours_with_exact_encoder"] = row.exact ? to_json(*row.exact) : json(nullptr);
    presses.push_back(j);
  }
  for (const auto& row : r.contacts) {
    json j = to_json(row.cell);
    j["speed_mm_s"] = row.speed_mm_s;
    j["ours"] = to_json(row.ours);
    j["explicit"] = to_json(row.explicit_voigt);
    contacts.push_back(j);
  }
  return {{"experiment", "press"},
          {"within_limits", r.within_limits()},
          {"limits", {{"sd_n", o.limit_sd_n}, {"generated_mj", o.limit_energy_mj}, {"bounces", 0}}},
          {"device",
           {{"mass_kg", o.omni.mass_kg},
            {"coulomb_n", o.omni.coulomb_n},
            {"viscous_n_s_per_mm", o.omni.viscous_n_s_per_mm},
            {"quantum_mm", o.omni.quantum_mm},
            {"saturation_n", o.omni.saturation_n}}},
          {"hand", {{"mass_kg", o.hand_mass_kg}, {"damping_ratio", o.hand_damping_ratio}}},
          {"hold_s", o.hold_s},
          {"presses", presses},
          {"contacts", contacts}};
}

}  // namespace cavum
