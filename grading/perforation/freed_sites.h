// Where the tip has moved freely, so that a fall of the force can be put down to an earlier cut.
#pragma once

#include <cstdint>
#include <map>

#include "engine/base/vec.h"

namespace cavum::grading {

/// Places where the tip moved without force, in cells of 0.15 mm, each with the frame when it first
/// did.
class FreedSites {
 public:
  /// The tip went from one place to the other, freely.
  void note(Vec3 from_mm, Vec3 to_mm, std::int64_t frame);
  /// Whether a place ahead of `from`, within `near_mm` of the line from `from` to `to`, was free
  /// before `frame`.
  [[nodiscard]] bool ahead(Vec3 from, Vec3 to, double near_mm, std::int64_t frame) const;

 private:
  [[nodiscard]] static IVec3 cell(Vec3 p);
  std::map<IVec3, std::int64_t> first_;
};

}  // namespace cavum::grading
