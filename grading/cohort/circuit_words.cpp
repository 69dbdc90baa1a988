// The figures of a circuit in JSON, in words, and as a table of its candidates.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "grading/cohort/circuit.h"

namespace cavum::cohort {
namespace {

using Json = nlohmann::ordered_json;

constexpr int k_tasks_in_words = 12;
constexpr std::size_t k_names_in_words = 5;

Json coefficients(const Dependability& d) {
  return {{"g", d.g}, {"phi", d.phi}, {"relative_sem_percent", d.relative_sem}, {"absolute_sem_percent", d.absolute_sem}};
}

Json study_json(const std::optional<CircuitStudy>& s, const std::string& why_not) {
  if (!s)
    return {{"why_not", why_not}, {"mean_percent", nullptr}, {"components", nullptr},        {"not_told_apart", nullptr},         {"as_sat", nullptr},
            {"at_cut", nullptr},  {"by_exams", nullptr},     {"exams_for_phi_080", nullptr}, {"exams_for_phi_080_range", nullptr}};
  Json j{{"why_not", nullptr}, {"mean_percent", s->mean}, {"components", Json::array()}, {"not_told_apart", Json::array()}};
  for (std::size_t k = 0; k < s->design.effects.size(); ++k)
    j["components"].push_back({{"effect", s->design.names[k]}, {"variance", s->components.variance[k]}, {"standard_error", s->error[k]}});
  for (const auto& [effect, in] : s->merged) j["not_told_apart"].push_back({{"effect", effect}, {"stands_in", in}});
  j["as_sat"] = coefficients(s->as_sat);
  j["as_sat"]["candidates"] = s->marking.persons();
  j["as_sat"]["marks_each"] = s->marking.marks_each();
  j["as_sat"]["conditions"] = s->marking.conditions();
  j["as_sat"]["g_range"] = {s->range.g_low, s->range.g_high};
  j["as_sat"]["phi_range"] = {s->range.phi_low, s->range.phi_high};
  j["at_cut"] = s->at_cut ? Json{{"phi", s->at_cut->phi_at_cut}, {"consistency", s->at_cut->consistency}, {"accuracy", s->at_cut->accuracy}} : Json();
  j["by_exams"] = Json::array();
  for (const auto& d : s->by_tasks) j["by_exams"].push_back(coefficients(d));
  const auto whole = [](const std::optional<int>& n) { return n ? Json(*n) : Json(); };
  j["exams_for_phi_080"] = whole(s->for_enough.estimate);
  j["exams_for_phi_080_range"] = {whole(s->for_enough.low), whole(s->for_enough.high)};
  return j;
}

Json severities_json(const std::vector<NamedSeverity>& list, const std::string& why_not, const std::vector<std::string>& not_told_from) {
  Json j{{"why_not", why_not.empty() ? Json() : Json(why_not)}, {"not_told_from", not_told_from}, {"conditions", Json::array()}};
  for (const auto& s : list)
    j["conditions"].push_back({{"name", s.name},
                               {"marks", s.severity.marks},
                               {"severity_percent", s.severity.severity},
                               {"standard_error", s.severity.error},
                               {"beyond_chance", s.severity.beyond_chance}});
  return j;
}

/// A number of things: whole, or with one digit where it is a mean of unequal ones.
std::string number_text(double n) { return fixed(n, n == std::floor(n) ? 0 : 1); }

/// "the mean of 6 marks: 3 exams, 2 judges"
std::string marks_text(const CircuitStudy& s) {
  const Marking& m = s.marking;
  std::string text =
      fmt::format("  a candidate's mark is the mean of {} marks: {} exams", number_text(m.marks_each()), number_text(m.conditions()[0]));
  if (m.conditions().size() > 1) text += fmt::format(", {} judges{}", number_text(m.conditions()[1]), m.nested(2) ? " in each" : "");
  return text + (m.even() ? "\n" : ", on average\n");
}

std::string tasks_text(const TasksNeeded& n) {
  const auto number = [](const std::optional<int>& tasks) { return tasks ? fmt::format("{}", *tasks) : fmt::format("more than {}", k_most_tasks); };
  const std::string range = n.low == n.high ? std::string() : fmt::format(" ({} to {})", number(n.low), number(n.high));
  return fmt::format("\n  for phi 0.80: {} exams{}\n", number(n.estimate), range);
}

std::string study_text(const char* whose, const std::optional<CircuitStudy>& s, const std::string& why_not, std::optional<double> cut) {
  if (!s) return fmt::format("{}: no study: {}\n", whose, why_not);
  double total = 0;
  for (const double v : s->components.variance) total += std::max(0.0, v);
  std::string text = fmt::format("{}: where the differences come from\n", whose);
  for (std::size_t k = 0; k < s->design.effects.size(); ++k)
    text += fmt::format("  {:<32} {:>8} ± {:<8} {:>4} %\n", s->design.names[k], fixed(s->components.variance[k], 1), fixed(s->error[k], 1),
                        fixed(total > 0 ? 100 * std::max(0.0, s->components.variance[k]) / total : 0, 0));
  for (const auto& [effect, in] : s->merged) text += fmt::format("  {} cannot be told from {} by these marks, and stands in it\n", effect, in);
  text += marks_text(*s);
  text += fmt::format("  this circuit: phi {} ({} to {}), g {} ({} to {}); a mark is good to ± {} %\n", fixed(s->as_sat.phi, 2),
                      fixed(s->range.phi_low, 2), fixed(s->range.phi_high, 2), fixed(s->as_sat.g, 2), fixed(s->range.g_low, 2),
                      fixed(s->range.g_high, 2), fixed(s->as_sat.absolute_sem, 1));
  if (cut && s->at_cut)
    text += fmt::format("  at {} %: another such circuit would pass or fail {} % of the candidates alike; phi at the cut {}\n", fixed(*cut, 1),
                        fixed(100 * s->at_cut->consistency, 0), fixed(s->at_cut->phi_at_cut, 2));
  text += "  phi by the number of exams:";
  for (int n = 1; n <= k_tasks_in_words; ++n) text += fmt::format(" {}: {}", n, fixed(s->by_tasks[static_cast<std::size_t>(n - 1)].phi, 2));
  return text + tasks_text(s->for_enough);
}

std::string left_out_text(const std::vector<MarkLeftOut>& marks) {
  if (marks.empty()) return "";
  std::string names;
  for (std::size_t i = 0; i < std::min(marks.size(), k_names_in_words); ++i)
    names += fmt::format("{}{} ({})", i > 0 ? ", " : "", one_line(marks[i].candidate), one_line(marks[i].exam));
  if (marks.size() > k_names_in_words) names += fmt::format(" and {} more", marks.size() - k_names_in_words);
  return fmt::format("people's marks left out: {}, of candidates without a session of that exam that counts: {}\n", marks.size(), names);
}

std::string severity_text(const char* what, const std::vector<NamedSeverity>& list, const std::string& why_not,
                          const std::vector<std::string>& not_told_from) {
  if (!why_not.empty()) return fmt::format("{}: not compared: {}\n", what, why_not);
  std::string text;
  for (const auto& s : list)
    text += fmt::format("  {:<24} takes {:>5} ± {} % of {} marks{}\n", one_line(s.name), fixed(s.severity.severity, 1), fixed(s.severity.error, 1),
                        s.severity.marks, s.severity.beyond_chance ? ": more than chance gives" : "");
  for (const auto& other : not_told_from)
    text += other == "exam"
                ? "  none is called severe: these marks do not tell it from what one exam and it do together; compare them in two exams at least\n"
                : "  none is called severe: these marks do not tell it from what a candidate and it do together; let more candidates be "
                  "marked by two of them\n";
  return text.empty() ? "" : fmt::format("{}, beside their mean\n", what) + text;
}

}  // namespace

nlohmann::ordered_json to_json(const CircuitFigures& f) {
  Json roster = Json::array();
  for (const RosterRow& r : f.roster) {
    Json by_exam = Json::object();
    for (std::size_t e = 0; e < f.exams.size(); ++e)
      by_exam[f.exams[e]] = r.percent[e] < 0 ? Json() : Json{{"percent", r.percent[e]}, {"verdict", r.verdict[e]}};
    roster.push_back(
        {{"candidate", r.candidate}, {"exams", by_exam}, {"raw_percent", r.raw}, {"adjusted_percent", r.adjusted ? Json(*r.adjusted) : Json()}});
  }
  Json left_out = Json::array();
  for (const MarkLeftOut& m : f.marks_left_out) left_out.push_back({{"exam", m.exam}, {"candidate", m.candidate}, {"judge", m.judge}});
  return {{"exams", f.exams},
          {"candidates", f.candidates},
          {"complete", f.complete},
          {"unknown", f.unknown},
          {"simulated", f.simulated},
          {"marks_left_out", left_out},
          {"cut_percent", f.cut_percent},
          {"program", study_json(f.program, f.why_no_program)},
          {"people", study_json(f.people, f.why_no_people)},
          {"stations", severities_json(f.stations, f.why_no_stations, f.stations_not_told_from)},
          {"judges", severities_json(f.judges, f.why_no_judges, f.judges_not_told_from)},
          {"roster", roster}};
}

std::string to_text(const CircuitFigures& f) {
  std::string text = fmt::format("a circuit of {} exams: {} candidates, {} of them sat all; percent of an exam's points\n", f.exams.size(),
                                 f.candidates, f.complete);
  if (f.simulated > 0) text += fmt::format("{} sessions are of simulated operators, and count among people\n", f.simulated);
  if (f.unknown > 0) text += fmt::format("{} sessions left out: nobody knows any more whose they are\n", f.unknown);
  text += left_out_text(f.marks_left_out);
  if (f.candidates < k_enough_for_alpha) text += fmt::format("few: {} candidates, under {} it is a rough guess\n", f.candidates, k_enough_for_alpha);
  text += study_text("the program's marks", f.program, f.why_no_program, f.cut_percent);
  text += study_text("people's marks", f.people, f.why_no_people, f.cut_percent);
  text += severity_text("stations", f.stations, f.why_no_stations, f.stations_not_told_from);
  text += severity_text("judges", f.judges, f.why_no_judges, f.judges_not_told_from);
  return text + "No mark was changed. Adjusted ones, beside the raw: --out roster.csv\n";
}

std::string roster_csv(const CircuitFigures& f) {
  std::string text = "candidate";
  for (const auto& e : f.exams) text += "," + csv_field(e + " percent") + "," + csv_field(e + " verdict");
  text += ",raw percent,adjusted percent\n";
  for (const RosterRow& r : f.roster) {
    text += csv_field(r.candidate);
    for (std::size_t e = 0; e < f.exams.size(); ++e) text += "," + (r.percent[e] < 0 ? "" : fixed(r.percent[e], 2)) + "," + csv_field(r.verdict[e]);
    text += "," + fixed(r.raw, 2) + "," + (r.adjusted ? fixed(*r.adjusted, 2) : "") + "\n";
  }
  return text;
}

}  // namespace cavum::cohort
