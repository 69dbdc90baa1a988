#include "grading/ledger/issue.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "grading/ledger/registry.h"

namespace cavum::ledger {

Ticket promise(const scenarios::ExamSetup& setup, const LedgerContent& ledger, std::int64_t not_before_utc_ns, std::int64_t not_after_utc_ns) {
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
  std::string text = sign_ticket(ticket, ledger.key());
  ledger.append("ticket", [&](const LedgerContent&) {
    const Registry& registry = ledger.registry();  // as it is under the lock
    const IssuedTicket* live = registry.live_ticket(candidate, ticket.exam, read_clocks().utc_ns);
    if (live != nullptr && another == Another::refuse)
      throw AnotherTicket("candidate " + candidate,
                          fmt::format("has a ticket for {} that is good until {} (entry {})", one_line(ticket.exam),
                                      utc_text(live->ticket.not_after_utc_ns), live->seq),
                          "cancel it with `cavum ledger cancel`, or add --another");
    const auto sat = std::find_if(registry.sessions.begin(), registry.sessions.end(),
                                  [&](const FiledSession& s) { return s.candidate == candidate && s.scenario_id == ticket.exam; });
    if (sat != registry.sessions.end() && another == Another::refuse)
      throw AnotherTicket("candidate " + candidate, fmt::format("has sat {} (entry {})", one_line(ticket.exam), sat->seq),
                          "give a makeup sitting for it, or add --another: of several attempts the last one that is released counts");
    return without_grant(text);
  });
  return text;
}

const LedgerEntry& cancel_ticket(Ledger& ledger, std::uint64_t seq, const std::string& reason) {
  constexpr std::size_t k_longest = 2000;
  if (reason.size() > k_longest || !is_seen_text(reason))
    throw Error("--reason", "is no line of text of at most 2000 bytes", "say why, without names: it is kept for ever");
  return ledger.append("cancel", [&](const LedgerContent&) -> nlohmann::json {
    const Registry& registry = ledger.registry();
    const auto t = std::find_if(registry.tickets.begin(), registry.tickets.end(), [&](const IssuedTicket& issued) { return issued.seq == seq; });
    const std::string where = fmt::format("--ticket {}", seq);
    if (t == registry.tickets.end()) throw Error(where, "is no ticket's entry", "see `cavum ledger tickets`");
    if (t->used_by)
      throw Error(where, fmt::format("was used: its exam is filed as entry {}", *t->used_by),
                  "there is nothing left to cancel: what becomes of its result is decided with `cavum ledger release`");
    if (t->made_up_by) throw Error(where, fmt::format("was made up by entry {}", *t->made_up_by), "cancel that one, if it is too much");
    if (t->cancelled_by) throw Error(where, fmt::format("was cancelled before, by entry {}", *t->cancelled_by), "nothing is left to do");
    return {{"ticket", seq}, {"reason", reason}};
  });
}

namespace {

bool meet(const TimeSpan& a, const Ticket& b) { return a.from_utc_ns < b.not_after_utc_ns && b.not_before_utc_ns < a.until_utc_ns; }

}  // namespace

const IssuedTicket* seated_there(const Registry& registry, const std::string& station, const TimeSpan& when, std::uint64_t but_ticket,
                                 std::int64_t now) {
  for (const auto& t : registry.tickets)
    if (!station.empty() && t.seat == station && t.seq != but_ticket && t.live(now) && meet(when, t.ticket)) return &t;
  return nullptr;
}

std::vector<std::string> stations_of(const Registry& registry, Identities& identities, const std::vector<Person>& people,
                                     const std::vector<TimeSpan>& when, const std::string& where) {
  std::vector<std::string> keys(people.size());
  Mistakes mistakes(where);
  const auto find = [&](std::size_t i) {
    const Person& p = people[i];
    const std::string at = fmt::format("{}:{}: station", where, p.line);
    for (const Station& s : registry.stations.stations) {
      if (s.name != p.station || s.revoked_utc_ns || !s.replaced_by.empty()) continue;
      if (!keys[i].empty()) throw Error(at, fmt::format("two stations bear the name '{}'", one_line(p.station)), "give each a name of its own");
      keys[i] = s.public_key;
    }
    if (keys[i].empty())
      throw Error(at, fmt::format("no station that is enrolled bears the name '{}'", one_line(p.station)),
                  "write it as the board does, or leave it empty");
    if (when.empty()) return;
    const IssuedTicket* there = seated_there(registry, keys[i], when.at(i), 0, read_clocks().utc_ns);
    const auto who = there == nullptr ? std::nullopt : identities.of_pseudonym(there->ticket.candidate);
    if (there != nullptr && (!who || who->id != p.id))
      throw Error(at, fmt::format("'{}' has another candidate at that time (entry {})", one_line(p.station), there->seq), "choose another station");
  };
  for (std::size_t i = 0; i < people.size(); ++i)
    if (!people[i].station.empty()) mistakes.unless([&] { find(i); });
  mistakes.tell();
  return keys;
}

const LedgerEntry& seat_candidates(Ledger& ledger, const std::vector<Seat>& seats) {
  if (seats.empty()) throw Error("the seats", "are none", "choose who is to sit where");
  return ledger.append("seats", [&](const LedgerContent&) -> nlohmann::json {
    const Registry& registry = ledger.registry();
    nlohmann::json list = nlohmann::json::array();
    for (const Seat& s : seats) {
      const auto t = std::find_if(registry.tickets.begin(), registry.tickets.end(), [&](const IssuedTicket& i) { return i.seq == s.ticket; });
      if (t == registry.tickets.end() || t->used_by || t->cancelled_by || t->made_up_by)
        throw Error(fmt::format("entry {}", s.ticket), "is no ticket that is good", "look at the list of tickets again");
      const Station* at = registry.stations.of(s.station);
      if (!s.station.empty() && (at == nullptr || at->revoked_utc_ns))
        throw Error("station " + one_line(s.station), "is none that is enrolled", "choose one of the list");
      const TimeSpan when{t->ticket.not_before_utc_ns, t->ticket.not_after_utc_ns};
      const bool twice = !s.station.empty() && std::any_of(seats.begin(), seats.end(), [&](const Seat& o) {
        const auto other = std::find_if(registry.tickets.begin(), registry.tickets.end(), [&](const IssuedTicket& i) { return i.seq == o.ticket; });
        return o.ticket != s.ticket && o.station == s.station && other != registry.tickets.end() && meet(when, other->ticket);
      });
      const IssuedTicket* there = seated_there(registry, s.station, when, s.ticket, read_clocks().utc_ns);
      const bool moves = there != nullptr && std::any_of(seats.begin(), seats.end(), [&](const Seat& o) { return o.ticket == there->seq; });
      if (twice || (there != nullptr && !moves))
        throw Error("station " + one_line(at->name), "has another candidate at that time", "choose another station");
      list.push_back({{"ticket", s.ticket}, {"station", s.station}});
    }
    return {{"seats", list}};
  });
}

}  // namespace cavum::ledger
