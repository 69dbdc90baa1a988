// What the desk reads out of requests, and how it names the states of tickets and results.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "grading/ledger/identities.h"
#include "grading/ledger/ledger.h"
#include "ui/office/roster.h"

namespace cavum::office {

/// Names by pseudonym.
[[nodiscard]] std::map<std::string, ledger::Identity> people_of(const ledger::Ledger& ledger);
/// {"id","name"} of a pseudonym, empty when nobody is behind it any more.
void put_name(nlohmann::json& row, const std::map<std::string, ledger::Identity>& people, const std::string& pseudonym);

/// The same in the office's language.
[[nodiscard]] std::vector<std::string> shown_each(std::vector<std::string> english);

/// The list of a request: {"base64","answers"}. Throws Error when it is none.
[[nodiscard]] Roster roster_of(const nlohmann::json& asked);
[[nodiscard]] nlohmann::json shown_roster(const Roster& roster);

/// {"id","title","file","time_limit_s"} of a scenario, its title in the office's language where the file has it. Throws Error when it cannot be read.
[[nodiscard]] nlohmann::json exam_facts(const std::string& scenario_file);

/// Notes of sessions, of each what one candidate is granted.
using Grants = std::vector<std::vector<std::pair<std::string, std::string>>>;
/// How long an exam of this scenario may take, for who of these has most time, in whole seconds; 0: without limit.
[[nodiscard]] std::int64_t time_limit_s(const std::string& scenario_file, const Grants& grants);

/// What tickets are issued for.
struct IssueWish {
  std::string scenario;  ///< file
  std::int64_t from_utc_ns = 0, until_utc_ns = 0;
  bool begun_at_ledger = false;
  bool another = false;  ///< also to those who have a ticket that is good, or have sat the exam
  std::string reason;
  std::size_t at_once = 0;    ///< candidates of a sitting, in the list's order; 0: all in one
  std::int64_t apart_ns = 0;  ///< from the beginning of a sitting to the next one's
  bool overlap = false;       ///< one may begin while the last is still sat
};
/// {"exam","from","until","begin_at_office","another","reason"}: the exam by its id, one of `exams`. With "at_once" (1 to 10,000) sittings follow
/// each other "minutes_apart" (1 to 10,080), and "overlap" says that one may begin while the last is still sat. Throws Error.
[[nodiscard]] IssueWish issue_wish(const nlohmann::json& asked, const std::vector<std::string>& exams);

/// What a request grants, as notes of a session: `accommodations` is "none", "these" (with extra_time_percent, extra_time_s, left_handed,
/// high_contrast, each where it is granted) or "as before": nothing is returned then. Throws Error for another word, or a value that is none.
[[nodiscard]] std::optional<std::vector<std::pair<std::string, std::string>>> grant_in(const nlohmann::json& asked);

/// Why: one line, kept for ever. Throws Error when it is none.
[[nodiscard]] std::string reason_in(const nlohmann::json& asked);

/// A station's name by its key; empty where the ledger knows none.
[[nodiscard]] std::string station_name(const ledger::Registry& registry, const std::string& key);

struct TicketState {
  std::string word;   ///< for people
  std::string group;  ///< live, begun, filed, cancelled, run out, made up
  bool live = false;  ///< it may still be used
};
[[nodiscard]] TicketState state_of(const ledger::IssuedTicket& ticket, std::int64_t now_utc_ns);
/// made up, released, to decide, questioned, taken back, marked otherwise (one of `otherwise`: Registry::marked_otherwise), not chosen, erased, or
/// ready: it waits for its release.
[[nodiscard]] std::string state_of(const ledger::Registry& registry, const ledger::FiledSession& session, const std::set<std::uint64_t>& otherwise);

}  // namespace cavum::office
