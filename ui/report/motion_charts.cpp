#include "ui/report/motion_charts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "ui/language/say.h"
#include "ui/parts/chart_svg.h"
#include "ui/report/figures/motion_track.h"

namespace cavum::report {
namespace {

constexpr double k_width_px = 900, k_height_px = 210;
constexpr std::size_t k_max_line_points = 700;  // points of a line
constexpr double k_one_line_share = 0.016;      // of the time: events nearer than that share a line

std::vector<ui::ChartMark> event_marks(const std::vector<ReportEvent>& events, double duration_s) {
  std::vector<ui::ChartMark> marks;
  std::size_t first = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const bool joins =
        !marks.empty() && events[i].t_s - marks.back().at < k_one_line_share * duration_s;
    if (!joins) {
      first = i;
      marks.push_back({events[i].t_s, true, ""});
    }
    marks.back().label =
        std::to_string(first + 1) + (i > first ? fmt::format("\u2013{}", i + 1) : "");
  }
  return marks;
}

Picture chart(const std::string& title, const std::string& unit, const std::string& colour,
              std::vector<ui::ChartPoint> points, double duration_s,
              const std::vector<ui::ChartMark>& marks) {
  ui::Chart c;
  c.title = title;
  c.x_label = tr("time, s");
  c.y_label = unit;
  c.width_px = k_width_px;
  c.height_px = k_height_px;
  constexpr double k_room = 1.045;  // for the number of the last event
  c.x_range = {0.0, k_room * std::max(duration_s, 1e-3)};
  double most = 0;
  for (const auto& p : points) most = std::max(most, p.y);
  c.y_range = {0.0, most > 0 ? 1.15 * most : 1.0};
  c.series.push_back({"", colour, ui::ChartSeries::Style::line, std::move(points), 1.2});
  c.marks = marks;
  return {ui::svg_page(k_width_px, k_height_px, ui::chart_group(c, 0, 0)), ""};
}

}  // namespace

std::vector<Picture> motion_charts(const ReportSource& s) {
  const MotionTrack m = make_motion_track(s.input);
  const std::size_t n = m.size(),
                    bin = std::max<std::size_t>(1, (n + k_max_line_points - 1) / k_bins);
  std::vector<ui::ChartPoint> force, depth, speed;
  for (std::size_t i = 0; i < n; i += bin) {
    const std::size_t end = std::min(n, i + bin);
    const double t = static_cast<double>(i) * m.step_s;
    const auto largest = [&](const auto& values) {
      return static_cast<double>(
          *std::max_element(values.begin() + static_cast<std::ptrdiff_t>(i),
                            values.begin() + static_cast<std::ptrdiff_t>(end)));
    };
    force.push_back({t, largest(m.force_cn) * 0.01});
    depth.push_back({t, std::max(0.0, largest(m.depth_um) * 1e-3)});
    speed.push_back({t, largest(m.rpm10) * 0.01});
  }
  const double duration_s = static_cast<double>(s.input.records.size()) * k_tick_s;
  const auto marks = event_marks(s.events, duration_s);
  return {
      chart(tr("Force on the hand"), tr("force, N"), "#d55e00", std::move(force), duration_s,
            marks),
      chart(tr("Depth of the tip below the opening"), tr("depth, mm"), "#0072b2", std::move(depth),
            duration_s, marks),
      chart(tr("Handpiece speed"), tr("1000 rpm"), "#4d4d4d", std::move(speed), duration_s, marks)};
}

Picture attempts_chart(const std::vector<ReportAttempt>& attempts, double pass_percent) {
  ui::Chart c;
  c.x_label = tr("attempt");
  c.y_label = tr("points, %");
  c.width_px = 420;
  c.height_px = 200;
  ui::ChartSeries line{"", "#0072b2", ui::ChartSeries::Style::line, {}, 1.4},
      dots{"", "#0072b2", ui::ChartSeries::Style::dots, {}, 1.4};
  ui::ChartSeries doubtful{tr("in doubt"), "#4d4d4d", ui::ChartSeries::Style::rings, {}, 1.4};
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const ui::ChartPoint p{static_cast<double>(i + 1),
                           attempts[i].max > 0 ? 100 * attempts[i].points / attempts[i].max : 0};
    if (!attempts[i].doubt.empty()) {
      doubtful.points.push_back(p);
      continue;
    }
    line.points.push_back(p);
    dots.points.push_back(p);
  }
  c.series = {line, dots};
  if (!doubtful.points.empty()) c.series.push_back(doubtful);
  c.x_range = {0.5, static_cast<double>(attempts.size()) + 0.5};
  c.y_range = {0, 105};
  c.marks = {{pass_percent, false, tr("pass mark")}};
  return {ui::svg_page(c.width_px, c.height_px, ui::chart_group(c, 0, 0)), ""};
}

}  // namespace cavum::report
