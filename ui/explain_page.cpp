#include "ui/explain_page.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/rig/print.h"
#include "ui/chart_svg.h"

namespace cavum {
namespace {

using explain::Series;
using explain::View;

constexpr int k_bins = 24;

/// Means of `y` over equal parts of u (quantiles), with their standard error.
std::vector<ChartPoint> binned(const Series& u, const Series& y, const Series& where) {
  std::vector<std::pair<double, double>> rows;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (where[i] > 0.5) rows.emplace_back(u[i], y[i]);
  std::sort(rows.begin(), rows.end());
  std::vector<ChartPoint> out;
  for (int b = 0; b < k_bins; ++b) {
    const std::size_t begin = rows.size() * b / k_bins, end = rows.size() * (b + 1) / k_bins;
    if (end <= begin + 5) continue;
    double x = 0, sum = 0, square = 0;
    for (std::size_t i = begin; i < end; ++i) x += rows[i].first, sum += rows[i].second, square += rows[i].second * rows[i].second;
    const double n = static_cast<double>(end - begin), mean = sum / n;
    out.push_back({x / n, mean, 2.0 * std::sqrt(std::max(0.0, square / n - mean * mean) / n)});
  }
  return out;
}

std::string svg(const Chart& chart) { return svg_page(chart.width_px, chart.height_px, chart_group(chart, 0, 0)); }

std::string residual_chart(const View& before, const View& after, const Series& u, const std::string& name) {
  const Series everywhere = Series::Ones(u.size());
  Chart c;
  c.title = "residual over " + name;
  c.x_label = name;
  c.y_label = "measured - simulated, N";
  c.series.push_back({"before", "#b03a2e", ChartSeries::Style::dots, binned(u, before.residual_n, everywhere), 1.8});
  c.series.push_back({"after", "#1f618d", ChartSeries::Style::rings, binned(u, after.residual_n, everywhere), 1.8});
  return svg(c);
}

/// The stretch of 12 s in which the force is largest.
std::string force_chart(const View& before, const View& after) {
  const auto& r = *before.scene.recording;
  Eigen::Index top = 0;
  before.force_n.maxCoeff(&top);
  const auto session = std::find_if(r.sessions.begin(), r.sessions.end(), [&](const auto& s) { return top >= s.begin && top < s.end; });
  Chart c;
  c.title = "measured and simulated, session " + session->name;
  c.x_label = "t, s";
  c.y_label = "force, N";
  c.width_px = 1050;
  ChartSeries measured{"measured", "#999999", ChartSeries::Style::line, {}, 1.0},
      first{"simulated before", "#b03a2e", ChartSeries::Style::line, {}, 1.4}, last{"simulated after", "#1f618d", ChartSeries::Style::line, {}, 1.4};
  const double from = std::max(r.t_s[session->begin], r.t_s[top] - 6.0), to = from + 12.0;
  Eigen::Index shown = 0;
  for (Eigen::Index i = session->begin; i < session->end; ++i) shown += r.t_s[i] >= from && r.t_s[i] <= to;
  const Eigen::Index stride = std::max<Eigen::Index>(1, shown / 1500);
  for (Eigen::Index i = session->begin; i < session->end; i += stride) {
    if (r.t_s[i] < from || r.t_s[i] > to) continue;
    measured.points.push_back({r.t_s[i], before.force_n[i]});
    first.points.push_back({r.t_s[i], before.model_n[i]});
    last.points.push_back({r.t_s[i], after.model_n[i]});
  }
  c.series = {measured, first, last};
  return svg(c);
}

}  // namespace

std::string explanation_html(const explain::Explanation& e, const std::string& title) {
  std::string out = "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + xml_text(title) +
                    "</title><style>body{font:16px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 "
                    "1em}pre{white-space:pre-wrap;background:#f5f5f5;padding:1em}"
                    "td,th{text-align:left;padding:.2em 1em .2em 0;border-bottom:1px solid "
                    "#ccc}table{border-collapse:collapse}svg{max-width:100%;height:auto}</style></head><body>\n<h1>" +
                    xml_text(title) + "</h1>\n<h2>What the simulation gets wrong</h2>\n<pre>" + xml_text(to_text(e)) + "</pre>\n";
  // xml_text keeps line ends as references, which a browser shows as line ends inside <pre>
  if (e.before && e.after) {
    const auto& scene = e.before->scene;
    out += "<h2>Measured against simulated</h2>\n" + force_chart(*e.before, *e.after);
    out += "\n<h2>The residual against each suspect</h2>\n<p>Means over equal shares of the rows, with two standard errors.</p>\n";
    out += residual_chart(*e.before, *e.after, scene.motion.x_mm, "x, mm") + residual_chart(*e.before, *e.after, scene.motion.v_mm_s, "v, mm/s") +
           residual_chart(*e.before, *e.after, scene.recording->t_s, "t, s");
    for (const auto& [name, u] : scene.recording->columns)
      if (u.maxCoeff() > u.minCoeff()) out += residual_chart(*e.before, *e.after, u, name);
    out += "\n<h2>What each mechanism would gain alone</h2>\n<table><tr><th>mechanism</th><th>fall of chi²</th><th></th></tr>\n";
    auto candidates = e.candidates;
    std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
    for (const auto& c : candidates) {
      const auto& m = explain::mechanisms()[static_cast<std::size_t>(c.hypothesis.term.mechanism)];
      out += printed("<tr><td>%s</td><td>%s</td><td>%s</td></tr>\n", m.name,
                     c.testable ? printed("%.0f", std::max(0.0, c.gain)).c_str() : "not testable here", m.words);
    }
    out += "</table>\n";
  }
  return out + "</body></html>\n";
}

}  // namespace cavum
