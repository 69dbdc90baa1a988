#include "engine/device/placement.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "engine/device/device_error.h"

namespace cavum {
namespace {

using Matrix4 = std::array<std::array<double, 4>, 4>;

/// Eigenvector of the largest eigenvalue of a symmetric matrix, by Jacobi rotations.
std::array<double, 4> largest_eigenvector(Matrix4 a) {
  Matrix4 vectors{};
  for (std::size_t i = 0; i < 4; ++i) vectors[i][i] = 1.0;
  constexpr int k_sweeps = 40;
  for (int sweep = 0; sweep < k_sweeps; ++sweep)
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t q = p + 1; q < 4; ++q) {
        if (a[p][q] == 0.0) continue;
        const double half = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
        const double t =
            (half >= 0 ? 1.0 : -1.0) / (std::fabs(half) + std::sqrt(half * half + 1.0));
        const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
        for (std::size_t k = 0; k < 4; ++k) {
          const double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y;
          a[k][q] = s * x + c * y;
        }
        for (std::size_t k = 0; k < 4; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y;
          a[q][k] = s * x + c * y;
          const double u = vectors[k][p], v = vectors[k][q];
          vectors[k][p] = c * u - s * v;
          vectors[k][q] = s * u + c * v;
        }
      }
  std::size_t best = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (a[i][i] > a[best][best]) best = i;
  return {vectors[0][best], vectors[1][best], vectors[2][best], vectors[3][best]};
}

Vec3 mean_of(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

/// Twice the largest area between three of the marks over their largest distance: the width of the
/// figure they make.
void require_a_plane(const std::vector<Vec3>& marks) {
  constexpr double k_min_mm = 5.0;
  double width = 0.0;
  for (std::size_t i = 0; i < marks.size(); ++i)
    for (std::size_t j = i + 1; j < marks.size(); ++j)
      for (std::size_t k = j + 1; k < marks.size(); ++k) {
        const double longest = std::max({length(marks[j] - marks[i]), length(marks[k] - marks[i]),
                                         length(marks[k] - marks[j])});
        if (longest > 0)
          width =
              std::max(width, length(cross(marks[j] - marks[i], marks[k] - marks[i])) / longest);
      }
  if (!(width >= k_min_mm))
    throw Error(DeviceError::marks_in_line, msg("placement"),
                msg("the marks lie on a line, or too close together"),
                msg("touch marks further apart, in the order asked for"));
}

}  // namespace

Quat turned(Quat first, Quat then) noexcept {
  const Quat &a = then, &b = first;
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

Quat rotation_of(Vec3 x, Vec3 y, Vec3 z) noexcept {
  // four times the square of each component; the largest one is divided by
  const std::array<double, 4> square{1 + x.x + y.y + z.z, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z,
                                     1 - x.x - y.y + z.z};
  const auto best =
      static_cast<std::size_t>(std::max_element(square.begin(), square.end()) - square.begin());
  const double s = square[best];
  if (!(s > 1e-9)) return {};
  switch (best) {
    case 0:
      return normalized(Quat{s, y.z - z.y, z.x - x.z, x.y - y.x});
    case 1:
      return normalized(Quat{y.z - z.y, s, x.y + y.x, z.x + x.z});
    case 2:
      return normalized(Quat{z.x - x.z, x.y + y.x, s, y.z + z.y});
    default:
      return normalized(Quat{x.y - y.x, z.x + x.z, y.z + z.y, s});
  }
}

Pose to_tooth(const Placement& placement, Vec3 device_mm) noexcept {
  return {rotation(placement.rotation) * device_mm + placement.offset_mm, placement.tool};
}

Pose to_tooth(const Placement& placement, Vec3 device_mm, Quat tool_to_device) noexcept {
  return {rotation(placement.rotation) * device_mm + placement.offset_mm,
          normalized(turned(tool_to_device, placement.rotation))};
}

Vec3 force_to_device(const Placement& placement, Vec3 tooth_n) noexcept {
  return rotation(placement.rotation).transposed(tooth_n);
}

Placement upright_device(Vec3 middle_mm) noexcept {
  Placement placement;
  placement.rotation = rotation_of({1, 0, 0}, {0, 0, 1}, {0, -1, 0});
  placement.offset_mm = Vec3{} - rotation(placement.rotation) * middle_mm;
  return placement;
}

PlacementFit fit_placement(const std::vector<Vec3>& device_mm, const std::vector<Vec3>& tooth_mm) {
  if (device_mm.size() != tooth_mm.size() || device_mm.size() < 3)
    throw Error(DeviceError::unequal_marks, msg("placement"),
                msg("there are {} marks of the device for {} of the tooth", device_mm.size(),
                    tooth_mm.size()),
                msg("touch at least three, each once"));
  require_a_plane(device_mm);
  require_a_plane(tooth_mm);
  const Vec3 from = mean_of(device_mm), to = mean_of(tooth_mm);
  Mat3 s{{}, {}, {}};  // sum of device times tooth, transposed
  for (std::size_t i = 0; i < device_mm.size(); ++i) {
    const Vec3 a = device_mm[i] - from, b = tooth_mm[i] - to;
    s.row_x += b * a.x;
    s.row_y += b * a.y;
    s.row_z += b * a.z;
  }
  const auto& [x, y, z] = s;
  const auto v = largest_eigenvector({{{x.x + y.y + z.z, y.z - z.y, z.x - x.z, x.y - y.x},
                                       {y.z - z.y, x.x - y.y - z.z, x.y + y.x, z.x + x.z},
                                       {z.x - x.z, x.y + y.x, y.y - x.x - z.z, y.z + z.y},
                                       {x.y - y.x, z.x + x.z, y.z + z.y, z.z - x.x - y.y}}});
  PlacementFit fit;
  fit.placement.rotation = normalized(Quat{v[0], v[1], v[2], v[3]});
  fit.placement.offset_mm = to - rotation(fit.placement.rotation) * from;
  double sum = 0.0;
  for (std::size_t i = 0; i < device_mm.size(); ++i) {
    const double off = length(to_tooth(fit.placement, device_mm[i]).tip_mm - tooth_mm[i]);
    sum += off * off;
    fit.worst_mm = std::max(fit.worst_mm, off);
  }
  fit.rms_mm = std::sqrt(sum / static_cast<double>(device_mm.size()));
  return fit;
}

}  // namespace cavum
