// Closed lines seen from above, as signed distance in the plane: negative inside, mm.
#pragma once

#include <cstdint>
#include <memory>

#include "scenarios/file/scenario.h"
#include "scenarios/zones/relief.h"

namespace cavum::scenarios {

class Outline {
 public:
  virtual ~Outline() = default;
  [[nodiscard]] virtual double distance_mm(double x_mm, double y_mm) const noexcept = 0;
  /// How many sides are looked at for one distance.
  [[nodiscard]] virtual std::uint64_t pieces() const noexcept { return 1; }
};

/// `centre` is added to the points (spec.centre_mm is not looked at). `shadow` is needed for a
/// projection only; a fissure must have been placed (placed.h).
[[nodiscard]] std::unique_ptr<Outline> make_outline(const OutlineSpec& spec, Vec3 centre,
                                                    const TissueRelief* shadow);

/// Distance of point `p` from the segment `a`-`b`; z counts too.
[[nodiscard]] double segment_distance(Vec3 p, Vec3 a, Vec3 b) noexcept;

}  // namespace cavum::scenarios
