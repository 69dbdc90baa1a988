// What the desk does with results: the queue, decisions, release, appeals, and what goes to other
// systems.
#include <fmt/core.h>

#include <algorithm>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "grading/records/appeal.h"
#include "grading/records/decision.h"
#include "grading/records/entry_text.h"
#include "grading/records/erasure.h"
#include "grading/records/exam_scale.h"
#include "grading/records/exported_grade.h"
#include "grading/records/exports.h"
#include "grading/records/release.h"
#include "ui/office/desk.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"

namespace cavum::office {

using nlohmann::json;

namespace {

/// By which its report is asked for; empty where the recording was erased.
std::string recording_sha256(const records::FiledSession& s) {
  return s.motion_erased_by ? "" : s.file_sha256;
}

/// The last decision of a person on it.
std::optional<Decided> decided(const records::FiledSession& s) {
  const records::Regrade* r = s.last_decision();
  if (r == nullptr) return std::nullopt;
  return Decided{r->seq, r->person, text_in(*r->result, "verdict"), r->reason,
                 r->seq == s.result_seq};
}

/// The station that a ticket was to be sat at; empty: any.
std::string planned_seat(const records::Registry& registry, const std::string& nonce) {
  const auto t =
      std::find_if(registry.tickets.begin(), registry.tickets.end(),
                   [&](const records::IssuedTicket& i) { return i.ticket.nonce == nonce; });
  return nonce.empty() || t == registry.tickets.end() ? "" : station_name(registry, t->seat);
}

/// What was noted of its candidate on the day.
std::vector<Noted> noted(const records::Registry& registry, const std::string& candidate) {
  std::vector<Noted> out;
  for (const auto& i : registry.day.incidents)
    if (i.candidate == candidate && !i.erased_by)
      out.push_back({utc_text(i.utc_ns), station_name(registry, i.station), i.words});
  return out;
}

/// Sessions by the entries of their results, as a page showed them. Throws Error when one is
/// another by now.
std::vector<std::uint64_t> sessions_of_results(const records::Registry& registry,
                                               const Entries& results) {
  std::vector<std::uint64_t> out;
  for (const std::uint64_t entry : results) {
    const auto found =
        std::find_if(registry.sessions.begin(), registry.sessions.end(),
                     [&](const records::FiledSession& s) { return entry == s.result_seq; });
    if (found == registry.sessions.end() || found->released)
      throw Error(msg("the results"), msg("are others by now than the page showed"),
                  msg("look again; nothing was released"));
    out.push_back(found->seq);
  }
  return out;
}

}  // namespace

Queue Desk::queue() {
  Turn turn(*this);
  const records::Registry& registry = turn.book.registry();
  Queue out;
  for (const auto& d : records::review_queue(registry)) {
    const records::FiledSession& s = *registry.session(d.session);
    out.value.push_back({d.session, d.candidate, d.scenario_id, d.points, d.max,
                         shown_each(words_of(d.reasons)), decided(s), noted(registry, d.candidate),
                         recording_sha256(s)});
  }
  return out;
}

Entered Desk::decide(const Decide& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  const records::Decision decision{records::decided_verdict(asked.verdict), by.name, asked.reason};
  return {records::enter_decision(turn.book, asked.session, decision).seq};
}

Results Desk::results(bool names) {
  Turn turn(*this);
  const records::Registry& registry = turn.book.registry();
  const auto people = names ? people_of(turn.book) : std::map<std::string, records::Identity>();
  const auto counting = registry.counting();
  const auto otherwise = registry.marked_otherwise();
  const auto scales = records::own_scales(registry);
  Results out;
  for (const auto& s : registry.sessions) {
    ResultRow row{.session = s.seq,
                  .result = s.result_seq,
                  .candidate = s.candidate,
                  .exam = s.scenario_id,
                  .simulated = s.simulated};
    row.state = state_of(registry, s, otherwise);
    row.verdict = text_in(*s.result, "verdict");
    row.station = station_name(registry, s.station_key);
    row.seat = planned_seat(registry, s.nonce);
    if (s.taken_back()) row.why_back = s.retracted_why;
    row.sha256 = recording_sha256(s);
    const json& score = member_of(*s.result, "score");
    row.points = number_in(member_of(score, "points"));
    row.max = number_in(member_of(score, "max"));
    if (s.shown->is_object()) row.grade = number_in(records::exported_grade(s, scales).grade);
    row.findings = shown_each(s.findings);
    row.decided = decided(s);
    row.shown = s.shown_seq != 0;
    row.appeal = s.open_appeal() != nullptr;
    if (s.makes_up) row.makes_up = s.makes_up->ticket;
    row.made_up_by = s.made_up_by;
    if (s.shown->is_object() && s.shown_seq != s.result_seq)  // what is out is not what will be
      row.out = {text_in(*s.shown, "verdict"),
                 number_in(member_of(member_of(*s.shown, "score"), "points"))};
    if (const auto last = counting.find({s.candidate, s.scenario_id});
        s.shown->is_object() && last->second != s.seq)
      row.later = last->second;
    if (names) put_name(row, people);
    out.value.push_back(std::move(row));
  }
  return out;
}

Released Desk::release(const ReleaseResults& asked, const Account& by) {
  records::ReleaseCommand wish;
  wish.all = asked.all;
  wish.sessions = asked.sessions;
  wish.with_findings = asked.with_findings;
  Turn turn(*this, {by.name, asked.reason, ""});
  if (asked.results) wish.sessions = sessions_of_results(turn.book.registry(), *asked.results);
  if (wish.all != wish.sessions.empty())
    throw Error(msg("the release"), msg("needs to know whose results"),
                msg("name all, or results as they were shown"));
  const records::Release done = records::release_results(turn.book, wish);
  return {done.results.size(), done.withheld, done.to_decide};
}

std::string Desk::gradebook(bool rehearsal) {
  Turn turn(*this);
  records::Identities identities = records::sound_identities(turn.book);
  int left_out = 0;
  return records::moodle_csv(turn.book.registry(), identities, left_out, in_words, rehearsal);
}

std::string Desk::criteria() {
  Turn turn(*this);
  return records::tidy_csv(turn.book.registry());
}

Entered Desk::retract(const Retract& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::retract_results(turn.book, asked.sessions, asked.reason).seq};
}

Appeals Desk::appeals() {
  Turn turn(*this);
  const records::Registry& registry = turn.book.registry();
  Appeals out;
  for (const auto& s : registry.sessions)
    for (const auto& a : s.appeals) {
      const json& score = member_of(*s.result, "score");
      AppealRow row{a.seq,
                    s.seq,
                    utc_text(a.utc_ns),
                    s.candidate,
                    s.scenario_id,
                    text_in(*s.result, "verdict"),
                    recording_sha256(s),
                    a.reason,
                    a.closed_by ? records::word_of(a.outcome) : "",
                    a.answer,
                    number_in(member_of(score, "points")),
                    number_in(member_of(score, "max")),
                    decided(s),
                    noted(registry, s.candidate),
                    s.made_up_by,
                    !a.closed_by.has_value(),
                    records::changed_since(s, a)};
      out.value.push_back(std::move(row));
    }
  return out;
}

Entered Desk::open_appeal(const OpenAppeal& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::open_appeal(turn.book, asked.session, asked.reason).seq};
}

Entered Desk::answer_appeal(const AnswerAppeal& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::answer_appeal(turn.book, asked.session,
                                 records::of_word<records::Outcome>(asked.outcome, "the outcome"),
                                 asked.reason)
              .seq};
}

records::ClassRegrade Desk::plan_regrade(const std::string& exam, records::RegradeBasis basis,
                                         std::uint64_t& entries) {
  Turn turn(*this);
  entries = turn.book.content().entries.size();
  return records::plan_class_regrade(turn.book.registry(), exam, std::move(basis));
}

std::size_t Desk::count_regrade(const records::ClassRegrade& plan, const std::string& reason,
                                const Account& by, std::uint64_t& first) {
  Turn turn(*this, {by.name, "", ""});
  const std::size_t entered = records::enter_class_regrade(turn.book, plan, reason);
  first = turn.book.content().entries.size() - entered;
  return entered;
}

std::uint64_t Desk::counted_regrades(const std::string& exam, const std::string& rubric_sha256,
                                     const std::string& by, std::uint64_t entries,
                                     std::uint64_t& first) {
  Turn turn(*this);
  const records::LedgerContent& content = turn.book.content();
  std::uint64_t counted = 0;
  for (const auto& s : turn.book.registry().sessions)
    for (const auto& r : s.regrades) {
      const auto rubric = r.documents.find("rubric.toml");
      if (s.scenario_id != exam || r.seq < entries || rubric == r.documents.end() ||
          rubric->second != rubric_sha256)
        continue;
      if (content.entries.at(r.seq).by.account != by) continue;
      first = counted == 0 ? r.seq : std::min(first, r.seq);
      ++counted;
    }
  return counted;
}

std::vector<FiledExam> Desk::filed_exams() {
  Turn turn(*this);
  std::map<std::string, std::size_t> exams;
  for (const auto& s : turn.book.registry().sessions)
    exams[s.scenario_id] += !s.motion_erased_by && s.result->is_object() ? 1 : 0;
  std::vector<FiledExam> out;
  for (const auto& [id, sessions] : exams)
    if (sessions > 0) out.push_back({id, sessions});
  return out;
}

Recording Desk::recording(const std::string& file_sha256) {
  Turn turn(*this);
  for (const auto& s : turn.book.registry().sessions)
    if (s.file_sha256 == file_sha256)
      return {records::recording_of(turn.book.places(), s), turn.book.content().entries.size()};
  throw Error(msg("the session"), msg("is not filed here"), msg("look at the results again"));
}

}  // namespace cavum::office
