#include "ui/office/day_parts.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"

namespace cavum::office {

using nlohmann::json;

std::map<std::string, std::string> begun_at(const ledger::LedgerContent& content, const ledger::Registry& registry) {
  std::map<std::string, std::string> out;
  for (const auto& t : registry.tickets)
    if (!t.begins.empty() && !t.used_by && !t.cancelled_by) out[t.ticket.candidate] = content.entries.at(t.begins.back().seq).by.station;
  return out;
}

std::vector<std::string> twins_of(const ledger::StationRegister& stations, const std::map<std::string, std::string>& begun, const std::string& key,
                                  const Said& said, std::int64_t now) {
  const auto candidate_at = [&](const std::string& station) -> std::string {
    const auto found = said.find(station);
    if (found == said.end() || now - whole_in(found->second, "seen_utc_ns") > k_silent_ns) return {};
    if (std::string asked_for = text_in(found->second, "refused"); !asked_for.empty()) return asked_for;
    return text_in(found->second, "state") == "ended" ? "" : text_in(found->second, "candidate");
  };
  std::vector<std::string> twins;
  const std::string candidate = candidate_at(key);
  if (candidate.empty()) return twins;
  const auto word = begun.find(candidate);
  for (const auto& other : stations.stations)
    if (other.public_key != key && ((word != begun.end() && word->second == other.public_key) || candidate_at(other.public_key) == candidate))
      twins.push_back(other.name);
  return twins;
}

std::vector<const ledger::Announcement*> announced_to(const ledger::ExamDay& day, const std::string& key, std::int64_t since, std::int64_t now) {
  const std::int64_t from = (since == 0 ? now : since) - k_before_sign_in_ns;
  std::vector<const ledger::Announcement*> out;
  for (const auto& a : day.announcements)
    if (a.audience.holds(key) && a.utc_ns >= from && now - a.utc_ns < k_announced_ns) out.push_back(&a);
  return out;
}

std::size_t unread_by(const ledger::ExamDay& day, const std::string& key, const Said& said, std::int64_t now) {
  const auto found = said.find(key);
  if (found == said.end() || whole_in(found->second, "since_utc_ns") == 0 || text_in(found->second, "state") == "ended") return 0;
  const auto all = announced_to(day, key, whole_in(found->second, "since_utc_ns"), now);
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [&](const ledger::Announcement* a) { return static_cast<std::int64_t>(a->seq) > whole_in(found->second, "heard"); }));
}

json shown_holds(const ledger::ExamDay& day) {
  json out = json::array();
  for (const auto& h : day.holds)
    if (!h.ended_by)
      out.push_back({{"entry", h.seq}, {"utc_ns", h.utc_ns}, {"reason", h.reason}, {"room", h.audience.room}, {"stations", h.audience.stations}});
  return out;
}

json shown_announcements(const ledger::ExamDay& day, std::int64_t now) {
  json out = json::array();
  for (auto a = day.announcements.rbegin(); a != day.announcements.rend(); ++a)
    if (now - a->utc_ns < k_announced_ns)
      out.push_back({{"entry", a->seq}, {"utc_ns", a->utc_ns}, {"text", a->words}, {"room", a->audience.room}, {"stations", a->audience.stations}});
  return out;
}

ledger::Audience audience_of(const json& asked, const ledger::StationRegister& stations) {
  const json& to = member_of(asked, "to");
  if (member_of(to, "all") == true) return {};
  if (const std::string key = text_in(to, "station"); !key.empty()) return {"", {key}};
  ledger::Audience a{text_in(to, "room"), {}};
  for (const auto& s : stations.stations)
    if (!a.room.empty() && s.room == a.room && !s.revoked_utc_ns && s.replaced_by.empty()) a.stations.push_back(s.public_key);
  if (a.stations.empty()) throw Error("for whom", "names no station that is enrolled", "choose all, a room, or a station");
  return a;
}

}  // namespace cavum::office
