#include "engine/physics/servo/grinding.h"

#include "engine/base/det_math.h"

namespace cavum {

double ground_mm_s(const GrindingSums& sums, double pressing_n, double stiffness_n_per_mm,
                   double rpm, double dt_s) noexcept {
  const double rad_per_s = rpm * (2.0 * k_pi / 60.0), turned_rad = rad_per_s * dt_s;
  const double slowed = sums.per_turn_n_per_mm + stiffness_n_per_mm * sums.head_share * turned_rad;
  return slowed > 0.0 && sums.per_turn_n_per_mm > 0.0
             ? pressing_n * sums.head_share * rad_per_s / slowed
             : 0.0;
}

double grinding_torque_n_mm(const GrindingSums& sums, double pressing_n,
                            double force_ratio) noexcept {
  if (!(sums.per_turn_n_per_mm > 0.0)) return 0.0;
  return force_ratio * pressing_n * sums.head_share * (sums.sliding_n / sums.per_turn_n_per_mm);
}

}  // namespace cavum
