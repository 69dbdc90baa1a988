#include "engine/lab/scan/scale_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace cavum {
namespace {

constexpr std::size_t k_scale_points = 6000, k_fewest_near = 500;
constexpr double k_max_change = 1.25;

/// The least-squares step of motion and size about a middle: (p - c) × n · w + n · t + (p - c) · n
/// e + r.
class SizedSteps {
 public:
  explicit SizedSteps(Vec3 middle_mm) : middle_mm_(middle_mm) {}
  void add(Vec3 p, Vec3 normal, double distance_mm, double weight) {
    const Vec3 off = p - middle_mm_, turn = cross(off, normal);
    const Eigen::Matrix<double, 7, 1> a{turn.x,   turn.y,   turn.z,          normal.x,
                                        normal.y, normal.z, dot(off, normal)};
    normal_.noalias() += weight * a * a.transpose();
    right_ -= weight * distance_mm * a;
    ++count_;
  }
  /// Moves the pose; false where too few points say how.
  [[nodiscard]] bool apply(ScaledPose& pose) const {
    if (count_ < k_fewest_near) return false;
    const Eigen::LDLT<Eigen::Matrix<double, 7, 7>> factors(normal_);
    if (factors.info() != Eigen::Success || !factors.isPositive()) return false;
    const Eigen::Matrix<double, 7, 1> x = factors.solve(right_);
    if (!x.allFinite()) return false;
    const Mat3 turn = rotation(normalized(Quat{1.0, 0.5 * x(0), 0.5 * x(1), 0.5 * x(2)}));
    const double grown = 1.0 + x(6);
    const Vec3 shift =
        middle_mm_ + Vec3{x(3), x(4), x(5)} + turn * (pose.to_tooth.shift_mm - middle_mm_) * grown;
    pose.to_tooth = Rigid{turn, {}}.after({pose.to_tooth.rotation, {}});
    pose.to_tooth.shift_mm = shift;
    pose.scale *= grown;
    return pose.scale > 1 / k_max_change && pose.scale < k_max_change;
  }

 private:
  Vec3 middle_mm_;
  Eigen::Matrix<double, 7, 7> normal_ = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> right_ = Eigen::Matrix<double, 7, 1>::Zero();
  std::size_t count_ = 0;
};

/// A point of the scan beside the plane that it should lie in.
struct Beside {
  Vec3 at, normal;
  double mm = 0.0;
};

double rank_of(std::vector<double> sizes, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(sizes.size() - 1));
  std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
  return sizes[static_cast<std::size_t>(rank)];
}

/// One step with weights of Tukey's kind that end at `reach_mm(sizes)`.
template <class Look, class Reach>
bool step(const std::vector<SurfacePoint>& points, ScaledPose& pose, const Look& look,
          const Reach& reach_mm) {
  std::vector<Beside> seen;
  std::vector<double> sizes;
  Vec3 middle;
  for (const auto& point : points) {
    const Vec3 at = pose.to_tooth * (point.at_mm * pose.scale);
    if (const auto beside = look(at, pose.to_tooth.rotation * point.normal)) {
      seen.push_back(*beside);
      sizes.push_back(std::fabs(beside->mm));
      middle += at;
    }
  }
  if (seen.size() < k_fewest_near) return false;
  const double reach = reach_mm(sizes);
  SizedSteps steps(middle / static_cast<double>(seen.size()));
  for (const Beside& b : seen) {
    const double u = b.mm / reach;
    if (std::fabs(u) < 1) steps.add(b.at, b.normal, b.mm, (1 - u * u) * (1 - u * u));
  }
  return steps.apply(pose);
}

}  // namespace

std::optional<ScaledPose> fit_with_scale(const std::vector<SurfacePoint>& scan, const Rigid& near,
                                         const OuterSurface& tooth) {
  constexpr int k_rough_steps = 40, k_fine_steps = 40;
  constexpr double k_facing_least = 0.5, k_rough_mm = 1.5, k_rough_share = 0.8, k_fine_mm = 0.15,
                   k_sigmas = 4.685 * 1.4826, k_min_reach_mm = 0.03;
  Random random(20261127);
  const auto points = drawn_by_area(scan, k_scale_points, random);
  ScaledPose pose{1.0, near};
  const auto rough = [&](Vec3 at, Vec3 normal) -> std::optional<Beside> {
    const SurfaceIndex::Place& place = tooth.index().near(at);
    if (dot(normal, place.normal) < k_facing_least || length(at - place.at_mm) > k_rough_mm)
      return std::nullopt;
    return Beside{at, place.normal, place.plane_mm(at)};
  };
  for (int i = 0; i < k_rough_steps; ++i)
    if (!step(points, pose, rough, [=](const std::vector<double>& sizes) {
          return std::max(rank_of(sizes, k_rough_share), k_min_reach_mm);
        }))
      return std::nullopt;
  Octree::Cursor cursor;
  const auto fine = [&](Vec3 at, Vec3 normal) -> std::optional<Beside> {
    const OuterSurface::Distance d = tooth.distance(at, cursor);
    if (std::fabs(d.mm) > k_fine_mm || dot(normal, d.normal) < k_facing_least) return std::nullopt;
    return Beside{at, d.normal, d.mm};
  };
  for (int i = 0; i < k_fine_steps; ++i)
    if (!step(points, pose, fine, [=](const std::vector<double>& sizes) {
          return std::max(k_sigmas * rank_of(sizes, 0.5), k_min_reach_mm);
        }))
      return std::nullopt;
  return pose;
}

std::vector<SurfacePoint> in_size(std::vector<SurfacePoint> points, double scale) {
  for (auto& p : points) {
    p.at_mm = p.at_mm * scale;
    p.area_mm2 *= scale * scale;
  }
  return points;
}

}  // namespace cavum
