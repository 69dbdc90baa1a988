// Whether two teeth are neighbours in a jaw: by their numbers where both were said, else by jaw and
// class.
#pragma once

#include <string>

#include "engine/tooth/anatomy/landmarks.h"
#include "engine/tooth/tooth_number.h"

namespace cavum {

/// What is known of a tooth that stands in a row.
struct RowTooth {
  const std::string& name;
  const ToothKind& kind;  ///< as it was said
  const ClassGuess& shape;
};

struct RowVerdict {
  Message why_not;    ///< what speaks against it; empty: nothing does
  Message unchecked;  ///< what could not be told; empty: all was
};
/// `side`: +1 where `beside` is to stand mesial of `tooth`, -1 distal.
[[nodiscard]] RowVerdict stand_in_a_row(const RowTooth& tooth, const RowTooth& beside, int side);

}  // namespace cavum
