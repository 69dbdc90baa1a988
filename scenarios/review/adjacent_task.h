// What a task asks for where a tooth stands beside its own, or gum: a box that comes clear of the
// neighbour, and criteria on contact, nick and gum.
#pragma once

#include <string>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum::scenarios {

/// A box at a contact area.
struct ContactBox {
  double width_mm = 0.0, above_neck_mm = 0.0;
  bool shell = false;  ///< one before the neighbour stays out of the target
};
/// The box with its walls moved outwards and its floor down until its margins lie far enough from
/// the neighbour on that side, as far as the crown has room (`least_above_neck_mm`, `widest_mm`).
/// As it is, and without a shell, where none stands there.
[[nodiscard]] ContactBox box_beside(const Tooth& tooth, const Landmarks& landmarks, int side,
                                    ContactBox wanted, double least_above_neck_mm,
                                    double widest_mm);

/// Whether hard tissue of a neighbour lies on a side of the tooth.
[[nodiscard]] bool neighbour_stands(const Tooth& tooth, int side);

/// Criteria on what stands beside the tooth, by their names in data/tasks/common.toml. `opens`: the
/// side on which the target opens the contact, 0: none.
[[nodiscard]] std::vector<std::string> adjacent_criteria(const Tooth& tooth, int opens);

}  // namespace cavum::scenarios
