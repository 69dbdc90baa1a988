// The desk's trail: the ledger's entries in words, the newest first.
#include <algorithm>
#include <map>

#include "engine/base/json_fields.h"
#include "engine/session/session.h"
#include "grading/records/entry_text.h"
#include "ui/office/day_parts.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"

namespace cavum::office {

using nlohmann::json;

namespace {

/// What the trail says of an entry.
struct TrailLine {
  std::string what;      ///< its kind; where one kind does several things, which of them
  std::string why = {};  ///< its reason, or what was said
  std::vector<std::uint64_t> about = {};  ///< entries of whom it is about
  std::string candidate = {};             ///< or himself, by his pseudonym
  std::size_t number = 0;                 ///< of results, seats or erased parts
};

/// Whom and which exam an entry is about, by what it names.
class Trail {
 public:
  explicit Trail(const records::Registry& registry) : registry_(registry) {
    for (const auto& t : registry.tickets) {
      people_[t.seq] = t.ticket.candidate;
      for (const auto& b : t.begins) people_[b.seq] = t.ticket.candidate;
    }
    for (const auto& s : registry.sessions) {
      people_[s.seq] = s.candidate;
      for (const auto& r : s.regrades) people_[r.seq] = s.candidate;
    }
  }

  /// Without its people. Of incidents what happened only with `words`.
  [[nodiscard]] TrailEntry row(const records::LedgerEntry& e, bool words) const {
    const auto* session = e.as<records::SessionEntry>();
    const TrailLine told = told_of(e, words);
    return {e.seq,
            utc_text(e.utc_ns),
            told.what,
            e.by.account.empty()
                ? station_name(registry_, session == nullptr ? e.by.station : session->station_key)
                : e.by.account,
            told.why,
            told.number};
  }

  /// Pseudonyms.
  [[nodiscard]] std::vector<std::string> people(const records::LedgerEntry& e) const {
    const TrailLine told = told_of(e, false);
    std::vector<std::string> out;
    if (!told.candidate.empty()) out.push_back(told.candidate);
    for (const auto seq : told.about)
      if (const auto who = people_.find(seq);
          who != people_.end() && std::find(out.begin(), out.end(), who->second) == out.end())
        out.push_back(who->second);
    return out;
  }

 private:
  [[nodiscard]] TrailLine told_of(const records::LedgerEntry& e, bool words) const {
    TrailLine t{e.what ? records::kind_name(*e.what) : "", e.by.reason, {}, {}, 0};
    const auto erased = [&](const std::vector<records::ErasedPart>& parts) {
      t.number = parts.size();
      for (const auto& part : parts) t.about.push_back(part.entry);
    };
    const auto of_station = [&](const std::string& name, const std::string& more) {
      t.why = more.empty() ? name : name + ": " + more;
    };
    const records::OfEach say{
        [](const records::InitEntry&) {},
        [&](const records::TicketEntry& x) {
          t.about = {e.seq};
          if (x.makes_up) t.what = "makeup";
        },
        [&](const records::CancelEntry& x) { t.about = {x.ticket}; },
        [&](const records::BeginEntry& x) {
          t.about = {e.seq};
          if (x.again) t.what = "begin again";
        },
        [&](const records::SessionEntry& x) {
          t.candidate = x.candidate;
          if (!x.findings.empty()) t.what = "session with findings";
        },
        [&](const records::RegradeEntry& x) {
          t.about = {x.session};
          if (!x.person.empty()) t.what = "decision";
        },
        [&](const records::ReleaseEntry& x) { t.about = x.results, t.number = x.results.size(); },
        [&](const records::RetractEntry& x) { t.about = x.results, t.number = x.results.size(); },
        [&](const records::AppealEntry& x) { t.about = {x.session}; },
        [&](const records::AnswerEntry& x) { t.about = {x.session}; },
        [&](const records::AnnounceEntry& x) { t.why = x.text; },
        [](const records::HoldEntry&) {},
        [](const records::GoOnEntry&) {},
        [&](const records::IncidentEntry& x) {
          t.candidate = x.candidate, t.why = words ? x.words.words() : "";
        },
        [&](const records::SeatsEntry& x) {
          t.number = x.seats.size();
          for (const auto& seat : x.seats) t.about.push_back(seat.ticket);
        },
        [&](const records::PassbackEntry& x) {
          t.about = {x.session}, t.why = std::to_string(x.status);
        },
        [&](const records::EraseEntry& x) { erased(x.erased); },
        [&](const records::ForgetEntry& x) { t.candidate = x.candidate, erased(x.erased); },
        [](const records::KeyEntry&) {},
        [](const records::RestoreEntry&) {},
        [&](const records::InviteEntry& x) { of_station(x.name, ""); },
        [&](const records::EnrolEntry& x) {
          of_station(station_name(registry_, x.asked.request.public_key), "");
        },
        [&](const records::RevokeEntry& x) {
          of_station(station_name(registry_, x.public_key), e.by.reason);
        },
        [&](const records::RoomEntry& x) {
          of_station(station_name(registry_, x.public_key), x.room);
        }};
    if (e.what) std::visit(say, *e.what);
    return t;
  }

  const records::Registry& registry_;
  std::map<std::uint64_t, std::string>
      people_;  // pseudonyms by entries: of tickets, begins, sessions and regrades
};

}  // namespace

TrailPage Desk::trail(const AskTrail& asked, bool names) {
  constexpr std::size_t k_page = 200;
  Turn turn(*this);
  const auto people = people_of(turn.book);
  const auto is_asked = [&](const std::string& who) {
    const auto known = people.find(who);
    return who == asked.about ||
           (names && known != people.end() && known->second.id == asked.about);
  };
  const Trail trail(turn.book.registry());
  const auto& entries = turn.book.content().entries;
  TrailPage out;
  std::size_t seq = std::min<std::size_t>(asked.before.value_or(entries.size()), entries.size());
  while (seq > 0 && out.entries.size() < k_page) {
    TrailEntry row = trail.row(entries[--seq], names);
    const auto everybody = trail.people(entries[seq]);
    const auto asked_for = std::find_if(everybody.begin(), everybody.end(), is_asked);
    if (!asked.about.empty() && asked_for == everybody.end()) continue;
    if (!asked.about.empty() ||
        everybody.size() == 1) {  // who is asked for, or the only one: of many the number is told
      row.people.push_back({asked.about.empty() ? everybody.front() : *asked_for, {}, {}});
      if (names) put_name(row.people.back(), people);
    }
    row.count = everybody.size();
    out.entries.push_back(std::move(row));
  }
  if (seq > 0) out.earlier = seq;
  return out;
}

}  // namespace cavum::office
