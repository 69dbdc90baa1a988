#include "ui/office/day_parts.h"

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"

namespace cavum::office {

std::map<std::string, std::string> begun_at(const records::LedgerContent& content,
                                            const records::Registry& registry) {
  std::map<std::string, std::string> out;
  for (const auto& t : registry.tickets)
    if (!t.begins.empty() && !t.used_by && !t.cancelled_by)
      out[t.ticket.candidate] = content.entries.at(t.begins.back().seq).by.station;
  return out;
}

std::vector<std::string> twins_of(const records::StationRegister& stations,
                                  const std::map<std::string, std::string>& begun,
                                  const std::string& key, const Said& said, std::int64_t now) {
  const auto candidate_at = [&](const std::string& station) -> std::string {
    const auto found = said.find(station);
    if (found == said.end() || now - found->second.seen_utc_ns > k_silent_ns) return {};
    if (!found->second.refused.empty()) return found->second.refused;
    if (found->second.state == AtStation::ended) return {};
    return found->second.candidate;
  };
  std::vector<std::string> twins;
  const std::string candidate = candidate_at(key);
  if (candidate.empty()) return twins;
  const auto word = begun.find(candidate);
  for (const auto& other : stations.stations)
    if (other.public_key != key && ((word != begun.end() && word->second == other.public_key) ||
                                    candidate_at(other.public_key) == candidate))
      twins.push_back(other.name);
  return twins;
}

std::vector<const records::Announcement*> announced_to(const records::ExamDay& day,
                                                       const std::string& key, std::int64_t since,
                                                       std::int64_t now) {
  const std::int64_t from = (since == 0 ? now : since) - k_before_sign_in_ns;
  std::vector<const records::Announcement*> out;
  for (const auto& a : day.announcements)
    if (a.audience.holds(key) && a.utc_ns >= from && now - a.utc_ns < k_announced_ns)
      out.push_back(&a);
  return out;
}

std::size_t unread_by(const records::ExamDay& day, const std::string& key, const Said& said,
                      std::int64_t now) {
  const auto found = said.find(key);
  if (found == said.end() || found->second.since_utc_ns == 0 ||
      found->second.state == AtStation::ended)
    return 0;
  const auto all = announced_to(day, key, found->second.since_utc_ns, now);
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(),
                    [&](const records::Announcement* a) { return a->seq > found->second.heard; }));
}

std::vector<Notice> shown_holds(const records::ExamDay& day) {
  std::vector<Notice> out;
  for (const auto& h : day.holds)
    if (!h.ended_by)
      out.push_back({{h.seq, h.utc_ns, h.reason}, h.audience.room, h.audience.stations});
  return out;
}

std::vector<Notice> shown_announcements(const records::ExamDay& day, std::int64_t now) {
  std::vector<Notice> out;
  for (auto a = day.announcements.rbegin(); a != day.announcements.rend(); ++a)
    if (now - a->utc_ns < k_announced_ns)
      out.push_back({{a->seq, a->utc_ns, a->words}, a->audience.room, a->audience.stations});
  return out;
}

records::Audience audience_of(const ForWhom& to, const records::StationRegister& stations) {
  if (to.all) return {};
  if (!to.station.empty()) return {"", {to.station}};
  records::Audience a{to.room, {}};
  for (const auto& s : stations.stations)
    if (!a.room.empty() && s.room == a.room && !s.revoked_utc_ns && s.replaced_by.empty())
      a.stations.push_back(s.public_key);
  if (a.stations.empty())
    throw Error(msg("for whom"), msg("names no station that is enrolled"),
                msg("choose all, a room, or a station"));
  return a;
}

}  // namespace cavum::office
