// The shape of a bur: a profile of straight lines and circular arcs, turned about the tool's
// axis. Tip at the origin, +z towards the handle. The signed distance is exact.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/vec.h"

namespace cavum {

/// A place on the profile: radius from the axis and height above the tip, mm.
struct ProfilePoint {
  double r_mm = 0.0, z_mm = 0.0;
};

/// A line, or an arc of less than half a turn about `centre`, from the end of the piece before to
/// `end`.
struct ProfileSegment {
  ProfilePoint end;
  bool arc = false;
  ProfilePoint centre;
};

/// A body of revolution with heights that never fall along the profile. Beyond its last point it
/// goes on upwards as a cylinder (handle side).
class Profile {
 public:
  Profile() = default;
  /// Starts on the axis at the tip (0, 0). Throws Error when heights fall, an arc does not fit or
  /// radii are negative.
  explicit Profile(std::vector<ProfileSegment> segments);

  /// Signed distance, mm, of a point in the tool frame; negative inside.
  [[nodiscard]] double distance_mm(Vec3 tool_mm) const noexcept;
  /// Radius at a height, mm (the larger one where the profile is flat).
  [[nodiscard]] double radius_mm(double z_mm) const noexcept;
  [[nodiscard]] double length_mm() const noexcept {
    return segments_.empty() ? 0.0 : segments_.back().end.z_mm;
  }
  /// The pieces that begin below a height: the same shape there, cheaper to ask.
  [[nodiscard]] Profile below(double z_mm) const;
  [[nodiscard]] const std::vector<ProfileSegment>& segments() const noexcept { return segments_; }

  /// A place on the surface with its outward normal, both in the (r, z) half plane.
  struct SurfacePoint {
    ProfilePoint at, normal;
  };
  /// A place where two pieces meet at an angle, with the normals on both sides.
  struct Corner {
    ProfilePoint at, normal_before, normal_after;
  };
  [[nodiscard]] std::vector<Corner> corners() const;
  /// Smallest radius of a bulging arc, mm; `otherwise` without one.
  [[nodiscard]] double smallest_arc_mm(double otherwise) const noexcept;
  /// The profile's points at even steps of at most `step_mm`, from the tip to `below_z_mm`.
  [[nodiscard]] std::vector<SurfacePoint> walk(double step_mm, double below_z_mm) const;

 private:
  /// A piece prepared for distances: where it starts and ends, squared length or radius.
  struct Piece {
    ProfilePoint a, b, centre;
    double length2 = 0, radius = 0;
    bool arc = false, bulge = true;
    double turn = 1;  ///< +1 counter-clockwise about the centre
  };
  [[nodiscard]] static double distance_to(const Piece& piece, double r, double z) noexcept;
  [[nodiscard]] static ProfilePoint normal_at(const Piece& piece, ProfilePoint at) noexcept;
  [[nodiscard]] static bool holds(const Piece& piece, double r, double z) noexcept;
  [[nodiscard]] static double radius_on(const Piece& piece, double z) noexcept;

  std::vector<ProfileSegment> segments_;
  std::vector<Piece> pieces_;
};

// The distance is asked thousands of times for each carve: it is inline.
constexpr double profile_cross(double ax, double ay, double bx, double by) noexcept {
  return ax * by - ay * bx;
}
constexpr double profile_squared(double v) noexcept { return v * v; }

inline double Profile::distance_to(const Piece& p, double r, double z) noexcept {
  if (p.arc) {
    const double vr = r - p.centre.r_mm, vz = z - p.centre.z_mm;
    if (p.turn * profile_cross(p.a.r_mm - p.centre.r_mm, p.a.z_mm - p.centre.z_mm, vr, vz) >= 0 &&
        p.turn * profile_cross(vr, vz, p.b.r_mm - p.centre.r_mm, p.b.z_mm - p.centre.z_mm) >= 0)
      return std::fabs(std::sqrt(vr * vr + vz * vz) - p.radius);
    return std::sqrt(std::min(profile_squared(r - p.a.r_mm) + profile_squared(z - p.a.z_mm),
                              profile_squared(r - p.b.r_mm) + profile_squared(z - p.b.z_mm)));
  }
  const double dr = p.b.r_mm - p.a.r_mm, dz = p.b.z_mm - p.a.z_mm;
  const double along = (r - p.a.r_mm) * dr + (z - p.a.z_mm) * dz;
  const double t = p.length2 > 0 ? std::clamp(along / p.length2, 0.0, 1.0) : 0.0;
  return std::sqrt(profile_squared(r - p.a.r_mm - t * dr) + profile_squared(z - p.a.z_mm - t * dz));
}

inline double Profile::radius_on(const Piece& p, double z) noexcept {
  if (p.arc) {
    const double side =
        std::sqrt(std::max(0.0, profile_squared(p.radius) - profile_squared(z - p.centre.z_mm)));
    return p.bulge ? p.centre.r_mm + side : p.centre.r_mm - side;
  }
  const double dz = p.b.z_mm - p.a.z_mm;
  if (dz <= 0) return std::max(p.a.r_mm, p.b.r_mm);
  return p.a.r_mm + (p.b.r_mm - p.a.r_mm) * (z - p.a.z_mm) / dz;
}

inline bool Profile::holds(const Piece& p, double r, double z) noexcept {
  if (p.arc) {
    const bool in_circle = profile_squared(r - p.centre.r_mm) + profile_squared(z - p.centre.z_mm) <
                           profile_squared(p.radius);
    return p.bulge ? r <= p.centre.r_mm || in_circle : r < p.centre.r_mm && !in_circle;
  }
  const double dz = p.b.z_mm - p.a.z_mm;
  if (dz <= 0) return r < std::max(p.a.r_mm, p.b.r_mm);
  return (r - p.a.r_mm) * dz < (p.b.r_mm - p.a.r_mm) * (z - p.a.z_mm);
}

inline double Profile::distance_mm(Vec3 at) const noexcept {
  const double r = std::sqrt(at.x * at.x + at.y * at.y);
  double nearest = std::numeric_limits<double>::max();
  bool inside = false;
  const ProfilePoint end = pieces_.back().b;
  if (at.z > end.z_mm) {  // the handle side goes on
    inside = r < end.r_mm;
    nearest = std::fabs(r - end.r_mm);
  }
  // pieces at this height first: they are near, and tell how far the others may be passed over
  for (const auto& p : pieces_) {
    if (at.z < p.a.z_mm || at.z > p.b.z_mm) continue;
    nearest = std::min(nearest, distance_to(p, r, at.z));
    inside = inside || holds(p, r, at.z);
  }
  for (const auto& p : pieces_) {
    const double gap = at.z < p.a.z_mm ? p.a.z_mm - at.z : at.z - p.b.z_mm;
    if (gap > 0 && gap < nearest) nearest = std::min(nearest, distance_to(p, r, at.z));
  }
  return inside ? -nearest : nearest;
}

}  // namespace cavum
