// Plain charts as SVG: axes with units and round ticks, lines, dots with error bars, bands, shaded
// spans, marks and a legend. Several charts make a page.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cavum::ui {

struct ChartPoint {
  double x = 0, y = 0;
  double error = 0;  ///< half height of an error bar, or of the band
};

struct ChartSeries {
  std::string label;  ///< in the legend; empty = not there
  std::string colour = "#444444";
  enum class Style { line, dashed, dots, rings, band } style = Style::line;
  std::vector<ChartPoint> points;
  double width_px = 1.8;
};

/// A span of x with a name at its top.
struct ChartSpan {
  double from = 0, to = 0;
  std::string label, colour;
};

/// A vertical or horizontal line with words beside it.
struct ChartMark {
  double at = 0;
  bool vertical = true;
  std::string label;
};

struct Chart {
  std::string title, x_label, y_label;  ///< labels with units
  std::vector<ChartSeries> series;
  std::vector<ChartSpan> spans;
  std::vector<ChartMark> marks;
  std::optional<std::pair<double, double>> x_range, y_range;  ///< else what the series need
  bool legend_at_right = false;  ///< inside, upper right; else upper left
  double width_px = 520, height_px = 400;
  double text_px = 11;  ///< of the numbers; larger ones have margins of their own, fewer ticks, and
                        ///< the legend beside the chart
};

/// A group of `chart.width_px` × `chart.height_px` with its corner at x, y.
[[nodiscard]] std::string chart_group(const Chart& chart, double x_px, double y_px);
/// A drawing of 26 × 14 with the sign of a series alone, for a legend beside a chart.
[[nodiscard]] std::string legend_sign_svg(const ChartSeries& series);
/// A whole file around groups. `name`: what is read aloud in its place, in a page.
[[nodiscard]] std::string svg_page(double width_px, double height_px, const std::string& content,
                                   const std::string& name = "");
/// Charts in a row under a title, with lines of small print below.
[[nodiscard]] std::string charts_page(const std::string& title, const std::vector<Chart>& charts,
                                      const std::vector<std::string>& small_print);

}  // namespace cavum::ui
