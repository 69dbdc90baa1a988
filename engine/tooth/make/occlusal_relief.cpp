#include "engine/tooth/make/occlusal_relief.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

/// |v| with a round edge of radius r; its slope is continuous.
double round_abs(double v, double r) { return std::sqrt(v * v + r * r) - r; }

double cusp_height(const CuspPlan& c, double x, double y) {
  const double dx = x - c.tip_mm.x, dy = y - c.tip_mm.y;
  const double straight = dx * c.inward_x + dy * c.inward_y,
               beside_tip = dy * c.inward_x - dx * c.inward_y;
  const double in =
      straight - c.cusp_ridge_bow * beside_tip * beside_tip / (1 + 0.05 * beside_tip * beside_tip);
  const double along =
      beside_tip - c.bend * straight * std::fabs(straight) * ramp(0.0, 0.8, straight);
  // The sides of the triangular ridge fall more steeply than the cusp ridges, which bound the
  // occlusal face. All edges are convex, so that the valleys between them are sharper than the
  // ridges.
  const double side =
      c.cusp_ridge_slope + (c.flank_slope - c.cusp_ridge_slope) * ramp(0.0, 1.6, in);
  const double across = side * (0.75 * round_abs(along, c.round_mm) + 0.13 * along * along);
  const double down =
      in > 0 ? c.triangular_slope * (0.85 * round_abs(in, c.round_mm) + 0.045 * in * in)
             : c.outer_slope * round_abs(in, c.round_mm);
  // Two faint grooves beside the triangular ridge.
  const double apart = std::fabs(along) - 0.45 - 0.3 * std::max(in, 0.0);
  const double beside = c.side_groove_mm * bell(apart, 0.22) * ramp(0.3, 0.9, in);
  return c.tip_mm.z - across - down - beside;
}

double crest_height(const CrestPlan& c, double x, double y) {
  const double in = (x - c.x_mm + c.bow * y * y) * c.inward_sign,
               to = std::min(std::fabs(y), c.end_mm), beyond = std::fabs(y) - to;
  return c.z_mm + c.rise * to * (to + 2 * beyond) - 0.8 * beyond * beyond -
         (in > 0 ? c.inward_slope : c.outer_slope) * round_abs(in, c.round_mm);
}

/// 1 on the bottom of a cleft, falling to 0 at its edge: a V whose edges are round.
double cleft(double below, double half_width) {
  const double t = std::clamp(1.0 - below / half_width, 0.0, 1.0);
  return t * (0.45 * t + 0.55 * t * t);
}

/// Box average along one axis of a table, in place; the ends repeat.
template <class Get>
void average(std::vector<Relief>& table, int n, int radius, const Get& index) {
  std::vector<double> row(static_cast<std::size_t>(n)), sum(static_cast<std::size_t>(n) + 1, 0.0);
  for (int i = 0; i < n; ++i) row[static_cast<std::size_t>(i)] = table[index(i)].plain_slant;
  for (int i = 0; i < n; ++i)
    sum[static_cast<std::size_t>(i) + 1] =
        sum[static_cast<std::size_t>(i)] + row[static_cast<std::size_t>(i)];
  for (int i = 0; i < n; ++i) {
    const int a = std::max(0, i - radius), b = std::min(n, i + radius + 1);
    table[index(i)].plain_slant =
        (sum[static_cast<std::size_t>(b)] - sum[static_cast<std::size_t>(a)]) / (b - a);
  }
}

}  // namespace

OcclusalRelief::OcclusalRelief(const ToothPlan& plan, double half_x_mm, double half_y_mm)
    : nx_(2 * static_cast<int>(half_x_mm / k_step_mm) + 3),
      ny_(2 * static_cast<int>(half_y_mm / k_step_mm) + 3),
      low_x_(-k_step_mm * (nx_ / 2)),
      low_y_(-k_step_mm * (ny_ / 2)),
      relief_(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_)) {
  const std::size_t cusps = plan.cusps.size(), all = cusps + plan.crests.size();
  const FissurePlan& f = plan.fissures;
  std::vector<double> height(all);
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) {
      const double x = low_x_ + k_step_mm * i, y = low_y_ + k_step_mm * j;
      for (std::size_t c = 0; c < all; ++c)
        height[c] = c < cusps ? cusp_height(plan.cusps[c], x, y)
                              : crest_height(plan.crests[c - cusps], x, y);
      double smooth = height[0], highest = height[0];
      for (std::size_t c = 1; c < all; ++c) {
        smooth = smooth_max(smooth, height[c], c < cusps ? 0.12 : 0.5);
        highest = std::max(highest, height[c]);
      }
      // All that follows is a maximum over pairs of continuous functions, so it is continuous where
      // the second highest changes.
      double depth = 0.0, third = 0.0;
      for (std::size_t a = 0; a < all; ++a)
        for (std::size_t b = a + 1; b < all; ++b) {
          const double below = highest - std::min(height[a], height[b]);
          depth = std::max(depth, (b < cusps ? 1.0 : f.at_crests) * cleft(below, f.half_width));
          for (std::size_t c = b + 1; c < all; ++c)
            third = std::max(third, cleft(highest - std::min({height[a], height[b], height[c]}),
                                          1.2 * f.half_width));
        }
      const double u = (x - f.middle_x_mm) / f.reach_x_mm, v = y / f.reach_y_mm;
      const double inside = 1.0 - ramp(0.55, 1.15, u * u + v * v);
      Relief& r = relief_[index(i, j)];
      r.height_mm = smooth;
      r.fissure_mm = inside * (f.depth_mm * depth + f.pit_mm * third);
      r.groove_mm = 0.0;
      for (const auto& g : plan.wall_grooves) {
        const double below = highest - std::min(height[g.first], height[g.second]);
        r.groove_mm = std::max(r.groove_mm, g.depth_mm * bell(below, g.width_mm));
      }
    }
  work_out_slants();
}

void OcclusalRelief::work_out_slants() {
  const auto slant = [&](int i, int j, bool fissures) {
    const auto h = [&](int p, int q) {
      const Relief& r = relief_[index(std::clamp(p, 0, nx_ - 1), std::clamp(q, 0, ny_ - 1))];
      return r.height_mm - (fissures ? r.fissure_mm : 0.0);
    };
    const double gx = (h(i + 1, j) - h(i - 1, j)) / (2 * k_step_mm),
                 gy = (h(i, j + 1) - h(i, j - 1)) / (2 * k_step_mm);
    return 1.0 / std::sqrt(1.0 + gx * gx + gy * gy);
  };
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) {
      relief_[index(i, j)].slant = slant(i, j, true);
      relief_[index(i, j)].plain_slant = slant(i, j, false);
    }
  for (int twice = 0; twice < 2; ++twice) {
    for (int j = 0; j < ny_; ++j) average(relief_, nx_, 8, [&](int i) { return index(i, j); });
    for (int i = 0; i < nx_; ++i) average(relief_, ny_, 8, [&](int j) { return index(i, j); });
  }
}

Relief OcclusalRelief::at(double x, double y) const noexcept {
  const double fx = std::clamp((x - low_x_) / k_step_mm, 0.0, nx_ - 1.001),
               fy = std::clamp((y - low_y_) / k_step_mm, 0.0, ny_ - 1.001);
  const int i = static_cast<int>(fx), j = static_cast<int>(fy);
  const double u = fx - i, v = fy - j;
  const Relief &a = relief_[index(i, j)], &b = relief_[index(i + 1, j)],
               &c = relief_[index(i, j + 1)], &d = relief_[index(i + 1, j + 1)];
  const auto mix = [&](double Relief::*m) {
    return (a.*m * (1 - u) + b.*m * u) * (1 - v) + (c.*m * (1 - u) + d.*m * u) * v;
  };
  return {mix(&Relief::height_mm), mix(&Relief::fissure_mm), mix(&Relief::slant),
          mix(&Relief::plain_slant), mix(&Relief::groove_mm)};
}

}  // namespace cavum
