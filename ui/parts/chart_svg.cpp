#include "ui/parts/chart_svg.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/svg.h"
#include "engine/base/vec.h"
#include "ui/language/say.h"

namespace cavum::ui {
namespace {

constexpr double k_left = 58, k_right = 14, k_top = 34, k_bottom = 46, k_text_px = 11;

/// A round step that divides `span` into about `wanted` parts.
double round_step(double span, int wanted) {
  const double raw = span / wanted, unit = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double f : {1.0, 2.0, 5.0})
    if (f * unit >= raw * 0.999) return f * unit;
  return 10.0 * unit;
}

struct Axis {
  double low = 0, high = 1, step = 0.2, from_px = 0, to_px = 1;
  [[nodiscard]] double px(double v) const {
    return from_px + (v - low) / (high - low) * (to_px - from_px);
  }
  [[nodiscard]] std::string label(double v) const {
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
    return tr("{}", as_number(std::fabs(v) < 1e-9 * step ? 0.0 : v, digits));
  }
};

/// Room around the plot, and how many parts the axes have at most.
struct Frame {
  double left = k_left, right = k_right, top = k_top, bottom = k_bottom;
  double spill = 0;  ///< how far a dot at an end of x is seen beyond it
  int across = 8, up = 7;
};

Axis make_axis(std::optional<std::pair<double, double>> range, double low, double high,
               int wanted) {
  Axis a;
  if (!(high > low)) {
    low -= 0.5;
    high += 0.5;
  }
  if (range) {
    low = range->first;
    high = range->second;
  }
  a.step = round_step(high - low, wanted);
  a.low = range ? low : std::floor(low / a.step + 1e-9) * a.step;
  a.high = range ? high : std::ceil(high / a.step - 1e-9) * a.step;
  return a;
}

/// Leaves room for the numbers beside the axis of y.
Frame frame_of(const Chart& chart, double y_low, double y_high) {
  Frame f;
  if (chart.text_px <= k_text_px) return f;
  const double digit_px = 0.57 * chart.text_px;
  f.top = chart.title.empty() ? 0.6 * chart.text_px : 2.4 * chart.text_px;
  f.bottom = 3.5 * chart.text_px;
  f.right = 1.2 * chart.text_px;
  f.spill = 5.0;
  f.up = std::clamp(static_cast<int>((chart.height_px - f.top - f.bottom) / (2.2 * chart.text_px)),
                    2, 7);
  const Axis y = make_axis(chart.y_range, y_low, y_high, f.up);
  const std::size_t longest = std::max(y.label(y.low).size(), y.label(y.high).size());
  f.left = 2.4 * chart.text_px + digit_px * static_cast<double>(longest);
  f.across = std::clamp(
      static_cast<int>((chart.width_px - f.left - f.right) / (3.6 * chart.text_px)), 2, 8);
  return f;
}

std::string series_dot(const ChartSeries& s, double x, double y) {
  return svg_circle(x, y, 3.4, s.style == ChartSeries::Style::rings ? "white" : s.colour,
                    fmt::format("stroke='{}' stroke-width='1.4'", s.colour));
}

std::string drawn(const ChartSeries& s, const Axis& x, const Axis& y) {
  using Style = ChartSeries::Style;
  std::string out;
  if (s.style == Style::band) {
    std::string path;
    for (const auto& p : s.points)
      path += fmt::format("{},{} ", svg_number(x.px(p.x)), svg_number(y.px(p.y + p.error)));
    for (auto p = s.points.rbegin(); p != s.points.rend(); ++p)
      path += fmt::format("{},{} ", svg_number(x.px(p->x)), svg_number(y.px(p->y - p->error)));
    return fmt::format("<polygon points='{}' fill='{}' fill-opacity='0.22'/>", path, s.colour);
  }
  if (s.style == Style::line || s.style == Style::dashed) {
    std::string path;
    for (const auto& p : s.points)
      path += fmt::format("{},{} ", svg_number(x.px(p.x)), svg_number(y.px(p.y)));
    return fmt::format(
        "<polyline points='{}' fill='none' stroke='{}' stroke-width='{}' stroke-linejoin='round'{}/>",
        path, s.colour, svg_number(s.width_px),
        s.style == Style::dashed ? " stroke-dasharray='5 4'" : "");
  }
  for (const auto& p : s.points) {
    const double px = x.px(p.x), py = y.px(p.y);
    if (p.error > 0) {
      const double high = y.px(p.y + p.error), low = y.px(p.y - p.error);
      out += svg_line(px, high, px, low, s.colour, 1) +
             svg_line(px - 3, high, px + 3, high, s.colour, 1) +
             svg_line(px - 3, low, px + 3, low, s.colour, 1);
    }
    out += series_dot(s, px, py);
  }
  return out;
}

std::string legend_sign(const ChartSeries& s, double x, double y) {
  if (s.style == ChartSeries::Style::band)
    return svg_rect(x, y - 5, 22, 10, s.colour, "fill-opacity='0.22'");
  if (s.style == ChartSeries::Style::line || s.style == ChartSeries::Style::dashed)
    return svg_line(x, y, x + 22, y, s.colour, s.width_px,
                    s.style == ChartSeries::Style::dashed ? "stroke-dasharray='5 4'" : "");
  return series_dot(s, x + 11, y);
}

std::string legend(const Chart& chart) {
  if (chart.text_px > k_text_px) return "";
  std::size_t longest = 0, n = 0;
  for (const auto& s : chart.series)
    if (!s.label.empty()) {
      longest = std::max(longest, s.label.size());
      ++n;
    }
  if (n == 0) return "";
  const double width = 40 + 5.9 * static_cast<double>(longest),
               height = 8 + 16.0 * static_cast<double>(n);
  const double x = chart.legend_at_right ? chart.width_px - k_right - width - 6 : k_left + 8,
               y = k_top + (chart.spans.empty() ? 6 : 22);
  std::string out = svg_rect(x, y, width, height, "white", "fill-opacity='0.85' stroke='#cccccc'");
  double at = y + 12;
  for (const auto& s : chart.series) {
    if (s.label.empty()) continue;
    out += legend_sign(s, x + 6, at) + svg_text(x + 34, at + 4, s.label, 11);
    at += 16;
  }
  return out;
}

}  // namespace

std::string chart_group(const Chart& chart, double x_px, double y_px) {
  Bounds box;
  for (const auto& s : chart.series)
    for (const auto& p : s.points) box.add({p.x, p.y - p.error, 0}, {p.x, p.y + p.error, 0});
  if (box.empty()) box = {{0, 0, 0}, {1, 1, 0}};
  const Frame f = frame_of(chart, box.low.y, box.high.y);
  const double text = chart.text_px, larger = text / k_text_px;
  Axis x = make_axis(chart.x_range, box.low.x, box.high.x, f.across),
       y = make_axis(chart.y_range, box.low.y, box.high.y, f.up);
  x.from_px = f.left;
  x.to_px = chart.width_px - f.right;
  y.from_px = chart.height_px - f.bottom;
  y.to_px = f.top;
  // charts of one page may lie at one place of their own drawings: what differs in size must differ
  // in name
  const std::string clip = fmt::format("plot{}-{}-{}x{}", svg_number(x_px), svg_number(y_px),
                                       svg_number(x.to_px), svg_number(y.from_px));
  std::string out = fmt::format(
      "<g transform='translate({} {})'><clipPath id='{}'><rect x='{}' y='{}' width='{}' height='{}'/></clipPath>",
      svg_number(x_px), svg_number(y_px), clip, svg_number(f.left - f.spill), svg_number(f.top),
      svg_number(x.to_px - f.left + 2 * f.spill), svg_number(y.from_px - f.top));
  out += svg_text(f.left, 20 * larger, chart.title, 13 * larger, "start", "font-weight='bold'");
  std::string names;
  for (const auto& s : chart.spans) {
    const double from = std::max(f.left, x.px(s.from)), to = std::min(x.to_px, x.px(s.to));
    if (to <= from) continue;
    out += svg_rect(from, f.top, to - from, y.from_px - f.top, s.colour);
    names += svg_text(
        (from + to) / 2, f.top + 14, s.label, text, "middle",
        fmt::format("fill='#555555' paint-order='stroke' stroke-width='4' stroke='{}'", s.colour));
  }
  for (double v = std::ceil(x.low / x.step - 1e-9) * x.step; v <= x.high + 1e-9 * x.step;
       v += x.step)
    out += svg_line(x.px(v), f.top, x.px(v), y.from_px, "#e4e4e4", 1) +
           svg_text(x.px(v), y.from_px + 16 * larger, x.label(v), text, "middle");
  for (double v = std::ceil(y.low / y.step - 1e-9) * y.step; v <= y.high + 1e-9 * y.step;
       v += y.step)
    out += svg_line(f.left, y.px(v), x.to_px, y.px(v), "#e4e4e4", 1) +
           svg_text(f.left - 6, y.px(v) + 4 * larger, y.label(v), text, "end");
  out += fmt::format("{}<g clip-path='url(#{})'>", names, clip);
  for (const auto& s : chart.series) out += drawn(s, x, y);
  out += "</g>";
  for (const auto& m : chart.marks) {
    if (m.vertical)
      out += svg_line(x.px(m.at), f.top, x.px(m.at), y.from_px, "#333333", 1,
                      "stroke-dasharray='3 3'") +
             svg_text(x.px(m.at) + 5, y.from_px - 8, m.label, text, "start", "fill='#333333'");
    else
      out += svg_line(f.left, y.px(m.at), x.to_px, y.px(m.at), "#333333", 1,
                      "stroke-dasharray='3 3'") +
             svg_text(x.to_px - 4, y.px(m.at) - 5, m.label, text, "end", "fill='#333333'");
  }
  out += svg_rect(f.left, f.top, x.to_px - f.left, y.from_px - f.top, "none", "stroke='#666666'");
  const double names_px = std::max(12.0, text), middle = (f.top + y.from_px) / 2;
  out += svg_text((f.left + x.to_px) / 2, chart.height_px - 10, chart.x_label, names_px, "middle") +
         svg_text(names_px + 4, middle, chart.y_label, names_px, "middle",
                  fmt::format("transform='rotate(-90 {} {})'", svg_number(names_px + 4),
                              svg_number(middle)));
  return fmt::format("{}{}</g>\n", out, legend(chart));
}

std::string legend_sign_svg(const ChartSeries& series) {
  return fmt::format("<svg width='26' height='14' viewBox='0 0 26 14' aria-hidden='true'>{}</svg>",
                     legend_sign(series, 2, 7));
}

std::string svg_page(double width_px, double height_px, const std::string& content,
                     const std::string& name) {
  const std::string role =
      name.empty() ? "" : fmt::format(" role='img' aria-label='{}'", xml_text(name));
  return svg_root(width_px, height_px, k_svg_white + content,
                  "font-family='Helvetica, Arial, sans-serif' fill='#222222'" + role);
}

std::string charts_page(const std::string& title, const std::vector<Chart>& charts,
                        const std::vector<std::string>& small_print) {
  double x = 8, height = 0;
  std::string body = svg_text(16, 24, title, 15, "start", "font-weight='bold'");
  for (const auto& c : charts) {
    body += chart_group(c, x, 32);
    x += c.width_px + 8;
    height = std::max(height, c.height_px);
  }
  double y = 32 + height + 16;
  for (const auto& words : small_print) {
    body += svg_text(16, y, words, 11, "start", "fill='#555555'") + "\n";
    y += 15;
  }
  return svg_page(x, y, body);
}

}  // namespace cavum::ui
