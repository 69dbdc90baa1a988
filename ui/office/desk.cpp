#include "ui/office/desk.h"

#include <algorithm>
#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "grading/records/begin.h"
#include "grading/records/decision.h"
#include "grading/records/entry_text.h"
#include "grading/records/erasure.h"
#include "grading/records/exports.h"
#include "grading/records/identities.h"
#include "grading/records/issue.h"
#include "grading/records/makeup.h"
#include "grading/records/regrade.h"
#include "grading/records/release.h"
#include "grading/records/ticket_state.h"
#include "scenarios/file/parse.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
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
bool comes_back(const records::Registry& registry, const records::IssuedTicket& first,
                std::int64_t now_utc_ns) {
  const records::IssuedTicket* makeup =
      first.made_up_by ? registry.ticket(*first.made_up_by) : nullptr;
  return makeup != nullptr && makeup->begins.empty() && makeup->live(now_utc_ns);
}

/// Who begins a sitting at its last moment is done before the next one begins, unless it is said
/// that they may overlap.
void require_apart(const IssueCommand& wish, std::int64_t apart_ns, std::int64_t longest_s) {
  constexpr std::int64_t k_second_ns = 1'000'000'000, k_minute_s = 60;
  const std::int64_t late_s =
      (wish.until_utc_ns - wish.from_utc_ns - apart_ns) / k_second_ns + longest_s;
  if (late_s > 0)
    throw Error(
        msg("the sittings"),
        msg("overlap: who begins one at its last moment sits until {} min after the next may begin",
            (late_s + k_minute_s - 1) / k_minute_s),
        msg("set them farther apart, let each begin in a shorter time, or say that they may overlap"));
}

}  // namespace

Desk::Desk(const std::string& ledger_folder, const SigningKey& school, OfficePaths places,
           std::vector<std::string> exams)
    : ledger_(ledger_folder, school), places_(std::move(places)), exams_(std::move(exams)) {
  id_ = ledger_.content().id;
  school_ = ledger_.content().school;
  public_key_ = ledger_.content().public_key;
  places_.folder += "/" + id_;
  make_private_folder(places_.folder + "/tickets");
  for (const auto& file : exams_) {  // steps and criteria of its exams, in the office's language
    const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file), file);
    if (const auto words = s.languages.find(language()); words != s.languages.end())
      add_translations(words->second);
  }
}

Exams Desk::exams() const {
  Exams out;
  for (const auto& file : exams_) out.value.push_back(exam_facts(file));
  return out;
}

Preview Desk::preview(const ClassList& asked) {
  Roster roster = roster_of(asked);
  try {
    Turn turn(*this);
    records::Identities identities = records::sound_identities(turn.book);
    static_cast<void>(
        records::stations_of(turn.book.registry(), identities, roster.people, {}, k_list));
  } catch (const Error& wrong) {
    roster.people.clear();
    roster.problems = mistakes_of(wrong);
  }
  Preview out = shown_roster(roster);
  const Grants grants = grants_of(roster);
  for (const std::string& file : exams_)
    out.longest_s[exam_facts(file).id] = time_limit_s(file, grants);
  return out;
}

Issued Desk::issue(const Issue& asked, const Account& by) {
  constexpr std::int64_t k_minute_ns = 60'000'000'000;
  const Roster roster = roster_of(asked);
  if (!roster.ready())
    throw Error(msg("the list"),
                roster.problems.empty() ? msg("has columns that nobody answered for")
                                        : msg("{}", cavum::List{roster.problems, true}),
                msg("answer, and look at the preview again"));
  const IssueCommand wish = issue_command(asked.exam, asked.from, asked.until, exams_);
  if (asked.at_once && !asked.minutes_apart)
    throw Error(msg("'minutes_apart'"), msg("is missing"),
                msg("say how far apart the sittings are"));
  const std::size_t at_once = asked.at_once ? static_cast<std::size_t>(*asked.at_once)
                                            : std::max<std::size_t>(1, roster.people.size());
  const std::int64_t apart_ns = asked.at_once ? *asked.minutes_apart * k_minute_ns : 0;
  if (at_once < roster.people.size() && !asked.overlap)
    require_apart(wish, apart_ns, time_limit_s(wish.scenario, grants_of(roster)));
  const auto setup = scenarios::prepare_exam(wish.scenario, {});
  Turn turn(*this, {by.name, asked.reason, ""});
  records::Identities identities = records::sound_identities(turn.book);
  records::Ticket ticket =
      records::promise(*setup, turn.book.content(), wish.from_utc_ns, wish.until_utc_ns);
  ticket.begun_at_ledger = asked.begin_at_office;
  std::vector<records::TimeSpan> times;
  for (std::size_t i = 0; i < roster.people.size(); ++i) {
    const std::int64_t later_ns = static_cast<std::int64_t>(i / at_once) * apart_ns;
    times.push_back({wish.from_utc_ns + later_ns, wish.until_utc_ns + later_ns});
  }
  Issued out{{}, {}, 0, roster.people.size()};
  const std::size_t first = std::min(asked.first, out.of);
  out.done = first + std::min(asked.most.value_or(out.of), out.of - first);
  const auto keep = [&](const records::Issued& one, const std::string& text) {
    write_private_text_file(places_.ticket(one.ticket.nonce), text + "\n");
  };
  const auto another = asked.another ? records::Another::allow : records::Another::refuse;
  for (const auto& one : records::issue_list(
           turn.book, identities,
           {ticket, roster.people, times, k_list, first, out.done, {}, another}, keep)) {
    if (one.refused)
      out.refused.push_back({one.person.id, one.person.name, tr(one.refused->where_and_problem())});
    else
      out.issued.push_back({one.candidate, one.person.id, one.person.name, one.person.station,
                            utc_text(one.ticket.not_before_utc_ns),
                            utc_text(one.ticket.not_after_utc_ns)});
  }
  return out;
}

MadeUp Desk::make_up(const MakeUp& asked, const Account& by) {
  const std::uint64_t first = asked.ticket;
  std::string exam;
  {
    Turn turn(*this);
    if (const auto* t = turn.book.registry().ticket(first)) exam = t->ticket.exam;
  }
  const IssueCommand wish = issue_command(exam, asked.from, asked.until, exams_);
  const auto setup = scenarios::prepare_exam(wish.scenario, {});
  auto grant = grant_in(asked);
  Turn turn(*this, {by.name, "", ""});
  Message why_not;
  if (const auto* t = turn.book.registry().ticket(
          first);  // before what is granted: of one that has a makeup nothing may be kept
      t != nullptr &&
      records::makeup_reasons(turn.book.registry(), *t, read_clocks().utc_ns, why_not).empty())
    throw Error(msg("the ticket of entry {}", first), why_not,
                msg("look at the list of tickets again"));
  if (!grant) grant = first_grant(turn.book, first);
  records::Ticket ticket =
      records::promise(*setup, turn.book.content(), wish.from_utc_ns, wish.until_utc_ns);
  ticket.begun_at_ledger = asked.begin_at_office;
  ticket.grant = *grant;
  const std::string text = records::issue_makeup(
      turn.book, ticket,
      {first, records::of_word<records::FirstSitting>(asked.became, "what became of the first"),
       asked.reason});
  const records::Ticket issued = records::parse_ticket(text, "", msg("the ticket"));
  write_private_text_file(places_.ticket(issued.nonce), text + "\n");
  remove_dead_tickets(turn.book, read_clocks().utc_ns);
  return {
      turn.book.content().entries.size() - 1, issued.candidate,
      tr(scenarios::accommodations_text(scenarios::granted({}, issued.grant, msg("the ticket"))))};
}

bool Desk::keeps_grant(const records::Registry& registry, const records::IssuedTicket& t) const {
  if (std::filesystem::exists(places_.ticket(t.ticket.nonce))) return true;
  const records::FiledSession* sat = t.used_by ? registry.session(*t.used_by) : nullptr;
  return sat != nullptr && !sat->motion_erased_by;
}

std::vector<std::pair<std::string, std::string>> Desk::first_grant(records::Ledger& book,
                                                                   std::uint64_t ticket) const {
  const auto& registry = book.registry();
  const records::IssuedTicket* t = registry.ticket(ticket);
  if (t == nullptr || !keeps_grant(registry, *t))
    throw Error(msg("the accommodations"), msg("of the first ticket are not kept any more"),
                msg("say them again"));
  if (const std::string file = places_.ticket(t->ticket.nonce); std::filesystem::exists(file))
    return records::parse_ticket(read_text_file(file), "", msg("the first ticket")).grant;
  const records::FiledSession* sat = registry.session(*t->used_by);
  return records::accommodations_in(
      SessionReader(records::recording_of(book.places(), *sat)).setup());
}

std::vector<std::pair<std::string, std::string>> Desk::grant_on(const std::string& nonce) const {
  if (!std::filesystem::exists(places_.ticket(nonce))) return {};
  return records::parse_ticket(read_text_file(places_.ticket(nonce)), "", msg("the ticket")).grant;
}

std::string Desk::granted_on(const std::string& nonce) const {
  return tr(
      scenarios::accommodations_text(scenarios::granted({}, grant_on(nonce), msg("the ticket"))));
}

Tickets Desk::tickets(bool grants, const std::set<std::string>& seen) {
  const Exams offered = exams();  // files are read while nobody waits
  Turn turn(*this);
  const auto people = people_of(turn.book);
  const std::int64_t now = read_clocks().utc_ns;
  remove_dead_tickets(turn.book, now);
  Tickets out;
  std::map<std::string, Grants> granted;  // by exam
  for (const auto& t : turn.book.registry().tickets) {
    const records::TicketState state = records::state_of(t, now);
    TicketRow row{.entry = t.seq,
                  .candidate = t.ticket.candidate,
                  .exam = t.ticket.exam,
                  .state = tr(state.words),
                  .seat = t.seat,
                  .why = t.why};
    row.not_before = utc_text(t.ticket.not_before_utc_ns);
    row.not_after = utc_text(t.ticket.not_after_utc_ns);
    row.live = t.live(now);
    row.at_station = std::filesystem::exists(places_.ticket(t.ticket.nonce));
    row.grant_stored = keeps_grant(turn.book.registry(), t);
    row.begun = state.group == records::TicketStatus::begun || seen.contains(t.ticket.candidate);
    Message why_not;
    if (const auto* makeup = t.made_up_by ? turn.book.registry().ticket(*t.made_up_by) : nullptr)
      row.became = records::word_of(makeup->makes_up->became);
    for (const auto became : records::makeup_reasons(turn.book.registry(), t, now, why_not))
      row.makeup.emplace_back(records::word_of(became));
    put_name(row, people);
    if (grants) row.accommodations = granted_on(t.ticket.nonce);
    if (row.live) granted[t.ticket.exam].push_back(grant_on(t.ticket.nonce));
    out.tickets.push_back(std::move(row));
  }
  for (ExamFacts facts :
       offered.value) {  // those of which tickets are good, with how long they take
    const auto good = granted.find(facts.id);
    if (good == granted.end()) continue;
    if (grants) facts.longest_s = time_limit_s(facts.file, good->second);
    out.exams.push_back(std::move(facts));
  }
  return out;
}

Entered Desk::cancel(const CancelTicket& asked, const Account& by,
                     const std::set<std::string>& seen) {
  Turn turn(*this, {by.name, "", ""});
  if (const auto* t = turn.book.registry().ticket(asked.entry);
      t != nullptr && (!t->begins.empty() || seen.contains(t->ticket.candidate)) && !asked.begun)
    throw Error(one_line(t->ticket.candidate),
                msg("has begun, and what is handed in would be refused"),
                msg("say that it is meant; a makeup keeps what was sat on record"));
  const auto seq = records::cancel_ticket(turn.book, asked.entry, asked.reason).seq;
  remove_dead_tickets(turn.book, read_clocks().utc_ns);
  return {seq};
}

BoardShown Desk::board(const Board& board, const Inbox& inbox) {
  Turn turn(*this);
  const records::Registry& registry = turn.book.registry();
  const std::int64_t now = read_clocks().utc_ns;
  const auto said = board.stations();
  const auto begun = begun_at(turn.book.content(), registry);
  BoardShown out{now,
                 {},
                 {},
                 shown_holds(registry.day),
                 shown_announcements(registry.day, now),
                 {inbox.waiting(), tr(inbox.trouble()), {}}};
  for (const auto& s : registry.stations.stations) {
    if (!s.replaced_by.empty()) continue;
    const records::Hold* hold = registry.day.hold_of(s.public_key);
    StationShown row{s.name,
                     s.public_key,
                     s.room,
                     s.seq,
                     hold == nullptr ? 0 : hold->seq,
                     s.revoked_utc_ns.has_value()};
    row.unread = unread_by(registry.day, s.public_key, said, now);
    row.twins = twins_of(registry.stations, begun, s.public_key, said, now);
    if (const auto found = said.find(s.public_key); found != said.end()) row.report = found->second;
    out.stations.push_back(std::move(row));
  }
  for (const auto& t : registry.tickets)
    ++out.tickets[std::string(records::name_of(records::state_of(t, now).group))];
  for (const auto& [hash, exam] : inbox.refused()) {
    const auto is_it = [&sha256 = hash](const records::FiledSession& s) {
      return s.file_sha256 == sha256;
    };
    if (std::any_of(registry.sessions.begin(), registry.sessions.end(), is_it))
      continue;  // and filed later
    const auto& all = registry.stations.stations;
    const auto from = std::find_if(
        all.begin(), all.end(),
        [&key = exam.station](const records::Station& s) { return s.public_key == key; });
    out.inbox.refused.push_back(
        {hash, exam.candidate, from == all.end() ? "" : from->name, shown_each(exam.findings)});
  }
  return out;
}

InviteCode Desk::invite(const Invite& asked, const Account& by) {
  constexpr std::int64_t k_week_of_ns = 7 * 86'400'000'000'000;
  const std::int64_t until = read_clocks().utc_ns + k_week_of_ns;
  Turn turn(*this, {by.name, "", ""});
  return {records::invite_station(turn.book, asked.value, until), utc_text(until)};
}

Entered Desk::revoke(const RevokeStation& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::revoke_station(
              turn.book, parse_public_key(asked.public_key, msg("the station's key")), asked.reason)
              .seq};
}

Message Desk::station_problem(const std::string& public_key) {
  Turn turn(*this);
  const std::int64_t now = read_clocks().utc_ns;
  const auto problem = turn.book.registry().stations.problem(public_key, now, now);
  return problem ? problem->message() : Message();
}

Enrolled Desk::enrol(const std::string& request) {
  Turn turn(*this);
  const auto seq = records::enrol_station(turn.book, request, 0, "the station's request").seq;
  return {seq, turn.book.registry().stations.stations.back().name};
}

void Desk::remove_dead_tickets(records::Ledger& book, std::int64_t now_utc_ns) const {
  constexpr std::int64_t k_for_makeups_ns = 60LL * 86'400 * 1'000'000'000;
  std::optional<std::map<std::string, records::Identity>> people;
  for (const auto& t : book.registry().tickets) {
    const std::string file = places_.ticket(t.ticket.nonce);
    if (t.live(now_utc_ns) || comes_back(book.registry(), t, now_utc_ns) ||
        !std::filesystem::exists(file))
      continue;
    if (records::state_of(t, now_utc_ns).group == records::TicketStatus::run_out &&
        now_utc_ns - t.ticket.not_after_utc_ns < k_for_makeups_ns) {
      if (!people) people = people_of(book);
      if (people->contains(t.ticket.candidate)) continue;  // not forgotten
    }
    std::filesystem::remove(file);
  }
}

StationTickets Desk::station_tickets() {
  Turn turn(*this);
  const std::int64_t now = read_clocks().utc_ns;
  remove_dead_tickets(turn.book, now);
  StationTickets out;
  for (const auto& t : turn.book.registry().tickets)
    if (const std::string file = places_.ticket(t.ticket.nonce);
        t.live(now) && std::filesystem::exists(file))
      out.value.push_back({t.ticket.candidate, t.ticket.nonce, read_text_file(file)});
  return out;
}

WordToBegin Desk::begin(const AskBegin& asked, const std::string& station) {
  const std::string& nonce = asked.value;
  Turn turn(*this, {"", "", station});
  for (const auto& t : turn.book.registry().tickets) {
    if (t.ticket.nonce != nonce || t.begins.empty() || t.used_by || t.cancelled_by) continue;
    const records::LedgerEntry& before = turn.book.content().entries.at(t.begins.back().seq);
    if (before.by.station == station)  // its answer was lost on the way
      return {records::begin_text(*before.as<records::BeginEntry>())};
  }
  return {records::let_begin(turn.book, nonce, "")};
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
