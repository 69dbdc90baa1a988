// Units that surfaces come in.
#pragma once

#include <string>

#include "engine/base/text.h"

namespace cavum {

struct MeshUnit {
  const char* name;  ///< of an option
  const char* text;
  double mm;
};
inline constexpr MeshUnit k_mesh_units[] = {{"mm", noop("millimetres"), 1.0},
                                            {"cm", noop("centimetres"), 10.0},
                                            {"m", noop("metres"), 1000.0},
                                            {"um", noop("micrometres"), 0.001},
                                            {"in", noop("inches"), 25.4}};

/// Millimetres of a unit by its name: mm, cm, m, um, in. Throws Error("--units", ...) for others.
[[nodiscard]] double mm_per_unit(const std::string& unit);

}  // namespace cavum
