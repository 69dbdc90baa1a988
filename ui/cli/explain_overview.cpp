#include "ui/cli/explain_overview.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/lab/explain/report/overview_report.h"
#include "ui/cli/explain_charts.h"
#include "ui/cli/explain_page.h"
#include "ui/language/say.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {
namespace {

using explain::Recording;
using explain::Series;

constexpr Eigen::Index k_max_points =
    4000;  // of a chart: more cannot be told apart, and make the page slow

/// "x=um" → {x, um}.
std::pair<std::string, std::string> name_and_value(const std::string& option,
                                                   const std::string& given,
                                                   const std::string& example) {
  const std::size_t at = given.find('=');
  if (at == std::string::npos || at == 0 || at + 1 == given.size())
    throw Error(Name{fmt::format("{} {}", option, given)},
                msg("is not of the form NAME={}", example),
                msg("write for example {}", option == "--unit" ? "--unit f=gf" : "--column f=Fz"));
  return {given.substr(0, at), given.substr(at + 1)};
}

std::vector<ChartPoint> thinned(const Series& x, const Series& y) {
  std::vector<ChartPoint> out;
  const Eigen::Index stride = std::max<Eigen::Index>(1, x.size() / k_max_points);
  for (Eigen::Index i = 0; i < x.size(); i += stride) out.push_back({x[i], y[i]});
  return out;
}

std::string chart_over(const Message& title, const Message& x_label, const Message& y_label,
                       std::vector<ChartPoint> points, ChartSeries::Style style,
                       const std::optional<ChartMark>& mark) {
  Chart c;
  c.width_px = 700;
  c.series.push_back({"", "#0072b2", style, std::move(points), 1.0});
  if (mark) c.marks.push_back(*mark);
  return figure(c, title, x_label, y_label);
}

/// Time of a recording whose sessions each begin anew, one behind the other.
Series running_time_s(const Recording& r) {
  Series out = r.t_s;
  double end = r.t_s[0];
  for (const auto& s : r.sessions) {
    const double shift = r.t_s[s.begin] < end ? end - r.t_s[s.begin] : 0.0;
    for (Eigen::Index i = s.begin; i < s.end; ++i) out[i] += shift;
    end = out[s.end - 1];
  }
  return out;
}

}  // namespace

bool ReadingArgs::empty() const {
  return columns.empty() && units.empty() && negate.empty() && !as_it_is && surface->count() == 0 &&
         lever->count() == 0;
}

void add_reading_options(CLI::App& verb, ReadingArgs& args) {
  verb.add_option(
      "--column", args.columns,
      tr("NAME=COLUMN: the file calls NAME (t, x, v, f, session, ...) something else; may be repeated"));
  verb.add_option(
      "--unit", args.units,
      tr("NAME=UNIT: t, x, v or f is in another unit than the header says (mN, gf, lbf; um, in, rad; ms); may be repeated"));
  verb.add_option("--negate", args.negate,
                  tr("x, v or f: the file counts it the other way; may be repeated"));
  verb.add_flag("--as-it-is", args.as_it_is,
                tr("signs and origin are as the contract has them, whatever they look like"));
  args.surface = verb.add_option("--surface-mm", args.surface_mm,
                                 tr("where the surface is in the file's positions"))
                     ->check(between(-1e6, 1e6));
  args.lever = verb.add_option("--lever-mm", args.lever_mm,
                               tr("lever of a joint: angle × lever = way, torque / lever = force"))
                   ->check(between(1e-3, 1e5));
}

explain::ReadingOptions reading_options(const ReadingArgs& args) {
  explain::ReadingOptions out;
  for (const std::string& given : args.columns) {
    const auto [name, column] = name_and_value("--column", given, "COLUMN");
    out.names[name] = column;
  }
  for (const std::string& given : args.units) {
    const auto [name, unit] = name_and_value("--unit", given, "UNIT");
    out.units[name] = unit;
  }
  out.negate = args.negate;
  if (args.surface->count() > 0) out.surface_mm = args.surface_mm;
  if (args.lever->count() > 0) out.lever_mm = args.lever_mm;
  return out;
}

std::string overview_html(const Recording& r, const explain::Overview& overview,
                          const std::string& title) {
  std::optional<ChartMark> surface, adjacent_surface;
  if (const auto& contact = overview.conventions.contact) {
    surface = ChartMark{contact->at_mm, true, tr("contact begins")};
    adjacent_surface = ChartMark{contact->at_mm, false, tr("contact begins")};
  }
  const Series time = running_time_s(r);
  const Message x = msg("penetration x, mm"), t = msg("time t, s; sessions one behind the other"),
                f = msg("force, N");
  std::string out = fmt::format("<p>{}</p>\n",
                                xml_text(tr("What was understood, before anything is explained.")));
  if (r.x_mm.size() > 0) {
    out += chart_over(msg("force over position"), x, f, thinned(r.x_mm, r.f_n),
                      ChartSeries::Style::dots, surface);
    out += chart_over(msg("position over time"), t, x, thinned(time, r.x_mm),
                      ChartSeries::Style::line, adjacent_surface);
  }
  out +=
      chart_over(msg("force over time"), t, f, thinned(time, r.f_n), ChartSeries::Style::line, {});
  // words may hold the control characters of a file's names: xml_text keeps line ends as
  // references, which pre shows
  return page_html(title,
                   out + fmt::format("<pre>{}</pre>\n", xml_text(tr(explain::to_text(overview)))));
}

}  // namespace cavum::ui
