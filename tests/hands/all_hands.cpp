#include <array>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {

std::span<const HandKind> all_hands() {
  static constexpr std::array kinds{
      HandKind{"plunger", &make_plunger},   HandKind{"miller", &make_miller},
      HandKind{"hesitant", &make_hesitant}, HandKind{"expert", &make_expert},
      HandKind{"pecker", &make_pecker},     HandKind{"circler", &make_circler},
      HandKind{"novice", &make_novice},
  };
  return kinds;
}

}  // namespace cavum::hands
