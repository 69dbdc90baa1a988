#include "engine/session/station_check.h"

#include "engine/session/chain.h"

namespace cavum {

std::vector<Message> check_stations(const SessionReader& session) {
  std::vector<Message> findings;
  const std::string begun = session.fact(k_station_fact);
  for (const auto& e : session.event_rows()) {
    const auto* gap = e.as<RecordingGap>();
    if (gap == nullptr) continue;
    const std::string& by = gap->station_key;
    if (by != begun)
      findings.push_back(msg("the exam was taken up again at tick {} by another station than began it: {}, begun by {}", e.tick, by, begun));
    else if (!gap->by.ticket_remembered)
      findings.push_back(msg(
          "the exam was taken up again at tick {} at a station that did not remember beginning it: its memory of used tickets was removed", e.tick));
  }
  if (session.seal() && to_hex(session.seal()->public_key) != begun)
    findings.push_back(
        msg("the exam was ended by another station than began it: ended by {}, begun by {}", to_hex(session.seal()->public_key), begun));
  return findings;
}

}  // namespace cavum
