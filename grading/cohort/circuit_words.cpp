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
  return {{"g", d.g},
          {"phi", d.phi},
          {"relative_sem_percent", d.relative_sem},
          {"absolute_sem_percent", d.absolute_sem}};
}

Json study_json(const std::optional<CircuitStudy>& s, const Message& why_not) {
  if (!s)
    return {{"why_not", english_text(why_not)},
            {"mean_percent", nullptr},
            {"components", nullptr},
            {"indistinguishable", nullptr},
            {"as_sat", nullptr},
            {"at_cut", nullptr},
            {"by_exams", nullptr},
            {"exams_for_phi_080", nullptr},
            {"exams_for_phi_080_range", nullptr}};
  Json j{{"why_not", nullptr},
         {"mean_percent", s->mean},
         {"components", Json::array()},
         {"indistinguishable", Json::array()}};
  for (std::size_t k = 0; k < s->design.effects.size(); ++k)
    j["components"].push_back({{"effect", s->design.names[k]},
                               {"variance", s->components.variance[k]},
                               {"standard_error", s->error[k]}});
  for (const auto& [effect, in] : s->merged)
    j["indistinguishable"].push_back({{"effect", effect}, {"stands_in", in}});
  j["as_sat"] = coefficients(s->as_sat);
  j["as_sat"]["candidates"] = s->marking.persons();
  j["as_sat"]["marks_each"] = s->marking.marks_each();
  j["as_sat"]["conditions"] = s->marking.conditions();
  j["as_sat"]["g_range"] = {s->range.g_low, s->range.g_high};
  j["as_sat"]["phi_range"] = {s->range.phi_low, s->range.phi_high};
  j["at_cut"] = s->at_cut ? Json{{"phi", s->at_cut->phi_at_cut},
                                 {"consistency", s->at_cut->consistency},
                                 {"accuracy", s->at_cut->accuracy}}
                          : Json();
  j["by_exams"] = Json::array();
  for (const auto& d : s->by_tasks) j["by_exams"].push_back(coefficients(d));
  const auto whole = [](const std::optional<int>& n) { return n ? Json(*n) : Json(); };
  j["exams_for_phi_080"] = whole(s->for_enough.estimate);
  j["exams_for_phi_080_range"] = {whole(s->for_enough.low), whole(s->for_enough.high)};
  return j;
}

Json severities_json(const std::vector<NamedSeverity>& list, const Message& why_not,
                     const std::vector<std::string>& indistinguishable_from) {
  Json j{{"why_not", why_not.empty() ? Json() : Json(english_text(why_not))},
         {"indistinguishable_from", indistinguishable_from},
         {"conditions", Json::array()}};
  for (const auto& s : list)
    j["conditions"].push_back({{"name", s.name},
                               {"marks", s.severity.marks},
                               {"severity_percent", s.severity.severity},
                               {"standard_error", s.severity.error},
                               {"beyond_chance", s.severity.beyond_chance}});
  return j;
}

/// A number of things: whole, or with one digit where it is a mean of unequal ones.
Number number_of(double n) { return as_number(n, n == std::floor(n) ? 0 : 1); }

/// "the mean of 6 marks: 3 exams, 2 judges"
Message marks_text(const CircuitStudy& s) {
  const Marking& m = s.marking;
  const Number each = number_of(m.marks_each()), exams = number_of(m.conditions()[0]);
  const bool judges = m.conditions().size() > 1;
  const Number by = judges ? number_of(m.conditions()[1]) : Number{};
  const Message mean =
      !judges ? msg("a candidate's mark is the mean of {} marks: {} exams", each, exams)
      : m.nested(2)
          ? msg("a candidate's mark is the mean of {} marks: {} exams, {} judges in each", each,
                exams, by)
          : msg("a candidate's mark is the mean of {} marks: {} exams, {} judges", each, exams, by);
  return m.even() ? mean : msg("{}, on average", mean);
}

Message tasks_text(const TasksNeeded& n) {
  const auto number = [](const std::optional<int>& tasks) {
    return tasks ? msg("{}", *tasks) : msg("more than {}", k_max_tasks);
  };
  return n.low == n.high ? msg("for phi {}: {} exams", as_number(0.8, 2), number(n.estimate))
                         : msg("for phi {}: {} exams ({} to {})", as_number(0.8, 2),
                               number(n.estimate), number(n.low), number(n.high));
}

void add_study(Lines& out, const Message& whose, const std::optional<CircuitStudy>& s,
               const Message& why_not, std::optional<double> cut) {
  if (!s) return out.add(msg("{}: no study: {}", whose, why_not));
  double total = 0;
  for (const double v : s->components.variance) total += std::max(0.0, v);
  out.add(msg("{}: where the differences come from", whose));
  for (std::size_t k = 0; k < s->design.effects.size(); ++k)
    out.row({msg("{}", Term{s->design.names[k]}),
             msg("{}", Number{s->components.variance[k], Unit::none, 1, s->error[k]}),
             msg("{}", as_percent(total > 0 ? 100 * std::max(0.0, s->components.variance[k]) / total
                                            : 0))},
            2);
  for (const auto& [effect, in] : s->merged)
    out.add(
        msg("{} cannot be told from {} by these marks, and stands in it", Term{effect}, Term{in}),
        2);
  out.add(marks_text(*s), 2);
  out.add(
      msg("this circuit: phi {} ({} to {}), g {} ({} to {}); a mark is good to ± {}",
          as_number(s->as_sat.phi, 2), as_number(s->range.phi_low, 2),
          as_number(s->range.phi_high, 2), as_number(s->as_sat.g, 2), as_number(s->range.g_low, 2),
          as_number(s->range.g_high, 2), as_percent(s->as_sat.absolute_sem, 1)),
      2);
  if (cut && s->at_cut)
    out.add(
        msg("at {}: another such circuit would pass or fail {} of the candidates alike; phi at the cut {}",
            as_percent(*cut, 1), as_percent(100 * s->at_cut->consistency),
            as_number(s->at_cut->phi_at_cut, 2)),
        2);
  List by_number;
  for (int n = 1; n <= k_tasks_in_words; ++n)
    by_number.items.push_back(
        msg("{}: {}", n, as_number(s->by_tasks[static_cast<std::size_t>(n - 1)].phi, 2)));
  out.add(msg("phi by the number of exams: {}", by_number), 2);
  out.add(tasks_text(s->for_enough), 2);
}

void add_left_out(Lines& out, const std::vector<MarkLeftOut>& marks) {
  if (marks.empty()) return;
  List names;
  for (std::size_t i = 0; i < std::min(marks.size(), k_names_in_words); ++i)
    names.items.push_back(msg("{} ({})", marks[i].candidate, marks[i].exam));
  if (marks.size() > k_names_in_words)
    names.items.push_back(msg("{} more", marks.size() - k_names_in_words));
  out.add(msg(
      "people's marks left out: {}, of candidates without a session of that exam that counts: {}",
      marks.size(), names));
}

/// `title` stands above what there is.
void add_severity(Lines& out, const Message& what, const Message& title,
                  const std::vector<NamedSeverity>& list, const Message& why_not,
                  const std::vector<std::string>& indistinguishable_from) {
  if (!why_not.empty()) return out.add(msg("{}: not compared: {}", what, why_not));
  if (list.empty() && indistinguishable_from.empty()) return;
  out.add(title);
  for (const auto& s : list)
    out.row({Name{s.name},
             msg("takes {} of {} marks",
                 Number{s.severity.severity, Unit::percent, 1, s.severity.error}, s.severity.marks),
             s.severity.beyond_chance ? msg("more than chance gives") : Message()},
            2);
  for (const auto& other : indistinguishable_from)
    out.add(
        other == "exam"
            ? msg("none is called severe: these marks do not tell it from what one exam and it do together; compare them in two exams "
                  "at least")
            : msg("none is called severe: these marks do not tell it from what a candidate and it do together; let more candidates be "
                  "marked by two of them"),
        2);
}

}  // namespace

nlohmann::ordered_json to_json(const CircuitFigures& f) {
  Json roster = Json::array();
  for (const RosterRow& r : f.roster) {
    Json by_exam = Json::object();
    for (std::size_t e = 0; e < f.exams.size(); ++e)
      by_exam[f.exams[e]] =
          r.percent[e] < 0 ? Json() : Json{{"percent", r.percent[e]}, {"verdict", r.verdict[e]}};
    roster.push_back({{"candidate", r.candidate},
                      {"exams", by_exam},
                      {"raw_percent", r.raw},
                      {"adjusted_percent", r.adjusted ? Json(*r.adjusted) : Json()}});
  }
  Json marked_differently = Json::array();
  for (const Message& m : f.marked_differently) marked_differently.push_back(english_text(m));
  Json left_out = Json::array();
  for (const MarkLeftOut& m : f.marks_left_out)
    left_out.push_back({{"exam", m.exam}, {"candidate", m.candidate}, {"judge", m.judge}});
  return {{"exams", f.exams},
          {"candidates", f.candidates},
          {"complete", f.complete},
          {"unknown", f.unknown},
          {"simulated", f.simulated},
          {"marks_left_out", left_out},
          {"cut_percent", f.cut_percent ? Json(*f.cut_percent) : Json()},
          {"marked_differently", marked_differently},
          {"program", study_json(f.program, f.why_no_program)},
          {"people", study_json(f.people, f.why_no_people)},
          {"stations",
           severities_json(f.stations, f.why_no_stations, f.stations_indistinguishable_from)},
          {"judges", severities_json(f.judges, f.why_no_judges, f.judges_indistinguishable_from)},
          {"roster", roster}};
}

Lines to_text(const CircuitFigures& f) {
  Lines out;
  out.add(
      msg("a circuit of {} exams: {} candidates, {} of them sat all; percent of an exam's points",
          f.exams.size(), f.candidates, f.complete));
  if (f.simulated > 0)
    out.add(msgn("{} session is of a simulated operator, and counts among people",
                 "{} sessions are of simulated operators, and count among people",
                 static_cast<std::int64_t>(f.simulated), f.simulated));
  if (f.unknown > 0)
    out.add(msgn("{} session left out: nobody knows any more whose it is",
                 "{} sessions left out: nobody knows any more whose they are",
                 static_cast<std::int64_t>(f.unknown), f.unknown));
  for (const Message& exam : f.marked_differently) out.add(exam);
  add_left_out(out, f.marks_left_out);
  if (f.candidates < k_enough_for_alpha)
    out.add(msgn("few: {} candidate, under {} it is a rough guess",
                 "few: {} candidates, under {} it is a rough guess",
                 static_cast<std::int64_t>(f.candidates), f.candidates, k_enough_for_alpha));
  add_study(out, msg("the program's marks"), f.program, f.why_no_program, f.cut_percent);
  add_study(out, msg("people's marks"), f.people, f.why_no_people, f.cut_percent);
  add_severity(out, msg("stations"), msg("stations, beside their mean"), f.stations,
               f.why_no_stations, f.stations_indistinguishable_from);
  add_severity(out, msg("judges"), msg("judges, beside their mean"), f.judges, f.why_no_judges,
               f.judges_indistinguishable_from);
  out.add(msg("No mark was changed. Adjusted ones, beside the raw: --out roster.csv"));
  return out;
}

std::string roster_csv(const CircuitFigures& f) {
  std::string text = "candidate";
  for (const auto& e : f.exams)
    text += "," + csv_field(e + " percent") + "," + csv_field(e + " verdict");
  text += ",raw percent,adjusted percent\n";
  for (const RosterRow& r : f.roster) {
    text += csv_field(r.candidate);
    for (std::size_t e = 0; e < f.exams.size(); ++e)
      text +=
          "," + (r.percent[e] < 0 ? "" : fixed(r.percent[e], 2)) + "," + csv_field(r.verdict[e]);
    text += "," + fixed(r.raw, 2) + "," + (r.adjusted ? fixed(*r.adjusted, 2) : "") + "\n";
  }
  return text;
}

}  // namespace cavum::cohort
