// A small block with a pulp chamber, and two tasks on it: a cavity over the pulp that spares it,
// and the way into it.
#pragma once

#include "tests/games/task.h"

namespace cavum::games {

/// Chamber 3 x 2 x 1.5 mm with its floor at z = -4.5, a horn on either side of its roof, two
/// canals; periodontium under -5.3. Leaf 0.1 mm.
[[nodiscard]] const Task& block_task(bool access);

}  // namespace cavum::games
