// A history of a station that was checked often, made of one real check and the scatter of days:
// what stands in it is signed as any other.
#pragma once

#include <random>

#include "engine/device/selfcheck/check_history.h"

namespace cavum::testing_device {

/// Adds checks like the last one of `stylus` until `checks` are there.
inline void learn_like_the_last(const CheckedStylus& stylus, std::size_t checks) {
  const SigningKey key = load_station_key(station_key_path());
  CheckHistory history(check_history_path());
  std::mt19937_64 random(7);
  std::normal_distribution<double> n;
  const CheckEntry last = *history.last_check(stylus);
  while (history.earlier(stylus).size() < checks) {
    ArmFigures f = last.figures;
    const double friction = 1.0 + 0.03 * n(random), gain = 1.0 + 0.008 * n(random);
    for (ArmAxis& a : f.axes) {
      a.friction_n *= friction;
      a.mass_kg *= gain;
      a.weight_n += 0.004 * n(random);
    }
    f.rate_hz *= 1.0 + 0.01 * n(random);
    history.add_check(stylus, f, last.utc_ns, key);
  }
}

}  // namespace cavum::testing_device
