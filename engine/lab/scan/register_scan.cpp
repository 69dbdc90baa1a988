#include "engine/lab/scan/register_scan.h"

#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

/// One round of the search: who is left over from the last one, looked at with more points.
struct Round {
  std::size_t points;
  int steps;
  double trim;       // of the points: the nearest ones that are drawn in
  double misfit_mm;  // from which on a point does not fit at all
  std::size_t kept;
};
constexpr std::size_t k_turns =
    2500;  // drawn evenly over all rotations: any pose lies within some 20 degrees of one
constexpr Round k_rounds[] = {
    {160, 6, 0.6, 0.8, 120}, {500, 15, 0.6, 0.4, 24}, {2500, 25, 0.6, 0.15, 8}};
constexpr std::size_t k_fine_points = 20000;
constexpr double k_facing = 0.3;  // cosine between the normals of a pair

struct Trial {
  Rigid pose;
  double misfit = 0.0;
};

Vec3 middle_of(const std::vector<SurfacePoint>& points) {
  Vec3 sum;
  double area = 0;
  for (const auto& p : points) {
    sum += p.at_mm * p.area_mm2;
    area += p.area_mm2;
  }
  return sum / area;
}

/// Evenly over all rotations: a unit quaternion with normal components (Shoemake, Graphics Gems
/// III).
Mat3 any_rotation(Random& random) {
  Quat q;
  do {
    q = {random.normal(), random.normal(), random.normal(), random.normal()};
  } while (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z < 0.01);
  return rotation(normalized(q));
}

/// Pairs of a scan's points with places of the tooth in one pose.
class Pairs {
 public:
  Pairs(const std::vector<SurfacePoint>& points, const SurfaceIndex& tooth)
      : points_(points), tooth_(tooth), away_(points.size()) {}

  /// Trimmed ICP, point to plane.
  void draw_in(Rigid& pose, const Round& round) {
    for (int step = 0; step < round.steps; ++step) {
      std::vector<double> sorted;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const Vec3 p = pose * points_[i].at_mm;
        const SurfaceIndex::Place& near = tooth_.near(p);
        away_[i] = dot(pose.rotation * points_[i].normal, near.normal) > k_facing
                       ? length(p - near.at_mm)
                       : k_none;
        if (away_[i] < k_none) sorted.push_back(away_[i]);
      }
      const auto rank = static_cast<std::size_t>(round.trim * static_cast<double>(points_.size()));
      double reach = k_none / 2;
      if (rank < sorted.size()) {
        std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(rank),
                         sorted.end());
        reach = sorted[rank];
      }
      PlaneSteps steps(pose * points_[points_.size() / 2].at_mm);
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (away_[i] > reach) continue;
        const Vec3 p = pose * points_[i].at_mm;
        const SurfaceIndex::Place& near = tooth_.near(p);
        steps.add(p, near.normal, near.plane_mm(p), 1.0);
      }
      const auto move = steps.solve();
      if (!move) return;
      pose = move->after(pose);
    }
  }
  /// Mean over all points, 0..1: squared distance over that from which on a point does not fit.
  [[nodiscard]] double misfit(const Rigid& pose, double misfit_mm) const {
    double sum = 0;
    for (const auto& point : points_) {
      const Vec3 p = pose * point.at_mm;
      const SurfaceIndex::Place& near = tooth_.near(p);
      // within a cell the place is not the nearest one, and its plane says more
      const double away =
          std::max(length(p - near.at_mm) - k_in_cell_mm, std::fabs(near.plane_mm(p))) / misfit_mm;
      sum += dot(pose.rotation * point.normal, near.normal) > k_facing ? std::min(1.0, away * away)
                                                                       : 1.0;
    }
    return sum / static_cast<double>(points_.size());
  }

 private:
  static constexpr double k_none = 1e9, k_in_cell_mm = 0.25;
  const std::vector<SurfacePoint>& points_;
  const SurfaceIndex& tooth_;
  std::vector<double> away_;
};

bool elsewhere(const Rigid& a, const Rigid& b, Vec3 middle, double cosine, double mm) {
  return cosine_between(a.rotation, b.rotation) < cosine || length(a * middle - b * middle) > mm;
}

/// The best of them, each once.
std::vector<Trial> best_of(std::vector<Trial> trials, std::size_t count, Vec3 middle) {
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.misfit < b.misfit; });
  std::vector<Trial> kept;
  for (const auto& t : trials) {
    if (kept.size() == count) break;
    if (std::all_of(kept.begin(), kept.end(), [&](const Trial& k) {
          return elsewhere(t.pose, k.pose, middle, 0.9994, 0.15);
        }))
      kept.push_back(t);
  }
  return kept;
}

/// Where a drawn point of the scan lies against the tooth.
struct Off {
  double mm = 0.0;
  Vec3 at, normal;
  bool near = false, facing = false;
};

/// Point to plane with Tukey's weights, against the octree's own distance.
class FineFit {
 public:
  static constexpr double k_min_noise_mm = 0.005;
  FineFit(const std::vector<SurfacePoint>& points, const OuterSurface& tooth)
      : points_(points), tooth_(tooth), off_(points.size()) {}

  [[nodiscard]] std::optional<ScanPose> fit(Rigid pose) {
    constexpr int k_steps = 40;
    constexpr double k_tukey = 4.685, k_still_mm = 1e-6;
    for (int step = 0; step < k_steps; ++step) {
      look(pose);
      const auto noise = noise_mm();
      if (!noise) return std::nullopt;
      const double reach = k_tukey * std::max(*noise, k_min_noise_mm);
      PlaneSteps steps(pose * points_[points_.size() / 2].at_mm);
      for (const Off& o : off_) {
        if (!o.near || !o.facing || std::fabs(o.mm) >= reach) continue;
        const double u = o.mm / reach, w = (1 - u * u) * (1 - u * u);
        steps.add(o.at, o.normal, o.mm, w);
      }
      const auto move = steps.solve();
      if (!move) return std::nullopt;
      pose = move->after(pose);
      double most = 0;
      for (std::size_t i = 0; i < off_.size(); i += off_.size() / 8 + 1)
        most = std::max(most, length(*move * off_[i].at - off_[i].at));
      if (most < k_still_mm) break;
    }
    look(pose);
    const auto noise = noise_mm();
    if (!noise) return std::nullopt;
    return ScanPose{pose, *noise, 0.0};
  }
  /// Of the points, those that lie within `within_mm` of the tooth and face the same way.
  [[nodiscard]] double share(const Rigid& pose, double within_mm) {
    look(pose);
    const auto fits = std::count_if(off_.begin(), off_.end(), [&](const Off& o) {
      return o.facing && std::fabs(o.mm) <= within_mm;
    });
    return static_cast<double>(fits) / static_cast<double>(off_.size());
  }

 private:
  static constexpr double k_fine_facing = 0.5;

  void look(const Rigid& pose) {
    const double near_mm = std::min(0.9 * tooth_.band_mm(), 0.15);
    for (std::size_t i = 0; i < off_.size(); ++i) {
      const Vec3 p = pose * points_[i].at_mm;
      const OuterSurface::Distance d = tooth_.distance(p, cursor_);
      off_[i] = {d.mm, p, d.normal, std::fabs(d.mm) < near_mm,
                 dot(pose.rotation * points_[i].normal, d.normal) > k_fine_facing};
    }
  }
  /// By the median of those near by; none when they are too few.
  [[nodiscard]] std::optional<double> noise_mm() const {
    constexpr std::size_t k_fewest = 500;
    constexpr double k_sigma_of_median = 1.4826;
    std::vector<double> sizes;
    for (const Off& o : off_)
      if (o.near && o.facing) sizes.push_back(std::fabs(o.mm));
    if (sizes.size() < k_fewest) return std::nullopt;
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2),
                     sizes.end());
    return k_sigma_of_median * sizes[sizes.size() / 2];
  }

  const std::vector<SurfacePoint>& points_;
  const OuterSurface& tooth_;
  std::vector<Off> off_;
  Octree::Cursor cursor_;
};

/// Every rotation, with the scan's middle on the tooth's and on its crown's.
std::vector<Trial> all_starts(Vec3 scan_middle, const OuterSurface& tooth, Random& random) {
  std::vector<Vec3> anchors{middle_of(tooth.points())};
  if (const Vec3 crown = middle_of(tooth.crown()); length(crown - anchors.front()) > 1.0)
    anchors.push_back(crown);
  std::vector<Trial> starts;
  for (std::size_t i = 0; i < k_turns; ++i) {
    const Mat3 turn = any_rotation(random);
    for (const Vec3 anchor : anchors) starts.push_back({{turn, anchor - turn * scan_middle}, 0});
  }
  return starts;
}

}  // namespace

std::optional<Registration> register_scan(const std::vector<SurfacePoint>& scan,
                                          const OuterSurface& tooth) {
  Random random(20261126);
  const Vec3 middle = middle_of(scan);
  std::vector<Trial> trials = all_starts(middle, tooth, random);
  for (const Round& round : k_rounds) {
    const auto points = drawn_by_area(scan, round.points, random);
    Pairs pairs(points, tooth.index());
    for (Trial& t : trials) {
      pairs.draw_in(t.pose, round);
      t.misfit = pairs.misfit(t.pose, round.misfit_mm);
    }
    trials = best_of(std::move(trials), round.kept, middle);
  }
  const auto points = drawn_by_area(scan, k_fine_points, random);
  FineFit fine(points, tooth);
  std::vector<ScanPose> poses;
  for (const Trial& t : trials)
    if (const auto pose = fine.fit(t.pose)) poses.push_back(*pose);
  if (poses.empty()) return std::nullopt;
  double noise_mm = poses.front().noise_mm;
  for (const auto& p : poses) noise_mm = std::min(noise_mm, p.noise_mm);
  for (auto& p : poses)
    p.share = fine.share(p.to_tooth, 3 * std::max(noise_mm, FineFit::k_min_noise_mm));
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ScanPose& a, const ScanPose& b) { return a.share > b.share; });
  Registration r{poses.front(), std::nullopt};
  for (const auto& p : poses)
    if (!r.second && elsewhere(p.to_tooth, r.best.to_tooth, middle, 0.9903, 1.0)) r.second = p;
  return r;
}

}  // namespace cavum
