#include "engine/tooth/anatomy/landmarks.h"

namespace cavum {

std::string_view name_of(ToothClass kind) noexcept {
  switch (kind) {
    case ToothClass::incisor:
      return "incisor";
    case ToothClass::canine:
      return "canine";
    case ToothClass::premolar:
      return "premolar";
    case ToothClass::molar:
      return "molar";
    default:
      return "unknown";
  }
}

}  // namespace cavum
