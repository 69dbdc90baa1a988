// Why an experiment cannot be done.
#pragma once

#include "engine/base/named_enum.h"

namespace cavum {

// clang-format off
#define CAVUM_RIG_ERRORS(ERROR) \
  ERROR(no_pulp)      /* under solid tissue of the tooth, or of its chosen place */ \
  ERROR(no_material)  /* the force model has none for the tissue */ \
  ERROR(no_stiffness) /* it has one that yields to every force */ \
  ERROR(by_pressure)  /* it cuts by pressure, and the experiment is the paper's */
// clang-format on
CAVUM_NAMED_ENUM(RigError, CAVUM_RIG_ERRORS)

}  // namespace cavum
