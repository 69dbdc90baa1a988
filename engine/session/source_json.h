// What moved the stylus, in recordings and ledgers.
#pragma once

#include "engine/base/json_struct.h"
#include "engine/session/motion_source.h"

namespace cavum {

[[nodiscard]] constexpr auto names_of(SourceKind) { return k_source_kinds; }
CAVUM_JSON_OF(MotionSource, (kind), (name), (serial))

}  // namespace cavum
