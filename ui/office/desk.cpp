#include "ui/office/desk.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/language/language.h"
#include "engine/language/shown.h"
#include "grading/ledger/begin.h"
#include "grading/ledger/decision.h"
#include "grading/ledger/entry_text.h"
#include "grading/ledger/erasure.h"
#include "grading/ledger/exports.h"
#include "grading/ledger/identities.h"
#include "grading/ledger/issue.h"
#include "grading/ledger/makeup.h"
#include "grading/ledger/regrade.h"
#include "grading/ledger/release.h"
#include "scenarios/file/parse.h"
#include "ui/office/day_parts.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"

namespace cavum::office {

using nlohmann::json;

namespace {

Grants grants_of(const Roster& roster) {
  Grants grants;
  for (const auto& p : roster.people) grants.push_back(scenarios::notes_of(p.grant));
  return grants;
}

/// Made up by a ticket that can still be cancelled: then this one is good again.
bool comes_back(const ledger::Registry& registry, const ledger::IssuedTicket& first, std::int64_t now_utc_ns) {
  const ledger::IssuedTicket* makeup = first.made_up_by ? registry.ticket(*first.made_up_by) : nullptr;
  return makeup != nullptr && makeup->begins.empty() && makeup->live(now_utc_ns);
}

/// Who begins a sitting at its last moment is done before the next one begins, unless it is said that they may overlap.
void require_apart(const IssueWish& wish, std::int64_t longest_s) {
  constexpr std::int64_t k_second_ns = 1'000'000'000, k_minute_s = 60;
  const std::int64_t late_s = (wish.until_utc_ns - wish.from_utc_ns - wish.apart_ns) / k_second_ns + longest_s;
  if (late_s > 0 && !wish.overlap)
    throw Error("the sittings",
                fmt::format(said("overlap: who begins one at its last moment sits until {} min after the next may begin"),
                            (late_s + k_minute_s - 1) / k_minute_s),
                "set them farther apart, let each begin in a shorter time, or say that they may overlap");
}

}  // namespace

Desk::Desk(const std::string& ledger_folder, const SigningKey& school, OfficePlaces places, std::vector<std::string> exams)
    : ledger_(ledger_folder, school), places_(std::move(places)), exams_(std::move(exams)) {
  id_ = ledger_.content().id;
  school_ = ledger_.content().school;
  public_key_ = ledger_.content().public_key;
  places_.folder += "/" + id_;
  make_private_folder(places_.folder + "/tickets");
  for (const auto& file : exams_) {  // steps and criteria of its exams, in the office's language
    const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file), file);
    if (const auto words = s.languages.find(language()); words != s.languages.end()) add_translations(words->second);
  }
}

json Desk::exams() const {
  json out = json::array();
  for (const auto& file : exams_) out.push_back(exam_facts(file));
  return {{"exams", out}};
}

json Desk::preview(const json& asked) {
  Roster roster = roster_of(asked);
  try {
    Turn turn(*this);
    ledger::Identities identities = ledger::sound_identities(turn.book);
    static_cast<void>(ledger::stations_of(turn.book.registry(), identities, roster.people, {}, k_list));
  } catch (const Error& wrong) {
    roster.people.clear();
    roster.problem = lines_of_mistakes(wrong);
  }
  json out = shown_roster(roster);
  const Grants grants = grants_of(roster);
  out["longest_s"] = json::object();  // of each exam, for who of the list has most time
  for (const std::string& file : exams_) out["longest_s"][exam_facts(file)["id"].get<std::string>()] = time_limit_s(file, grants);
  return out;
}

json Desk::issue(const json& asked, const Account& by) {
  const auto whole = [&](const char* name, std::size_t otherwise) {
    return member_of(asked, name).is_null() ? otherwise : require_whole<std::size_t>(asked, name, "the portion");
  };
  const Roster roster = roster_of(asked);
  if (!roster.ready())
    throw Error("the list", roster.problem.empty() ? "has columns that nobody answered for" : roster.problem,
                "answer, and look at the preview again");
  const IssueWish wish = issue_wish(asked, exams_);
  if (wish.at_once != 0 && wish.at_once < roster.people.size()) require_apart(wish, time_limit_s(wish.scenario, grants_of(roster)));
  const auto setup = scenarios::prepare_exam(wish.scenario, {});
  Turn turn(*this, {by.name, wish.reason, ""});
  ledger::Identities identities = ledger::sound_identities(turn.book);
  ledger::Ticket ticket = ledger::promise(*setup, turn.book.content(), wish.from_utc_ns, wish.until_utc_ns);
  ticket.begun_at_ledger = wish.begun_at_ledger;
  const std::size_t at_once = wish.at_once == 0 ? roster.people.size() : wish.at_once;
  std::vector<ledger::TimeSpan> times;
  for (std::size_t i = 0; i < roster.people.size(); ++i) {
    const std::int64_t later_ns = static_cast<std::int64_t>(i / at_once) * wish.apart_ns;
    times.push_back({wish.from_utc_ns + later_ns, wish.until_utc_ns + later_ns});
  }
  const std::size_t first = std::min(whole("first", 0), roster.people.size());
  const std::size_t end = first + std::min(whole("most", roster.people.size()), roster.people.size() - first);
  const auto keep = [&](const ledger::Issued& one, const std::string& text) {
    write_private_text_file(places_.ticket(one.ticket.nonce), text + "\n");
  };
  json issued = json::array(), refused = json::array();
  for (const auto& one : ledger::issue_list(
           turn.book, identities,
           {ticket, roster.people, times, k_list, first, end, {}, wish.another ? ledger::Another::allow : ledger::Another::refuse}, keep)) {
    json row = {{"id", one.person.id}, {"name", one.person.name}};
    if (one.refused) {
      row["why"] = shown(without_advice(one.refused->what()));
    } else {
      row["candidate"] = one.candidate;
      row["station"] = one.person.station;
      row["not_before"] = utc_text(one.ticket.not_before_utc_ns);
      row["not_after"] = utc_text(one.ticket.not_after_utc_ns);
    }
    (one.refused ? refused : issued).push_back(std::move(row));
  }
  return {{"issued", issued}, {"refused", refused}, {"done", end}, {"of", roster.people.size()}};
}

json Desk::make_up(const json& asked, const Account& by) {
  const auto first = require_whole<std::uint64_t>(asked, "ticket", "the ticket");
  const std::string reason = reason_in(asked);
  std::string exam;
  {
    Turn turn(*this);
    if (const auto* t = turn.book.registry().ticket(first)) exam = t->ticket.exam;
  }
  json wanted = asked;
  wanted["exam"] = exam;
  const IssueWish wish = issue_wish(wanted, exams_);
  const auto setup = scenarios::prepare_exam(wish.scenario, {});
  auto grant = grant_in(asked);
  Turn turn(*this, {by.name, "", ""});
  std::string why_not;
  if (const auto* t = turn.book.registry().ticket(first);  // before what is granted: of one that has a makeup nothing may be kept
      t != nullptr && ledger::makeup_reasons(turn.book.registry(), *t, read_clocks().utc_ns, why_not).empty())
    throw Error(fmt::format("the ticket of entry {}", first), why_not, "look at the list of tickets again");
  if (!grant) grant = first_grant(turn.book, first);
  ledger::Ticket ticket = ledger::promise(*setup, turn.book.content(), wish.from_utc_ns, wish.until_utc_ns);
  ticket.begun_at_ledger = wish.begun_at_ledger;
  ticket.grant = *grant;
  const std::string text = ledger::issue_makeup(
      turn.book, ticket, {first, ledger::of_word<ledger::FirstSitting>(text_in(asked, "became"), "what became of the first"), reason});
  const ledger::Ticket issued = ledger::parse_ticket(text, "", "the ticket");
  write_private_text_file(places_.ticket(issued.nonce), text + "\n");
  remove_dead_tickets(turn.book, read_clocks().utc_ns);
  return {{"entry", turn.book.content().entries.size() - 1},
          {"candidate", issued.candidate},
          {"accommodations", shown(scenarios::accommodations_text(scenarios::granted({}, issued.grant, "the ticket")))}};
}

bool Desk::keeps_grant(const ledger::Registry& registry, const ledger::IssuedTicket& t) const {
  if (std::filesystem::exists(places_.ticket(t.ticket.nonce))) return true;
  const ledger::FiledSession* sat = t.used_by ? registry.session(*t.used_by) : nullptr;
  return sat != nullptr && !sat->motion_erased_by;
}

std::vector<std::pair<std::string, std::string>> Desk::first_grant(ledger::Ledger& book, std::uint64_t ticket) const {
  const auto& registry = book.registry();
  const ledger::IssuedTicket* t = registry.ticket(ticket);
  if (t == nullptr || !keeps_grant(registry, *t)) throw Error("the accommodations", "of the first ticket are not kept any more", "say them again");
  if (const std::string file = places_.ticket(t->ticket.nonce); std::filesystem::exists(file))
    return ledger::parse_ticket(read_text_file(file), "", "the first ticket").grant;
  const ledger::FiledSession* sat = registry.session(*t->used_by);
  return ledger::accommodations_in(SessionReader(ledger::recording_of(book.places(), *sat)).setup());
}

std::vector<std::pair<std::string, std::string>> Desk::grant_on(const std::string& nonce) const {
  if (!std::filesystem::exists(places_.ticket(nonce))) return {};
  return ledger::parse_ticket(read_text_file(places_.ticket(nonce)), "", "the ticket").grant;
}

std::string Desk::granted_on(const std::string& nonce) const {
  return shown(scenarios::accommodations_text(scenarios::granted({}, grant_on(nonce), "the ticket")));
}

json Desk::tickets(bool grants, const std::set<std::string>& seen) {
  json offered = exams().at("exams");  // files are read while nobody waits
  Turn turn(*this);
  const auto people = people_of(turn.book);
  const std::int64_t now = read_clocks().utc_ns;
  remove_dead_tickets(turn.book, now);
  json out = json::array();
  std::map<std::string, Grants> granted;  // by exam
  for (const auto& t : turn.book.registry().tickets) {
    const TicketState state = state_of(t, now);
    json row = {{"entry", t.seq},
                {"candidate", t.ticket.candidate},
                {"exam", t.ticket.exam},
                {"not_before", utc_text(t.ticket.not_before_utc_ns)},
                {"not_after", utc_text(t.ticket.not_after_utc_ns)},
                {"state", state.word},
                {"live", state.live},
                {"at_station", std::filesystem::exists(places_.ticket(t.ticket.nonce))},
                {"grant_kept", keeps_grant(turn.book.registry(), t)},
                {"begun", state.group == "begun" || seen.contains(t.ticket.candidate)},
                {"seat", t.seat},
                {"became", ""},
                {"why", t.why}};
    std::string why_not;
    if (const auto* makeup = t.made_up_by ? turn.book.registry().ticket(*t.made_up_by) : nullptr)
      row["became"] = ledger::word_of(makeup->makes_up->became);
    row["makeup"] = json::array();
    for (const auto became : ledger::makeup_reasons(turn.book.registry(), t, now, why_not)) row["makeup"].push_back(ledger::word_of(became));
    put_name(row, people, t.ticket.candidate);
    if (grants) row["accommodations"] = granted_on(t.ticket.nonce);
    if (state.live) granted[t.ticket.exam].push_back(grant_on(t.ticket.nonce));
    out.push_back(std::move(row));
  }
  json exams = json::array();  // those of which tickets are good, with how long they take
  for (json& facts : offered) {
    const auto good = granted.find(facts["id"]);
    if (good == granted.end()) continue;
    if (grants) facts["longest_s"] = time_limit_s(facts["file"], good->second);
    exams.push_back(std::move(facts));
  }
  return {{"tickets", out}, {"exams", exams}};
}

json Desk::cancel(const json& asked, const Account& by, const std::set<std::string>& seen) {
  const auto entry = require_whole<std::uint64_t>(asked, "entry", "the ticket");
  Turn turn(*this, {by.name, "", ""});
  if (const auto* t = turn.book.registry().ticket(entry);
      t != nullptr && (!t->begins.empty() || seen.contains(t->ticket.candidate)) && member_of(asked, "begun") != true)
    throw Error(one_line(t->ticket.candidate), "has begun, and what is handed in would be refused",
                "say that it is meant; a makeup keeps what was sat on record");
  const auto seq = ledger::cancel_ticket(turn.book, entry, reason_in(asked)).seq;
  remove_dead_tickets(turn.book, read_clocks().utc_ns);
  return {{"entry", seq}};
}

json Desk::board(const Board& board, const Inbox& inbox) {
  Turn turn(*this);
  const ledger::Registry& registry = turn.book.registry();
  const std::int64_t now = read_clocks().utc_ns;
  const auto said = board.stations();
  const auto begun = begun_at(turn.book.content(), registry);
  json stations = json::array();
  for (const auto& s : registry.stations.stations) {
    if (!s.replaced_by.empty()) continue;
    const ledger::Hold* hold = registry.day.hold_of(s.public_key);
    json row = {{"name", s.name},
                {"public_key", s.public_key},
                {"entry", s.seq},
                {"revoked", s.revoked_utc_ns.has_value()},
                {"room", s.room},
                {"hold", hold == nullptr ? 0 : hold->seq},
                {"unread", unread_by(registry.day, s.public_key, said, now)},
                {"twins", twins_of(registry.stations, begun, s.public_key, said, now)}};
    const auto found = said.find(s.public_key);
    row["said"] = found == said.end() ? json() : found->second;
    stations.push_back(std::move(row));
  }
  json tickets = {{"live", 0}, {"begun", 0}, {"filed", 0}, {"cancelled", 0}, {"run out", 0}, {"made up", 0}};
  for (const auto& t : registry.tickets) {
    json& n = tickets[state_of(t, now).group];
    n = n.get<int>() + 1;
  }
  json refused = json::array();
  for (const auto& [hash, exam] : inbox.refused()) {
    const auto is_it = [&sha256 = hash](const ledger::FiledSession& s) { return s.file_sha256 == sha256; };
    if (std::any_of(registry.sessions.begin(), registry.sessions.end(), is_it)) continue;  // and filed later
    const auto& all = registry.stations.stations;
    const auto from = std::find_if(all.begin(), all.end(), [&key = exam.station](const ledger::Station& s) { return s.public_key == key; });
    refused.push_back(
        {{"sha256", hash}, {"findings", shown_each(exam.findings)}, {"candidate", exam.candidate}, {"station", from == all.end() ? "" : from->name}});
  }
  return {{"utc_ns", now},
          {"stations", stations},
          {"tickets", tickets},
          {"holds", shown_holds(registry.day)},
          {"announcements", shown_announcements(registry.day, now)},
          {"inbox", {{"waiting", inbox.waiting()}, {"refused", refused}, {"trouble", shown(inbox.trouble())}}}};
}

json Desk::invite(const json& asked, const Account& by) {
  constexpr std::int64_t k_week_of_ns = 7 * 86'400'000'000'000;
  const std::int64_t until = read_clocks().utc_ns + k_week_of_ns;
  Turn turn(*this, {by.name, "", ""});
  const std::string code = ledger::invite_station(turn.book, text_in(asked, "name"), until);
  return {{"code", code}, {"until", utc_text(until)}};
}

json Desk::revoke(const json& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::revoke_station(turn.book, parse_public_key(text_in(asked, "public_key"), "the station's key"), reason_in(asked)).seq}};
}

std::string Desk::station_problem(const std::string& public_key) {
  Turn turn(*this);
  const std::int64_t now = read_clocks().utc_ns;
  return turn.book.registry().stations.problem(public_key, now, now);
}

json Desk::enrol(const std::string& request) {
  Turn turn(*this);
  const auto seq = ledger::enrol_station(turn.book, request, 0, "the station's request").seq;
  return {{"entry", seq}, {"name", turn.book.registry().stations.stations.back().name}};
}

void Desk::remove_dead_tickets(ledger::Ledger& book, std::int64_t now_utc_ns) const {
  constexpr std::int64_t k_for_makeups_ns = 60LL * 86'400 * 1'000'000'000;
  std::optional<std::map<std::string, ledger::Identity>> people;
  for (const auto& t : book.registry().tickets) {
    const std::string file = places_.ticket(t.ticket.nonce);
    const TicketState state = state_of(t, now_utc_ns);
    if (state.live || comes_back(book.registry(), t, now_utc_ns) || !std::filesystem::exists(file)) continue;
    if (state.group == "run out" && now_utc_ns - t.ticket.not_after_utc_ns < k_for_makeups_ns) {
      if (!people) people = people_of(book);
      if (people->contains(t.ticket.candidate)) continue;  // not forgotten
    }
    std::filesystem::remove(file);
  }
}

json Desk::station_tickets() {
  Turn turn(*this);
  const std::int64_t now = read_clocks().utc_ns;
  remove_dead_tickets(turn.book, now);
  json out = json::array();
  for (const auto& t : turn.book.registry().tickets)
    if (const std::string file = places_.ticket(t.ticket.nonce); state_of(t, now).live && std::filesystem::exists(file))
      out.push_back({{"candidate", t.ticket.candidate}, {"nonce", t.ticket.nonce}, {"text", read_text_file(file)}});
  return {{"tickets", out}};
}

json Desk::begin(const json& asked, const std::string& station) {
  const std::string nonce = text_in(asked, "ticket");
  Turn turn(*this, {"", "", station});
  for (const auto& t : turn.book.registry().tickets) {
    if (t.ticket.nonce != nonce || t.begins.empty() || t.used_by || t.cancelled_by) continue;
    const ledger::LedgerEntry& before = turn.book.content().entries.at(t.begins.back().seq);
    if (before.by.station == station)  // its answer was lost on the way
      return {{"begin", ledger::begin_text(*before.as<ledger::BeginEntry>())}};
  }
  return {{"begin", ledger::let_begin(turn.book, nonce, "")}};
}

std::string Desk::candidate_of(const std::string& nonce) {
  Turn turn(*this);
  for (const auto& t : turn.book.registry().tickets)
    if (t.ticket.nonce == nonce) return t.ticket.candidate;
  return {};
}

std::optional<std::uint64_t> Desk::filed(const std::string& file_sha256) {
  Turn turn(*this);
  for (const auto& s : turn.book.registry().sessions)
    if (s.file_sha256 == file_sha256) return s.seq;
  return std::nullopt;
}

json Desk::receipt(std::uint64_t entry) {
  Turn turn(*this);
  return turn.book.receipt(entry);
}

}  // namespace cavum::office
