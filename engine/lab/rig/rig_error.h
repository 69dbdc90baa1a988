// Why an experiment cannot be done.
#pragma once

#include <cstdint>

namespace cavum {

enum class RigError : std::uint8_t {
  no_pulp,       ///< under solid tissue of the tooth, or of its chosen place
  no_material,   ///< the force model has none for the tissue
  no_stiffness,  ///< it has one that yields to every force
  by_pressure,   ///< it cuts by pressure, and the experiment is the paper's
};

}  // namespace cavum
