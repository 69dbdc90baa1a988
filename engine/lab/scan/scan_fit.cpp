#include "engine/lab/scan/scan_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "engine/base/error.h"

namespace cavum {
namespace {

constexpr std::size_t k_looked_at = 40000;
constexpr double k_fits_near_mm = 0.15, k_fits_facing = 0.5, k_fits_shallow_mm = 0.3,
                 k_min_within_mm = 0.03;

struct Seen {
  double mm = 0.0;
  bool facing = false;
};

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

constexpr double k_patch_mm = 0.7;
/// Signed distances by patches, cells of that size: the standard deviation of their means, by the
/// median.
class Patches {
 public:
  void add(Vec3 p, double mm) {
    const auto cell = [](double v) { return static_cast<int>(std::floor(v / k_patch_mm)); };
    Sum& s = sums_[{cell(p.x), cell(p.y), cell(p.z)}];
    s.mm += mm;
    ++s.count;
  }
  [[nodiscard]] std::vector<double> mean_sizes() const {
    std::vector<double> sizes;
    for (const auto& [cell, s] : sums_)
      if (s.count >= k_fewest) sizes.push_back(std::fabs(s.mm / s.count));
    return sizes;
  }

 private:
  static constexpr int k_fewest = 15;
  struct Sum {
    double mm = 0.0;
    int count = 0;
  };
  std::map<std::array<int, 3>, Sum> sums_;
};

/// Of the tooth's enamel surface, what the scan lies upon.
double seen_of_crown(const std::vector<SurfacePoint>& scan, const Rigid& to_tooth,
                     const OuterSurface& tooth, double within_mm) {
  constexpr double k_cell_mm = 0.15, k_beside_mm = 0.4, k_of_cell_mm = 0.02;
  std::vector<SurfacePoint> in_tooth = scan;
  for (auto& p : in_tooth) {
    p.at_mm = to_tooth * p.at_mm;
    p.normal = to_tooth.rotation * p.normal;
  }
  const SurfaceIndex index(in_tooth, k_cell_mm, 1.0);
  double all = 0, seen = 0;
  for (const auto& p : tooth.crown()) {
    const SurfaceIndex::Place& near = index.near(p.at_mm);
    all += p.area_mm2;
    if (length(p.at_mm - near.at_mm) < k_beside_mm &&
        std::fabs(near.plane_mm(p.at_mm)) <= within_mm + k_of_cell_mm &&
        dot(near.normal, p.normal) > k_fits_facing)
      seen += p.area_mm2;
  }
  return seen / all;
}

}  // namespace

ScanFit fit_of(const std::vector<SurfacePoint>& scan, const Rigid& to_tooth,
               const OuterSurface& tooth) {
  constexpr double k_sigma_of_median = 1.4826;
  Random random(7);
  const auto points = drawn_by_area(scan, k_looked_at, random);
  std::vector<Seen> seen;
  std::vector<double> near;
  Patches patches;
  Octree::Cursor cursor;
  for (const auto& p : points) {
    const Vec3 at = to_tooth * p.at_mm;
    const OuterSurface::Distance d = tooth.distance(at, cursor);
    seen.push_back({d.mm, dot(to_tooth.rotation * p.normal, d.normal) > k_fits_facing});
    if (seen.back().facing && std::fabs(d.mm) < k_fits_near_mm)
      near.push_back(std::fabs(d.mm)), patches.add(at, d.mm);
  }
  ScanFit fit;
  fit.noise_mm = k_sigma_of_median * median_of(near);
  fit.form_mm = k_sigma_of_median * median_of(patches.mean_sizes());
  fit.within_mm = std::max(k_min_within_mm, 3 * fit.noise_mm);
  double squares = 0;
  const double one = 1.0 / static_cast<double>(seen.size());
  for (const Seen& s : seen) {
    if (s.mm > fit.within_mm)
      fit.beyond += one;
    else if (s.mm < -k_fits_shallow_mm || !s.facing)
      fit.deep += one;
    else if (s.mm < -fit.within_mm)
      fit.shallow += one;
    else {
      fit.fits += one;
      squares += s.mm * s.mm;
    }
  }
  fit.rms_mm = fit.fits > 0 ? std::sqrt(squares * one / fit.fits) : 0.0;
  fit.crown_seen = seen_of_crown(scan, to_tooth, tooth, fit.within_mm);
  return fit;
}

bool fits_tooth(const ScanFit& f) noexcept {
  constexpr double k_max_noise_mm = 0.06, k_max_form_mm = 0.018, k_min_agreement = 0.88,
                   k_max_beyond = 0.04;
  return f.noise_mm <= k_max_noise_mm && f.form_mm <= k_max_form_mm &&
         agreement(f) >= k_min_agreement && f.beyond <= k_max_beyond;
}

void require_same_tooth(const ScanFit& f, const std::string& where) {
  constexpr double k_min_crown = 0.45;
  const auto percent = [](double share) { return as_percent(100 * share, 1); };
  const Message found = msg(
      "where it fits best, {} of its surface lies within {} of the tooth (RMS {}, patches of {} {}), {} outside it and {} just below it; {} of the "
      "crown is seen",
      percent(f.fits), as_mm(f.within_mm, 3), as_mm(f.rms_mm, 3), as_mm(k_patch_mm, 1),
      as_mm(f.form_mm, 3), percent(f.beyond), percent(f.shallow), percent(f.crown_seen));
  if (!fits_tooth(f))
    throw Error(
        ScanError::another_tooth, Name{where}, msg("is not the tooth of this exam: {}", found),
        msg("give the scan of this very tooth, without its neighbours, or name its tooth with --tooth; if it is this tooth, too much of its "
            "crown was "
            "ground off to lay the scan upon the rest"));
  if (f.crown_seen < k_min_crown)
    throw Error(ScanError::crown_not_seen, Name{where},
                msg("shows too little of the crown to be sure: {}", found),
                msg("scan the whole crown down to its neck"));
}

}  // namespace cavum
