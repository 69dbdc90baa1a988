// What can be wrong with a tooth that is imported, once its files were read (their own mistakes are FileErrors).
#pragma once

#include <cstdint>

namespace cavum {

enum class ImportError : std::uint8_t {
  bad_option,        ///< an axis, a threshold, a map, a unit that cannot be
  no_tooth,          ///< nothing in the volume stands out as one
  no_tissue,         ///< one of its tissues is not there
  layers_exchanged,  ///< enamel, dentin and pulp
  layers_apart,      ///< they do not fit upon one another
  unknown_labels,
  contradicted,  ///< what was said of it is not what was measured; `--confirm` takes it all the same, and the error tells that name
};

}  // namespace cavum
