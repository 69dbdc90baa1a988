#include "engine/lab/explain/recording/layers.h"

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "engine/base/text.h"
#include "engine/lab/explain/recording/motion.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_max_layers = 12;
constexpr double k_min_rows = 100.0, k_alike = 0.05, k_held = 0.01;

/// Sums of products of X, V and F over rows in contact.
struct Sums {
  double rows = 0, xx = 0, xv = 0, vv = 0, xf = 0, vf = 0;
  void add(double x, double v, double f) {
    ++rows, xx += x * x, xv += x * v, vv += v * v, xf += x * f, vf += v * f;
  }
  /// k and c, drawn to `near` by a weight of 1 % of the sums.
  [[nodiscard]] Eigen::Vector2d solved(Eigen::Vector2d near) const {
    const double hx = k_held * xx, hv = k_held * vv + 1e-12;
    Eigen::Matrix2d a;
    a << xx + hx, xv, xv, vv + hv;
    return a.ldlt().solve(Eigen::Vector2d(xf + hx * near[0], vf + hv * near[1]));
  }
};

}  // namespace

void set_layers(Recording& r) {
  const Series* layer = r.column("layer");
  if (layer == nullptr || r.relative_k.size() > 0) return;
  const Motion motion = estimate_motion(r);
  std::map<double, Sums> sums;
  Sums all;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    if (motion.x_mm[i] <= 2.0 * motion.sd_x_mm[i] || r.f_n[i] <= 0.0) continue;
    sums[(*layer)[i]].add(motion.x_mm[i], motion.v_mm_s[i], r.f_n[i]);
    all.add(motion.x_mm[i], motion.v_mm_s[i], r.f_n[i]);
    if (sums.size() > k_max_layers) return;
  }
  std::erase_if(sums, [](const auto& s) { return s.second.rows < k_min_rows; });
  if (sums.size() < 2) return;
  const Eigen::Vector2d together = all.solved({0.0, 0.0});
  std::map<double, Eigen::Vector2d> fitted;
  double reference = sums.begin()->first, least = 1e300, most = 0.0;
  for (const auto& [name, s] : sums) {
    const Eigen::Vector2d kc = s.solved(together);
    if (!kc.allFinite() || !(kc[0] > 0.0)) return;
    fitted[name] = kc;
    least = std::min(least, kc[0]);
    most = std::max(most, kc[0]);
    if (s.rows > sums[reference].rows) reference = name;
  }
  if (most < (1.0 + k_alike) * least) return;
  const Eigen::Vector2d by = fitted[reference];
  r.relative_k = Series::Ones(r.rows());
  r.relative_c = Series::Ones(r.rows());
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    const auto found = fitted.find((*layer)[i]);
    if (found == fitted.end()) continue;
    r.relative_k[i] = found->second[0] / by[0];
    if (by[1] > 0.0 && found->second[1] > 0.0) r.relative_c[i] = found->second[1] / by[1];
  }
  List layers{{}, true};
  for (const auto& [name, kc] : fitted) {
    const Number k = as_unit(std::round(1e4 * kc[0]) / 1e4, cavum::Unit::n_per_mm),
                 c = as_number(std::round(1e4 * kc[1]) / 1e4);
    layers.items.push_back(
        name == reference
            ? msg("layer {} (k and c below): k {}, c {} N s/mm", as_number(name), k, c)
            : msg("layer {}: k {}, c {} N s/mm", as_number(name), k, c));
  }
  r.notes.emplace_back(
      "layers", std::vector{"layers"},
      msg("layers have k and c of their own, words numbered in order of appearance: {}", layers));
}

}  // namespace cavum::explain
