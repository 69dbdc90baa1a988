// Teeth with a seed: each seed is another individual of the same kind, with measures drawn from
// published means and deviations (docs/teeth.md). Nothing is measured from a person's scan, so they
// can be shipped, altered and published freely. The same seed gives the same bytes everywhere.
#pragma once

#include <cstdint>

#include "engine/tooth/make/tooth_plan.h"
#include "engine/tooth/tooth.h"

namespace cavum {

struct SeedTooth {
  std::uint64_t seed = 1;
  double leaf_mm = 0.05;         ///< 0.03 to 0.5
  double periodontium_mm = 1.0;  ///< 0 = none
};

/// The drawn measures as a plan: lower first molar (five cusps, two roots, three canals), upper
/// second premolar (two cusps, one root, one canal), upper central incisor (one root, one canal).
[[nodiscard]] ToothPlan molar_plan(std::uint64_t seed);
[[nodiscard]] ToothPlan premolar_plan(std::uint64_t seed);
[[nodiscard]] ToothPlan incisor_plan(std::uint64_t seed);

/// The whole tooth; a few seconds at 0.05 mm. Throws Error on a leaf or a periodontium out of its
/// range.
[[nodiscard]] Tooth grow_molar(const SeedTooth& what);
[[nodiscard]] Tooth grow_premolar(const SeedTooth& what);
[[nodiscard]] Tooth grow_incisor(const SeedTooth& what);

}  // namespace cavum
