// Why somebody from a learning platform is not let in, and why a platform is not asked.
#pragma once

#include "engine/base/named_enum.h"

namespace cavum::office {

// clang-format off
#define CAVUM_LTI_ERRORS(ERROR) \
  ERROR(not_understood) /* no form, no token */ \
  ERROR(twice)          /* says one thing twice */ \
  ERROR(incomplete) \
  ERROR(login)          /* of no login of this office, or of another than this browser's */ \
  ERROR(too_late)       /* also a token of the future */ \
  ERROR(used) \
  ERROR(platform)       /* unknown, or another one */ \
  ERROR(algorithm) \
  ERROR(key) \
  ERROR(signature) \
  ERROR(audience) \
  ERROR(deployment) \
  ERROR(message)        /* not a link's of LTI 1.3 */ \
  ERROR(target) \
  ERROR(role) \
  ERROR(address)        /* none of the platform's */
// clang-format on
CAVUM_NAMED_ENUM(LtiError, CAVUM_LTI_ERRORS)

}  // namespace cavum::office
