// The desk's trail: the ledger's entries in words, the newest first.
#include <algorithm>
#include <map>

#include "engine/base/json_fields.h"
#include "engine/session/session.h"
#include "grading/ledger/entry_text.h"
#include "ui/office/day_parts.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"

namespace cavum::office {

using nlohmann::json;

namespace {

/// What the trail says of an entry.
struct Told {
  std::string what;                       ///< its kind; where one kind does several things, which of them
  std::string why = {};                   ///< its reason, or what was said
  std::vector<std::uint64_t> about = {};  ///< entries of whom it is about
  std::string candidate = {};             ///< or himself, by his pseudonym
  std::size_t number = 0;                 ///< of results, seats or erased parts
};

/// Whom and which exam an entry is about, by what it names.
class Trail {
 public:
  explicit Trail(const ledger::Registry& registry) : registry_(registry) {
    for (const auto& t : registry.tickets) {
      people_[t.seq] = t.ticket.candidate;
      for (const auto& b : t.begins) people_[b.seq] = t.ticket.candidate;
    }
    for (const auto& s : registry.sessions) {
      people_[s.seq] = s.candidate;
      for (const auto& r : s.regrades) people_[r.seq] = s.candidate;
    }
  }

  /// {"entry","utc","what","by","why","number","people"}: `people` are pseudonyms; `number`: of results, seats or erased parts. Of incidents what
  /// happened only with `words`.
  [[nodiscard]] json row(const ledger::LedgerEntry& e, bool words) const {
    const auto* session = e.as<ledger::SessionEntry>();
    const Told told = told_of(e, words);
    std::vector<std::string> people;
    if (!told.candidate.empty()) people.push_back(told.candidate);
    for (const auto seq : told.about)
      if (const auto who = people_.find(seq); who != people_.end() && std::find(people.begin(), people.end(), who->second) == people.end())
        people.push_back(who->second);
    return {{"entry", e.seq},
            {"utc", utc_text(e.utc_ns)},
            {"what", told.what},
            {"by", e.by.account.empty() ? station_name(registry_, session == nullptr ? e.by.station : session->station_key) : e.by.account},
            {"why", told.why},
            {"number", told.number},
            {"people", people}};
  }

 private:
  [[nodiscard]] Told told_of(const ledger::LedgerEntry& e, bool words) const {
    Told t{e.what ? ledger::kind_name(*e.what) : "", e.by.reason, {}, {}, 0};
    const auto erased = [&](const std::vector<ledger::ErasedPart>& parts) {
      t.number = parts.size();
      for (const auto& part : parts) t.about.push_back(part.entry);
    };
    const auto of_station = [&](const std::string& name, const std::string& more) { t.why = more.empty() ? name : name + ": " + more; };
    const ledger::OfEach say{[](const ledger::InitEntry&) {},
                             [&](const ledger::TicketEntry& x) {
                               t.about = {e.seq};
                               if (x.makes_up) t.what = "makeup";
                             },
                             [&](const ledger::CancelEntry& x) { t.about = {x.ticket}; },
                             [&](const ledger::BeginEntry& x) {
                               t.about = {e.seq};
                               if (x.again) t.what = "begin again";
                             },
                             [&](const ledger::SessionEntry& x) {
                               t.candidate = x.candidate;
                               if (!x.findings.empty()) t.what = "session with findings";
                             },
                             [&](const ledger::RegradeEntry& x) {
                               t.about = {x.session};
                               if (!x.person.empty()) t.what = "decision";
                             },
                             [&](const ledger::ReleaseEntry& x) { t.about = x.results, t.number = x.results.size(); },
                             [&](const ledger::RetractEntry& x) { t.about = x.results, t.number = x.results.size(); },
                             [&](const ledger::AppealEntry& x) { t.about = {x.session}; },
                             [&](const ledger::AnswerEntry& x) { t.about = {x.session}; },
                             [&](const ledger::AnnounceEntry& x) { t.why = x.text; },
                             [](const ledger::HoldEntry&) {},
                             [](const ledger::GoOnEntry&) {},
                             [&](const ledger::IncidentEntry& x) { t.candidate = x.candidate, t.why = words ? x.words.words() : ""; },
                             [&](const ledger::SeatsEntry& x) {
                               t.number = x.seats.size();
                               for (const auto& seat : x.seats) t.about.push_back(seat.ticket);
                             },
                             [&](const ledger::PassbackEntry& x) { t.about = {x.session}, t.why = std::to_string(x.status); },
                             [&](const ledger::EraseEntry& x) { erased(x.erased); },
                             [&](const ledger::ForgetEntry& x) { t.candidate = x.candidate, erased(x.erased); },
                             [](const ledger::KeyEntry&) {},
                             [](const ledger::RestoreEntry&) {},
                             [&](const ledger::InviteEntry& x) { of_station(x.name, ""); },
                             [&](const ledger::EnrolEntry& x) { of_station(station_name(registry_, x.asked.request.public_key), ""); },
                             [&](const ledger::RevokeEntry& x) { of_station(station_name(registry_, x.public_key), e.by.reason); },
                             [&](const ledger::RoomEntry& x) { of_station(station_name(registry_, x.public_key), x.room); }};
    if (e.what) std::visit(say, *e.what);
    return t;
  }

  const ledger::Registry& registry_;
  std::map<std::uint64_t, std::string> people_;  // pseudonyms by entries: of tickets, begins, sessions and regrades
};

}  // namespace

json Desk::trail(const json& asked, bool names) {
  constexpr std::size_t k_page = 200;
  const std::string about = text_in(asked, "about");
  const json& before = member_of(asked, "before");
  Turn turn(*this);
  const auto people = people_of(turn.book);
  const auto is_asked = [&](const json& who) {
    const auto known = people.find(who.get<std::string>());
    return who == about || (names && known != people.end() && known->second.id == about);
  };
  const Trail trail(turn.book.registry());
  const auto& entries = turn.book.content().entries;
  json out = json::array();
  std::size_t seq = before.is_number_unsigned() ? std::min<std::size_t>(before.get<std::size_t>(), entries.size()) : entries.size();
  while (seq > 0 && out.size() < k_page) {
    json row = trail.row(entries[--seq], names);
    const json everybody = row["people"];
    const auto asked_for = std::find_if(everybody.begin(), everybody.end(), is_asked);
    if (!about.empty() && asked_for == everybody.end()) continue;
    json& shown = row["people"] = json::array();  // who is asked for, or the only one: of many the number is told
    if (!about.empty() || everybody.size() == 1) {
      shown.push_back({{"candidate", about.empty() ? everybody.front() : *asked_for}});
      if (names) put_name(shown.back(), people, shown.back()["candidate"]);
    }
    row["count"] = everybody.size();
    out.push_back(std::move(row));
  }
  return {{"entries", out}, {"earlier", seq > 0 ? json(seq) : json()}};
}

}  // namespace cavum::office
