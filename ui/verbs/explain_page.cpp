#include "ui/verbs/explain_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "engine/base/print.h"
#include "engine/base/text.h"
#include "engine/explain/inference/probability.h"
#include "ui/parts/chart_svg.h"

namespace cavum::ui {
namespace {

using explain::Series;
using explain::View;
using Style = ChartSeries::Style;

constexpr int k_bins = 24;
constexpr double k_text_px = 16, k_narrow_px = 340, k_wide_px = 1050;  // read on a telephone: a narrow chart fits, a wide one scrolls in its box
// Okabe and Ito's colours: told apart with any colour vision; shapes and dashes say the same again
constexpr const char *k_measured = "#7f7f7f", *k_before = "#d55e00", *k_after = "#0072b2", *k_third = "#009e73";

/// "fc_n" → {"fc", "N"}.
std::pair<std::string, std::string> name_and_unit(const std::string& name) {
  static const std::pair<const char*, const char*> k_units[] = {
      {"_n_s_per_mm", "N s/mm"}, {"_n_per_mm", "N/mm"}, {"_n_per_s", "N/s"}, {"_per_mm3", "1/mm³"}, {"_per_mm", "1/mm"}, {"_per_k", "1/K"},
      {"_mm_s", "mm/s"},         {"_mm3", "mm³"},       {"_mm", "mm"},       {"_deg", "°"},         {"_hz", "Hz"},       {"_kg", "kg"},
      {"_turns", "turns"},       {"_rpm", "1/min"},     {"_n", "N"},         {"_s", "s"},           {"_c", "°C"}};
  const std::string all = "_" + name;
  for (const auto& [ending, unit] : k_units)
    if (all.ends_with(ending)) {
      const std::string stem = all.substr(1, std::max<std::size_t>(1, all.size() - std::string(ending).size()) - 1);
      return {stem.empty() ? "value" : stem, unit};
    }
  return {name, ""};
}

std::string axis_label(const std::string& column) {
  if (column == "x_mm") return "penetration x, mm";
  if (column == "v_mm_s") return "speed v, mm/s";
  if (column == "t_s") return "time t, s";
  if (column == "spindle_rpm") return "spindle, 1000/min";
  if (column == "a_mm_s2") return "acceleration a, mm/s²";
  if (column == "simulated_n") return "simulated force, N";
  auto [name, unit] = name_and_unit(column);
  std::replace(name.begin(), name.end(), '_', ' ');
  return unit.empty() ? name : fmt::format("{}, {}", name, unit);
}

/// Means of `y` over equal parts of u (quantiles), with two standard errors.
std::vector<ChartPoint> binned(const Series& u, const Series& y) {
  std::vector<std::pair<double, double>> rows;
  for (Eigen::Index i = 0; i < u.size(); ++i) rows.emplace_back(u[i], y[i]);
  std::sort(rows.begin(), rows.end());
  std::vector<ChartPoint> out;
  std::size_t begin = 0;
  for (int b = 0; b < k_bins && begin < rows.size(); ++b) {
    std::size_t end = std::max(begin + 1, rows.size() * static_cast<std::size_t>(b + 1) / k_bins);
    while (end < rows.size() && rows[end].first == rows[end - 1].first) ++end;  // one value is one point
    double x = 0, sum = 0, square = 0;
    for (std::size_t i = begin; i < end; ++i) x += rows[i].first, sum += rows[i].second, square += rows[i].second * rows[i].second;
    const double n = static_cast<double>(end - begin), mean = sum / n;
    if (n > 5) out.push_back({x / n, mean, 2.0 * std::sqrt(std::max(0.0, square / n - mean * mean) / n)});
    begin = end;
  }
  return out;
}

/// What scrolls sideways by itself where it is too wide, by keyboard too.
std::string scrolling(const std::string& content, const std::string& name) {
  return fmt::format("<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"{}\">{}</div>\n", xml_text(name), content);
}

/// A chart with its title and legend above it as text of the page, which breaks where a telephone ends.
std::string figure(Chart chart) {
  chart.text_px = k_text_px;
  chart.english = true;
  std::string keys;
  for (const auto& s : chart.series)
    if (!s.label.empty()) keys += fmt::format("<span class=\"key\">{} {}</span> ", legend_sign_svg(s), xml_text(s.label));
  const std::string title = std::exchange(chart.title, "");
  const std::string name = fmt::format("chart: {}; {} over {}", title, chart.y_label, chart.x_label);
  const std::string drawn = svg_page(chart.width_px, chart.height_px, chart_group(chart, 0, 0), name);
  return fmt::format("<figure><figcaption><b>{}</b><br>{}</figcaption>{}</figure>\n", xml_text(title), keys,
                     chart.width_px > k_narrow_px ? scrolling(drawn, title) : drawn);
}

/// How much of the residual goes with `u`: variance of the means over it.
double strength(const View& before, const Series& u) {
  double sum = 0.0;
  const auto means = binned(u, *before.residual_n);
  for (const auto& p : means) sum += p.y * p.y;
  return means.empty() ? 0.0 : sum / static_cast<double>(means.size());
}

/// Half the height of a common scale: all residual charts are to be compared at a glance.
double residual_scale(const View& before, const std::vector<std::pair<std::string, const Series*>>& suspects) {
  double most = 1e-6;
  for (const auto& s : suspects)
    for (const auto& p : binned(*s.second, *before.residual_n)) most = std::max(most, std::fabs(p.y) + p.error);
  return 1.15 * most;
}

std::string residual_chart(const View& before, const View& after, const std::string& name, const Series& u, double scale) {
  Chart c;
  c.title = "over " + axis_label(name);
  c.x_label = axis_label(name);
  c.y_label = "measured - simulated, N";
  c.y_range = {-scale, scale};
  c.width_px = k_narrow_px;
  c.height_px = 300;
  const Series shown = name == "spindle_rpm" ? Series(u / 1000.0) : u;
  const auto first = binned(shown, *before.residual_n), last = binned(shown, *after.residual_n);
  c.series.push_back({"before", k_before, Style::dots, first, 1.8});
  c.series.push_back({"after", k_after, Style::rings, last, 1.8});
  if (!first.empty()) c.series.push_back({"", "#333333", Style::line, {{first.front().x, 0, 0}, {first.back().x, 0, 0}}, 0.8});
  return figure(c);
}

constexpr double k_stretch_s = 12.0;

/// Row at which the stretch begins in which the causes change most; where they change nothing, in which the force is largest.
Eigen::Index telling_stretch(const View& before, const View& after) {
  const auto& r = *before.scene->recording;
  const Series change = (*after.model_n - *before.model_n).square() + 1e-6 * before.force_n->square();
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

/// Measured and simulated over the most telling 12 s, and the residual below.
std::string force_charts(const View& before, const View& after) {
  const auto& r = *before.scene->recording;
  const Eigen::Index begin = telling_stretch(before, after);
  const auto session = std::find_if(r.sessions.begin(), r.sessions.end(), [&](const auto& s) { return begin >= s.begin && begin < s.end; });
  Chart c, d;
  c.title =
      fmt::format("session {}{}", session->name,
                  after.causes.empty() ? ": the twelve seconds of the greatest forces" : ": the twelve seconds in which the causes change most");
  d.title = "what is left: measured - simulated";
  c.x_label = d.x_label = "time t, s";
  c.y_label = d.y_label = "force, N";
  c.width_px = d.width_px = k_wide_px;
  c.height_px = 340;
  d.height_px = 240;
  ChartSeries measured{"measured", k_measured, Style::line, {}, 2.6}, first{"simulated, before", k_before, Style::dashed, {}, 1.6},
      last{"simulated, with the causes", k_after, Style::line, {}, 1.4}, left{"before", k_before, Style::dashed, {}, 1.2},
      rest{"with the causes", k_after, Style::line, {}, 1.2};
  const double from = r.t_s[begin], to = std::min(from + k_stretch_s, r.t_s[session->end - 1]);
  c.x_range = d.x_range = {from, to};
  Eigen::Index shown = 0;
  for (Eigen::Index i = session->begin; i < session->end; ++i) shown += r.t_s[i] >= from && r.t_s[i] <= to;
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
    first.label = "simulated";
    last = rest = {};
  }
  c.series = {measured, last, first};
  c.y_range = {lowest - 0.04 * (highest - lowest), highest + 0.04 * (highest - lowest)};
  d.series = {left, rest};
  return figure(c) + figure(d);
}

std::string gain_chart(const explain::Gain& g) {
  const double most = std::max({g.base_rmse_n, g.extended_rmse_n, g.noise_floor_n, 1e-9});
  std::string out = "<table class=\"bars\">";
  for (const auto& [name, value, colour] : {std::tuple{"simulation as it is", g.base_rmse_n, k_before},
                                            {"with the causes", g.extended_rmse_n, k_after},
                                            {"noise of the measurement", g.noise_floor_n, k_measured}})
    out += printed(
        "<tr><th scope=\"row\">%s</th><td class=\"wide\"><span class=\"bar\" style=\"width:%.0f%%;background:%s\"></span></td><td class=\"n\">%.4f "
        "N</td></tr>\n",
        name, 1.0 + 99.0 * value / most, colour, value);
  return out + "</table>\n";
}

/// A file's name, which may break behind its slashes.
std::string breakable(const std::string& name) {
  std::string out;
  for (const char c : xml_text(name)) out += c == '/' ? std::string("/<wbr>") : std::string(1, c);
  return out;
}

std::string head(const std::string& title) {
  return fmt::format(
             "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
             "content=\"width=device-width, initial-scale=1\"><title>{}</title>",
             xml_text(title)) +
         "<style>:root{color-scheme:light}body{font:16px/1.5 sans-serif;color:#222;background:#fff;max-width:68em;margin:2em auto;padding:0 "
         "1em;overflow-wrap:anywhere}h1{font-size:1.5em}h2{font-size:1.25em;margin-top:2em}h3{font-size:1.1em;margin-top:2em}small{font-size:1rem;"
         "font-weight:normal}code{background:#f2f2f2;font-size:1em}figure{margin:0 0 1em}.key{white-space:nowrap;margin-right:.8em}"
         ".key svg{vertical-align:-.1em}svg{max-width:100%;height:auto}.verdict{border-left:.5em solid #0072b2;background:#eef4f9;padding:.6em "
         "1em}.verdict ul{margin:.3em 0;padding-left:1.2em}.next{border-left:.5em solid #009e73;background:#edf7f3;padding:.6em 1em}"
         ".pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(21em,100%),1fr));gap:.5em}.pair p{margin-top:0}"
         ".alone>figure>svg{width:100%;max-width:24em}.alone .key{display:block;white-space:normal}.scroll{overflow-x:auto}.scroll "
         "svg{max-width:none;display:block}table{border-collapse:collapse}"
         "td,th{overflow-wrap:break-word;text-align:left;vertical-align:top;padding:.2em 1em .2em 0;border-bottom:1px solid "
         "#ddd}td.n,th.n{text-align:right;"
         "font-variant-numeric:tabular-nums}td.n{white-space:nowrap}caption{text-align:left}.bars{width:100%;max-width:42em}.bars td,.bars "
         "th{border:0}.bars th{font-weight:normal}.bars .wide{width:45%}.sessions "
         "th{overflow-wrap:anywhere;min-width:3em}.bar{display:inline-block;height:1em}li{margin:.3em 0}summary{cursor:"
         "pointer}</style></head><body><main>\n<h1>" +
         breakable(title) + "</h1>\n";
}

constexpr const char* k_end = "</main></body></html>\n";

std::string list(const std::vector<Message>& items) {
  std::string out = "<ul>\n";
  for (const auto& i : items) out += fmt::format("<li>{}</li>\n", xml_text(english_text(i)));
  return out + "</ul>\n";
}

std::string verdict_box(const explain::Explanation& e, const std::string& words) {
  std::string causes;
  for (const auto& c : e.causes) {
    if (c.probability <= 0.0) continue;  // a table of means gives none
    const auto& m = explain::mechanism_at(c.term.mechanism);
    causes += fmt::format("<li>{}{}: {}</li>\n", xml_text(m.words), c.aliases.empty() ? "" : ", or one that fits as well",
                          printed("%.0f %%", 100.0 * (c.aliases.empty() ? c.probability : c.set_probability)));
  }
  if (e.unexplained && !causes.empty()) causes += "<li>something that no mechanism here describes</li>\n";
  return fmt::format("<div class=\"verdict\"><b>{}</b><br>{}{}</div>\n", xml_text(e.verdict), xml_text(words),
                     causes.empty() ? "" : fmt::format("<ul>\n{}</ul>\n", causes));
}

std::string next_box(const std::string& words) { return fmt::format("<h2>The next experiment</h2>\n<p class=\"next\">{}</p>\n", xml_text(words)); }

/// What a mechanism's picture shows it over, and its name; its own force where the recording has no such thing.
std::pair<std::string, Series> seen_over(const explain::Cause& c, const View& after) {
  const char* over = explain::mechanism_at(c.term.mechanism).seen_over;
  const std::string name = over != nullptr ? over : "";
  const auto& motion = after.scene->motion;
  if (name == "x_mm") return {name, motion->x_mm};
  if (name == "v_mm_s") return {name, motion->v_mm_s};
  if (name == "a_mm_s2") return {name, motion->a_mm_s2};
  if (name == "t_s") return {name, after.scene->recording->t_s};
  if (name == "simulated_n") return {name, after.scene->force_n};
  if (const Series* column = name.empty() ? nullptr : after.scene->recording->column(name)) return {name, *column};
  return {"force of the cause, N", c.force_n};
}

/// All that the simulation and the other causes leave, and the cause's own force, over what shows it best.
std::string cause_chart(const explain::Cause& c, const View& after) {
  const auto [name, u] = seen_over(c, after);
  Chart chart;
  chart.title = "what it alone explains, over " + axis_label(name);
  chart.width_px = k_narrow_px;
  chart.x_label = axis_label(name);
  chart.y_label = "force, N";
  chart.height_px = 300;
  const Series left = *after.residual_n + c.force_n, shown = name == "spindle_rpm" ? Series(u / 1000.0) : u;
  const auto data = binned(shown, left), law = binned(shown, c.force_n);
  double low = 0.0, high = 1e-9;
  for (const auto* points : {&data, &law})
    for (const auto& p : *points) low = std::min(low, p.y - p.error), high = std::max(high, p.y + p.error);
  chart.y_range = {low - 0.05 * (high - low), high + 0.05 * (high - low)};
  chart.series = {{"measured, less all else", k_before, Style::dots, data, 1.8}, {"this cause", k_after, Style::rings, law, 1.8}};
  return figure(chart);
}

/// What the cause gains on each session that the fit had not seen.
std::string sessions_table(const explain::Explanation& e, const explain::Cause& c) {
  std::vector<std::string> names;
  for (const Message& name : fold_names(e)) names.push_back(english_text(name));
  double most = 1e-9;
  for (const double g : c.by_fold_percent) most = std::max(most, std::fabs(g));
  std::string out = "<table class=\"bars sessions\"><caption>Error that it takes away from each session not seen</caption>";
  for (std::size_t f = 0; f < names.size() && f < c.by_fold_percent.size(); ++f) {
    const double g = c.by_fold_percent[f];
    out += fmt::format(
        "<tr><th scope=\"row\">{}</th>{}", xml_text(names[f]),
        printed("<td class=\"wide\"><span class=\"bar\" style=\"width:%.0f%%;background:%s\"></span></td><td class=\"n\">%.1f %%</td></tr>\n",
                1.0 + 99.0 * std::fabs(g) / most, g < 0.0 ? k_before : k_after, g));
  }
  return out + "</table>\n";
}

std::string how_likely(const explain::Cause& c) {
  std::string out = printed("<p><b>%.0f %%: %s.</b> ", 100.0 * c.probability, explain::probability_words(c.probability));
  if (!c.aliases.empty()) out += printed("That it is this or one that fits as well: %.0f %%. ", 100.0 * c.set_probability);
  return out + printed("By it alone the error on sessions not seen falls by %.1f %% (95 %%: %.1f to %.1f); chance of a false alarm %s.</p>\n",
                       c.gain_percent.value, c.gain_percent.low, c.gain_percent.high,
                       c.p_value < 0.0051 ? "below 1 in 199" : printed("%.2g", c.p_value).c_str());
}

std::string fit_as_well(const explain::Cause& c) {
  if (c.aliases.empty()) return "";
  std::string out = "<p><b>These fit as well:</b> ";
  for (std::size_t i = 0; i < c.aliases.size(); ++i) {
    const auto& other = explain::mechanism_at(explain::find_mechanism(c.aliases[i]));
    out += fmt::format("{}{} (<code>{}</code>)", i > 0 ? "; " : "", xml_text(other.words), other.name);
  }
  return out + ". The data cannot tell which it is.</p>\n";
}

std::string values_table(const explain::Cause& c) {
  std::string out = "<table><thead><tr><th>value</th><th class=\"n\">found</th><th class=\"n\">95 %</th></tr></thead>\n";
  for (const auto& [parameter, i] : c.parameters) {
    const auto [name, unit] = name_and_unit(parameter);
    out += fmt::format("<tr><th scope=\"row\">{}{}{}</th>{}</tr>\n", xml_text(name), unit.empty() ? "" : ", ", xml_text(unit),
                       printed("<td class=\"n\">%.4g</td><td class=\"n\">%.4g to %.4g</td>", i.value, i.low, i.high));
  }
  return scrolling(out + "</table>", fmt::format("values of {}", explain::mechanism_at(c.term.mechanism).name));
}

std::string causes_html(const explain::Explanation& e) {
  std::string out;
  for (const auto& c : e.causes) {
    const auto& m = explain::mechanism_at(c.term.mechanism);
    out += fmt::format("<h3>{} <small><code>{}</code></small></h3>\n", xml_text(m.words), m.name);
    const std::string said = how_likely(c) + fit_as_well(c);
    out += e.after ? fmt::format("<div class=\"pair\"><div>{}</div><div>{}{}</div></div>\n", cause_chart(c, *e.after), said, sessions_table(e, c))
                   : said;
    out +=
        fmt::format("<p>It adds <code>{}{}{}{}", xml_text(m.equation), printed("</code>: %.4f N root mean square over the recording. ", c.effect_n),
                    m.term != nullptr ? "An exam can feel it.</p>\n" : "It belongs to this measurement, not to the tooth.</p>\n", values_table(c));
    if (m.separate != nullptr) out += fmt::format("<p class=\"next\"><b>To be surer:</b> {}</p>\n", xml_text(m.separate));
  }
  if (e.unexplained)
    out += fmt::format("<h3>something that no mechanism here describes</h3>\n<p>The force depends on <b>{}</b> ({}{}",
                       xml_text(axis_label(e.unexplained->variable)), xml_text(english_text(e.unexplained->form)),
                       printed("), %.4f N root mean square.</p>\n", e.unexplained->effect_n));
  if (const Message left = left_over_words(e); !left.empty()) out += fmt::format("<p>{}</p>\n", xml_text(english_text(left)));
  return out.empty() ? "<p>No cause was found.</p>\n" : out;
}

std::string cannot_tell(const explain::Explanation& e) {
  std::string out = "<h2>What these data cannot tell</h2>\n";
  if (e.not_testable.empty()) return out + "<p>Every mechanism could have shown itself.</p>\n";
  std::map<std::string, std::vector<const explain::Mechanism*>> by_reason;
  for (const auto& n : e.not_testable) by_reason[english_text(n.reason)].push_back(&explain::mechanism_at(explain::find_mechanism(n.mechanism)));
  for (const auto& [reason, group] : by_reason) {
    out += fmt::format("<p><b>{}:</b></p>\n<details{}{}{}", xml_text(reason), group.size() > 8 ? "" : " open",
                       printed("><summary>%zu mechanism%s", group.size(), group.size() == 1 ? "" : "s"),
                       group.size() == 1 ? ", and what would show it</summary>\n<ul>\n" : ", and what would show them</summary>\n<ul>\n");
    for (const auto* m : group) out += fmt::format("<li>{} (<code>{}</code>): {}</li>\n", xml_text(m->words), m->name, xml_text(m->separate));
    out += "</ul></details>\n";
  }
  return out;
}

/// The table is long: what gains most stands in sight.
std::string candidates_html(const explain::Explanation& e) {
  constexpr std::size_t k_shown = 8;
  auto candidates = e.candidates;
  std::sort(candidates.begin(), candidates.end(),
            [](const auto& a, const auto& b) { return std::pair(a.testable, a.gain) > std::pair(b.testable, b.gain); });
  const std::string begin = "<table><thead><tr><th>mechanism</th><th class=\"n\">fall of chi²</th></tr></thead>\n";
  std::string shown = begin, rest = begin;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto& m = explain::mechanism_at(candidates[i].hypothesis.term.mechanism);
    (i < k_shown ? shown : rest) +=
        fmt::format("<tr><td>{} (<code>{}</code>)</td><td class=\"n\">{}</td></tr>\n", xml_text(m.words), m.name,
                    candidates[i].testable ? printed("%.0f", std::max(0.0, candidates[i].gain)) : std::string("not testable"));
  }
  std::string out = "<h2>What each mechanism would gain alone</h2>\n" + shown + "</table>\n";
  if (candidates.size() > k_shown)
    out += fmt::format("<details><summary>the other {}</summary>\n{}</table></details>\n", candidates.size() - k_shown, rest);
  return out;
}

std::string verdict_words(const explain::Explanation& e) {
  if (e.verdict == "clean") return "Nothing that these data can show is missing from the simulation.";
  if (e.verdict == "not_testable") return "These data cannot show anything either way.";
  if (e.verdict == "data_fault") return "The recording cannot be trusted, so nothing was explained.";
  if (e.verdict == "unexplained") return "The force depends on something that no mechanism here describes.";
  if (e.verdict == "alias") return "Something is missing, but these data cannot tell which of several mechanisms it is.";
  return "The simulation lacks what is named below.";
}

/// Laws side by side: three columns fit a telephone, six do not.
std::string laws_table(const explain::TableExplanation& e) {
  std::string out =
      "<table><thead><tr><th>law</th><th class=\"n\">Voigt law alone</th><th class=\"n\">k X and an intercept</th><th class=\"n\">all "
      "three</th></tr></thead>\n";
  const auto row = [&](const char* name, int digits, double explain::TableFit::*value) {
    out += fmt::format("<tr><th scope=\"row\">{}</th>", name);
    for (const auto* f : {&e.voigt, &e.line, &e.all}) out += "<td class=\"n\">" + fixed(f->*value, digits) + "</td>";
    out += "</tr>\n";
  };
  row("slope: F = … k", 3, &explain::TableFit::slope_mm);
  row("root: … √k", 3, &explain::TableFit::root);
  row("intercept: … at k = 0, N", 3, &explain::TableFit::intercept_n);
  row("rms, N", 4, &explain::TableFit::rms_n);
  row("row left out, N", 4, &explain::TableFit::left_out_rms_n);
  return out + "</table>\n";
}

}  // namespace

std::string explanation_html(const explain::Explanation& e, const std::string& title) {
  std::string out = head(title) + verdict_box(e, verdict_words(e));
  if (e.verdict == "data_fault") return fmt::format("{}{}{}{}", out, list(e.data_faults), next_box(english_text(e.next_experiment)), k_end);
  out += "<h2>What the simulation gets wrong</h2>\n" + causes_html(e);
  out += fmt::format(
      "<h2>What fixing it gains</h2>\n<p>Root mean square error on sessions that the fit had not seen.</p>\n{}{}", gain_chart(e.gain),
      printed("<p>Gain %.1f %% (95 %%: %.1f to %.1f), %.0f %% of what could be explained. k = %.4g N/mm (%.4g to %.4g), c = %.4g N s/mm (%.4g to "
              "%.4g).</p>\n",
              e.gain.percent.value, e.gain.percent.low, e.gain.percent.high, e.gain.share_percent, e.base.k_n_per_mm, e.k.low, e.k.high,
              e.base.c_n_s_per_mm, e.c.low, e.c.high));
  out += next_box(english_text(e.next_experiment));
  if (e.before && e.after) {
    const auto& scene = *e.before->scene;
    out += "<h2>Measured against simulated</h2>\n" + force_charts(*e.before, *e.after);
    out +=
        "<h2>The residual against each suspect</h2>\n<p>What moves the residual most comes first. Means over equal shares of the rows with two "
        "standard errors; all charts on one "
        "scale.</p>\n<div "
        "class=\"pair\">\n";
    std::vector<std::pair<std::string, const Series*>> suspects{
        {"x_mm", &scene.motion->x_mm}, {"v_mm_s", &scene.motion->v_mm_s}, {"t_s", &scene.recording->t_s}};
    for (const auto& [name, u] : scene.recording->columns)
      if (u.maxCoeff() > u.minCoeff()) suspects.emplace_back(name, &u);
    std::stable_sort(suspects.begin(), suspects.end(),
                     [&](const auto& a, const auto& b) { return strength(*e.before, *a.second) > strength(*e.before, *b.second); });
    const double scale = residual_scale(*e.before, suspects);
    for (const auto& [name, u] : suspects) out += residual_chart(*e.before, *e.after, name, *u, scale);
    out += "</div>\n" + cannot_tell(e) + candidates_html(e);
  }
  if (!e.notes.empty()) out += "<h2>Notes</h2>\n" + list(e.notes);
  return out + k_end;
}

std::string table_html(const explain::TableExplanation& e, const std::string& title) {
  std::string out = head(title);
  if (e.said.verdict == "data_fault")
    return fmt::format("{}{}{}{}{}", out, verdict_box(e.said, verdict_words(e.said)), list(e.said.data_faults),
                       next_box(english_text(e.said.next_experiment)), k_end);
  out += verdict_box(
      e.said, e.said.verdict == "alias"
                  ? printed("A force of %.3f N is missing that does not depend on k. Friction, a bias of the load cell, an edge force: the table "
                            "cannot tell which.",
                            e.line.intercept_n)
                  : verdict_words(e.said));
  const double most = *std::max_element(e.table.k_n_per_mm.begin(), e.table.k_n_per_mm.end());
  Chart c;
  c.title = "force over stiffness";
  c.x_label = "stiffness k, N/mm";
  c.y_label = "force, N";
  c.height_px = 360;
  c.width_px = k_narrow_px;
  ChartSeries points{"the table", "#222222", Style::dots, {}, 1.8}, line{"k X and an intercept", k_after, Style::line, {}, 1.8},
      voigt{"Voigt law alone, best fit: k X + c V, c ~ √k", k_before, Style::dashed, {}, 1.8},
      published{"published: k X at the line's slope, + c V with c = 2 √k", k_third, Style::dashed, {}, 1.2};
  double top = 0.0;
  for (std::size_t i = 0; i < e.table.f_n.size(); ++i)
    points.points.push_back({e.table.k_n_per_mm[i], e.table.f_n[i]}), top = std::max(top, e.table.f_n[i]);
  for (int i = 0; i <= 120; ++i) {
    const double k = most * i / 120.0;
    line.points.push_back({k, e.line.at(k)});
    voigt.points.push_back({k, e.voigt.at(k)});
    published.points.push_back({k, e.line.slope_mm * k + e.predicted_root * std::sqrt(k)});
    top = std::max(top, published.points.back().y);
  }
  c.series = {line, voigt, published, points};
  c.y_range = {0.0, 1.05 * top};
  c.x_range = {-0.03 * most, 1.03 * most};
  out += "<h2>Measured against simulated</h2>\n" + fmt::format("<div class=\"alone\">{}</div>\n", figure(c));
  out += laws_table(e) + fmt::format("<h2>What it says, and what it cannot say</h2>\n{}{}{}", list(e.said.notes),
                                     next_box(english_text(e.said.next_experiment)), cannot_tell(e.said));
  return out + k_end;
}

}  // namespace cavum::ui
