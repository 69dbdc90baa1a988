// A circuit: several exams that one class sits. Its marks come from the ledger, and people's beside
// them; what they say of the circuit comes from circuit_study.h and severity.h. Marks are percent
// of each exam's points. No mark is changed.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "grading/cohort/circuit_study.h"
#include "grading/cohort/class_figures.h"
#include "grading/cohort/severity.h"

namespace cavum::cohort {

struct NamedSeverity {
  std::string name;  ///< station, judge or exam
  Severity severity;
};
/// A candidate, over all exams.
struct RosterRow {
  std::string candidate;        ///< the school's own number
  std::vector<double> percent;  ///< by exam; below 0: not sat
  std::vector<std::string> verdict;
  double raw = 0.0;                ///< mean of those that were sat
  std::optional<double> adjusted;  ///< the same under stations and exams of middle severity
};
/// A person's mark of somebody who has no session of the exam that counts.
struct MarkLeftOut {
  std::string exam, candidate, judge;  ///< candidate: the school's own number, or what the file has
};

struct CircuitFigures {
  std::vector<std::string> exams;
  std::size_t candidates = 0, complete = 0;  ///< who sat any, all
  std::size_t unknown = 0;    ///< sessions whose candidate nobody knows any more: left out
  std::size_t simulated = 0;  ///< sessions of simulated operators, counted among people
  std::vector<MarkLeftOut> marks_left_out;
  std::optional<double> cut_percent;  ///< mean over the exams of what passes; none where results of
                                      ///< one exam were marked by different pass marks
  std::vector<Message> marked_differently;  ///< exams whose results were not marked alike
  std::optional<CircuitStudy> program, people;
  Message why_no_program, why_no_people;  ///< where there is none
  std::vector<NamedSeverity> stations, judges;
  Message why_no_stations, why_no_judges;
  /// With what stations and judges may do something together that these marks do not tell from
  /// severity: "candidate", "exam". Then none is named severe.
  std::vector<std::string> stations_indistinguishable_from, judges_indistinguishable_from;
  std::vector<RosterRow> roster;
};

/// `marks`: people's, by exam. Throws Error with fewer than two exams, with one twice, or when
/// nobody sat one.
[[nodiscard]] CircuitFigures circuit_figures(
    const records::Registry& registry, records::Identities& identities,
    const std::vector<std::string>& exams,
    const std::map<std::string, std::vector<HumanMark>>& marks);
[[nodiscard]] nlohmann::ordered_json to_json(const CircuitFigures& figures);
[[nodiscard]] Lines to_text(const CircuitFigures& figures);
/// candidate, each exam's percent and verdict, raw and adjusted mean; a row each.
[[nodiscard]] std::string roster_csv(const CircuitFigures& figures);

}  // namespace cavum::cohort
