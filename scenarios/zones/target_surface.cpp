#include "scenarios/zones/target_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tooth/distance_transform.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {
namespace {

struct OnSurface {
  Vec3 at, normal;  // leaves from the first one's centre; unit, out of the target
  bool found = false;
};

Vec3 centre_of(IVec3 c) { return {double(c.x), double(c.y), double(c.z)}; }

/// Change of the level from leaf to leaf along one axis; one-sided at the box's ends.
double slope(const ShapeField& shape, std::size_t c, std::size_t stride, int at, int count) {
  const std::size_t up = at + 1 < count ? c + stride : c, down = at > 0 ? c - stride : c;
  const double steps = static_cast<double>((up - down) / stride);
  return steps > 0 ? (static_cast<double>(shape.level_mm[up]) -
                      static_cast<double>(shape.level_mm[down])) /
                         steps
                   : 0.0;
}

/// The surface point nearest to a point `from` that lies within about a leaf of the surface; all in
/// leaves.
OnSurface on_surface(const ShapeField& shape, Vec3 from) {
  OnSurface place;
  const IVec3 size = shape.size;
  const IVec3 c{static_cast<int>(std::clamp(from.x + 0.5, 0.0, size.x - 1.0)),
                static_cast<int>(std::clamp(from.y + 0.5, 0.0, size.y - 1.0)),
                static_cast<int>(std::clamp(from.z + 0.5, 0.0, size.z - 1.0))};
  const std::size_t o = shape.index(c);
  const Vec3 gradient{slope(shape, o, 1, c.x, size.x), slope(shape, o, shape.row(), c.y, size.y),
                      slope(shape, o, shape.layer(), c.z, size.z)};
  const double steepness = length(gradient);
  if (!(steepness > 1e-9)) return place;
  place.normal = gradient / steepness;
  const double here = static_cast<double>(shape.level_mm[o]) + dot(gradient, from - centre_of(c));
  const double sink = here / steepness;
  place.found = std::fabs(sink) <= 1.0;
  place.at = from - place.normal * sink;
  return place;
}

/// Of a leaf at `here`, inside the target or not, when the nearest leaf across the surface lies at
/// `across`.
NearestPoint place_towards(const ShapeField& shape, Facing facing, Vec3 here, Vec3 across,
                           bool inside) {
  OnSurface place = on_surface(shape, across);
  if (!place.found) place.at = across;
  const OnSurface foot =
      on_surface(shape, here - place.normal * dot(here - place.at, place.normal));
  if (foot.found && length(here - foot.at) < length(here - place.at)) place = foot;
  const OnSurface own =
      dot(across - here, across - here) < 4 ? on_surface(shape, here) : OnSurface{};
  if (own.found && length(here - own.at) < length(here - place.at)) place = own;
  const Vec3 normal = length(place.normal) > 0.5 ? place.normal
                      : inside                   ? across - here
                                                 : here - across;
  return {static_cast<float>(place.at.x), static_cast<float>(place.at.y),
          static_cast<float>(place.at.z), wall_of(facing.local(normal)), true};
}

/// Each leaf by itself, from the nearest leaf on the other side of the surface.
std::vector<NearestPoint> places_across(const ShapeField& shape, Facing facing) {
  std::vector<std::uint8_t> outside(shape.inside.size());
  std::transform(shape.inside.begin(), shape.inside.end(), outside.begin(),
                 [](std::uint8_t in) { return in != 0 ? 0 : 1; });
  const auto to_inside = nearest_seed(shape.size, shape.inside),
             to_outside = nearest_seed(shape.size, outside);
  std::vector<NearestPoint> nearest(shape.inside.size());
  for_each_cell(shape.size, [&](std::size_t i, IVec3 cell) {
    const bool inside = shape.inside[i] != 0;
    const std::int32_t other = inside ? to_outside[i] : to_inside[i];
    if (other < 0) return;  // the target fills the whole box: no surface anywhere
    const auto o = static_cast<std::size_t>(other);
    const Vec3 across{static_cast<double>(o % shape.row()),
                      static_cast<double>(o % shape.layer() / shape.row()),
                      static_cast<double>(o / shape.layer())};
    nearest[i] = place_towards(shape, facing, centre_of(cell), across, inside);
  });
  return nearest;
}

/// Takes over a neighbour's place where that is nearer, from leaves on the same side of the
/// surface.
void ask_neighbours(const ShapeField& shape, std::vector<NearestPoint>& nearest, IVec3 at,
                    const std::array<IVec3, 3>& neighbours) {
  const IVec3 size = shape.size;
  const std::size_t c = shape.index(at);
  if (!nearest[c].found) return;
  const Vec3 here = centre_of(at);
  double best = dot(here - nearest[c].at(), here - nearest[c].at());
  for (const IVec3 step : neighbours) {
    const IVec3 next = at + step;
    if (!lies_in(next, size)) continue;
    const std::size_t m = shape.index(next);
    if (shape.inside[m] != shape.inside[c]) continue;
    const Vec3 way = here - nearest[m].at();
    if (dot(way, way) >= best) continue;
    best = dot(way, way);
    nearest[c] = nearest[m];
  }
}

/// Far from an edge the nearest leaf's place may lie a little along it: neighbours know better
/// ones. Once upwards and once downwards.
void pass_on(const ShapeField& shape, std::vector<NearestPoint>& nearest) {
  const IVec3 size = shape.size;
  for_each_cell(size, [&](std::size_t, IVec3 at) {
    ask_neighbours(shape, nearest, at, {{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}});
  });
  for (int z = size.z; z-- > 0;)
    for (int y = size.y; y-- > 0;)
      for (int x = size.x; x-- > 0;)
        ask_neighbours(shape, nearest, {x, y, z}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
}

}  // namespace

std::vector<NearestPoint> nearest_points(const ShapeField& shape, Facing facing) {
  std::vector<NearestPoint> nearest = places_across(shape, facing);
  pass_on(shape, nearest);
  return nearest;
}

}  // namespace cavum::scenarios
