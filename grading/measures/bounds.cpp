#include "grading/measures/bounds.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/base/order.h"
#include "engine/base/statistics.h"
#include "grading/measures/cut_surface.h"

namespace cavum::grading {
namespace {

double less(const BoundedVolume& v) noexcept { return std::max(0.0, v.mm3 - v.bound_mm3); }
double more(const BoundedVolume& v) noexcept { return v.mm3 + v.bound_mm3; }
/// a / (a + b), 1 when there is neither.
double share(double a, double b) noexcept { return a + b > 0 ? a / (a + b) : 1.0; }

/// By the nearest rank.
double p95_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const std::size_t rank = (values.size() * 95 + 99) / 100;
  return in_order(std::move(values), rank - 1);
}

/// The mean when only those doubtful values count that raise it (sign 1) or lower it (sign -1).
double extreme_mean(const WallValues& v, double sign) {
  std::vector<double> doubtful = v.own;
  doubtful.insert(doubtful.end(), v.of_others.begin(), v.of_others.end());
  std::sort(doubtful.begin(), doubtful.end(),
            [sign](double a, double b) { return sign * a > sign * b; });
  double sum = 0;
  for (const double value : v.sure) sum += value;
  auto n = static_cast<double>(v.sure.size());
  for (const double value : doubtful) {
    if (n > 0 && sign * value <= sign * sum / n) break;
    sum += value;
    n += 1;
  }
  return n > 0 ? sum / n : 0.0;
}

std::vector<double> all_own(const WallValues& v) {
  std::vector<double> all = v.sure;
  all.insert(all.end(), v.own.begin(), v.own.end());
  return all;
}

}  // namespace

double share_bound_percent(const BoundedVolume& in, const BoundedVolume& missed) noexcept {
  const double now = share(in.mm3, missed.mm3);
  return 100 * std::max(share(more(in), less(missed)) - now, now - share(less(in), more(missed)));
}

double dice_bound(const BoundedVolume& in, const BoundedVolume& missed,
                  const BoundedVolume& beyond) noexcept {
  const double now = share(2 * in.mm3, missed.mm3 + beyond.mm3);
  return std::max(share(2 * more(in), less(missed) + less(beyond)) - now,
                  now - share(2 * less(in), more(missed) + more(beyond)));
}

double mean_bound(const WallValues& v) {
  const double now = mean(all_own(v));
  return std::max(extreme_mean(v, 1) - now, now - extreme_mean(v, -1));
}

double p95_bound(const WallValues& v) {
  const double now = p95_of(all_own(v));
  if (v.sure.empty() && v.own.empty()) return 0.0;
  std::vector<double> high = v.sure, low = v.sure;
  for (const auto* list : {&v.own, &v.of_others})
    for (const double value : *list) (value >= now ? high : low).push_back(value);
  const double up = p95_of(high) - now, down = low.empty() ? 0.0 : now - p95_of(low);
  return std::max({0.0, up, down});
}

double taper_bound_deg(const std::vector<WallHeight>& walls, double leaf_mm) noexcept {
  double places = 0, slope = 0;
  for (const auto& w : walls) {
    if (!(w.places > 0)) continue;
    places += w.places;
    slope += w.places * leaf_mm / std::max(leaf_mm, w.high_mm - w.low_mm);
  }
  return places > 0 ? atan_deg(slope / places) : 0.0;
}

}  // namespace cavum::grading
