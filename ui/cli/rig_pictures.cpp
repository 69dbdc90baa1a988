#include "ui/cli/rig_pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "engine/base/svg.h"
#include "engine/tooth/tissues.h"
#include "ui/language/say.h"
#include "ui/parts/chart_svg.h"

namespace cavum::ui {
namespace {

using Style = ChartSeries::Style;

constexpr std::array k_colours{"#c0392b", "#1f6fb2", "#2e8b57", "#8e44ad"};
const std::string k_paper_colour = "#222222";

/// y = value at 0 … largest k, in steps fine enough for a root.
std::vector<ChartPoint> curve(double largest_k, const std::function<double(double)>& force) {
  std::vector<ChartPoint> points;
  for (int i = 0; i <= 60; ++i) {
    const double k = largest_k * i / 60.0;
    points.push_back({k, force(k), 0});
  }
  return points;
}

/// Green within the limit, from yellow to red with each factor of ten above it.
std::string heat_colour(double value, double limit) {
  if (value <= limit) return value <= 0.25 * limit ? "#bfe3c5" : "#dcefd5";
  const double hot = std::clamp(std::log10(value / limit) / 2.0, 0.0, 1.0);
  const auto channel = [&](double from, double to) {
    return static_cast<int>(from + (to - from) * hot);
  };
  return fmt::format("rgb({},{},{})", channel(255, 200), channel(226, 50), channel(130, 45));
}

std::string field(double x, double y, double w, double h, const std::string& colour,
                  const std::string& words, bool bold) {
  return svg_rect(x, y, w - 1, h - 1, colour) + svg_text(x + w / 2, y + h / 2 + 3.5, words, 10,
                                                         "middle",
                                                         bold ? "font-weight='bold'" : "");
}

/// The straight line of a fit, over all stiffnesses.
std::vector<ChartPoint> fitted_line(const Fit& line, double largest_k) {
  return curve(largest_k, [&](double k) { return line.value[0] * k + line.value[1]; });
}

/// What a fit with a root of k says beside the straight one, mN.
std::vector<ChartPoint> root_beside_line(const Fit& root, const Fit& line, double largest_k) {
  return curve(largest_k, [&](double k) {
    return 1000 * ((root.value[0] - line.value[0]) * k + root.value[1] - line.value[1] +
                   root.value[2] * std::sqrt(k));
  });
}

/// The forces of one model, and what its straight line leaves over.
void add_cube_set(const CubeSet& set, const std::string& colour, double largest_k, Chart& force,
                  Chart& rest) {
  ChartSeries with{tr("{}, with friction", as_is(set.name)), colour, Style::dots, {}, 1.8},
      without{tr("{}, without friction", as_is(set.name)), colour, Style::rings, {}, 1.8},
      left{tr("{}", as_is(set.name)), colour, Style::dots, {}, 1.8};
  const Fit& line = set.with.line;
  for (const auto& row : set.rows) {
    with.points.push_back({row.k_n_per_mm, row.with.mean, row.with.sd});
    without.points.push_back({row.k_n_per_mm, row.without.mean, row.without.sd});
    if (line.solved)
      left.points.push_back(
          {row.k_n_per_mm, 1000 * (row.with.mean - line.value[0] * row.k_n_per_mm - line.value[1]),
           1000 * row.with.sd});
  }
  if (line.solved) {
    force.series.push_back({tr("{}: F = {} k {}", as_is(set.name), as_number(line.value[0], 3),
                               Number{line.value[1], Unit::none, 3, 0, true}),
                            colour, Style::line, fitted_line(line, largest_k), 1.4});
    force.series.push_back(
        {"", colour, Style::line, fitted_line(set.without.line, largest_k), 0.7});
  }
  if (set.with.with_root.solved && line.solved)
    rest.series.push_back({tr("{}, fit with a root of k", as_is(set.name)), colour, Style::dashed,
                           root_beside_line(set.with.with_root, line, largest_k), 1.4});
  force.series.push_back(with);
  force.series.push_back(without);
  rest.series.push_back(left);
}

/// Room for the legend over all that is drawn.
void scale_cube_charts(Chart& force, Chart& rest, double largest_k) {
  double top = 0;
  for (const auto& s : force.series)
    for (const auto& p : s.points) top = std::max(top, p.y);
  force.y_range = {{-0.05, 1.55 * top}};
  double low = -1, high = 1;
  for (const auto& s : rest.series)
    for (const auto& p : s.points) {
      low = std::min(low, p.y - p.error);
      high = std::max(high, p.y + p.error);
    }
  rest.y_range = {{1.1 * low, high + 0.4 * (high - low)}};
  force.x_range = rest.x_range = {{-0.03 * largest_k, 1.03 * largest_k}};
}

}  // namespace

std::string cube_svg(const CubeResult& r) {
  Chart force;
  force.title = tr("Steady cutting force");
  force.x_label = tr("spring coefficient k, N/mm");
  force.y_label = tr("force, N");
  Chart rest;
  rest.title = tr("What a straight line leaves over (with friction)");
  rest.x_label = force.x_label;
  rest.y_label = tr("mean force - fitted line, mN");
  rest.width_px = 420;
  double largest = 0.1;
  for (const double k : r.options.k_n_per_mm) largest = std::max(largest, k);
  force.series.push_back({tr("paper, eq. 6: F = {} k + {}", as_number(k_paper_slope_mm, 3),
                             as_number(k_paper_intercept_n, 3)),
                          k_paper_colour, Style::line, curve(largest, paper_force_n), 2.4});
  for (std::size_t i = 0; i < r.sets.size(); ++i)
    add_cube_set(r.sets[i], k_colours[i % k_colours.size()], largest, force, rest);
  scale_cube_charts(force, rest, largest);
  const auto& m = r.options.machine;
  return charts_page(
      trn("Virtual cubes on the testing machine, {}, {} run each",
          "Virtual cubes on the testing machine, {}, {} runs each", r.options.runs,
          as_unit(m.speed_mm_s, Unit::mm_per_s), r.options.runs),
      {force, rest},
      {tr("Bars: sd over the runs. Joint friction of the simulated Omni {}; load cell noise {} and zero error {} a run (assumed). "
          "Mean of the last 2 s of a steady cut.",
          as_n(m.omni.coulomb_n, k_as_needed), as_n(m.noise_n, k_as_needed),
          as_n(m.zero_n, k_as_needed))});
}

std::string tooth_svg(const ToothRigResult& r) {
  Chart whole;
  whole.title = tr("From the first contact");
  whole.x_label = tr("time since contact, s");
  whole.y_label = tr("force on the load cell, N");
  whole.width_px = 560;
  Chart fall;
  fall.title = tr("Around the pulp's roof");
  fall.x_label = tr("time since the pulp was reached, s");
  fall.y_label = whole.y_label;
  fall.width_px = 440;
  double top = 0.1, last_s = 0;
  const auto add = [&](Chart& chart, const std::vector<BandPoint>& band) {
    ChartSeries shade{trn("mean ± sd of {} run", "mean ± sd of {} runs", r.counted, r.counted),
                      k_colours[1],
                      Style::band,
                      {},
                      1},
        mean{tr("mean"), k_colours[1], Style::line, {}, 2.2};
    for (const auto& p : band) {
      shade.points.push_back({p.t_s, p.force_n.mean, p.force_n.sd});
      mean.points.push_back({p.t_s, p.force_n.mean, 0});
      top = std::max(top, p.force_n.mean + p.force_n.sd);
    }
    chart.series.push_back(shade);
    chart.series.push_back(mean);
  };
  const auto first = std::find_if(r.runs.begin(), r.runs.end(), [](const ToothRun& run) {
    return run.reached_pulp && !run.held;
  });
  if (first != r.runs.end()) {
    ChartSeries one{tr("a single run"), "#9a9a9a", Style::line, {}, 0.7};
    for (const auto& s : first->samples) {
      one.points.push_back({s.t_s, s.f_n, 0});
      top = std::max(top, s.f_n);
    }
    whole.series.push_back(one);
  }
  add(whole, r.from_contact);
  add(fall, r.around_pulp);
  if (!r.from_contact.empty()) last_s = r.from_contact.back().t_s;
  for (std::size_t i = 0; i < r.layers.size(); ++i) {
    const double to = i + 1 < r.layers.size() ? r.layers[i + 1].from_s.mean : last_s;
    whole.spans.push_back({r.layers[i].from_s.mean, to, tr("{}", Term{r.layers[i].tissue}),
                           known_tissue(r.layers[i].tissue).behind});
  }
  whole.x_range = {{0.0, std::max(1.0, last_s)}};
  if (r.counted > 0) {
    whole.marks.push_back({r.pulp_s.mean, true, ""});
    fall.marks.push_back({0.0, true, ""});
    fall.spans.push_back(
        {-1e9, 0, r.layers.size() > 1 ? tr("{}", Term{r.layers[r.layers.size() - 2].tissue}) : "",
         known_tissue("dentin").behind});
    fall.spans.push_back({0, 1e9, tr("pulp"), known_tissue("pulp").behind});
    fall.marks.push_back({r.before_n.mean, false, tr("before {}", as_n(r.before_n.mean))});
    fall.marks.push_back({r.after_n.mean, false, tr("after {}", as_n(r.after_n.mean))});
  }
  whole.y_range = fall.y_range = {{0.0, 1.3 * top}};
  std::vector<std::string> words{tr(
      "Joint friction {} included. Shaded spans: mean times at which a tissue lies before the tip.",
      as_n(r.options.machine.omni.coulomb_n, k_as_needed))};
  if (r.counted > 0)
    words.push_back(
        tr("Pulp reached {} after contact (dashed); fall from {} to {}, 90 to 10 % within {}.",
           as_s(r.pulp_s.mean, 1, r.pulp_s.sd), as_n(r.before_n.mean, 3), as_n(r.after_n.mean, 3),
           as_s(r.fall_s.mean)));
  return charts_page(tr("{}, force model '{}', {}, crosshead {}", as_is(r.tooth), as_is(r.model),
                        Term{r.bur}, as_unit(r.options.machine.speed_mm_s, Unit::mm_per_s, 2)),
                     {whole, fall}, words);
}

namespace {

/// Where the cells of the press's picture stand, px: for both renderings a block of presses by hand
/// and load, then one of bounces by speed.
struct PressTable {
  static constexpr double k_label_w = 186, k_w = 42, k_h = 19, k_gap = 18, k_top = 104,
                          k_bounce_w = 32;
  std::array<double, 2> press_x, bounce_x;  // ours, explicit
  double width;

  explicit PressTable(const PressOptions& o) {
    const auto columns = static_cast<double>(o.hand_n_per_mm.size() * o.press_n.size()),
               speeds = static_cast<double>(o.contact_mm_s.size());
    press_x = {k_label_w, k_label_w + columns * k_w + k_gap};
    bounce_x = {press_x[1] + columns * k_w + k_gap,
                press_x[1] + columns * k_w + 2 * k_gap + speeds * k_bounce_w};
    width = bounce_x[1] + speeds * k_bounce_w + 16;
  }
};

std::string press_heading(const PressTable& table, const PressOptions& o) {
  std::string body = svg_text(
      16, 24,
      tr("Closed-loop press on the simulated Omni: sd of the force in the last half second, N"), 15,
      "start", "font-weight='bold'");
  const std::array titles{tr("ours"), tr("explicit k X + c V")};
  for (std::size_t b = 0; b < 2; ++b) {
    body += svg_text(table.press_x[b], 52, titles[b], 13, "start", "font-weight='bold'");
    for (std::size_t h = 0; h < o.hand_n_per_mm.size(); ++h) {
      const double x =
          table.press_x[b] + static_cast<double>(h * o.press_n.size()) * PressTable::k_w;
      body += svg_text(x + static_cast<double>(o.press_n.size()) * PressTable::k_w / 2, 74,
                       tr("hand {} N/m", as_number(1000 * o.hand_n_per_mm[h])), 11, "middle");
      for (std::size_t p = 0; p < o.press_n.size(); ++p)
        body += svg_text(x + (static_cast<double>(p) + 0.5) * PressTable::k_w, 92,
                         tr("{}", as_n(o.press_n[p], k_as_needed)), 10, "middle", "fill='#555555'");
    }
    if (o.contact_mm_s.empty()) continue;
    body += svg_text(table.bounce_x[b], 52, tr("bounces"), 13, "start", "font-weight='bold'") +
            svg_text(table.bounce_x[b], 68, b == 0 ? tr("ours, at mm/s") : tr("explicit, at mm/s"),
                     11, "start");
    for (std::size_t v = 0; v < o.contact_mm_s.size(); ++v)
      body += svg_text(table.bounce_x[b] + (static_cast<double>(v) + 0.5) * PressTable::k_bounce_w,
                       92, tr("{}", as_number(o.contact_mm_s[v])), 10, "middle", "fill='#555555'");
  }
  return body;
}

/// Of the same stiffness, damping and delay: one row of the table.
bool same_row(const PressCell& a, const PressCell& b) {
  return a.k_n_per_mm == b.k_n_per_mm && a.damping == b.damping && a.delay_ticks == b.delay_ticks;
}

std::string press_cells(const PressTable& table, const PressResult& r, const PressCell& of_row,
                        double y) {
  std::string body;
  std::size_t column = 0;
  for (const auto& row : r.presses) {
    if (!same_row(row.cell, of_row)) continue;
    for (std::size_t b = 0; b < 2; ++b) {
      const PressOutcome& out = b == 0 ? row.ours : row.explicit_voigt;
      const double x = table.press_x[b] + static_cast<double>(column) * PressTable::k_w;
      body +=
          field(x, y, PressTable::k_w, PressTable::k_h, heat_colour(out.sd_n, r.options.limit_sd_n),
                tr("{}", as_number(out.sd_n, 3)) + (out.passive ? "" : "*"), !out.steady);
    }
    ++column;
  }
  return body;
}

/// The most bounces of all hands at each speed.
std::string bounce_cells(const PressTable& table, const PressResult& r, const PressCell& of_row,
                         double y) {
  std::string body;
  for (std::size_t v = 0; v < r.options.contact_mm_s.size(); ++v) {
    std::array<int, 2> worst{};
    for (const auto& c : r.contacts)
      if (same_row(c.cell, of_row) && c.speed_mm_s == r.options.contact_mm_s[v]) {
        worst[0] = std::max(worst[0], c.ours.bounces);
        worst[1] = std::max(worst[1], c.explicit_voigt.bounces);
      }
    for (std::size_t b = 0; b < 2; ++b)
      body += field(table.bounce_x[b] + static_cast<double>(v) * PressTable::k_bounce_w, y,
                    PressTable::k_bounce_w, PressTable::k_h,
                    worst[b] == 0 ? "#bfe3c5" : heat_colour(worst[b], 0.5),
                    std::to_string(worst[b]), worst[b] > 0);
  }
  return body;
}

/// The colours at `y`, and below them what was held constant.
std::string press_legend(const PressOptions& o, double y) {
  const std::array<std::pair<double, std::string>, 5> scale{
      {{0.1, tr("under a quarter of the limit")},
       {0.9, tr("within the limit")},
       {1.5, tr("over the limit")},
       {10, tr("ten times the limit")},
       {100, tr("a hundred times the limit")}}};
  std::string body;
  double x = 16;
  for (const auto& [times, words] : scale) {
    body += svg_rect(x, y - 10, 16, 12, heat_colour(times, 1.0)) + svg_text(x + 21, y, words, 11);
    x += 40 + 6.2 * static_cast<double>(words.size());
  }
  body += svg_text(
      16, y + 18,
      tr("Limit {}; * = the wall gave out energy (passivity observer, limit {} mJ). Hand {} g, damping ratio {} (assumed). Bounces: most of all "
         "hands at {}.",
         as_n(o.limit_sd_n, k_as_needed), as_number(o.limit_energy_mj),
         as_number(1000 * o.hand_mass_kg), as_number(o.hand_damping_ratio),
         as_n(o.contact_press_n, k_as_needed)),
      11, "start", "fill='#555555'");
  return body;
}

}  // namespace

std::string press_svg(const PressResult& r) {
  const auto& o = r.options;
  const PressTable table(o);
  std::string body = press_heading(table, o);
  double y = PressTable::k_top;
  double last_k = -1;
  for (const double k : o.k_n_per_mm)
    for (const DampingRule damping : o.damping)
      for (const int delay : o.delay_ticks) {
        if (last_k >= 0 && k != last_k) y += 6;
        last_k = k;
        const PressCell row{.k_n_per_mm = k, .damping = damping, .delay_ticks = delay};
        body += svg_text(
            16, y + 13,
            tr("k {},  c {},  delay {}", as_number(k), as_is(damping_name(damping)), delay), 11);
        body +=
            fmt::format("{}{}\n", press_cells(table, r, row, y), bounce_cells(table, r, row, y));
        y += PressTable::k_h;
      }
  y += 22;
  body += press_legend(o, y);
  return svg_page(std::max(table.width, 700.0), y + 32, body);
}

}  // namespace cavum::ui
