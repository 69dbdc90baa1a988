#include "engine/session/station_check.h"

#include <fmt/core.h>

#include "engine/session/chain.h"

namespace cavum {

std::vector<std::string> check_stations(const SessionReader& session) {
  std::vector<std::string> findings;
  const std::string begun = session.fact(k_station_fact);
  for (const auto& e : session.event_rows()) {
    const auto* gap = e.as<RecordingGap>();
    if (gap == nullptr) continue;
    const std::string &by = gap->station_key, when = fmt::format("the exam was taken up again at tick {}", e.tick);
    if (begun.empty())
      findings.push_back(when + ", and the recording does not say which station began it");
    else if (by != begun)
      findings.push_back(fmt::format("{} by another station than began it: {}, begun by {}", when, by.empty() ? "one that is not named" : by, begun));
    else if (!gap->by.ticket_remembered)
      findings.push_back(when + " at a station that did not remember beginning it: its memory of used tickets was removed");
  }
  if (session.seal() && !begun.empty() && to_hex(session.seal()->public_key) != begun)
    findings.push_back(
        fmt::format("the exam was ended by another station than began it: ended by {}, begun by {}", to_hex(session.seal()->public_key), begun));
  return findings;
}

}  // namespace cavum
