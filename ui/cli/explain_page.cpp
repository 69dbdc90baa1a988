#include "ui/cli/explain_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "ui/cli/explain_charts.h"
#include "ui/language/language.h"
#include "ui/language/say.h"

namespace cavum::ui {
namespace {

using explain::Verdict;
using Style = ChartSeries::Style;

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

std::string gain_chart(const explain::Gain& g) {
  const double most = std::max({g.base_rmse_n, g.extended_rmse_n, g.noise_floor_n, 1e-9});
  const auto bar = [&](const Message& name, double value, const char* colour) {
    return bar_row(name, value / most, colour, msg("{}", as_n(value, 4)));
  };
  return fmt::format("<table class=\"bars\">{}{}{}</table>\n",
                     bar(msg("simulation as it is"), g.base_rmse_n, k_before),
                     bar(msg("with the causes"), g.extended_rmse_n, k_after),
                     bar(msg("noise of the measurement"), g.noise_floor_n, k_measured));
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
                                       : msg("{}, or one that fits as well: {}", cause,
                                             as_percent(100.0 * c.set_probability)));
  }
  if (e.unexplained && !causes.empty())
    causes.push_back(msg("something that no mechanism here describes"));
  return fmt::format("<div class=\"verdict\" data-verdict=\"{}\"><b>{}</b><br>{}{}</div>\n",
                     verdict_name(e.verdict), html(word_of(e.verdict)), html(words),
                     causes.empty() ? "" : list(causes));
}

std::string next_box(const explain::Explanation& e) {
  return fmt::format("{}<p class=\"next\">{}</p>\n", heading(msg("The next experiment")),
                     html(e.next_experiment.what()));
}

/// What the cause gains on each session that the fit had not seen.
std::string sessions_table(const explain::Explanation& e, const explain::Cause& c) {
  const std::vector<Message> names = fold_names(e);
  double most = 1e-9;
  for (const double g : c.by_fold_percent) most = std::max(most, std::fabs(g));
  std::string out = fmt::format("<table class=\"bars sessions\"><caption>{}</caption>",
                                html(msg("Error that it takes away from each session not seen")));
  for (std::size_t f = 0; f < names.size() && f < c.by_fold_percent.size(); ++f) {
    const double g = c.by_fold_percent[f];
    out += bar_row(names[f], std::fabs(g) / most, g < 0.0 ? k_before : k_after,
                   msg("{}", as_percent(g, 1)));
  }
  return out + "</table>\n";
}

std::string causes_html(const explain::Explanation& e) {
  std::string out;
  for (const auto& c : e.causes) {
    const auto& m = explain::mechanism_at(c.term.mechanism);
    const std::string said = html(to_text(c));
    out += fmt::format("<h3>{}</h3>\n", html(heading_of(c)));
    out += e.after ? fmt::format("<div class=\"pair\"><div>{}</div><div>{}{}</div></div>\n",
                                 cause_chart(c, *e.after), said, sessions_table(e, c))
                   : said;
    out += paragraph(m.term != nullptr ? msg("An exam can feel it.")
                                       : msg("It belongs to this measurement, not to the tooth."));
    if (m.separate != nullptr)
      out += fmt::format("<p class=\"next\">{}</p>\n",
                         html(msg("To be surer: {}", cavum::Term{m.separate})));
  }
  if (e.unexplained) out += paragraph(unexplained_words(*e.unexplained));
  if (const Message left = left_over_words(e); !left.empty()) out += paragraph(left);
  return out.empty() ? paragraph(msg("No cause was found.")) : out;
}

std::string cannot_tell(const explain::Explanation& e) {
  std::string out = heading(msg("What these data cannot tell"));
  if (e.not_testable.empty())
    return out + paragraph(msg("Every mechanism could have shown itself."));
  std::vector<std::pair<Message, std::vector<Message>>> by_reason;
  for (const auto& n : e.not_testable) {
    const auto& m = explain::mechanism_at(explain::known_mechanism(n.mechanism));
    auto group = std::find_if(by_reason.begin(), by_reason.end(),
                              [&](const auto& r) { return r.first == n.reason; });
    if (group == by_reason.end()) group = by_reason.insert(group, {n.reason, {}});
    group->second.push_back(
        msg("{} ({}): {}", cavum::Term{m.words}, m.name, cavum::Term{m.separate}));
  }
  for (const auto& [reason, group] : by_reason) {
    const auto n = static_cast<std::int64_t>(group.size());
    out += fmt::format("<p><b>{}</b></p>\n<details{}><summary>{}</summary>\n{}</details>\n",
                       html(reason), n > 8 ? "" : " open",
                       html(msgn("{} mechanism, and what would show it",
                                 "{} mechanisms, and what would show them", n, n)),
                       list(group));
  }
  return out;
}

/// The table is long: what gains most stands in sight.
std::string candidates_html(const explain::Explanation& e) {
  constexpr std::size_t k_shown = 8;
  auto candidates = e.candidates;
  std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return std::pair(a.testable, a.gain) > std::pair(b.testable, b.gain);
  });
  const std::string begin =
      fmt::format("<table><thead><tr><th>{}</th><th class=\"n\">{}</th></tr></thead>\n",
                  html(msg("mechanism")), html(msg("fall of chi²")));
  std::string shown = begin, rest = begin;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto& m = explain::mechanism_at(candidates[i].hypothesis.term.mechanism);
    (i < k_shown ? shown : rest) += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{}</td></tr>\n",
        html(msg("{} ({})", cavum::Term{m.words}, m.name)),
        html(candidates[i].testable ? msg("{}", as_number(std::max(0.0, candidates[i].gain), 0))
                                    : msg("not testable")));
  }
  std::string out = heading(msg("What each mechanism would gain alone")) + shown + "</table>\n";
  if (candidates.size() > k_shown)
    out += fmt::format("<details><summary>{}</summary>\n{}</table></details>\n",
                       html(msg("the other mechanisms: {}", candidates.size() - k_shown)), rest);
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

std::string explanation_html(const explain::Explanation& e, const std::string& title) {
  std::string out = verdict_box(e, in_words(e));
  if (e.verdict == Verdict::data_fault)
    return page_html(title, out + list(texts_of(e.data_faults)) + next_box(e));
  out += heading(msg("What the simulation gets wrong")) + causes_html(e);
  out += heading(msg("What fixing it gains")) +
         paragraph(msg("Root mean square error on sessions that the fit had not seen.")) +
         gain_chart(e.gain) + html(gain_words(e)) + next_box(e);
  if (e.before && e.after) {
    out += heading(msg("Measured against simulated")) + force_charts(*e.before, *e.after);
    out +=
        heading(msg("The residual against each suspect")) +
        paragraph(msg(
            "What moves the residual most comes first. Means over equal shares of the rows with two standard errors; all charts on one "
            "scale.")) +
        "<div class=\"pair\">\n";
    out += residual_charts(*e.before, *e.after);
    out += "</div>\n" + cannot_tell(e) + candidates_html(e);
  }
  if (!e.notes.empty()) out += heading(msg("Notes")) + list(words_of(e.notes));
  return page_html(title, out);
}

std::string table_html(const explain::TableExplanation& e, const std::string& title) {
  std::string out = verdict_box(e.explanation, in_words(e));
  if (e.explanation.verdict == Verdict::data_fault)
    return page_html(title,
                     out + list(texts_of(e.explanation.data_faults)) + next_box(e.explanation));
  const double most = *std::max_element(e.table.k_n_per_mm.begin(), e.table.k_n_per_mm.end());
  Chart c;
  c.height_px = 360;
  c.width_px = k_narrow_px;
  ChartSeries points{tr("the table"), "#222222", Style::dots, {}, 1.8},
      line{tr("k X and an intercept"), k_after, Style::line, {}, 1.8},
      voigt{tr("Voigt law alone, best fit: k X + c V, c ~ √k"), k_before, Style::dashed, {}, 1.8},
      published{tr("published: k X at the line's slope, + c V with c = 2 √k"),
                k_third,
                Style::dashed,
                {},
                1.2};
  double top = 0.0;
  for (std::size_t i = 0; i < e.table.f_n.size(); ++i)
    points.points.push_back({e.table.k_n_per_mm[i], e.table.f_n[i]}),
        top = std::max(top, e.table.f_n[i]);
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
         fmt::format(
             "<div class=\"alone\">{}</div>\n",
             figure(c, msg("force over stiffness"), msg("stiffness k, N/mm"), msg("force, N")));
  out += html(law_rows(e)) + heading(msg("What it says, and what it cannot say")) +
         list(words_of(e.explanation.notes)) + next_box(e.explanation) + cannot_tell(e.explanation);
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
      paragraph(msg(
          "Six sessions of about a minute, each with the motion in the CSV file beside this page (height z above the surface; "
          "the first touch is z = 0). Sample force and position together, 200 times a second or faster; write the measured "
          "speed down too when the machine knows it: with a coarse encoder it is worth most.")) +
      "<ol>\n";
  for (const Message& step : steps) out += fmt::format("<li>{}</li>\n", with_code(step));
  out += fmt::format(
      "</ol>\n<p>{}</p>\n",
      with_code(msg(
          "CSV columns: `session,t_s,x_mm,f_n` and any of `v_mm_s, spindle_rpm, wet, posture_deg, approach_deg, fy_n, fz_n, "
          "removed_mm3, bur_id, site, layer, temperature_c`; any other numeric column is tried as an explanation too. Then: "
          "`cavum explain recording.csv --out report.html`")));
  std::vector<Message> laws;
  for (const auto& m : explain::mechanisms())
    laws.push_back(msg("{} ({}): {}", cavum::Term{m.words}, m.name, cavum::Term{m.separate}));
  return page_html(tr("Recording protocol for cavum explain"),
                   out + heading(msg("What shows what")) + list(laws));
}

}  // namespace cavum::ui
