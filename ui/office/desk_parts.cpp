#include "ui/office/desk_parts.h"

#include <algorithm>

#include "engine/base/encoding.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "grading/records/erasure.h"
#include "grading/records/makeup.h"
#include "grading/records/reason.h"
#include "scenarios/exam/runner.h"
#include "scenarios/file/accommodations.h"
#include "scenarios/file/parse.h"
#include "ui/language/language.h"
#include "ui/language/say.h"

namespace cavum::office {

std::map<std::string, records::Identity> people_of(const records::Ledger& ledger) {
  std::map<std::string, records::Identity> out;
  for (auto& one : records::sound_identities(ledger).all()) out[one.pseudonym] = one;
  return out;
}

std::string in_words(const Message& message) { return tr(message); }

std::vector<std::string> shown_each(const std::vector<Message>& messages) {
  std::vector<std::string> texts;
  for (const Message& m : messages) texts.push_back(one_line(tr(m)));
  return texts;
}

std::vector<ShownFinding> shown_each(const records::Findings& findings) {
  std::vector<ShownFinding> shown;
  for (const auto& f : findings) shown.push_back({f.kind, one_line(tr(f.message()))});
  return shown;
}

Roster roster_of(const ClassList& asked) {
  const auto bytes = from_base64(asked.base64);
  if (!bytes) throw Error(msg("the list"), msg("did not arrive whole"), msg("send it again"));
  return read_roster({bytes->begin(), bytes->end()}, {asked.answers.begin(), asked.answers.end()});
}

Preview shown_roster(const Roster& roster) {
  Preview out{roster.headed,
              roster.encoding,
              std::string(1, roster.separator),
              roster.rows,
              roster.columns,
              {},
              {},
              {}};
  out.problems = shown_each(roster.problems);
  for (const auto& p : roster.people)
    out.people.push_back({p.id, p.name, p.station,
                          tr(scenarios::accommodations_text(scenarios::granted(
                              {}, scenarios::notes_of(p.grant), msg("the list"))))});
  for (const auto& name : records::people_columns()) out.uses.emplace_back(name);
  return out;
}

ExamFacts exam_facts(const std::string& file) {
  const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file), file);
  const auto words = s.languages.find(language());
  const bool translated = words != s.languages.end() && words->second.contains(s.title);
  return {s.id, translated ? words->second.at(s.title) : s.title, file, time_limit_s(file, {})};
}

std::int64_t time_limit_s(const std::string& file, const Grants& grants) {
  const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file), file);
  std::int64_t longest = scenarios::exam_limit_ticks(s);
  for (const auto& grant : grants) {
    scenarios::Scenario granted = s;
    granted.accommodations = scenarios::granted(s.accommodations, grant, msg("the exam"));
    longest = std::max(longest, scenarios::exam_limit_ticks(granted));
  }
  return (longest + k_ticks_per_second - 1) / k_ticks_per_second;
}

IssueCommand issue_command(const std::string& exam, const std::string& from,
                           const std::string& until, const std::vector<std::string>& exams) {
  IssueCommand wish;
  for (const auto& file : exams)
    if (exam_facts(file).id == exam) wish.scenario = file;
  if (wish.scenario.empty())
    throw Error(msg("the exam"), msg("is none that this office offers"),
                msg("choose one of the list"));
  wish.from_utc_ns = records::parse_utc(from, msg("the first moment"));
  wish.until_utc_ns = records::parse_utc(until, msg("the last moment"));
  if (wish.until_utc_ns <= wish.from_utc_ns)
    throw Error(msg("the last moment"), msg("is not after the first"),
                msg("give the last moment at which the exam may begin"));
  return wish;
}

std::optional<std::vector<std::pair<std::string, std::string>>> grant_in(const MakeUp& asked) {
  if (asked.accommodations == Granting::as_before) return std::nullopt;
  scenarios::Grant grant;
  if (asked.accommodations == Granting::these) {
    const auto yes = [](bool said) { return said ? std::optional(true) : std::nullopt; };
    grant = {asked.extra_time_percent, asked.extra_time_s, yes(asked.left_handed),
             yes(asked.high_contrast)};
    if (!grant.extra_time_percent && !grant.extra_time_s && !grant.left_handed &&
        !grant.high_contrast)
      throw Error(msg("the accommodations"), msg("are none"),
                  msg("say what is granted, or that nothing is"));
    scenarios::require_sound(grant, msg("the accommodations"));
  }
  auto notes = scenarios::notes_of(grant);
  std::sort(notes.begin(), notes.end());
  return notes;
}

std::string station_name(const records::Registry& registry, const std::string& key) {
  const records::Station* s = registry.stations.of(key);
  return s == nullptr ? "" : s->name;
}

std::string state_of(const records::Registry& registry, const records::FiledSession& s,
                     const std::set<std::uint64_t>& otherwise) {
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
