#include "ui/office/desk_parts.h"

#include <sodium.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/language/language.h"
#include "engine/language/say.h"
#include "grading/ledger/erasure.h"
#include "grading/ledger/makeup.h"
#include "grading/ledger/reason.h"
#include "scenarios/exam/runner.h"
#include "scenarios/file/accommodations.h"
#include "scenarios/file/parse.h"

namespace cavum::office {

using nlohmann::json;

std::map<std::string, ledger::Identity> people_of(const ledger::Ledger& ledger) {
  std::map<std::string, ledger::Identity> out;
  for (auto& one : ledger::sound_identities(ledger).all()) out[one.pseudonym] = one;
  return out;
}

void put_name(json& row, const std::map<std::string, ledger::Identity>& people, const std::string& pseudonym) {
  const auto found = people.find(pseudonym);
  row["id"] = found == people.end() ? "" : found->second.id;
  row["name"] = found == people.end() ? "" : found->second.name;
}

std::vector<std::string> shown_each(std::vector<std::string> english) {
  for (std::string& text : english) text = shown(text);
  return english;
}

Roster roster_of(const json& asked) {
  const std::string packed = text_in(asked, "base64");
  std::string bytes(packed.size() / 4 * 3 + 3, '\0');
  std::size_t size = 0;
  if (sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), packed.data(), packed.size(), nullptr, &size, nullptr,
                        sodium_base64_VARIANT_ORIGINAL) != 0)
    throw Error("the list", "did not arrive whole", "send it again");
  bytes.resize(size);
  std::vector<std::string> answers;
  if (const json& given = member_of(asked, "answers"); given.is_array())
    for (const json& a : given) answers.push_back(a.is_string() ? a.get<std::string>() : "");
  return read_roster(bytes, answers);
}

json shown_roster(const Roster& roster) {
  json columns = json::array(), people = json::array();
  for (const auto& c : roster.columns) columns.push_back({{"heading", c.heading}, {"use", c.use}, {"known", c.known}, {"samples", c.samples}});
  for (const auto& p : roster.people)
    people.push_back({{"id", p.id},
                      {"name", p.name},
                      {"station", p.station},
                      {"accommodations", shown(scenarios::accommodations_text(scenarios::granted({}, scenarios::notes_of(p.grant), "the list")))}});
  return {{"headed", roster.headed},
          {"encoding", roster.encoding},
          {"separator", std::string(1, roster.separator)},
          {"rows", roster.rows},
          {"columns", columns},
          {"people", people},
          {"problem", shown(roster.problem)},
          {"uses", ledger::people_columns()}};
}

json exam_facts(const std::string& file) {
  const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file), file);
  const auto words = s.languages.find(language());
  const bool translated = words != s.languages.end() && words->second.contains(s.title);
  return {{"id", s.id}, {"title", translated ? words->second.at(s.title) : s.title}, {"file", file}, {"time_limit_s", time_limit_s(file, {})}};
}

std::int64_t time_limit_s(const std::string& file, const Grants& grants) {
  const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file), file);
  std::int64_t longest = scenarios::exam_limit_ticks(s);
  for (const auto& grant : grants) {
    scenarios::Scenario granted = s;
    granted.accommodations = scenarios::granted(s.accommodations, grant, "the exam");
    longest = std::max(longest, scenarios::exam_limit_ticks(granted));
  }
  return (longest + k_ticks_per_second - 1) / k_ticks_per_second;
}

IssueWish issue_wish(const json& asked, const std::vector<std::string>& exams) {
  IssueWish wish;
  const std::string exam = text_in(asked, "exam");
  for (const auto& file : exams)
    if (exam_facts(file)["id"] == exam) wish.scenario = file;
  if (wish.scenario.empty()) throw Error("the exam", "is none that this office offers", "choose one of the list");
  wish.from_utc_ns = ledger::parse_utc(text_in(asked, "from"), "the first moment");
  wish.until_utc_ns = ledger::parse_utc(text_in(asked, "until"), "the last moment");
  if (wish.until_utc_ns <= wish.from_utc_ns)
    throw Error("the last moment", "is not after the first", "give the last moment at which the exam may begin");
  wish.begun_at_ledger = member_of(asked, "begin_at_office") == true;
  wish.another = member_of(asked, "another") == true;
  wish.reason = reason_in(asked);
  if (!member_of(asked, "at_once").is_null()) {
    constexpr std::int64_t k_most = 10'000, k_week_min = 10'080, k_minute_ns = 60'000'000'000;
    const auto at_once = require_whole<std::int64_t>(asked, "at_once", "the sittings"),
               apart_min = require_whole<std::int64_t>(asked, "minutes_apart", "the sittings");
    if (at_once < 1 || at_once > k_most || apart_min < 1 || apart_min > k_week_min)
      throw Error("the sittings", "are of no number of candidates, or too far apart", "say 1 to 10,000 candidates, and 1 to 10,080 minutes");
    wish.at_once = static_cast<std::size_t>(at_once);
    wish.apart_ns = apart_min * k_minute_ns;
    wish.overlap = member_of(asked, "overlap") == true;
  }
  return wish;
}

std::optional<std::vector<std::pair<std::string, std::string>>> grant_in(const json& asked) {
  const std::string word = text_in(asked, "accommodations");
  if (word == "as before") return std::nullopt;
  if (word != "none" && word != "these")
    throw Error("the accommodations", "are not said", "say none, these, or as before: nobody's extra time is lost in silence");
  scenarios::Grant grant;
  if (word == "these") {
    const auto number = [&](const char* name) -> std::optional<double> {
      const json& value = member_of(asked, name);
      return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
    };
    const auto yes = [&](const char* name) { return member_of(asked, name) == true ? std::optional(true) : std::nullopt; };
    grant = {number("extra_time_percent"), number("extra_time_s"), yes("left_handed"), yes("high_contrast")};
    if (!grant.extra_time_percent && !grant.extra_time_s && !grant.left_handed && !grant.high_contrast)
      throw Error("the accommodations", "are none", "say what is granted, or that nothing is");
    scenarios::require_sound(grant, "the accommodations");
  }
  auto notes = scenarios::notes_of(grant);
  std::sort(notes.begin(), notes.end());
  return notes;
}

std::string reason_in(const json& asked) {
  std::string reason = text_in(asked, "reason");
  ledger::require_reason(reason);
  return reason;
}

std::string station_name(const ledger::Registry& registry, const std::string& key) {
  const ledger::Station* s = registry.stations.of(key);
  return s == nullptr ? "" : s->name;
}

namespace {

/// Of the ticket alone.
TicketState own_state(const ledger::IssuedTicket& t, std::int64_t now) {
  if (t.used_by) return {tr("filed, entry {}", *t.used_by), "filed", false};
  if (t.cancelled_by) return {tr("cancelled, entry {}", *t.cancelled_by), "cancelled", false};
  if (!t.begins.empty()) return {tr("begun, entry {}", t.begins.back().seq), "begun", now <= t.ticket.not_after_utc_ns};
  if (now > t.ticket.not_after_utc_ns) return {tr("run out"), "run out", false};
  return {now < t.ticket.not_before_utc_ns ? tr("not yet") : tr("live"), "live", true};
}

}  // namespace

TicketState state_of(const ledger::IssuedTicket& t, std::int64_t now) {
  TicketState state = own_state(t, now);
  if (t.makes_up)
    state.word = t.makes_up->became == ledger::FirstSitting::missed
                     ? tr("{0}; makeup of entry {1}, which was missed", state.word, t.makes_up->ticket)
                     : tr("{0}; makeup of entry {1}, which was interrupted", state.word, t.makes_up->ticket);
  if (t.made_up_by) {
    const bool open = state.group == "live" || state.group == "run out";  // it is neither any more
    state = {open ? tr("made up by entry {}", *t.made_up_by) : tr("{0}; made up by entry {1}", state.word, *t.made_up_by), "made up", false};
  }
  return state;
}

std::string state_of(const ledger::Registry& registry, const ledger::FiledSession& s, const std::set<std::uint64_t>& otherwise) {
  if (s.result_erased_by) return "erased";
  if (s.made_up_by) return "made up";
  if (registry.chosen_instead_of(s) != nullptr) return "not chosen";
  if (s.released) return "released";
  if (s.doubtful()) return "questioned";
  if (s.undecided()) return "to decide";
  if (s.taken_back()) return "taken back";
  return otherwise.contains(s.seq) ? "marked otherwise" : "ready";
}

}  // namespace cavum::office
