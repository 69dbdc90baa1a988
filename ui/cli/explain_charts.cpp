#include "ui/cli/explain_charts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "ui/language/say.h"

namespace cavum::ui {
namespace {

using explain::Series;
using explain::View;
using Style = ChartSeries::Style;

/// Of a column; of none: what the cause itself adds.
Message axis_label(const std::string& column) {
  if (column.empty()) return msg("force of the cause, N");
  if (column == "x_mm") return msg("penetration x, mm");
  if (column == "v_mm_s") return msg("speed v, mm/s");
  if (column == "t_s") return msg("time t, s");
  if (column == "spindle_rpm") return msg("spindle, 1000/min");
  if (column == "a_mm_s2") return msg("acceleration a, mm/s²");
  if (column == "simulated_n") return msg("simulated force, N");
  return Name{column};
}

constexpr int k_bins = 24;

/// Means of `y` over equal parts of u (quantiles), with two standard errors.
std::vector<ChartPoint> binned(const Series& u, const Series& y) {
  std::vector<std::pair<double, double>> rows;
  for (Eigen::Index i = 0; i < u.size(); ++i) rows.emplace_back(u[i], y[i]);
  std::sort(rows.begin(), rows.end());
  std::vector<ChartPoint> out;
  std::size_t begin = 0;
  for (int b = 0; b < k_bins && begin < rows.size(); ++b) {
    std::size_t end = std::max(begin + 1, rows.size() * static_cast<std::size_t>(b + 1) / k_bins);
    while (end < rows.size() && rows[end].first == rows[end - 1].first)
      ++end;  // one value is one point
    double x = 0, sum = 0, square = 0;
    for (std::size_t i = begin; i < end; ++i)
      x += rows[i].first, sum += rows[i].second, square += rows[i].second * rows[i].second;
    const double n = static_cast<double>(end - begin), mean = sum / n;
    if (n > 5)
      out.push_back({x / n, mean, 2.0 * std::sqrt(std::max(0.0, square / n - mean * mean) / n)});
    begin = end;
  }
  return out;
}

/// How much of the residual goes with `u`: variance of the means over it.
double strength(const View& before, const Series& u) {
  double sum = 0.0;
  const auto means = binned(u, *before.residual_n);
  for (const auto& p : means) sum += p.y * p.y;
  return means.empty() ? 0.0 : sum / static_cast<double>(means.size());
}

/// Half the height of a common scale: all residual charts are to be compared at a glance.
double residual_scale(const View& before,
                      const std::vector<std::pair<std::string, const Series*>>& suspects) {
  double most = 1e-6;
  for (const auto& s : suspects)
    for (const auto& p : binned(*s.second, *before.residual_n))
      most = std::max(most, std::fabs(p.y) + p.error);
  return 1.15 * most;
}

std::string residual_chart(const View& before, const View& after, const std::string& name,
                           const Series& u, double scale) {
  Chart c;
  c.y_range = {-scale, scale};
  c.width_px = k_narrow_px;
  c.height_px = 300;
  const Series shown = name == "spindle_rpm" ? Series(u / 1000.0) : u;
  const auto first = binned(shown, *before.residual_n), last = binned(shown, *after.residual_n);
  c.series.push_back({tr("before"), k_before, Style::dots, first, 1.8});
  c.series.push_back({tr("after"), k_after, Style::rings, last, 1.8});
  if (!first.empty())
    c.series.push_back(
        {"", "#333333", Style::line, {{first.front().x, 0, 0}, {first.back().x, 0, 0}}, 0.8});
  return figure(c, msg("over {}", axis_label(name)), axis_label(name),
                msg("measured - simulated, N"));
}

constexpr double k_stretch_s = 12.0;

/// Row at which the stretch begins in which the causes change most; where they change nothing, in
/// which the force is largest.
Eigen::Index telling_stretch(const View& before, const View& after) {
  const auto& r = *before.scene->recording;
  const Series change =
      (*after.model_n - *before.model_n).square() + 1e-6 * before.force_n->square();
  double most = -1.0;
  Eigen::Index best = 0;
  for (const auto& s : r.sessions) {
    double sum = 0.0;
    Eigen::Index from = s.begin;
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      sum += change[i];
      while (r.t_s[i] - r.t_s[from] > k_stretch_s) sum -= change[from++];
      if (sum > most) most = sum, best = from;
    }
  }
  return best;
}

/// What a mechanism's picture shows it over, and its name; its own force, of no name, where the
/// recording has no such thing.
std::pair<std::string, Series> seen_over(const explain::Cause& c, const View& after) {
  const char* over = explain::mechanism_at(c.term.mechanism).seen_over;
  const std::string name = over != nullptr ? over : "";
  const auto& motion = after.scene->motion;
  if (name == "x_mm") return {name, motion->x_mm};
  if (name == "v_mm_s") return {name, motion->v_mm_s};
  if (name == "a_mm_s2") return {name, motion->a_mm_s2};
  if (name == "t_s") return {name, after.scene->recording->t_s};
  if (name == "simulated_n") return {name, after.scene->force_n};
  if (const Series* column = name.empty() ? nullptr : after.scene->recording->column(name))
    return {name, *column};
  return {"", c.force_n};
}

}  // namespace

std::string figure(Chart chart, const Message& title, const Message& x_label,
                   const Message& y_label) {
  chart.x_label = tr(x_label);
  chart.y_label = tr(y_label);
  chart.text_px = 16;
  std::string keys;
  for (const auto& s : chart.series)
    if (!s.label.empty())
      keys +=
          fmt::format("<span class=\"key\">{} {}</span> ", legend_sign_svg(s), xml_text(s.label));
  std::string drawn = svg_page(chart.width_px, chart.height_px, chart_group(chart, 0, 0),
                               tr("chart: {}; {} over {}", title, y_label, x_label));
  if (chart.width_px > k_narrow_px)  // scrolls sideways by itself, by keyboard too
    drawn = fmt::format(
        "<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"{}\">{}</div>\n",
        xml_text(tr(title)), drawn);
  return fmt::format("<figure><figcaption><b>{}</b><br>{}</figcaption>{}</figure>\n",
                     xml_text(tr(title)), keys, drawn);
}

std::string force_charts(const View& before, const View& after) {
  const auto& r = *before.scene->recording;
  const Eigen::Index begin = telling_stretch(before, after);
  const auto session = std::find_if(r.sessions.begin(), r.sessions.end(), [&](const auto& s) {
    return begin >= s.begin && begin < s.end;
  });
  Chart c, d;
  c.width_px = d.width_px = k_wide_px;
  c.height_px = 340;
  d.height_px = 240;
  ChartSeries measured{tr("measured"), k_measured, Style::line, {}, 2.6},
      first{tr("simulated, before"), k_before, Style::dashed, {}, 1.6},
      last{tr("simulated, with the causes"), k_after, Style::line, {}, 1.4},
      left{tr("before"), k_before, Style::dashed, {}, 1.2},
      rest{tr("with the causes"), k_after, Style::line, {}, 1.2};
  const double from = r.t_s[begin], to = std::min(from + k_stretch_s, r.t_s[session->end - 1]);
  c.x_range = d.x_range = {from, to};
  Eigen::Index shown = 0;
  for (Eigen::Index i = session->begin; i < session->end; ++i)
    shown += r.t_s[i] >= from && r.t_s[i] <= to;
  const Eigen::Index stride = std::max<Eigen::Index>(1, shown / 1500);
  double highest = 1e-9, lowest = 0.0;
  for (Eigen::Index i = session->begin; i < session->end; i += stride) {
    if (r.t_s[i] < from || r.t_s[i] > to) continue;
    measured.points.push_back({r.t_s[i], (*before.force_n)[i]});
    first.points.push_back({r.t_s[i], (*before.model_n)[i]});
    last.points.push_back({r.t_s[i], (*after.model_n)[i]});
    left.points.push_back({r.t_s[i], (*before.residual_n)[i]});
    rest.points.push_back({r.t_s[i], (*after.residual_n)[i]});
    highest = std::max({highest, (*before.force_n)[i], (*before.model_n)[i], (*after.model_n)[i]});
    lowest = std::min({lowest, (*before.force_n)[i], (*before.model_n)[i], (*after.model_n)[i]});
  }
  if (after.causes.empty()) {
    first.label = tr("simulated");
    last = rest = {};
  }
  c.series = {measured, last, first};
  c.y_range = {lowest - 0.04 * (highest - lowest), highest + 0.04 * (highest - lowest)};
  d.series = {left, rest};
  const Message time = msg("time t, s"), force = msg("force, N");
  return figure(c,
                after.causes.empty()
                    ? msg("session {}: the twelve seconds of the greatest forces", session->name)
                    : msg("session {}: the twelve seconds in which the causes change most",
                          session->name),
                time, force) +
         figure(d, msg("what is left: measured - simulated"), time, force);
}

std::string residual_charts(const View& before, const View& after) {
  const auto& scene = *before.scene;
  std::vector<std::pair<std::string, const Series*>> suspects{{"x_mm", &scene.motion->x_mm},
                                                              {"v_mm_s", &scene.motion->v_mm_s},
                                                              {"t_s", &scene.recording->t_s}};
  for (const auto& [name, u] : scene.recording->columns)
    if (u.maxCoeff() > u.minCoeff()) suspects.emplace_back(name, &u);
  std::stable_sort(suspects.begin(), suspects.end(), [&](const auto& a, const auto& b) {
    return strength(before, *a.second) > strength(before, *b.second);
  });
  const double scale = residual_scale(before, suspects);
  std::string out;
  for (const auto& [name, u] : suspects) out += residual_chart(before, after, name, *u, scale);
  return out;
}

std::string cause_chart(const explain::Cause& c, const View& after) {
  const auto [name, u] = seen_over(c, after);
  Chart chart;
  chart.width_px = k_narrow_px;
  chart.height_px = 300;
  const Series left = *after.residual_n + c.force_n,
               shown = name == "spindle_rpm" ? Series(u / 1000.0) : u;
  const auto data = binned(shown, left), law = binned(shown, c.force_n);
  double low = 0.0, high = 1e-9;
  for (const auto* points : {&data, &law})
    for (const auto& p : *points)
      low = std::min(low, p.y - p.error), high = std::max(high, p.y + p.error);
  chart.y_range = {low - 0.05 * (high - low), high + 0.05 * (high - low)};
  chart.series = {{tr("measured, less all else"), k_before, Style::dots, data, 1.8},
                  {tr("this cause"), k_after, Style::rings, law, 1.8}};
  return figure(chart, msg("what it alone explains, over {}", axis_label(name)), axis_label(name),
                msg("force, N"));
}

}  // namespace cavum::ui
