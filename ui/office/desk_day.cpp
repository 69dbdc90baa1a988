// The desk on an exam day: announcements, pauses, incidents, who is not here, rooms and seats.
#include <algorithm>
#include <set>

#include "engine/session/session.h"
#include "grading/records/issue.h"
#include "ui/office/day_parts.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"
#include "ui/office/papers.h"

namespace cavum::office {

namespace {

/// Gives each ticket of a sitting that has no seat a station that nobody has at that time.
std::vector<records::Seat> free_seats(const records::Registry& registry, const std::string& exam,
                                      std::int64_t from, std::int64_t until,
                                      const std::string& room, std::int64_t now) {
  std::vector<records::Seat> seats;
  std::set<std::string> given;
  for (const auto& t : registry.tickets) {
    if (!t.live(now) || t.ticket.exam != exam || t.ticket.not_before_utc_ns != from ||
        t.ticket.not_after_utc_ns != until || !t.seat.empty())
      continue;
    for (const auto& s : registry.stations.stations) {
      if (s.revoked_utc_ns || !s.replaced_by.empty() || (!room.empty() && s.room != room) ||
          given.contains(s.public_key))
        continue;
      if (records::seated_there(registry, s.public_key, {from, until}, t.seq, now) != nullptr)
        continue;
      seats.push_back({t.seq, s.public_key});
      given.insert(s.public_key);
      break;
    }
  }
  return seats;
}

}  // namespace

Entered Desk::announce(const Announce& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {
      records::announce(turn.book, asked.text, audience_of(asked.to, turn.book.registry().stations))
          .seq};
}

Entered Desk::hold(const Hold& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::hold_exams(turn.book, asked.reason,
                              audience_of(asked.to, turn.book.registry().stations))
              .seq};
}

Entered Desk::go_on(const GoOn& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::let_go_on(turn.book, asked.hold, asked.reason).seq};
}

Entered Desk::note_incident(const NoteIncident& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::note_incident(turn.book, asked.station, asked.candidate, asked.words).seq};
}

Incidents Desk::incidents() {
  Turn turn(*this);
  const records::Registry& registry = turn.book.registry();
  const auto people = people_of(turn.book);
  Incidents out;
  for (auto i = registry.day.incidents.rbegin(); i != registry.day.incidents.rend(); ++i) {
    out.value.push_back({i->seq, utc_text(i->utc_ns), i->account,
                         station_name(registry, i->station), i->candidate, "", "", i->words,
                         i->erased_by.has_value()});
    put_name(out.value.back(), people);
  }
  return out;
}

Attendance Desk::attendance(const Board& board) {
  constexpr std::int64_t k_day_ns = 86'400'000'000'000;
  Turn turn(*this);
  const records::Registry& registry = turn.book.registry();
  const auto people = people_of(turn.book);
  const auto seen = board.candidates();
  const std::int64_t now = read_clocks().utc_ns;
  Attendance out;
  for (const auto& t : registry.tickets) {
    if (t.used_by || t.cancelled_by || t.made_up_by || !t.begins.empty() ||
        seen.contains(t.ticket.candidate))
      continue;
    if (now < t.ticket.not_before_utc_ns || now > t.ticket.not_after_utc_ns + k_day_ns) continue;
    out.value.push_back({t.ticket.candidate, "", "", t.ticket.exam,
                         utc_text(t.ticket.not_before_utc_ns), utc_text(t.ticket.not_after_utc_ns),
                         station_name(registry, t.seat), now > t.ticket.not_after_utc_ns});
    put_name(out.value.back(), people);
  }
  return out;
}

Entered Desk::place(const PlaceStation& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {records::place_station(turn.book, asked.public_key, asked.room).seq};
}

Seated Desk::seat(const SeatThem& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  const records::Registry& registry = turn.book.registry();
  std::vector<records::Seat> seats;
  std::size_t left = 0;
  if (asked.sitting) {
    const std::string& exam = asked.sitting->exam;
    const std::int64_t from =
                           records::parse_utc(asked.sitting->not_before, msg("the first moment")),
                       until = records::parse_utc(asked.sitting->not_after, msg("the last moment")),
                       now = read_clocks().utc_ns;
    seats = free_seats(registry, exam, from, until, asked.room, now);
    for (const auto& t : registry.tickets)
      left += t.ticket.exam == exam && t.ticket.not_before_utc_ns == from &&
                      t.ticket.not_after_utc_ns == until && t.seat.empty() && t.live(now)
                  ? 1
                  : 0;
    left -= seats.size();
    if (seats.empty())
      throw Error(msg("the sitting"), msg("has nobody without a seat, or no station is free"),
                  msg("take another room or time"));
  } else {
    if (!asked.ticket)
      throw Error(msg("'ticket'"), msg("is missing"), msg("name a sitting or a ticket"));
    seats.push_back({*asked.ticket, asked.station});
  }
  return {records::seat_candidates(turn.book, seats).seq, seats.size(), left};
}

std::vector<Invited> Desk::invited_now() {
  Turn turn(*this);
  auto people = invited(turn.book, read_clocks().utc_ns);
  const Exams offered = exams();
  for (auto& i : people) {
    i.accommodations = granted_on(i.nonce);
    for (const ExamFacts& e : offered.value)
      if (e.id == i.exam) i.title = e.title;
  }
  return people;
}

std::string Desk::cards() {
  const auto people = invited_now();  // stations are heard meanwhile
  const std::lock_guard guard(printing_);
  return candidate_cards(school_, people);
}

std::string Desk::sign_in_sheet() {
  const auto people = invited_now();
  const std::lock_guard guard(printing_);
  return sheet_to_sign(school_, people);
}

OfficeWord Desk::word_for(const std::string& station, std::uint64_t heard,
                          std::int64_t since_utc_ns) {
  Turn turn(*this);
  const records::Registry& registry = turn.book.registry();
  const std::int64_t now = read_clocks().utc_ns;
  OfficeWord word{now, registry.tickets.size(), {}, {}};
  for (const auto* a : announced_to(registry.day, station, since_utc_ns, now))
    if (a->seq > heard) word.announcements.push_back({a->seq, a->utc_ns, a->words});
  for (const auto& t : registry.tickets) word.tickets += !t.live(now) ? 1 : 0;
  if (const records::Hold* hold = registry.day.hold_of(station); hold != nullptr)
    word.hold = {hold->seq, hold->reason};
  return word;
}

}  // namespace cavum::office
