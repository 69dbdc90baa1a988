// Where the tool stood still under a coarse encoder, and whether it came back to the same places. A
// rig that follows one programme stops at the same places in every session, to a hundredth of what
// the encoder shows: the error of rounding is then the same each time, does not average out, and
// bends the force over position as if the material did.
#pragma once

#include <vector>

#include "engine/base/random.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// Rows [begin, end) that show one reading for 0.3 s or more, and half as long again as the
/// readings before and after: a slow motion is no hold.
struct Hold {
  Eigen::Index begin = 0, end = 0;
  std::size_t place = 0;  ///< index into Holds::positions_mm
};

struct Holds {
  std::vector<Hold> holds;  ///< in the order of the rows
  std::vector<double>
      positions_mm;       ///< ascending; two neighbouring cells of the encoder are one place
  double repeated = 0.0;  ///< 0..1: share of a session's holds in contact that the next one makes
                          ///< too, in the same order
  /// The sessions follow one programme.
  [[nodiscard]] bool repeat() const { return repeated > 0.8; }
};
/// `quantum_mm` > 0.
[[nodiscard]] Holds find_holds(const Recording& recording, double quantum_mm);

/// A path of the same programme whose places lie elsewhere in the cells of the encoder. Rigs stop
/// at round depths, whose rounding errors grow in even steps and wrap: so do these, from a random
/// start by a random step, -quantum/2..quantum/2. In a hold the tool stands still, and in between
/// it is off by what lies between, along the way. Shape [rows].
[[nodiscard]] Series replaced_holds(const Recording& recording, const Series& x_mm,
                                    const Holds& holds, double quantum_mm, Random& random);

}  // namespace cavum::explain
