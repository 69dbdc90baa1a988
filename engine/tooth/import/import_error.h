// What can be wrong with a tooth that is imported, once its files were read (their own mistakes are
// FileErrors).
#pragma once

#include "engine/base/named_enum.h"

namespace cavum {

// clang-format off
#define CAVUM_IMPORT_ERRORS(ERROR) \
  ERROR(bad_option)       /* an axis, a threshold, a map, a unit that cannot be */ \
  ERROR(no_tooth)         /* nothing in the volume stands out as one */ \
  ERROR(no_tissue)        /* one of its tissues is not there */ \
  ERROR(layers_exchanged) /* enamel, dentin and pulp */ \
  ERROR(layers_apart)     /* they do not fit upon one another */ \
  ERROR(unknown_labels) \
  ERROR(contradicted)     /* what was said of it is not what was measured; `--confirm` takes it all the same, and the error tells that name */
// clang-format on
CAVUM_NAMED_ENUM(ImportError, CAVUM_IMPORT_ERRORS)

}  // namespace cavum
