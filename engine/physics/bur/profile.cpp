#include "engine/physics/bur/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/error.h"

namespace cavum {
namespace {

double cross2(double ax, double ay, double bx, double by) noexcept { return ax * by - ay * bx; }

double squared(double v) noexcept { return v * v; }

}  // namespace

Profile::Profile(std::vector<ProfileSegment> segments) : segments_(std::move(segments)) {
  const auto fail = [](const Message& what) {
    throw Error(msg("profile"), what, msg("list the pieces from the tip upwards"));
  };
  if (segments_.empty()) fail(msg("has no pieces"));
  ProfilePoint a;
  for (const auto& s : segments_) {
    if (!(s.end.r_mm >= 0) || !std::isfinite(s.end.r_mm) || !std::isfinite(s.end.z_mm))
      fail(msg("a radius is negative or not a number"));
    if (s.end.z_mm < a.z_mm) fail(msg("the heights fall"));
    if (s.end.z_mm == a.z_mm && s.end.r_mm == a.r_mm) fail(msg("a piece has no length"));
    if (s.arc) {
      const double one =
          std::sqrt(squared(a.r_mm - s.centre.r_mm) + squared(a.z_mm - s.centre.z_mm));
      const double two =
          std::sqrt(squared(s.end.r_mm - s.centre.r_mm) + squared(s.end.z_mm - s.centre.z_mm));
      if (!(std::fabs(one - two) <= 1e-6) || !(one > 0))
        fail(msg("an arc's ends are not equally far from its centre"));
    }
    a = s.end;
  }
  if (!(segments_.back().end.r_mm > 0)) fail(msg("the shank has no radius"));
  a = {};
  for (const auto& s : segments_) {
    Piece p{a, s.end, s.centre, squared(s.end.r_mm - a.r_mm) + squared(s.end.z_mm - a.z_mm),
            0, s.arc};
    if (s.arc) {
      p.radius = std::sqrt(squared(a.r_mm - s.centre.r_mm) + squared(a.z_mm - s.centre.z_mm));
      p.turn = cross2(a.r_mm - s.centre.r_mm, a.z_mm - s.centre.z_mm, s.end.r_mm - s.centre.r_mm,
                      s.end.z_mm - s.centre.z_mm) >= 0
                   ? 1.0
                   : -1.0;
      p.bulge = 0.5 * (a.r_mm + s.end.r_mm) >=
                s.centre.r_mm;  // a bulge lies outside its centre, a hollow inside
    }
    pieces_.push_back(p);
    a = s.end;
  }
}

Profile Profile::below(double z_mm) const {
  std::vector<ProfileSegment> kept;
  double start_z = 0;
  for (const auto& s : segments_) {
    if (start_z < z_mm) kept.push_back(s);
    start_z = s.end.z_mm;
  }
  return Profile(std::move(kept));
}

double Profile::radius_mm(double z_mm) const noexcept {
  if (z_mm < 0) return 0.0;
  double widest = -1.0;
  for (const auto& p : pieces_)
    if (z_mm >= p.a.z_mm && z_mm <= p.b.z_mm) widest = std::max(widest, radius_on(p, z_mm));
  return widest >= 0 ? widest : pieces_.back().b.r_mm;
}

ProfilePoint Profile::normal_at(const Piece& p, ProfilePoint at) noexcept {
  if (p.arc) {  // counter-clockwise about its centre is a bulge
    const double s = p.turn / p.radius;
    return {(at.r_mm - p.centre.r_mm) * s, (at.z_mm - p.centre.z_mm) * s};
  }
  const double length = std::sqrt(p.length2);
  return length > 0 ? ProfilePoint{(p.b.z_mm - p.a.z_mm) / length, -(p.b.r_mm - p.a.r_mm) / length}
                    : ProfilePoint{1, 0};
}

std::vector<Profile::Corner> Profile::corners() const {
  std::vector<Corner> out;
  for (std::size_t i = 0; i + 1 < pieces_.size(); ++i) {
    const ProfilePoint at = pieces_[i].b;
    const Corner c{at, normal_at(pieces_[i], at), normal_at(pieces_[i + 1], at)};
    if (c.normal_before.r_mm * c.normal_after.r_mm + c.normal_before.z_mm * c.normal_after.z_mm <
        0.999)
      out.push_back(c);
  }
  return out;
}

double Profile::smallest_arc_mm(double otherwise) const noexcept {
  double smallest = otherwise;
  for (const auto& p : pieces_)
    if (p.arc && p.turn > 0) smallest = std::min(smallest, p.radius);
  return smallest;
}

std::vector<Profile::SurfacePoint> Profile::walk(double step_mm, double below_z_mm) const {
  std::vector<SurfacePoint> out;
  ProfilePoint a;
  for (const auto& s : segments_) {
    const double chord = std::sqrt(squared(s.end.r_mm - a.r_mm) + squared(s.end.z_mm - a.z_mm));
    const int n = std::max(1, static_cast<int>(chord * (s.arc ? 1.6 : 1.0) / step_mm + 0.999));
    for (int i = 0; i < n; ++i) {
      const double t = (i + 0.5) / n;
      SurfacePoint p;
      p.at = {a.r_mm + t * (s.end.r_mm - a.r_mm), a.z_mm + t * (s.end.z_mm - a.z_mm)};
      if (s.arc) {  // push the chord's point out to the arc
        const double radius =
            std::sqrt(squared(a.r_mm - s.centre.r_mm) + squared(a.z_mm - s.centre.z_mm));
        double vr = p.at.r_mm - s.centre.r_mm, vz = p.at.z_mm - s.centre.z_mm;
        const double v = std::sqrt(vr * vr + vz * vz);
        vr /= v;
        vz /= v;
        p.at = {s.centre.r_mm + radius * vr, s.centre.z_mm + radius * vz};
        const double turn = cross2(a.r_mm - s.centre.r_mm, a.z_mm - s.centre.z_mm,
                                   s.end.r_mm - s.centre.r_mm, s.end.z_mm - s.centre.z_mm);
        p.normal = turn >= 0
                       ? ProfilePoint{vr, vz}
                       : ProfilePoint{-vr, -vz};  // counter-clockwise about its centre is a bulge
      } else {
        p.normal = {(s.end.z_mm - a.z_mm) / chord, -(s.end.r_mm - a.r_mm) / chord};
      }
      if (p.at.z_mm <= below_z_mm) out.push_back(p);
    }
    a = s.end;
  }
  return out;
}

}  // namespace cavum
