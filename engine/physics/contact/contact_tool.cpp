#include "engine/physics/contact/contact_tool.h"

#include <algorithm>
#include <cmath>

#include "engine/base/det_math.h"
#include "engine/physics/contact/tuning.h"

namespace cavum {

using namespace tuning;

namespace {

/// Moves a place near a bulging corner onto the fillet that rounds it.
void round_edges(const std::vector<Profile::Corner>& corners, Profile::SurfacePoint& p) {
  for (const auto& c : corners) {
    const double bend =
        c.normal_before.r_mm * c.normal_after.z_mm - c.normal_before.z_mm * c.normal_after.r_mm;
    const double along =
        c.normal_before.r_mm * c.normal_after.r_mm + c.normal_before.z_mm * c.normal_after.z_mm;
    if (bend <= 0) continue;                                       // hollow
    const double tangent = k_edge_radius_mm * bend / (1 + along);  // radius · tan(half the turn)
    const double dr = p.at.r_mm - c.at.r_mm, dz = p.at.z_mm - c.at.z_mm;
    if (dr * dr + dz * dz > tangent * tangent) continue;
    // the fillet's centre lies one radius inside both sides
    const double inward = k_edge_radius_mm / (1 + along);
    const ProfilePoint centre{c.at.r_mm - inward * (c.normal_before.r_mm + c.normal_after.r_mm),
                              c.at.z_mm - inward * (c.normal_before.z_mm + c.normal_after.z_mm)};
    const double vr = p.at.r_mm - centre.r_mm, vz = p.at.z_mm - centre.z_mm,
                 v = std::sqrt(vr * vr + vz * vz);
    p.normal = {vr / v, vz / v};
    p.at = {centre.r_mm + k_edge_radius_mm * vr / v, centre.z_mm + k_edge_radius_mm * vz / v};
  }
}

/// Samples of the part between two heights, one for each `spacing²` of area, along a golden-angle
/// spiral.
void spread(const Profile& profile, double low_z, double high_z, double spacing,
            std::vector<ToolSample>& out) {
  struct Ring {
    Profile::SurfacePoint place;
    double area, until;
  };
  constexpr double k_walk_mm = 0.004;
  std::vector<Ring> rings;
  double total = 0;
  const auto places = profile.walk(k_walk_mm, high_z);
  ProfilePoint before;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto& p = places[i];
    const ProfilePoint next = i + 1 < places.size() ? places[i + 1].at : p.at;
    const double dr = 0.5 * (next.r_mm - before.r_mm), dz = 0.5 * (next.z_mm - before.z_mm);
    before = p.at;
    if (p.at.z_mm < low_z) continue;
    const double area = 2 * k_pi * p.at.r_mm * std::sqrt(dr * dr + dz * dz);
    total += area;
    rings.push_back({p, area, total});
  }
  const int n = std::max(8, static_cast<int>(total / (spacing * spacing)));
  const double golden_rad = k_pi * (3.0 - std::sqrt(5.0));
  const auto corners = profile.corners();
  std::size_t ring = 0;
  for (int i = 0; i < n; ++i) {
    const double area = total * (i + 0.5) / n;
    while (ring + 1 < rings.size() && rings[ring].until < area) ++ring;
    auto p = rings[ring].place;
    round_edges(corners, p);
    const auto turn = det_sincos(i * golden_rad);
    out.push_back({{p.at.r_mm * turn.cos, p.at.r_mm * turn.sin, p.at.z_mm},
                   {p.normal.r_mm * turn.cos, p.normal.r_mm * turn.sin, p.normal.z_mm},
                   total / n});
  }
}

/// Groups samples [first, end) into cubes of `edge`, each a patch.
void group(ContactTool& tool, std::size_t first, double edge) {
  const auto cell = [edge](const ToolSample& s) {
    return IVec3{static_cast<int>(std::floor(s.at_mm.x / edge)),
                 static_cast<int>(std::floor(s.at_mm.y / edge)),
                 static_cast<int>(std::floor(s.at_mm.z / edge))};
  };
  std::stable_sort(tool.samples.begin() + static_cast<std::ptrdiff_t>(first), tool.samples.end(),
                   [&](const ToolSample& a, const ToolSample& b) { return cell(a) < cell(b); });
  for (std::size_t i = first; i < tool.samples.size();) {
    std::size_t j = i;
    Vec3 sum;
    while (j < tool.samples.size() && cell(tool.samples[j]) == cell(tool.samples[i]))
      sum += tool.samples[j++].at_mm;
    ToolPatch patch{sum / static_cast<double>(j - i), 0, static_cast<std::uint32_t>(i),
                    static_cast<std::uint32_t>(j)};
    for (std::size_t s = i; s < j; ++s) {
      patch.radius_mm = std::max(patch.radius_mm, length(tool.samples[s].at_mm - patch.centre_mm));
      patch.lever_mm = std::max(patch.lever_mm, length(tool.samples[s].at_mm));
    }
    tool.patches.push_back(patch);
    i = j;
  }
}

/// The pieces of the coated head where the normal turns; edges as `round_edges` makes them.
std::vector<TurningPiece> turning_pieces(const Bur& bur) {
  std::vector<TurningPiece> out;
  const Profile& profile = bur.profile;
  ProfilePoint normal{0, -1};  // of the axis, looking down
  ProfilePoint a;
  bool first = true;
  for (const auto& s : profile.segments()) {
    if (a.z_mm >= bur.cutting_length_mm) break;
    ProfilePoint begins, ends;
    if (s.arc) {
      const double br = a.r_mm - s.centre.r_mm, bz = a.z_mm - s.centre.z_mm,
                   er = s.end.r_mm - s.centre.r_mm, ez = s.end.z_mm - s.centre.z_mm;
      const double radius = std::sqrt(br * br + bz * bz);
      begins = {br / radius, bz / radius};
      ends = {er / radius, ez / radius};
    } else {
      const double dr = s.end.r_mm - a.r_mm, dz = s.end.z_mm - a.z_mm,
                   n = std::sqrt(dr * dr + dz * dz);
      begins = ends = {dz / n, -dr / n};
    }
    const double bend = normal.r_mm * begins.z_mm - normal.z_mm * begins.r_mm,
                 along = normal.r_mm * begins.r_mm + normal.z_mm * begins.z_mm;
    if (bend > 0.04) {
      const double radius =
          first ? 0.0 : k_edge_radius_mm;  // a tip on the axis is as sharp as it is
      const double inward = radius / (1 + along);
      out.push_back({{a.r_mm - inward * (normal.r_mm + begins.r_mm),
                      a.z_mm - inward * (normal.z_mm + begins.z_mm)},
                     normal,
                     begins,
                     radius});
    }
    if (s.arc)
      out.push_back({s.centre, begins, ends,
                     std::sqrt(profile_squared(a.r_mm - s.centre.r_mm) +
                               profile_squared(a.z_mm - s.centre.z_mm))});
    normal = ends;
    first = false;
    a = s.end;
  }
  // where the coating ends the shank goes on: that edge is no edge of the tool, but the head's
  // furthest place on its way up
  out.push_back(
      {{profile.radius_mm(bur.cutting_length_mm), bur.cutting_length_mm}, normal, {0, 1}, 0.0});
  return out;
}

}  // namespace

Vec3 ContactTool::furthest_along(Vec3 way) const noexcept {
  const double across = std::sqrt(way.x * way.x + way.y * way.y);
  double best = -1e9;
  ProfilePoint at;
  for (const auto& p : turning) {
    if (p.from.r_mm * way.z - p.from.z_mm * across < 0 ||
        across * p.to.z_mm - way.z * p.to.r_mm < 0)
      continue;
    const double height = p.centre.r_mm * across + p.centre.z_mm * way.z + p.radius_mm;
    if (height <= best) continue;
    best = height;
    at = {p.centre.r_mm + p.radius_mm * across, p.centre.z_mm + p.radius_mm * way.z};
  }
  if (across < 1e-12)
    return {0, 0, at.z_mm};  // along the axis every direction is as good: the axis itself
  return {at.r_mm * way.x / across, at.r_mm * way.y / across, at.z_mm};
}

ContactTool make_contact_tool(const Bur& bur, double head_spacing_mm) {
  ContactTool tool;
  tool.bur = bur;
  tool.turning = turning_pieces(bur);
  double head_area = 0;
  ProfilePoint before;
  for (const auto& p : bur.profile.walk(0.02, bur.cutting_length_mm)) {
    const double dr = p.at.r_mm - before.r_mm, dz = p.at.z_mm - before.z_mm;
    head_area += 2 * k_pi * p.at.r_mm * std::sqrt(dr * dr + dz * dz);
    before = p.at;
  }
  head_spacing_mm =
      std::clamp(std::sqrt(head_area / k_max_head_samples), head_spacing_mm, 2 * head_spacing_mm);
  spread(bur.profile, 0, bur.cutting_length_mm, head_spacing_mm, tool.samples);
  tool.samples.push_back(
      {{0, 0, 0}, {0, 0, -1}, 1e-4});  // the very tip: a sharp bur touches with nothing else
  group(tool, 0, 0.4);
  tool.head_patches = static_cast<std::uint32_t>(tool.patches.size());
  const auto head = tool.samples.size();
  spread(bur.profile, bur.cutting_length_mm, std::min(bur.profile.length_mm(), 16.0), 0.27,
         tool.samples);
  group(tool, head, 1.2);
  for (const auto& s : tool.samples) tool.reach_mm = std::max(tool.reach_mm, length(s.at_mm));
  return tool;
}

}  // namespace cavum
