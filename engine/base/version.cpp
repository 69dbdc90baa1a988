// CMakeLists.txt reads the version here.
#include "engine/base/version.h"

namespace cavum {

const char* version() noexcept { return "1.0.0"; }

}  // namespace cavum
