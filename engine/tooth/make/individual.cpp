#include "engine/tooth/make/individual.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

/// Seeds that follow each other give unlike individuals: the first numbers of a generator are
/// thrown away.
Random start(std::uint64_t seed, std::uint64_t kind) {
  Random random(seed * 0x2545f4914f6cdd1dULL + kind);
  (void)random.next();
  return Random(random.next());
}

double normal_within(Random& random, double limit) {
  for (;;) {
    const double z = random.normal();
    if (std::fabs(z) <= limit) return z;
  }
}

}  // namespace

Individual::Individual(std::uint64_t seed, std::uint64_t kind)
    : random_(start(seed, kind)), size_(normal_within(random_, 1.6)) {}

double Individual::draw(const Published& measure, double share_of_size) {
  const double own = std::sqrt(1.0 - share_of_size * share_of_size);
  for (int tries = 0; tries < 64; ++tries) {
    const double value =
        measure.mean + measure.sd * (share_of_size * size_ + own * random_.normal());
    if (value >= measure.low && value <= measure.high) return value;
  }
  return measure.mean;  // a range so narrow is not in use; whatever is asked for, an answer comes
}

}  // namespace cavum
