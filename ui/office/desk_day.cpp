// The desk on an exam day: announcements, pauses, incidents, who is not here, rooms and seats.
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/ledger/issue.h"
#include "ui/office/day_parts.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"
#include "ui/office/papers.h"

namespace cavum::office {

using nlohmann::json;

namespace {

/// Gives each ticket of a sitting that has no seat a station that nobody has at that time.
std::vector<ledger::Seat> free_seats(const ledger::Registry& registry, const std::string& exam, std::int64_t from, std::int64_t until,
                                     const std::string& room, std::int64_t now) {
  std::vector<ledger::Seat> seats;
  std::set<std::string> given;
  for (const auto& t : registry.tickets) {
    if (!state_of(t, now).live || t.ticket.exam != exam || t.ticket.not_before_utc_ns != from || t.ticket.not_after_utc_ns != until ||
        !t.seat.empty())
      continue;
    for (const auto& s : registry.stations.stations) {
      if (s.revoked_utc_ns || !s.replaced_by.empty() || (!room.empty() && s.room != room) || given.contains(s.public_key)) continue;
      if (ledger::seated_there(registry, s.public_key, {from, until}, t.seq, now) != nullptr) continue;
      seats.push_back({t.seq, s.public_key});
      given.insert(s.public_key);
      break;
    }
  }
  return seats;
}

}  // namespace

json Desk::announce(const json& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::announce(turn.book, text_in(asked, "text"), audience_of(asked, turn.book.registry().stations)).seq}};
}

json Desk::hold(const json& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::hold_exams(turn.book, text_in(asked, "reason"), audience_of(asked, turn.book.registry().stations)).seq}};
}

json Desk::go_on(const json& asked, const Account& by) {
  const auto hold = require_whole<std::uint64_t>(asked, "hold", "the pause");
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::let_go_on(turn.book, hold, text_in(asked, "reason")).seq}};
}

json Desk::note_incident(const json& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::note_incident(turn.book, text_in(asked, "station"), text_in(asked, "candidate"), text_in(asked, "words")).seq}};
}

json Desk::incidents() {
  Turn turn(*this);
  const ledger::Registry& registry = turn.book.registry();
  const auto people = people_of(turn.book);
  json out = json::array();
  for (auto i = registry.day.incidents.rbegin(); i != registry.day.incidents.rend(); ++i) {
    json row = {{"entry", i->seq},
                {"utc", utc_text(i->utc_ns)},
                {"by", i->account},
                {"station", station_name(registry, i->station)},
                {"candidate", i->candidate},
                {"words", i->words},
                {"erased", i->erased_by.has_value()}};
    put_name(row, people, i->candidate);
    out.push_back(std::move(row));
  }
  return {{"incidents", out}};
}

json Desk::attendance(const Board& board) {
  constexpr std::int64_t k_day_ns = 86'400'000'000'000;
  Turn turn(*this);
  const ledger::Registry& registry = turn.book.registry();
  const auto people = people_of(turn.book);
  const auto seen = board.candidates();
  const std::int64_t now = read_clocks().utc_ns;
  json out = json::array();
  for (const auto& t : registry.tickets) {
    if (t.used_by || t.cancelled_by || t.made_up_by || !t.begins.empty() || seen.contains(t.ticket.candidate)) continue;
    if (now < t.ticket.not_before_utc_ns || now > t.ticket.not_after_utc_ns + k_day_ns) continue;
    json row = {{"candidate", t.ticket.candidate},
                {"exam", t.ticket.exam},
                {"not_before", utc_text(t.ticket.not_before_utc_ns)},
                {"not_after", utc_text(t.ticket.not_after_utc_ns)},
                {"seat", station_name(registry, t.seat)},
                {"no_show", now > t.ticket.not_after_utc_ns}};
    put_name(row, people, t.ticket.candidate);
    out.push_back(std::move(row));
  }
  return {{"missing", out}};
}

json Desk::place(const json& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  return {{"entry", ledger::place_station(turn.book, text_in(asked, "public_key"), text_in(asked, "room")).seq}};
}

json Desk::seat(const json& asked, const Account& by) {
  Turn turn(*this, {by.name, "", ""});
  const ledger::Registry& registry = turn.book.registry();
  std::vector<ledger::Seat> seats;
  std::size_t left = 0;
  if (const json& sitting = member_of(asked, "sitting"); sitting.is_object()) {
    const std::string exam = text_in(sitting, "exam");
    const std::int64_t from = ledger::parse_utc(text_in(sitting, "not_before"), "the first moment"),
                       until = ledger::parse_utc(text_in(sitting, "not_after"), "the last moment"), now = read_clocks().utc_ns;
    seats = free_seats(registry, exam, from, until, text_in(asked, "room"), now);
    for (const auto& t : registry.tickets)
      left +=
          t.ticket.exam == exam && t.ticket.not_before_utc_ns == from && t.ticket.not_after_utc_ns == until && t.seat.empty() && state_of(t, now).live
              ? 1
              : 0;
    left -= seats.size();
    if (seats.empty()) throw Error("the sitting", "has nobody without a seat, or no station is free", "take another room or time");
  } else {
    seats.push_back({require_whole<std::uint64_t>(asked, "ticket", "the seat"), text_in(asked, "station")});
  }
  return {{"entry", ledger::seat_candidates(turn.book, seats).seq}, {"seated", seats.size()}, {"left", left}};
}

std::vector<Invited> Desk::invited_now() {
  Turn turn(*this);
  auto people = invited(turn.book, read_clocks().utc_ns);
  const json offered = exams().at("exams");
  for (auto& i : people) {
    i.accommodations = granted_on(i.nonce);
    for (const json& e : offered)
      if (e["id"] == i.exam) i.title = e["title"];
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

json Desk::word_for(const std::string& station, std::uint64_t heard, std::int64_t since_utc_ns) {
  Turn turn(*this);
  const ledger::Registry& registry = turn.book.registry();
  const std::int64_t now = read_clocks().utc_ns;
  json announcements = json::array();
  for (const auto* a : announced_to(registry.day, station, since_utc_ns, now))
    if (a->seq > heard) announcements.push_back({{"entry", a->seq}, {"utc_ns", a->utc_ns}, {"text", a->words}});
  const ledger::Hold* hold = registry.day.hold_of(station);
  std::size_t changes = registry.tickets.size();
  for (const auto& t : registry.tickets) changes += !state_of(t, now).live ? 1 : 0;
  return {{"utc_ns", now},
          {"tickets", changes},
          {"hold", hold == nullptr ? json() : json{{"entry", hold->seq}, {"reason", hold->reason}}},
          {"announcements", announcements}};
}

}  // namespace cavum::office
