// What the desk does with results: the queue, decisions, release, appeals, and what goes to other systems.
#include <fmt/core.h>

#include <algorithm>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "grading/ledger/appeal.h"
#include "grading/ledger/decision.h"
#include "grading/ledger/entry_text.h"
#include "grading/ledger/erasure.h"
#include "grading/ledger/exam_scale.h"
#include "grading/ledger/exported_grade.h"
#include "grading/ledger/exports.h"
#include "grading/ledger/release.h"
#include "ui/office/desk.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"

namespace cavum::office {

using nlohmann::json;

namespace {

/// By which its report is asked for; empty where the recording was erased.
std::string recording_sha256(const ledger::FiledSession& s) { return s.motion_erased_by ? "" : s.file_sha256; }

std::vector<std::uint64_t> sessions_in(const json& asked) {
  std::vector<std::uint64_t> out;
  if (const json& sessions = member_of(asked, "sessions"); sessions.is_array())
    for (const json& s : sessions)
      if (s.is_number_unsigned()) out.push_back(s);
  return out;
}

/// The last decision of a person on it: {"entry","by","verdict","reason","counts"}; null without one.
json decided(const ledger::FiledSession& s) {
  const ledger::Regrade* r = s.last_decision();
  if (r == nullptr) return {};
  return {
      {"entry", r->seq}, {"by", r->person}, {"verdict", text_in(*r->result, "verdict")}, {"reason", r->reason}, {"counts", r->seq == s.result_seq}};
}

/// The station that a ticket was to be sat at; empty: any.
std::string planned_seat(const ledger::Registry& registry, const std::string& nonce) {
  const auto t =
      std::find_if(registry.tickets.begin(), registry.tickets.end(), [&](const ledger::IssuedTicket& i) { return i.ticket.nonce == nonce; });
  return nonce.empty() || t == registry.tickets.end() ? "" : station_name(registry, t->seat);
}

/// What was noted of its candidate on the day: [{"utc","station","words"}].
json noted(const ledger::Registry& registry, const std::string& candidate) {
  json out = json::array();
  for (const auto& i : registry.day.incidents)
    if (i.candidate == candidate && !i.erased_by)
      out.push_back({{"utc", utc_text(i.utc_ns)}, {"station", station_name(registry, i.station)}, {"words", i.words}});
  return out;
}

/// Sessions by the entries of their results, as a page showed them. Throws Error when one is another by now.
std::vector<std::uint64_t> sessions_of_results(const ledger::Registry& registry, const json& results) {
  std::vector<std::uint64_t> out;
  for (const json& entry : results) {
    const auto found =
        std::find_if(registry.sessions.begin(), registry.sessions.end(), [&](const ledger::FiledSession& s) { return entry == s.result_seq; });
    if (found == registry.sessions.end() || found->released)
      throw Error("the results", "are others by now than the page showed", "look again; nothing was released");
    out.push_back(found->seq);
  }
  return out;
}

}  // namespace

json Desk::queue() {
  Turn turn(*this);
  json out = json::array();
  for (const auto& d : ledger::review_queue(turn.book.registry()))
    out.push_back({{"session", d.session},
                   {"candidate", d.candidate},
                   {"exam", d.scenario_id},
                   {"points", d.points},
                   {"max", d.max},
                   {"reasons", shown_each(d.reasons)},
                   {"decided", decided(*turn.book.registry().session(d.session))},
                   {"noted", noted(turn.book.registry(), d.candidate)},
                   {"sha256", recording_sha256(*turn.book.registry().session(d.session))}});
  return {{"queue", out}};
}

json Desk::decide(const json& asked, const Account& by) {
  const auto session = require_whole<std::uint64_t>(asked, "session", "the session");
  Turn turn(*this, {by.name, "", ""});
  const ledger::Decision decision{ledger::decided_verdict(text_in(asked, "verdict")), by.name, reason_in(asked)};
  return {{"entry", ledger::enter_decision(turn.book, session, decision).seq}};
}

json Desk::results(bool names) {
  Turn turn(*this);
  const ledger::Registry& registry = turn.book.registry();
  const auto people = names ? people_of(turn.book) : std::map<std::string, ledger::Identity>();
  const auto counting = registry.counting();
  const auto otherwise = registry.marked_otherwise();
  const auto scales = ledger::own_scales(registry);
  json out = json::array();
  for (const auto& s : registry.sessions) {
    json row = {{"session", s.seq},
                {"candidate", s.candidate},
                {"exam", s.scenario_id},
                {"result", s.result_seq},
                {"state", state_of(registry, s, otherwise)},
                {"station", station_name(registry, s.station_key)},
                {"seat", planned_seat(registry, s.nonce)},
                {"why_back", s.taken_back() ? s.retracted_why : ""},
                {"decided", decided(s)},
                {"grade", s.shown->is_object() ? ledger::exported_grade(s, scales).grade : json()},
                {"findings", shown_each(s.findings)},
                {"simulated", s.simulated},
                {"verdict", text_in(*s.result, "verdict")},
                {"sha256", recording_sha256(s)},
                {"shown", s.shown_seq != 0},
                {"makes_up", s.makes_up ? json(s.makes_up->ticket) : json()},
                {"made_up_by", s.made_up_by ? json(*s.made_up_by) : json()},
                {"appeal", s.open_appeal() != nullptr}};
    const json& score = member_of(*s.result, "score");
    row["points"] = member_of(score, "points");
    row["max"] = member_of(score, "max");
    if (s.shown->is_object() && s.shown_seq != s.result_seq)  // what is out is not what will be
      row["out"] = {{"verdict", text_in(*s.shown, "verdict")}, {"points", member_of(member_of(*s.shown, "score"), "points")}};
    if (const auto last = counting.find({s.candidate, s.scenario_id}); s.shown->is_object() && last->second != s.seq) row["later"] = last->second;
    if (names) put_name(row, people, s.candidate);
    out.push_back(std::move(row));
  }
  return {{"results", out}};
}

json Desk::release(const json& asked, const Account& by) {
  ledger::ReleaseWish wish;
  wish.all = member_of(asked, "all") == true;
  wish.sessions = sessions_in(asked);
  wish.with_findings = member_of(asked, "with_findings") == true;
  Turn turn(*this, {by.name, reason_in(asked), ""});
  if (const json& results = member_of(asked, "results"); results.is_array()) wish.sessions = sessions_of_results(turn.book.registry(), results);
  if (wish.all != wish.sessions.empty()) throw Error("the release", "needs to know whose results", "name all, or results as they were shown");
  const ledger::Release done = ledger::release_results(turn.book, wish);
  return {{"released", done.results.size()}, {"kept_back", done.kept_back}, {"to_decide", done.to_decide}};
}

std::string Desk::gradebook(bool rehearsal) {
  Turn turn(*this);
  ledger::Identities identities = ledger::sound_identities(turn.book);
  int left_out = 0;
  return ledger::moodle_csv(turn.book.registry(), identities, left_out, rehearsal);
}

std::string Desk::criteria() {
  Turn turn(*this);
  return ledger::tidy_csv(turn.book.registry());
}

json Desk::retract(const json& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::retract_results(turn.book, sessions_in(asked), reason_in(asked)).seq}};
}

json Desk::appeals() {
  Turn turn(*this);
  json out = json::array();
  for (const auto& s : turn.book.registry().sessions)
    for (const auto& a : s.appeals) {
      const json& score = member_of(*s.result, "score");
      out.push_back({{"entry", a.seq},
                     {"utc", utc_text(a.utc_ns)},
                     {"session", s.seq},
                     {"candidate", s.candidate},
                     {"exam", s.scenario_id},
                     {"verdict", text_in(*s.result, "verdict")},
                     {"points", member_of(score, "points")},
                     {"max", member_of(score, "max")},
                     {"sha256", recording_sha256(s)},
                     {"decided", decided(s)},
                     {"noted", noted(turn.book.registry(), s.candidate)},
                     {"reason", a.reason},
                     {"made_up_by", s.made_up_by ? json(*s.made_up_by) : json()},
                     {"open", !a.closed_by.has_value()},
                     {"changed", ledger::changed_since(s, a)},
                     {"outcome", a.closed_by ? ledger::word_of(a.outcome) : ""},
                     {"answer", a.answer}});
    }
  return {{"appeals", out}};
}

json Desk::open_appeal(const json& asked, const Account& by) {
  const auto session = require_whole<std::uint64_t>(asked, "session", "the session");
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::open_appeal(turn.book, session, reason_in(asked)).seq}};
}

json Desk::answer_appeal(const json& asked, const Account& by) {
  const auto session = require_whole<std::uint64_t>(asked, "session", "the session");
  const auto outcome = ledger::of_word<ledger::Outcome>(text_in(asked, "outcome"), "the outcome");
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::answer_appeal(turn.book, session, outcome, reason_in(asked)).seq}};
}

ledger::ClassRegrade Desk::plan_regrade(const std::string& exam, ledger::RegradeBasis basis, std::uint64_t& entries) {
  Turn turn(*this);
  entries = turn.book.content().entries.size();
  return ledger::plan_class_regrade(turn.book.registry(), exam, std::move(basis));
}

std::size_t Desk::count_regrade(const ledger::ClassRegrade& plan, const std::string& reason, const Account& by, std::uint64_t& first) {
  Turn turn(*this, {by.name, "", ""});
  const std::size_t entered = ledger::enter_class_regrade(turn.book, plan, reason);
  first = turn.book.content().entries.size() - entered;
  return entered;
}

std::uint64_t Desk::counted_regrades(const std::string& exam, const std::string& rubric_sha256, const std::string& by, std::uint64_t entries,
                                     std::uint64_t& first) {
  Turn turn(*this);
  const ledger::LedgerContent& content = turn.book.content();
  std::uint64_t counted = 0;
  for (const auto& s : turn.book.registry().sessions)
    for (const auto& r : s.regrades) {
      const auto rubric = r.documents.find("rubric.toml");
      if (s.scenario_id != exam || r.seq < entries || rubric == r.documents.end() || rubric->second != rubric_sha256) continue;
      if (content.entries.at(r.seq).by.account != by) continue;
      first = counted == 0 ? r.seq : std::min(first, r.seq);
      ++counted;
    }
  return counted;
}

json Desk::filed_exams() {
  Turn turn(*this);
  std::map<std::string, std::size_t> exams;
  for (const auto& s : turn.book.registry().sessions) exams[s.scenario_id] += !s.motion_erased_by && s.result->is_object() ? 1 : 0;
  json out = json::array();
  for (const auto& [id, sessions] : exams)
    if (sessions > 0) out.push_back({{"id", id}, {"sessions", sessions}});
  return out;
}

Recording Desk::recording(const std::string& file_sha256) {
  Turn turn(*this);
  for (const auto& s : turn.book.registry().sessions)
    if (s.file_sha256 == file_sha256) return {ledger::recording_of(turn.book.places(), s), turn.book.content().entries.size()};
  throw Error("the session", "is not filed here", "look at the results again");
}

}  // namespace cavum::office
