// The desk's trail: the ledger's entries in words, the newest first.
#include <algorithm>
#include <map>

#include "engine/base/json_fields.h"
#include "engine/session/session.h"
#include "ui/office/day_parts.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"

namespace cavum::office {

using nlohmann::json;

namespace {

/// Whom and which exam an entry is about, by what it names.
class Trail {
 public:
  explicit Trail(const ledger::Registry& registry) : registry_(registry) {
    for (const auto& t : registry.tickets) {
      tickets_[t.seq] = t.ticket.candidate;
      for (const auto& b : t.begins) tickets_[b.seq] = t.ticket.candidate;
    }
    for (const auto& s : registry.sessions) {
      sessions_[s.seq] = s.candidate;
      for (const auto& r : s.regrades) sessions_[r.seq] = s.candidate;
    }
  }

  /// Without its people. Of incidents what happened only with `words`.
  [[nodiscard]] TrailEntry row(const ledger::LedgerEntry& e, bool words) const {
    const std::string account = text_in(e.body, "account");
    const std::string station = text_in(e.body, e.kind == "session" ? "station_key" : "station");
    return {e.seq, utc_text(e.utc_ns), what(e), account.empty() ? station_name(registry_, station) : account, why(e, words), number(e)};
  }

  /// Pseudonyms.
  [[nodiscard]] std::vector<std::string> people(const ledger::LedgerEntry& e) const {
    std::vector<std::string> out;
    const auto add = [&](const std::map<std::uint64_t, std::string>& known, std::int64_t seq) {
      const auto found = seq < 0 ? known.end() : known.find(static_cast<std::uint64_t>(seq));
      if (found != known.end() && std::find(out.begin(), out.end(), found->second) == out.end()) out.push_back(found->second);
    };
    if (const std::string who = text_in(e.body, "candidate"); !who.empty()) out.push_back(who);
    add(tickets_, static_cast<std::int64_t>(e.seq));
    if (e.kind == "cancel") add(tickets_, whole_in(e.body, "ticket"));
    if (e.kind == "regrade" || e.kind == "appeal" || e.kind == "passback") add(sessions_, whole_in(e.body, "session"));
    for (const json& result : member_of(e.body, "results")) add(sessions_, result.is_number_integer() ? result.get<std::int64_t>() : -1);
    for (const json& seat : member_of(e.body, "seats")) add(tickets_, whole_in(seat, "ticket"));
    for (const json& erased : member_of(e.body, "erased")) add(sessions_, whole_in(erased, "entry"));
    return out;
  }

 private:
  /// The kind of an entry; where one kind does several things, which of them.
  [[nodiscard]] std::string what(const ledger::LedgerEntry& e) const {
    if (e.kind == "ticket" && e.body.contains("makes_up")) return "makeup";
    if (e.kind == "begin" && e.body.contains("again")) return "begin again";
    if (e.kind == "session" && !member_of(e.body, "findings").empty()) return "session with findings";
    if (e.kind == "regrade" && !text_in(e.body, "person").empty()) return "decision";
    if (e.kind == "appeal" && e.body.contains("answers")) return "answer";
    return e.kind == "station" ? "station " + text_in(e.body, "action") : e.kind;
  }

  [[nodiscard]] std::string why(const ledger::LedgerEntry& e, bool words) const {
    if (e.kind == "announce") return text_in(e.body, "text");
    if (e.kind == "incident") return words ? text_opened(e, ledger::k_words) : "";
    if (e.kind == "station") return about_station(e);
    if (e.kind == "passback") return std::to_string(whole_in(e.body, "status"));
    return text_in(e.body, "reason");
  }

  /// Its name, and where it stands or why.
  [[nodiscard]] std::string about_station(const ledger::LedgerEntry& e) const {
    std::string name = text_in(e.body, "name");
    for (const auto& s : registry_.stations.stations)
      if (s.seq == e.seq || s.public_key == text_in(e.body, "public_key")) name = s.name;
    const std::string more = text_in(e.body, text_in(e.body, "action") == "room" ? "room" : "reason");
    return more.empty() ? name : name + ": " + more;
  }

  [[nodiscard]] static std::size_t number(const ledger::LedgerEntry& e) {
    for (const char* many : {"results", "seats", "erased"})
      if (const json& list = member_of(e.body, many); list.is_array()) return list.size();
    return 0;
  }

  const ledger::Registry& registry_;
  std::map<std::uint64_t, std::string> tickets_, sessions_;  // pseudonyms by entries: of tickets and begins; of sessions and regrades
};

}  // namespace

TrailPage Desk::trail(const AskTrail& asked, bool names) {
  constexpr std::size_t k_page = 200;
  Turn turn(*this);
  const auto people = people_of(turn.book);
  const auto is_asked = [&](const std::string& who) {
    const auto known = people.find(who);
    return who == asked.about || (names && known != people.end() && known->second.id == asked.about);
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
    if (!asked.about.empty() || everybody.size() == 1) {  // who is asked for, or the only one: of many the number is told
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
