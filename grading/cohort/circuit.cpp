#include "grading/cohort/circuit.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "grading/cohort/judge_names.h"

namespace cavum::cohort {
namespace {

/// Numbers for names, in the order in which they come.
class Numbered {
 public:
  std::uint32_t of(const std::string& name) {
    const auto [at, is_new] = number_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
    if (is_new) names_.push_back(name);
    return at->second;
  }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

 private:
  std::map<std::string, std::uint32_t> number_;
  std::vector<std::string> names_;
};

/// A mark, with everything that a study may ask of it.
struct CircuitMark {
  std::uint32_t candidate = 0, exam = 0, station = 0, judge = 0;
  double percent = 0.0;
};

/// Runs what may be refused, and keeps why.
template <class Result, class Make>
void when_possible(Result& out, Message& why_not, const Make& make) {
  try {
    out = make();
  } catch (const Error& e) {
    why_not = e.message();
  }
}

/// Severities of facet 2 (of three: candidate, exam, station or judge), with their names.
std::vector<NamedSeverity> named(const SeverityStudy& study,
                                 const std::vector<std::string>& names) {
  std::vector<NamedSeverity> out;
  for (std::size_t i = 0; i < study.facets[1].conditions.size(); ++i)
    out.push_back({names[i], study.facets[1].conditions[i]});
  return out;
}

/// With what facet 2 may do something together that looks like severity.
std::vector<std::string> indistinguishable_from(const SeverityStudy& study) {
  std::vector<std::string> names;
  for (const std::uint32_t facet : study.facets[1].indistinguishable_from)
    names.emplace_back(facet == 1U ? noop("candidate") : noop("exam"));
  return names;
}

/// What the exams of the ledger say of one class.
class Collected {
 public:
  Collected(const records::Registry& registry, records::Identities& identities,
            CircuitFigures& figures)
      : registry_(registry), identities_(identities), figures_(figures) {}

  void add(const std::string& exam, const std::vector<HumanMark>& by_people) {
    const auto number = static_cast<std::uint32_t>(figures_.exams.size());
    figures_.exams.push_back(exam);
    const auto sat = counting_sessions(registry_, exam);
    const double points = points_of_exam(registry_, exam);
    const auto marked_by = cohort::marked_by(sat);
    pass_percent_.push_back(one_pass_percent(marked_by));
    if (marked_by.size() > 1)
      figures_.marked_differently.push_back(msg("{}: {}", exam, marked_by_words(marked_by)));
    std::map<std::string, std::uint32_t> person_of;
    for (const auto& [pseudonym, session] : sat) {
      const auto known = identities_.of_pseudonym(pseudonym);
      if (!known) {
        ++figures_.unknown;
        continue;
      }
      if (!session->simulated.empty()) ++figures_.simulated;
      const auto& score = session->result->at("score");
      const CircuitMark m{candidates.of(known->id), number,
                          stations.of(station_label(registry_, session->station_key)), 0,
                          100 * score.at("points").get<double>() / score.at("max").get<double>()};
      person_of[pseudonym] = m.candidate;
      program.push_back(m);
      verdict[{m.candidate, number}] = session->result->value("verdict", "");
    }
    for (const HumanMark& h : by_people) {
      if (const auto at = person_of.find(h.candidate); at != person_of.end()) {
        people.push_back(
            {at->second, marked.of(exam), 0, judges.of(h.judge), 100 * h.points / points});
        continue;
      }
      const auto known = identities_.of_pseudonym(h.candidate);
      figures_.marks_left_out.push_back({exam, known ? known->id : h.candidate, h.judge});
    }
  }
  /// None where one of the exams has none.
  [[nodiscard]] std::optional<double> cut_percent() const {
    std::vector<double> all;
    for (const auto& percent : pass_percent_) {
      if (!percent) return std::nullopt;
      all.push_back(*percent);
    }
    return mean(all);
  }

  Numbered candidates, stations, judges;
  Numbered marked;  // exams that people marked
  std::vector<CircuitMark> program, people;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> verdict;

 private:
  const records::Registry& registry_;
  records::Identities& identities_;
  CircuitFigures& figures_;
  std::vector<std::optional<double>> pass_percent_;  // by exam
};

void put_roster(CircuitFigures& f, const Collected& all,
                const std::optional<SeverityStudy>& severity) {
  const std::size_t exams = f.exams.size();
  for (const auto& name : all.candidates.names())
    f.roster.push_back(
        {name, std::vector<double>(exams, -1.0), std::vector<std::string>(exams), 0.0, {}});
  for (const CircuitMark& m : all.program) {
    RosterRow& row = f.roster[m.candidate];
    row.percent[m.exam] = m.percent;
    row.verdict[m.exam] = all.verdict.at({m.candidate, m.exam});
  }
  for (std::size_t p = 0; p < f.roster.size(); ++p) {
    RosterRow& row = f.roster[p];
    std::vector<double> sat;
    for (const double v : row.percent)
      if (v >= 0) sat.push_back(v);
    row.raw = mean(sat);
    f.complete += sat.size() == exams ? 1 : 0;
    if (severity) row.adjusted = severity->persons[p].adjusted;
  }
  f.candidates = f.roster.size();
  std::sort(f.roster.begin(), f.roster.end(),
            [](const RosterRow& a, const RosterRow& b) { return a.candidate < b.candidate; });
}

}  // namespace

CircuitFigures circuit_figures(const records::Registry& registry, records::Identities& identities,
                               const std::vector<std::string>& exams,
                               const std::map<std::string, std::vector<HumanMark>>& marks) {
  if (exams.size() < 2)
    throw Error(msg("a circuit"), msg("has two exams at least"), msg("name them with --exams A,B"));
  if (std::set<std::string>(exams.begin(), exams.end()).size() != exams.size())
    throw Error(msg("a circuit"), msg("names an exam twice"), msg("name each once"));
  CircuitFigures f;
  Collected all(registry, identities, f);
  for (const auto& exam : exams) {
    const auto by_people = marks.find(exam);
    all.add(exam, by_people == marks.end() ? std::vector<HumanMark>() : by_people->second);
  }
  require_distinct_judges({all.judges.names().begin(), all.judges.names().end()},
                          msg("people's marks"));
  f.cut_percent = all.cut_percent();

  std::vector<StudyMark> by_exam, by_station, by_judge;
  for (const auto& m : all.program) {
    by_exam.push_back({{m.candidate, m.exam}, m.percent});
    by_station.push_back({{m.candidate, m.exam, m.station}, m.percent});
  }
  for (const auto& m : all.people) by_judge.push_back({{m.candidate, m.exam, m.judge}, m.percent});
  when_possible(f.program, f.why_no_program, [&] {
    return study_circuit(crossed_design({"candidate", "exam"}), by_exam, f.cut_percent);
  });
  if (all.people.empty())
    f.why_no_people = msg("no marks of people");
  else
    when_possible(f.people, f.why_no_people,
                  [&] { return study_of_judges(by_judge, f.cut_percent); });

  std::optional<SeverityStudy> severity, of_judges;
  when_possible(severity, f.why_no_stations, [&] { return study_severity(by_station); });
  if (severity)
    f.stations = named(*severity, all.stations.names()),
    f.stations_indistinguishable_from = indistinguishable_from(*severity);
  if (!by_judge.empty()) {
    when_possible(of_judges, f.why_no_judges, [&] { return study_severity(by_judge); });
    if (of_judges)
      f.judges = named(*of_judges, all.judges.names()),
      f.judges_indistinguishable_from = indistinguishable_from(*of_judges);
  }
  put_roster(f, all, severity);
  return f;
}

}  // namespace cavum::cohort
