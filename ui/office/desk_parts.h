// What the desk reads out of requests, and how it names the states of tickets and results.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grading/records/identities.h"
#include "grading/records/ledger.h"
#include "ui/office/roster.h"
#include "ui/office/wire.h"

namespace cavum::office {

/// Names by pseudonym.
[[nodiscard]] std::map<std::string, records::Identity> people_of(const records::Ledger& ledger);
/// `id` and `name` of a row's candidate, empty when nobody is behind it any more.
template <class Row>
void put_name(Row& row, const std::map<std::string, records::Identity>& people) {
  const auto found = people.find(row.candidate);
  row.id = found == people.end() ? "" : found->second.id;
  row.name = found == people.end() ? "" : found->second.name;
}

/// Points and the like; none where it is no number.
[[nodiscard]] inline std::optional<double> number_in(const nlohmann::json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

/// The same in the office's language.
/// In the office's language.
[[nodiscard]] std::string in_words(const Message& message);
[[nodiscard]] std::vector<std::string> shown_each(const std::vector<Message>& messages);
[[nodiscard]] std::vector<ShownFinding> shown_each(const records::Findings& findings);

/// The list of a request. Throws Error when it is none.
[[nodiscard]] Roster roster_of(const ClassList& asked);
[[nodiscard]] Preview shown_roster(const Roster& roster);

/// Of a scenario, its title in the office's language where the file has it. Throws Error when it
/// cannot be read.
[[nodiscard]] ExamFacts exam_facts(const std::string& scenario_file);

/// Notes of sessions, of each what one candidate is granted.
using Grants = std::vector<std::vector<std::pair<std::string, std::string>>>;
/// How long an exam of this scenario may take, for who of these has most time, in whole seconds; 0:
/// without limit.
[[nodiscard]] std::int64_t time_limit_s(const std::string& scenario_file, const Grants& grants);

/// What tickets are issued for.
struct IssueCommand {
  std::string scenario;  ///< file
  std::int64_t from_utc_ns = 0, until_utc_ns = 0;
};
/// The exam by its id, one of `exams`. Throws Error.
[[nodiscard]] IssueCommand issue_command(const std::string& exam, const std::string& from,
                                         const std::string& until,
                                         const std::vector<std::string>& exams);

/// What a request grants, as notes of a session; none: as before. Throws Error for a value that is
/// none.
[[nodiscard]] std::optional<std::vector<std::pair<std::string, std::string>>> grant_in(
    const MakeUp& asked);

/// A station's name by its key; empty where the ledger knows none.
[[nodiscard]] std::string station_name(const records::Registry& registry, const std::string& key);

/// made up, released, to decide, questioned, taken back, marked otherwise (one of `otherwise`:
/// Registry::marked_otherwise), not chosen, erased, or ready: it waits for its release.
[[nodiscard]] std::string state_of(const records::Registry& registry,
                                   const records::FiledSession& session,
                                   const std::set<std::uint64_t>& otherwise);

}  // namespace cavum::office
