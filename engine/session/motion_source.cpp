#include "engine/session/motion_source.h"

#include "engine/session/session_reader.h"

namespace cavum {

std::optional<SourceKind> source_kind_of(const std::string& text) {
  for (std::size_t i = 0; i < k_source_kinds.size(); ++i)
    if (text == k_source_kinds[i]) return static_cast<SourceKind>(i);
  return std::nullopt;
}

Message in_words(SourceKind kind) {
  switch (kind) {
    case SourceKind::unnamed:
      return msg("a source that is not named");
    case SourceKind::device:
      return msg("a stylus");
    case SourceKind::pointer:
      return msg("mouse and keyboard");
    case SourceKind::practice:
      return msg("practice");
    case SourceKind::simulated_operator:
      return msg("a simulated candidate");
    case SourceKind::motion_file:
      return msg("a file of motion");
    case SourceKind::program:
      break;
  }
  return msg("a program");
}

Message in_words(const MotionSource& source) {
  if (source.name.empty()) return in_words(source.kind);
  switch (source.kind) {
    case SourceKind::unnamed:
      break;
    case SourceKind::device:
      return msg("stylus {}", source.name);
    case SourceKind::pointer:
      return in_words(source.kind);
    case SourceKind::practice:
      return msg("practice with {}", source.name);
    case SourceKind::simulated_operator:
      return msg("simulated candidate {}", source.name);
    case SourceKind::motion_file:
      return msg("file of motion {}", source.name);
    case SourceKind::program:
      return msg("program {}", source.name);
  }
  return Name{source.name};
}

std::vector<SourceFrom> sources_of(const SessionReader& session) {
  std::vector<SourceFrom> out{
      {0,
       {source_kind_of(session.fact(k_source_fact)).value_or(SourceKind::unnamed),
        session.fact(k_source_name_fact), session.fact(k_source_serial_fact)}}};
  for (const auto& e : session.event_rows())
    if (const auto* gap = e.as<RecordingGap>(); gap != nullptr && e.tick < session.ticks())
      out.push_back({e.tick, gap->by.source.value_or(MotionSource{.kind = SourceKind::unnamed})});
  return out;
}

}  // namespace cavum
