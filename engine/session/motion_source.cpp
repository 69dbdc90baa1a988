#include "engine/session/motion_source.h"

#include "engine/session/session_reader.h"

namespace cavum {

bool is_source_kind(const std::string& kind) {
  for (const char* known : {"device", "pointer", "practice", "operator", "motion_file", "program"})
    if (kind == known) return true;
  return false;
}

std::vector<SourceFrom> sources_of(const SessionReader& session) {
  std::vector<SourceFrom> out{{0, {session.fact(k_source_fact), session.fact(k_source_name_fact), session.fact(k_source_serial_fact)}}};
  for (const auto& e : session.event_rows())
    if (const auto* gap = e.as<RecordingGap>(); gap != nullptr && e.tick < session.ticks())
      out.push_back({e.tick, gap->by.source.value_or(MotionSource{.kind = ""})});
  return out;
}

}  // namespace cavum
