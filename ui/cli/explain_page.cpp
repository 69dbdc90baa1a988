#include "ui/cli/explain_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "ui/language/language.h"
#include "ui/language/say.h"

namespace cavum::ui {
namespace {

using explain::Series;
using explain::Verdict;
using explain::View;
using Style = ChartSeries::Style;

constexpr int k_bins = 24;
constexpr double k_text_px = 16, k_narrow_px = 340, k_wide_px = 1050;  // read on a telephone: a narrow chart fits, a wide one scrolls in its box
// Okabe and Ito's colours: told apart with any colour vision; shapes and dashes say the same again
constexpr const char *k_measured = "#7f7f7f", *k_before = "#d55e00", *k_after = "#0072b2", *k_third = "#009e73";

std::string html(const Message& message) { return xml_text(tr(message)); }

/// Sentences are paragraphs, rows one below the other a table.
std::string html(const Lines& lines) {
  std::string out;
  bool in_table = false;
  for (const auto& line : lines.all()) {
    const bool row = line.cells.size() > 1;
    if (row != in_table) out += row ? "<table class=\"words\">\n" : "</table>\n";
    in_table = row;
    std::string cells;
    for (const Message& cell : line.cells)
      cells += !row            ? fmt::format("<p>{}</p>", html(cell))
               : cells.empty() ? fmt::format("<th scope=\"row\">{}</th>", html(cell))
                               : fmt::format("<td>{}</td>", html(cell));
    out += row ? fmt::format("<tr>{}</tr>\n", cells) : cells + "\n";
  }
  return out + (in_table ? "</table>\n" : "");
}

std::string heading(const Message& words) { return fmt::format("<h2>{}</h2>\n", html(words)); }
std::string paragraph(const Message& words) { return fmt::format("<p>{}</p>\n", html(words)); }

std::string list(const std::vector<Message>& items) {
  std::string out = "<ul>\n";
  for (const auto& i : items) out += fmt::format("<li>{}</li>\n", html(i));
  return out + "</ul>\n";
}

std::string bar_row(const Message& name, double share, const char* colour, const Message& value) {
  return fmt::format(
      "<tr><th scope=\"row\">{}</th><td class=\"wide\"><span class=\"bar\" style=\"width:{:.0f}%;background:{}\"></span></td><td "
      "class=\"n\">{}</td></tr>\n",
      html(name), 1.0 + 99.0 * share, colour, html(value));
}

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
  c.y_range = {-scale, scale};
  c.width_px = k_narrow_px;
  c.height_px = 300;
  const Series shown = name == "spindle_rpm" ? Series(u / 1000.0) : u;
  const auto first = binned(shown, *before.residual_n), last = binned(shown, *after.residual_n);
  c.series.push_back({tr("before"), k_before, Style::dots, first, 1.8});
  c.series.push_back({tr("after"), k_after, Style::rings, last, 1.8});
  if (!first.empty()) c.series.push_back({"", "#333333", Style::line, {{first.front().x, 0, 0}, {first.back().x, 0, 0}}, 0.8});
  return figure(c, msg("over {}", axis_label(name)), axis_label(name), msg("measured - simulated, N"));
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
  c.width_px = d.width_px = k_wide_px;
  c.height_px = 340;
  d.height_px = 240;
  ChartSeries measured{tr("measured"), k_measured, Style::line, {}, 2.6}, first{tr("simulated, before"), k_before, Style::dashed, {}, 1.6},
      last{tr("simulated, with the causes"), k_after, Style::line, {}, 1.4}, left{tr("before"), k_before, Style::dashed, {}, 1.2},
      rest{tr("with the causes"), k_after, Style::line, {}, 1.2};
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
    first.label = tr("simulated");
    last = rest = {};
  }
  c.series = {measured, last, first};
  c.y_range = {lowest - 0.04 * (highest - lowest), highest + 0.04 * (highest - lowest)};
  d.series = {left, rest};
  const Message time = msg("time t, s"), force = msg("force, N");
  return figure(c,
                after.causes.empty() ? msg("session {}: the twelve seconds of the greatest forces", session->name)
                                     : msg("session {}: the twelve seconds in which the causes change most", session->name),
                time, force) +
         figure(d, msg("what is left: measured - simulated"), time, force);
}

std::string gain_chart(const explain::Gain& g) {
  const double most = std::max({g.base_rmse_n, g.extended_rmse_n, g.noise_floor_n, 1e-9});
  const auto bar = [&](const Message& name, double value, const char* colour) {
    return bar_row(name, value / most, colour, msg("{}", as_n(value, 4)));
  };
  return fmt::format("<table class=\"bars\">{}{}{}</table>\n", bar(msg("simulation as it is"), g.base_rmse_n, k_before),
                     bar(msg("with the causes"), g.extended_rmse_n, k_after), bar(msg("noise of the measurement"), g.noise_floor_n, k_measured));
}

/// A file's name, which may break behind its slashes.
std::string breakable(const std::string& name) {
  std::string out;
  for (const char c : xml_text(name)) out += c == '/' ? std::string("/<wbr>") : std::string(1, c);
  return out;
}

std::string verdict_box(const explain::Explanation& e, const Message& words) {
  std::vector<Message> causes;
  for (const auto& c : e.causes) {
    if (c.probability <= 0.0) continue;  // a table of means gives none
    const cavum::Term cause{explain::mechanism_at(c.term.mechanism).words};
    causes.push_back(c.aliases.empty() ? msg("{}: {}", cause, as_percent(100.0 * c.probability))
                                       : msg("{}, or one that fits as well: {}", cause, as_percent(100.0 * c.set_probability)));
  }
  if (e.unexplained && !causes.empty()) causes.push_back(msg("something that no mechanism here describes"));
  return fmt::format("<div class=\"verdict\" data-verdict=\"{}\"><b>{}</b><br>{}{}</div>\n", verdict_name(e.verdict), html(word_of(e.verdict)),
                     html(words), causes.empty() ? "" : list(causes));
}

std::string next_box(const explain::Explanation& e) {
  return fmt::format("{}<p class=\"next\">{}</p>\n", heading(msg("The next experiment")), html(e.next_experiment));
}

/// What a mechanism's picture shows it over, and its name; its own force, of no name, where the recording has no such thing.
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
  return {"", c.force_n};
}

/// All that the simulation and the other causes leave, and the cause's own force, over what shows it best.
std::string cause_chart(const explain::Cause& c, const View& after) {
  const auto [name, u] = seen_over(c, after);
  Chart chart;
  chart.width_px = k_narrow_px;
  chart.height_px = 300;
  const Series left = *after.residual_n + c.force_n, shown = name == "spindle_rpm" ? Series(u / 1000.0) : u;
  const auto data = binned(shown, left), law = binned(shown, c.force_n);
  double low = 0.0, high = 1e-9;
  for (const auto* points : {&data, &law})
    for (const auto& p : *points) low = std::min(low, p.y - p.error), high = std::max(high, p.y + p.error);
  chart.y_range = {low - 0.05 * (high - low), high + 0.05 * (high - low)};
  chart.series = {{tr("measured, less all else"), k_before, Style::dots, data, 1.8}, {tr("this cause"), k_after, Style::rings, law, 1.8}};
  return figure(chart, msg("what it alone explains, over {}", axis_label(name)), axis_label(name), msg("force, N"));
}

/// What the cause gains on each session that the fit had not seen.
std::string sessions_table(const explain::Explanation& e, const explain::Cause& c) {
  const std::vector<Message> names = fold_names(e);
  double most = 1e-9;
  for (const double g : c.by_fold_percent) most = std::max(most, std::fabs(g));
  std::string out =
      fmt::format("<table class=\"bars sessions\"><caption>{}</caption>", html(msg("Error that it takes away from each session not seen")));
  for (std::size_t f = 0; f < names.size() && f < c.by_fold_percent.size(); ++f) {
    const double g = c.by_fold_percent[f];
    out += bar_row(names[f], std::fabs(g) / most, g < 0.0 ? k_before : k_after, msg("{}", as_percent(g, 1)));
  }
  return out + "</table>\n";
}

std::string causes_html(const explain::Explanation& e) {
  std::string out;
  for (const auto& c : e.causes) {
    const auto& m = explain::mechanism_at(c.term.mechanism);
    const std::string said = html(to_text(c));
    out += fmt::format("<h3>{}</h3>\n", html(heading_of(c)));
    out += e.after ? fmt::format("<div class=\"pair\"><div>{}</div><div>{}{}</div></div>\n", cause_chart(c, *e.after), said, sessions_table(e, c))
                   : said;
    out += paragraph(m.term != nullptr ? msg("An exam can feel it.") : msg("It belongs to this measurement, not to the tooth."));
    if (m.separate != nullptr) out += fmt::format("<p class=\"next\">{}</p>\n", html(msg("To be surer: {}", cavum::Term{m.separate})));
  }
  if (e.unexplained) out += paragraph(unexplained_words(*e.unexplained));
  if (const Message left = left_over_words(e); !left.empty()) out += paragraph(left);
  return out.empty() ? paragraph(msg("No cause was found.")) : out;
}

std::string cannot_tell(const explain::Explanation& e) {
  std::string out = heading(msg("What these data cannot tell"));
  if (e.not_testable.empty()) return out + paragraph(msg("Every mechanism could have shown itself."));
  std::vector<std::pair<Message, std::vector<Message>>> by_reason;
  for (const auto& n : e.not_testable) {
    const auto& m = explain::mechanism_at(explain::known_mechanism(n.mechanism));
    auto group = std::find_if(by_reason.begin(), by_reason.end(), [&](const auto& r) { return r.first == n.reason; });
    if (group == by_reason.end()) group = by_reason.insert(group, {n.reason, {}});
    group->second.push_back(msg("{} ({}): {}", cavum::Term{m.words}, m.name, cavum::Term{m.separate}));
  }
  for (const auto& [reason, group] : by_reason) {
    const auto n = static_cast<std::int64_t>(group.size());
    out += fmt::format("<p><b>{}</b></p>\n<details{}><summary>{}</summary>\n{}</details>\n", html(reason), n > 8 ? "" : " open",
                       html(msgn("{} mechanism, and what would show it", "{} mechanisms, and what would show them", n, n)), list(group));
  }
  return out;
}

/// The table is long: what gains most stands in sight.
std::string candidates_html(const explain::Explanation& e) {
  constexpr std::size_t k_shown = 8;
  auto candidates = e.candidates;
  std::sort(candidates.begin(), candidates.end(),
            [](const auto& a, const auto& b) { return std::pair(a.testable, a.gain) > std::pair(b.testable, b.gain); });
  const std::string begin =
      fmt::format("<table><thead><tr><th>{}</th><th class=\"n\">{}</th></tr></thead>\n", html(msg("mechanism")), html(msg("fall of chi²")));
  std::string shown = begin, rest = begin;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto& m = explain::mechanism_at(candidates[i].hypothesis.term.mechanism);
    (i < k_shown ? shown : rest) +=
        fmt::format("<tr><td>{}</td><td class=\"n\">{}</td></tr>\n", html(msg("{} ({})", cavum::Term{m.words}, m.name)),
                    html(candidates[i].testable ? msg("{}", as_number(std::max(0.0, candidates[i].gain), 0)) : msg("not testable")));
  }
  std::string out = heading(msg("What each mechanism would gain alone")) + shown + "</table>\n";
  if (candidates.size() > k_shown)
    out += fmt::format("<details><summary>{}</summary>\n{}</table></details>\n", html(msg("the other mechanisms: {}", candidates.size() - k_shown)),
                       rest);
  return out;
}

/// What stands between `…` is a name of a column, or a command.
std::string with_code(const Message& words) {
  std::string out;
  bool inside = false;
  for (const char c : html(words))
    if (c == '`')
      out += (inside = !inside) ? "<code>" : "</code>";
    else
      out += c;
  return out;
}

}  // namespace

std::string page_html(const std::string& title, const std::string& content) {
  return fmt::format(
             "<!DOCTYPE html><html lang=\"{}\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
             "content=\"width=device-width, initial-scale=1\"><title>{}</title>",
             language(), xml_text(title)) +
         "<style>:root{color-scheme:light}body{font:16px/1.5 sans-serif;color:#222;background:#fff;max-width:68em;margin:2em auto;padding:0 "
         "1em;overflow-wrap:anywhere}h1{font-size:1.5em}h2{font-size:1.25em;margin-top:2em}h3{font-size:1.1em;margin-top:2em}code{background:#f2f2f2;"
         "font-size:1em}figure{margin:0 0 1em}.key{white-space:nowrap;margin-right:.8em}"
         ".key svg{vertical-align:-.1em}svg{max-width:100%;height:auto}.verdict{border-left:.5em solid #0072b2;background:#eef4f9;padding:.6em "
         "1em}.verdict ul{margin:.3em 0;padding-left:1.2em}.next{border-left:.5em solid #009e73;background:#edf7f3;padding:.6em 1em}"
         ".pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(21em,100%),1fr));gap:.5em}.pair p{margin-top:0}"
         ".alone>figure>svg{width:100%;max-width:24em}.alone .key{display:block;white-space:normal}.scroll{overflow-x:auto}.scroll "
         "svg{max-width:none;display:block}table{border-collapse:collapse}"
         "td,th{overflow-wrap:break-word;text-align:left;vertical-align:top;padding:.2em 1em .2em 0;border-bottom:1px solid "
         "#ddd}td.n,th.n{text-align:right;"
         "font-variant-numeric:tabular-nums}td.n{white-space:nowrap}pre{font-size:1em;white-space:pre-wrap;background:#f2f2f2;padding:1em}caption{"
         "text-align:left}."
         "bars{width:100%;max-width:42em}.bars td,.bars "
         "th{border:0}.bars th{font-weight:normal}.bars .wide{width:45%}.words th{font-weight:normal;min-width:5em}.sessions th{min-width:3em}.words "
         "th,.sessions "
         "th{overflow-wrap:anywhere}.bar{display:inline-block;height:1em}li{margin:.3em 0}summary{cursor:"
         "pointer}</style></head><body><main>\n<h1>" +
         breakable(title) + "</h1>\n" + content + "</main></body></html>\n";
}

std::string figure(Chart chart, const Message& title, const Message& x_label, const Message& y_label) {
  chart.x_label = tr(x_label);
  chart.y_label = tr(y_label);
  chart.text_px = k_text_px;
  std::string keys;
  for (const auto& s : chart.series)
    if (!s.label.empty()) keys += fmt::format("<span class=\"key\">{} {}</span> ", legend_sign_svg(s), xml_text(s.label));
  std::string drawn = svg_page(chart.width_px, chart.height_px, chart_group(chart, 0, 0), tr("chart: {}; {} over {}", title, y_label, x_label));
  if (chart.width_px > k_narrow_px)  // scrolls sideways by itself, by keyboard too
    drawn = fmt::format("<div class=\"scroll\" role=\"group\" tabindex=\"0\" aria-label=\"{}\">{}</div>\n", html(title), drawn);
  return fmt::format("<figure><figcaption><b>{}</b><br>{}</figcaption>{}</figure>\n", html(title), keys, drawn);
}

std::string explanation_html(const explain::Explanation& e, const std::string& title) {
  std::string out = verdict_box(e, in_words(e));
  if (e.verdict == Verdict::data_fault) return page_html(title, out + list(e.data_faults) + next_box(e));
  out += heading(msg("What the simulation gets wrong")) + causes_html(e);
  out += heading(msg("What fixing it gains")) + paragraph(msg("Root mean square error on sessions that the fit had not seen.")) + gain_chart(e.gain) +
         html(gain_words(e)) + next_box(e);
  if (e.before && e.after) {
    const auto& scene = *e.before->scene;
    out += heading(msg("Measured against simulated")) + force_charts(*e.before, *e.after);
    out += heading(msg("The residual against each suspect")) +
           paragraph(msg("What moves the residual most comes first. Means over equal shares of the rows with two standard errors; all charts on one "
                         "scale.")) +
           "<div class=\"pair\">\n";
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
  if (!e.notes.empty()) out += heading(msg("Notes")) + list(e.notes);
  return page_html(title, out);
}

std::string table_html(const explain::TableExplanation& e, const std::string& title) {
  std::string out = verdict_box(e.said, in_words(e));
  if (e.said.verdict == Verdict::data_fault) return page_html(title, out + list(e.said.data_faults) + next_box(e.said));
  const double most = *std::max_element(e.table.k_n_per_mm.begin(), e.table.k_n_per_mm.end());
  Chart c;
  c.height_px = 360;
  c.width_px = k_narrow_px;
  ChartSeries points{tr("the table"), "#222222", Style::dots, {}, 1.8}, line{tr("k X and an intercept"), k_after, Style::line, {}, 1.8},
      voigt{tr("Voigt law alone, best fit: k X + c V, c ~ √k"), k_before, Style::dashed, {}, 1.8},
      published{tr("published: k X at the line's slope, + c V with c = 2 √k"), k_third, Style::dashed, {}, 1.2};
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
  out += heading(msg("Measured against simulated")) +
         fmt::format("<div class=\"alone\">{}</div>\n", figure(c, msg("force over stiffness"), msg("stiffness k, N/mm"), msg("force, N")));
  out += html(law_rows(e)) + heading(msg("What it says, and what it cannot say")) + list(e.said.notes) + next_box(e.said) + cannot_tell(e.said);
  return page_html(title, out);
}

std::string protocol_html() {
  const Message steps[] = {
      msg("Switch on, wait ten minutes, and zero the load cell in air with the handpiece level."),
      msg("Sessions 1 and 4 with the handpiece level, 2 and 5 tilted by 30 degrees, 3 and 6 by 60 degrees: `posture_deg`."),
      msg("In each session the motion does it all: strokes in air at four speeds with reversals; four presses at four speeds, spindle off and on, "
          "each "
          "with a hold (one of 10 s), a reversal in contact at another speed, and a way back into air. When the measured speed is not written down, "
          "begin each session {} deeper than the last: a coarse encoder rounds a hold at one depth by the same error every time, which looks like a "
          "bend in the material.",
          as_mm(0.013, 3)),
      msg("A new site for each session, and the site of the first session again in the last: `site`. Approach at 0, 45, 90 and 135 degrees in turn: "
          "`approach_deg`."),
      msg("Sessions 2, 4 and 6 with water: `wet` 1. A new bur for session 4: `bur_id`. Count the removed volume: `removed_mm3`."),
      msg("Press once sideways in air in each session, if lateral forces are measured: `fy_n`, `fz_n`."),
      msg("Write beside the CSV a `rig.toml` with `position_quantum_mm`, `force_quantum_n`, `force_limit_n`, and `k_n_per_mm`, `c_n_s_per_mm` of the "
          "simulation.")};
  std::string out =
      heading(msg("A recording from which causes can be told apart")) +
      paragraph(msg("Six sessions of about a minute, each with the motion in the CSV file beside this page (height z above the surface; "
                    "the first touch is z = 0). Sample force and position together, 200 times a second or faster; write the measured "
                    "speed down too when the machine knows it: with a coarse encoder it is worth most.")) +
      "<ol>\n";
  for (const Message& step : steps) out += fmt::format("<li>{}</li>\n", with_code(step));
  out += fmt::format("</ol>\n<p>{}</p>\n",
                     with_code(msg("CSV columns: `session,t_s,x_mm,f_n` and any of `v_mm_s, spindle_rpm, wet, posture_deg, approach_deg, fy_n, fz_n, "
                                   "removed_mm3, bur_id, site, layer, temperature_c`; any other numeric column is tried as an explanation too. Then: "
                                   "`cavum explain recording.csv --out report.html`")));
  std::vector<Message> laws;
  for (const auto& m : explain::mechanisms()) laws.push_back(msg("{} ({}): {}", cavum::Term{m.words}, m.name, cavum::Term{m.separate}));
  return page_html(tr("Recording protocol for cavum explain"), out + heading(msg("What shows what")) + list(laws));
}

}  // namespace cavum::ui
