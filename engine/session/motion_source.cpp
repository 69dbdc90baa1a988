#include "engine/session/motion_source.h"

#include <nlohmann/json.hpp>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/session/session_reader.h"

namespace cavum {

bool is_source_kind(const std::string& kind) {
  for (const char* known : {"device", "pointer", "practice", "operator", "motion_file", "program"})
    if (kind == known) return true;
  return false;
}

std::vector<SourceFrom> sources_of(const SessionReader& session) {
  std::vector<SourceFrom> out{{0, {session.fact(k_source_fact), session.fact(k_source_name_fact), session.fact(k_source_serial_fact)}}};
  for (const auto& e : session.events()) {
    if (e.kind != "gap" || e.tick >= session.ticks()) continue;
    const auto detail = parse_json_or_null(e.detail_json);
    const auto& s = member_of(detail, "source");
    out.push_back({e.tick, {text_in(s, k_source_fact), text_in(s, k_source_name_fact), text_in(s, k_source_serial_fact)}});
  }
  return out;
}

}  // namespace cavum
