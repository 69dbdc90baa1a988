#include "engine/session/station_check.h"

#include "engine/session/chain.h"

namespace cavum {

Damages check_stations(const SessionReader& session) {
  Damages findings;
  const std::string begun = session.fact(k_station_fact);
  for (const auto& e : session.event_rows()) {
    const auto* gap = e.as<RecordingGap>();
    if (gap == nullptr) continue;
    const std::string& by = gap->station_key;
    if (by != begun)
      findings.push_back(damage<DamageKind::resumed_elsewhere>(e.tick, by, begun));
    else if (!gap->by.ticket_remembered)
      findings.push_back(damage<DamageKind::resumed_unremembered>(e.tick));
  }
  if (session.seal() && to_hex(session.seal()->public_key) != begun)
    findings.push_back(
        damage<DamageKind::station_changed>(to_hex(session.seal()->public_key), begun));
  return findings;
}

}  // namespace cavum
