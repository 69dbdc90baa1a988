// The measures of one individual: each is drawn from a normal distribution with a published mean
// and standard deviation, cut off at a range that lies inside the published one. All lean on one
// size factor, for large teeth are large in everything; so a tooth keeps its proportions.
#pragma once

#include <cstdint>

#include "engine/base/random.h"

namespace cavum {

/// A published measure, mm or degrees: mean, standard deviation, and the range that is drawn from
/// (low < mean < high, sd > 0).
struct Published {
  double mean, sd, low, high;
};

/// One individual of a kind. The same seed gives the same measures, in the order they are asked
/// for.
class Individual {
 public:
  /// `kind` keeps molar 7 from being drawn like premolar 7.
  Individual(std::uint64_t seed, std::uint64_t kind);
  /// A measure in its range. `share_of_size` (0 to 1) is its correlation with the size factor.
  [[nodiscard]] double draw(const Published& measure, double share_of_size = 0.0);
  /// Uniform, for what no study measured: low <= value < high.
  [[nodiscard]] double between(double low, double high) { return random_.uniform(low, high); }

 private:
  Random random_;
  double size_;  // of this individual, in standard deviations, -1.6 to 1.6
};

}  // namespace cavum
