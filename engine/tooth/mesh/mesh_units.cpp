#include "engine/tooth/mesh/mesh_units.h"

#include <fmt/core.h>

#include "engine/base/error.h"
#include "engine/base/file_error.h"

namespace cavum {

double mm_per_unit(const std::string& unit) {
  for (const auto& u : k_mesh_units)
    if (unit == u.name) return u.mm;
  throw Error(FileError::unknown, Name{"--units"}, msg("'{}' is no unit known here", unit),
              msg("give mm, cm, m, um or in"));
}

}  // namespace cavum
