#include "engine/tooth/make/add_gum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/distance_transform.h"

namespace cavum {
namespace {

constexpr double k_gap_leaves = 1.8;  // from a tooth's nearest leaf: the leaf between stays air

/// Height of the neck in the direction of a place, mm: of the points of the neck within ten degrees
/// or so, the nearest most.
class NeckHeight {
 public:
  explicit NeckHeight(const Polyline& neck) : neck_(neck) {
    for (const Vec3& p : neck) {
      middle_ += p / static_cast<double>(neck.size());
      lowest_mm_ = std::min(lowest_mm_, p.z);
    }
  }
  [[nodiscard]] double lowest_mm() const noexcept { return lowest_mm_; }
  [[nodiscard]] double at(double x_mm, double y_mm) const noexcept {
    constexpr double k_narrow = 0.98;  // cosine
    const Vec3 way = normalized(Vec3{x_mm - middle_.x, y_mm - middle_.y, 0}, {1, 0, 0});
    double weights = 0, sum = 0;
    for (const Vec3& p : neck_) {
      const double w = std::max(
          1e-9,
          dot(way, normalized(Vec3{p.x - middle_.x, p.y - middle_.y, 0}, {1, 0, 0})) - k_narrow);
      weights += w * w;
      sum += w * w * p.z;
    }
    return sum / weights;
  }

 private:
  const Polyline& neck_;
  Vec3 middle_;
  double lowest_mm_ = 1e9;
};

/// Distances to bodies in a slab of the lattice, mm; by the nearest leaf's own distance finer than
/// leaves.
class ToBody {
 public:
  ToBody(const TissueGrid& slab, const std::array<bool, 256>& body) : slab_(slab) {
    std::vector<std::uint8_t> seed(slab.count());
    for (std::size_t i = 0; i < seed.size(); ++i) seed[i] = body[slab.tissue[i]] ? 1 : 0;
    nearest_ = nearest_seed(slab.size, seed);
  }
  [[nodiscard]] double mm(std::size_t i, IVec3 at) const noexcept {
    constexpr double k_far_mm = 1e6;
    const std::int32_t n = nearest_[i];
    if (n < 0) return k_far_mm;
    const std::int32_t plane = slab_.size.x * slab_.size.y;
    const double dx = n % slab_.size.x - at.x, dy = n / slab_.size.x % slab_.size.y - at.y,
                 dz = n / plane - at.z;
    return (std::sqrt(dx * dx + dy * dy + dz * dz) +
            decode_distance(slab_.distance[static_cast<std::size_t>(n)])) *
           slab_.leaf_mm;
  }

 private:
  const TissueGrid& slab_;
  std::vector<std::int32_t> nearest_;
};

TissueGrid slab_of(const TissueGrid& grid, int low_z, int high_z) {
  TissueGrid slab;
  slab.allocate({grid.size.x, grid.size.y, high_z - low_z}, grid.leaf_mm,
                grid.origin_mm + Vec3{0, 0, low_z * grid.leaf_mm});
  const auto from = static_cast<std::ptrdiff_t>(grid.index({0, 0, low_z}));
  std::copy_n(grid.tissue.begin() + from, slab.count(), slab.tissue.begin());
  std::copy_n(grid.distance.begin() + from, slab.count(), slab.distance.begin());
  return slab;
}

/// 0 to 1, level at both ends.
double eased(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// How high the gum stands at a place that lies `apart_mm` from the tooth and its neighbour
/// together.
double top_of_gum_mm(double margin_mm, double apart_mm, double papilla_mm) {
  return margin_mm + std::max(0.0, papilla_mm - margin_mm) *
                         eased((k_papilla_wide_mm - apart_mm) / (0.75 * k_papilla_wide_mm));
}

constexpr float k_far_level = 1e6F;

/// The distances around the gum: the body's level, and at least what the nearest leaf of gum leaves
/// open.
void lower_around(TissueGrid& grid, const TissueGrid& slab, const std::vector<float>& level,
                  int low_z) {
  constexpr double k_reach_leaves = 3.0;
  std::vector<std::uint8_t> gum(slab.count());
  for (std::size_t i = 0; i < gum.size(); ++i) gum[i] = level[i] < 0 ? 1 : 0;
  const auto nearest = nearest_seed(slab.size, gum, k_reach_leaves);
  const std::int32_t plane = slab.size.x * slab.size.y;
  std::size_t i = 0;
  for (int z = 0; z < slab.size.z; ++z)
    for (int y = 0; y < slab.size.y; ++y)
      for (int x = 0; x < slab.size.x; ++x, ++i) {
        const std::int32_t n = nearest[i];
        if (gum[i] != 0 || n < 0) continue;
        const double dx = n % slab.size.x - x, dy = n / slab.size.x % slab.size.y - y,
                     dz = n / plane - z;
        const double leaves = std::sqrt(dx * dx + dy * dy + dz * dz),
                     known = level[i] < k_far_level ? static_cast<double>(level[i]) : 0.0;
        std::int8_t& code = grid.distance[grid.index({x, y, low_z + z})];
        if (code > 0)
          code = std::min(code,
                          std::max(encode_distance(std::max(known, leaves - 1.0)), std::int8_t{1}));
      }
}

}  // namespace

void add_gum(TissueGrid& grid, const std::vector<Tissue>& tissues, const AdjacentIds& ids,
             const Landmarks& landmarks, const std::vector<Vec3>& contacts,
             const std::string& where) {
  if (landmarks.neck_mm.empty())
    throw Error(where + " --gum", msg("no neck is found on this tooth"),
                msg("leave --gum out, or see `cavum tooth landmarks`"));
  const NeckHeight neck(landmarks.neck_mm);
  const double leaf = grid.leaf_mm, bottom_mm = neck.lowest_mm() - k_gum_below_neck_mm;
  double top_mm = -1e9;
  for (const Vec3& p : landmarks.neck_mm) top_mm = std::max(top_mm, p.z + k_gum_margin_mm);
  for (const Vec3& c : contacts) top_mm = std::max(top_mm, c.z - k_papilla_below_contact_mm);
  const auto layer = [&](double z_mm) {
    return std::clamp(static_cast<int>((z_mm - grid.origin_mm.z) / leaf), 0, grid.size.z);
  };
  const int low_z = layer(bottom_mm - 4 * leaf), high_z = layer(top_mm + 4 * leaf);
  if (high_z <= low_z) return;
  const TissueGrid slab = slab_of(grid, low_z, high_z);
  std::array<bool, 256> own{}, beside{};
  for (const Tissue& t : tissues)
    if (t.solid && t.id != ids.gum)
      (t.id == ids.enamel || t.id == ids.dentin ? beside : own)[t.id] = true;
  const ToBody to_tooth(slab, own), to_neighbour(slab, beside);
  std::vector<double> margin_mm(static_cast<std::size_t>(slab.size.x) *
                                static_cast<std::size_t>(slab.size.y));
  for (int y = 0; y < slab.size.y; ++y)
    for (int x = 0; x < slab.size.x; ++x) {
      const Vec3 p = slab.centre_mm({x, y, 0});
      margin_mm[slab.index({x, y, 0})] = neck.at(p.x, p.y) + k_gum_margin_mm;
    }
  const auto papilla_mm = [&](double x_mm) {  // of the contact on that side
    double best = -1e9, nearest = 1e9;
    for (const Vec3& c : contacts)
      if (const double d = std::fabs(c.x - x_mm); d < nearest) {
        nearest = d;
        best = c.z - k_papilla_below_contact_mm;
      }
    return best;
  };
  std::vector<float> level(slab.count(), k_far_level);  // leaves
  constexpr double k_steepest =
      1.5;  // of the body's function, so that its value is no more than the distance
  std::size_t i = 0;
  for (int z = 0; z < slab.size.z; ++z)
    for (int y = 0; y < slab.size.y; ++y)
      for (int x = 0; x < slab.size.x; ++x, ++i) {
        const std::size_t at = grid.index({x, y, low_z + z});
        if (grid.tissue[at] != k_air) continue;
        const double a = to_tooth.mm(i, {x, y, z}), b = to_neighbour.mm(i, {x, y, z}),
                     d = std::min(a, b);
        if (d > k_gum_thickness_mm + 2 * leaf) continue;
        const Vec3 p = slab.centre_mm({x, y, z});
        const double top = top_of_gum_mm(margin_mm[slab.index({x, y, 0})], a + b, papilla_mm(p.x));
        const double thick = std::min(k_gum_thickness_mm, k_gum_edge_mm + 0.9 * (top - p.z));
        const int rim = std::min({x, y, slab.size.x - 1 - x, slab.size.y - 1 - y});
        const double body = std::max({p.z - top, bottom_mm - p.z, d - thick,
                                      k_gap_leaves * leaf - d, (3 - rim) * leaf}) /
                            (k_steepest * leaf);
        level[i] = static_cast<float>(body);
        if (body < 0) {
          grid.tissue[at] = ids.gum;
          grid.distance[at] = std::min(encode_distance(body), std::int8_t{-1});
        }
      }
  lower_around(grid, slab, level, low_z);
}

}  // namespace cavum
