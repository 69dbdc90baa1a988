// The small quadratic program of the proxy: the step nearest to the wanted one that keeps to every
// half space. Exact for three dimensions, deterministic, without allocation.
#pragma once

#include <array>
#include <span>

#include "engine/base/state_hash.h"
#include "engine/base/vec.h"

namespace cavum {

/// Steps s with normal·s >= -slack_mm are allowed (normal about unit length).
struct HalfSpace {
  Vec3 normal;
  double slack_mm = 0.0;
};

/// The half spaces that hold the step, by their places in the list.
struct ActiveSet {
  int count = 0;  ///< 0 to 3
  std::array<int, 3> at{-1, -1, -1};
};
CAVUM_STATE(ActiveSet, count, at)

struct HalfSpaceSolution {
  Vec3 step;
  bool feasible = true;  ///< false when the half spaces exclude one another: `step` then breaks
                         ///< them least as found
  ActiveSet active;
};

/// argmin |s - wanted| over all allowed s. Active-set method: the most violated half space enters,
/// at most three stay (their KKT conditions are solved exactly); the objective grows with each
/// round. `guess` is tried first (that of the step before, for instance); it saves time and changes
/// nothing else.
[[nodiscard]] HalfSpaceSolution nearest_step(Vec3 wanted, std::span<const HalfSpace> half_spaces,
                                             const ActiveSet& guess = {}) noexcept;

}  // namespace cavum
