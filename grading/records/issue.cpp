#include "grading/records/issue.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "grading/records/ledger_error.h"
#include "grading/records/reason.h"
#include "grading/records/registry.h"

namespace cavum::records {

Ticket promise(const scenarios::ExamSetup& setup, const LedgerContent& ledger,
               std::int64_t not_before_utc_ns, std::int64_t not_after_utc_ns) {
  Ticket t;
  t.ledger = ledger.id;
  t.public_key = ledger.public_key;
  t.exam = setup.scenario.id;
  t.not_before_utc_ns = not_before_utc_ns;
  t.not_after_utc_ns = not_after_utc_ns;
  t.artifacts = examined_artifacts(setup.session);
  t.grant = accommodations_in(setup.session);
  return t;
}

std::string issue(Ledger& ledger, Ticket ticket, const std::string& candidate, Another another) {
  ticket.candidate = candidate;
  ticket.nonce = random_hex(16);
  const SignedTicket made = sign_ticket(std::move(ticket), ledger.key());
  ledger.append([&](const LedgerContent&) {
    const Registry& registry = ledger.registry();  // as it is under the lock
    const std::string& exam = made.ticket.exam;
    const IssuedTicket* live = registry.live_ticket(candidate, exam, read_clocks().utc_ns);
    if (live != nullptr && another == Another::refuse)
      throw AnotherTicket(msg("candidate {}", candidate),
                          msg("has a ticket for {} that is good until {} (entry {})",
                              one_line(exam), utc_text(live->ticket.not_after_utc_ns), live->seq),
                          msg("cancel it with `cavum ledger cancel`, or add --another"));
    const auto sat = std::find_if(
        registry.sessions.begin(), registry.sessions.end(),
        [&](const FiledSession& s) { return s.candidate == candidate && s.scenario_id == exam; });
    if (sat != registry.sessions.end() && another == Another::refuse)
      throw AnotherTicket(
          msg("candidate {}", candidate), msg("has sat {} (entry {})", one_line(exam), sat->seq),
          msg("give a makeup sitting for it, or add --another: of several attempts the last one that is released counts"));
    return TicketEntry{made.ticket, made.signature, {}};
  });
  return made.text;
}

const LedgerEntry& cancel_ticket(Ledger& ledger, std::uint64_t seq, const std::string& reason) {
  require_reason(reason);
  return ledger.append(
      [&](const LedgerContent&) {
        const IssuedTicket* t = ledger.registry().ticket(seq);
        const Message where = msg("entry {}", seq);
        if (t == nullptr)
          throw Error(where, msg("is no ticket's entry"), msg("see `cavum ledger tickets`"));
        if (t->used_by)
          throw Error(
              LedgerError::used, where, msg("was used: its exam is filed as entry {}", *t->used_by),
              msg("there is nothing left to cancel: what becomes of its result is decided with `cavum ledger release`"));
        if (t->made_up_by)
          throw Error(where, msg("was made up by entry {}", *t->made_up_by),
                      msg("cancel that one, if it is too much"));
        if (t->cancelled_by)
          throw Error(LedgerError::ended, where,
                      msg("was cancelled before, by entry {}", *t->cancelled_by),
                      msg("nothing is left to do"));
        return CancelEntry{seq};
      },
      reason);
}

namespace {

bool meet(const TimeSpan& a, const Ticket& b) {
  return a.from_utc_ns < b.not_after_utc_ns && b.not_before_utc_ns < a.until_utc_ns;
}

}  // namespace

const IssuedTicket* seated_there(const Registry& registry, const std::string& station,
                                 const TimeSpan& when, std::uint64_t but_ticket, std::int64_t now) {
  for (const auto& t : registry.tickets)
    if (!station.empty() && t.seat == station && t.seq != but_ticket && t.live(now) &&
        meet(when, t.ticket))
      return &t;
  return nullptr;
}

std::vector<std::string> stations_of(const Registry& registry, Identities& identities,
                                     const std::vector<Person>& people,
                                     const std::vector<TimeSpan>& when, const std::string& where) {
  std::vector<std::string> keys(people.size());
  Mistakes mistakes(where);
  const auto find = [&](std::size_t i) {
    const Person& p = people[i];
    const std::string at = fmt::format("{}:{}: station", where, p.line);
    for (const Station& s : registry.stations.stations) {
      if (s.name != p.station || s.revoked_utc_ns || !s.replaced_by.empty()) continue;
      if (!keys[i].empty())
        throw Error(at, msg("two stations bear the name '{}'", one_line(p.station)),
                    msg("give each a name of its own"));
      keys[i] = s.public_key;
    }
    if (keys[i].empty())
      throw Error(at, msg("no station that is enrolled bears the name '{}'", one_line(p.station)),
                  msg("write it as the board does, or leave it empty"));
    if (when.empty()) return;
    const IssuedTicket* there =
        seated_there(registry, keys[i], when.at(i), 0, read_clocks().utc_ns);
    const auto who =
        there == nullptr ? std::nullopt : identities.of_pseudonym(there->ticket.candidate);
    if (there != nullptr && (!who || who->id != p.id))
      throw Error(at,
                  msg("'{}' has another candidate at that time (entry {})", one_line(p.station),
                      there->seq),
                  msg("choose another station"));
  };
  for (std::size_t i = 0; i < people.size(); ++i)
    if (!people[i].station.empty()) mistakes.unless([&] { find(i); });
  mistakes.tell();
  return keys;
}

std::vector<Issued> issue_list(Ledger& ledger, Identities& identities, const ListCommand& wish,
                               const KeepTicket& keep) {
  // before the first ticket: a name that is none refuses the list
  const auto stations =
      stations_of(ledger.registry(), identities, wish.people, wish.times, wish.where);
  std::vector<Issued> out;
  std::vector<Seat> seats;
  for (std::size_t i = wish.first; i < wish.end; ++i) {
    const Person& person = wish.people[i];
    Issued& one = out.emplace_back();
    Ticket ticket = wish.ticket;
    ticket.not_before_utc_ns = wish.times[i].from_utc_ns;
    ticket.not_after_utc_ns = wish.times[i].until_utc_ns;
    ticket.grant = scenarios::notes_of(together(wish.grant, person.grant));
    std::sort(ticket.grant.begin(), ticket.grant.end());
    one.person = person;
    one.candidate = identities.enrol(person.id, person.name, ticket.exam, ledger.key());
    try {
      const std::string text = issue(ledger, ticket, one.candidate, wish.another);
      one.ticket = parse_ticket(text, "", msg("the ticket"));
      one.entry = ledger.content().entries.back().seq;
      keep(one, text);
      if (!stations[i].empty()) seats.push_back({*one.entry, stations[i]});
    } catch (const AnotherTicket& has) {  // the others get theirs
      one.refused = has;
    }
  }
  if (!seats.empty()) seat_candidates(ledger, seats);
  return out;
}

const LedgerEntry& seat_candidates(Ledger& ledger, const std::vector<Seat>& seats) {
  if (seats.empty())
    throw Error(msg("the seats"), msg("are none"), msg("choose who is to sit where"));
  return ledger.append([&](const LedgerContent&) {
    const Registry& registry = ledger.registry();
    for (const Seat& s : seats) {
      const IssuedTicket* t = registry.ticket(s.ticket);
      if (t == nullptr || t->used_by || t->cancelled_by || t->made_up_by)
        throw Error(msg("entry {}", s.ticket), msg("is no ticket that is good"),
                    msg("look at the list of tickets again"));
      const Station* at = registry.stations.of(s.station);
      if (!s.station.empty() && (at == nullptr || at->revoked_utc_ns))
        throw Error(msg("station {}", one_line(s.station)), msg("is none that is enrolled"),
                    msg("choose one of the list"));
      const TimeSpan when{t->ticket.not_before_utc_ns, t->ticket.not_after_utc_ns};
      const bool twice =
          !s.station.empty() && std::any_of(seats.begin(), seats.end(), [&](const Seat& o) {
            const IssuedTicket* other = registry.ticket(o.ticket);
            return o.ticket != s.ticket && o.station == s.station && other != nullptr &&
                   meet(when, other->ticket);
          });
      const IssuedTicket* there =
          seated_there(registry, s.station, when, s.ticket, read_clocks().utc_ns);
      const bool moves =
          there != nullptr && std::any_of(seats.begin(), seats.end(),
                                          [&](const Seat& o) { return o.ticket == there->seq; });
      if (twice || (there != nullptr && !moves))
        throw Error(msg("station {}", one_line(at->name)),
                    msg("has another candidate at that time"), msg("choose another station"));
    }
    return SeatsEntry{seats};
  });
}

}  // namespace cavum::records
