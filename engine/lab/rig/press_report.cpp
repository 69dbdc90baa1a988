// The closed-loop press in words, tables and JSON.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/lab/rig/press_rig.h"

namespace cavum {
namespace {

using nlohmann::json;

bool same_wall(const PressCell& a, const PressCell& b) {
  return a.k_n_per_mm == b.k_n_per_mm && a.damping == b.damping && a.delay_ticks == b.delay_ticks;
}

Message figure(double v, int digits) { return msg("{}", as_number(v, digits)); }

/// Cells of every table that say what was pressed on: k, c and delay.
std::vector<Message> wall_cells(const PressCell& c) {
  return {figure(c.k_n_per_mm, 2), Name{damping_name(c.damping)}, msg("{}", c.delay_ticks)};
}
std::vector<Message> wall_heads() { return {msg("k, N/mm"), msg("c"), msg("delay, ticks")}; }
std::vector<Message> joined(std::vector<Message> first, const std::vector<Message>& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

double given_out_mj(const PressOutcome& o) { return std::max(o.generated_mj, o.late_mj); }

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

void add_walls(const PressResult& r, Lines& out) {
  const auto& o = r.options;
  std::vector<std::vector<Message>> forces, bounces;
  for (auto row = r.presses.begin(); row != r.presses.end();) {
    const PressCell wall = row->cell;
    Worst ours, other;
    for (; row != r.presses.end() && same_wall(row->cell, wall); ++row) {
      ours.add(row->ours);
      other.add(row->explicit_voigt);
    }
    std::vector<Message>& force = forces.emplace_back(wall_cells(wall));
    for (const Worst* w : {&ours, &other})
      force = joined(force, {figure(w->sd_n, 4), figure(w->generated_mj, 4), figure(w->peak_n, 2),
                             msg("{}/{}", w->out, w->of)});
    std::vector<Message>& bounced = bounces.emplace_back(wall_cells(wall));
    for (const double v : o.contact_mm_s) {
      int a = 0, b = 0;
      for (const auto& c : r.contacts)
        if (same_wall(c.cell, wall) && c.speed_mm_s == v) {
          a = std::max(a, c.ours.bounces);
          b = std::max(b, c.explicit_voigt.bounces);
        }
      bounced.push_back(msg("{}/{}", a, b));
    }
  }
  out.add(msg("The worst of all hands and loads, ours and explicit (k X + c V):"));
  out.row(joined(wall_heads(), {msg("ours: sd, N"), msg("given out, mJ"), msg("peak, N"),
                                msg("miss a limit"), msg("explicit: sd, N"), msg("given out, mJ"),
                                msg("peak, N"), msg("miss a limit")}),
          2);
  for (auto& cells : forces) out.row(std::move(cells), 2);
  if (o.contact_mm_s.empty()) return;
  out.gap();
  out.add(msg("Bounces by the speed of contact, ours/explicit:"));
  std::vector<Message> heads = wall_heads();
  for (const double v : o.contact_mm_s) heads.push_back(msg("{}", as_unit(v, Unit::mm_per_s, 0)));
  out.row(std::move(heads), 2);
  for (auto& cells : bounces) out.row(std::move(cells), 2);
}

void add_cells(const PressResult& r, Lines& out) {
  out.gap();
  out.row(joined(wall_heads(), {msg("hand, N/m"),
                                msg("press, N"),
                                msg("ours: mean, N"),
                                msg("sd, N"),
                                msg("given out, mJ"),
                                msg("explicit: mean, N"),
                                msg("sd, N"),
                                msg("given out, mJ"),
                                {}}),
          2);
  for (const auto& row : r.presses)
    out.row(joined(wall_cells(row.cell),
                   {figure(1000 * row.cell.hand_n_per_mm, 0), figure(row.cell.press_n, 1),
                    figure(row.ours.mean_n, 3), figure(row.ours.sd_n, 4),
                    figure(given_out_mj(row.ours), 4), figure(row.explicit_voigt.mean_n, 3),
                    figure(row.explicit_voigt.sd_n, 4), figure(given_out_mj(row.explicit_voigt), 4),
                    row.ours.steady && row.ours.passive ? Message() : msg("misses a limit")}),
            2);
  out.gap();
  out.row(joined(wall_heads(), {msg("hand, N/m"), msg("mm/s"), msg("bounces: ours"),
                                msg("explicit"), msg("peak, N: ours"), msg("explicit")}),
          2);
  for (const auto& row : r.contacts)
    out.row(joined(wall_cells(row.cell),
                   {figure(1000 * row.cell.hand_n_per_mm, 0), figure(row.speed_mm_s, 0),
                    msg("{}", row.ours.bounces), msg("{}", row.explicit_voigt.bounces),
                    figure(row.ours.peak_n, 2), figure(row.explicit_voigt.peak_n, 2)}),
            2);
}

/// Presses of ours that miss a limit, and what they do with an exact encoder.
void add_failing(const PressResult& r, Lines& out) {
  bool any = false;
  for (const auto& row : r.presses) {
    if (row.ours.steady && row.ours.passive) continue;
    if (!any) {
      out.gap();
      out.add(msg("Ours out of the limits:"));
      out.row(joined(wall_heads(),
                     {msg("hand, N/m"), msg("press, N"), msg("sd, N"), msg("given out, mJ"),
                      msg("encoder steps"), msg("sd with an exact encoder, N")}),
              2);
      any = true;
    }
    out.row(joined(wall_cells(row.cell),
                   {figure(1000 * row.cell.hand_n_per_mm, 0), figure(row.cell.press_n, 1),
                    figure(row.ours.sd_n, 4), figure(given_out_mj(row.ours), 4),
                    msg("{}", row.ours.encoder_steps),
                    row.exact ? figure(row.exact->sd_n, 4) : Message()}),
            2);
  }
}

void add_summary(const PressResult& r, Lines& lines) {
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
  const std::size_t presses = r.presses.size(), contacts = r.contacts.size();
  lines.add(msg(
      "Ours: presses that miss a limit: {} of {}; largest sd {} (limit {}); presses with energy given out: {}; contacts that bounce: {} of "
      "{}.",
      out, presses, as_n(worst, 4), as_n(r.options.limit_sd_n, 2), not_passive, bounced, contacts));
  lines.add(msg(
      "Explicit: presses that miss a limit: {} of {}; largest sd {}; contacts that bounce: {} of {}.",
      explicit_out, presses, as_n(explicit_worst, 4), explicit_bounced, contacts));
  if (out > 0)
    lines.add(msg(
        "Of ours that miss a limit, {} of {} are within the limits with an exact encoder: there the tip still creeps, as c lets go of its "
        "force, and each step of the encoder ({}) is a step of the force.",
        by_encoder, out, as_mm(r.options.omni.quantum_mm, 3)));
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

Lines to_text(const PressResult& r, bool every_cell) {
  const auto& o = r.options;
  Lines out;
  out.add(msg(
      "A hand presses the simulated Omni ({} g, friction {}, {} N s/m, encoder {}, peak {}) on a block, handpiece still, 1 kHz.",
      as_number(1000 * o.omni.mass_kg, 0), as_n(o.omni.coulomb_n, 2),
      as_number(1000 * o.omni.viscous_n_s_per_mm, 1), as_mm(o.omni.quantum_mm, 3),
      as_n(o.omni.saturation_n, 1)));
  out.add(msg(
      "The hand has {} g and a damping ratio of {} (assumed); it is down within 1 s and held for {}.",
      as_number(1000 * o.hand_mass_kg, 0), as_number(o.hand_damping_ratio, 2), as_s(o.hold_s, 1)));
  out.add(msg("Limits: sd of the last half second {}, energy given out none (under {} mJ).",
              as_n(o.limit_sd_n, 2), as_number(o.limit_energy_mj)));
  out.gap();
  add_walls(r, out);
  if (every_cell) add_cells(r, out);
  add_failing(r, out);
  out.gap();
  add_summary(r, out);
  return out;
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
