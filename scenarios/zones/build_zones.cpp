#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/tooth/anatomy/landmarks_file.h"
#include "engine/tooth/octree_edit.h"
#include "scenarios/file/bodies.h"
#include "scenarios/zones/leaf_parts.h"
#include "scenarios/zones/placed.h"
#include "scenarios/zones/shape.h"
#include "scenarios/zones/target_surface.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {
namespace {

/// Leaves around the part of the target that lies in the tooth.
LeafBounds find_target(const Shape& target, const Tooth& tooth, const Message& where,
                       ZoneWork& work) {
  const Octree& tree = tooth.octree;
  LeafBounds box;
  const auto see = [&](IVec3 leaf) {
    const bool seen = leaf.x >= box.low.x && leaf.y >= box.low.y && leaf.z >= box.low.z &&
                      leaf.x < box.high.x && leaf.y < box.high.y && leaf.z < box.high.z;
    if (seen || target.distance_mm(tree.centre_mm(leaf)) >= 0) return;
    box.add(leaf, leaf + IVec3{1, 1, 1});
  };
  // every second leaf of large cubes, every small one: a target thinner than two leaves is none
  const auto step_in = [](int edge) { return edge >= 4 ? 2 : 1; };
  std::uint64_t leaves = 0;
  tree.for_each_cube([&](IVec3, int edge, std::uint8_t) {
    const auto along = static_cast<std::uint64_t>(edge / step_in(edge));
    leaves += along * along * along;
  });
  work.steps(leaves, target.pieces());
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t) {
    const int step = step_in(edge);
    for (int z = 0; z < edge; z += step)
      for (int y = 0; y < edge; y += step)
        for (int x = 0; x < edge; x += step) see(at + IVec3{x, y, z});
  });
  if (box.empty())
    throw Error(where, msg("no part of the target lies in the tooth '{}'", tooth.name),
                msg("move or enlarge [[zones.target]], or choose another tooth"));
  return box;
}

std::uint64_t leaves_with_tissue(const Octree& tree) {
  std::uint64_t leaves = 0;
  tree.for_each_cube([&](IVec3, int edge, std::uint8_t tissue) {
    if (tissue != k_air)
      leaves += static_cast<std::uint64_t>(edge) * static_cast<std::uint64_t>(edge) *
                static_cast<std::uint64_t>(edge);
  });
  return leaves;
}

/// The widest margin around the target that has a zone, and a little more.
double margin_mm(const ZoneSpec& spec) {
  return std::max({spec.leeway.sides_mm, spec.leeway.bottom_mm, spec.container.sides_mm,
                   spec.container.bottom_mm}) +
         0.25;
}

/// The axis of the target's first body where a handpiece comes in that way; from the side, of a
/// cavity in it; else +z.
Vec3 approach_of(const ZoneSpec& spec, ShapeMaker& maker) {
  constexpr double k_steep = 0.5;  // cosine: flatter ways in are no way for a handpiece
  if (spec.target.empty()) return {0, 0, 1};
  const Vec3 axis = maker.way_in(spec.target[0]);
  if (body_is(spec.target[0], k_from_side)) return axis;
  return axis.z >= k_steep ? axis : Vec3{0, 0, 1};
}

Facing facing_of(const ZoneSpec& spec, const ToothKind& tooth) {
  return {!spec.target.empty() && body_is(spec.target[0], k_from_side) ? spec.target[0].side : 0,
          tooth.anterior()};
}

/// Of a leaf outside the target that is not protected: by its distance, towards the sides or the
/// bottom.
Zone zone_at(double distance_mm, bool bottom, const ZoneSpec& spec) {
  if (distance_mm <= (bottom ? spec.leeway.bottom_mm : spec.leeway.sides_mm))
    return bottom ? Zone::leeway_bottom : Zone::leeway_sides;
  if (distance_mm <= (bottom ? spec.container.bottom_mm : spec.container.sides_mm))
    return bottom ? Zone::container_bottom : Zone::container_sides;
  return Zone::none;
}

}  // namespace

/// Makes a map step by step, each from what the ones before it found.
class ZoneBuilder {
 public:
  ZoneBuilder(const Scenario& scenario, const Tooth& tooth, std::optional<Landmarks> landmarks);
  ZoneMap build();

 private:
  void place_box();
  void count_work();
  [[nodiscard]] ShapeField shape_field() const;
  void lay_distances(const ShapeField& shape);
  void lay_tissues();
  void lay_zones(const ShapeField& shape);
  void require_target() const;
  void measure_target(const ShapeField& shape);
  [[nodiscard]] std::optional<double> surface_above(IVec3 at, std::size_t i);
  [[nodiscard]] std::optional<double> adjacent_surface(IVec3 at) const;
  void lay_guard_beyond();
  void lay_shares();
  [[nodiscard]] bool guarded(IVec3 leaf) const {
    return guard_ != nullptr && guard_->distance_mm(map_.centre_mm(leaf)) < 0;
  }

  const Octree& tree_;  // with all that stands beside the tooth
  const ZoneSpec& spec_;
  const Tooth& tooth_;
  ShapeMaker maker_;
  const Octree& own_;  // the tooth alone: what has a zone, but for what is protected
  std::unique_ptr<Shape> target_, guard_,
      beside_;     // no guard where nothing is protected, nothing beside a tooth that stands alone
  Message where_;  // of the target's first body
  ZoneMap map_;
  std::vector<std::uint8_t> tissue_;  // of the leaves of the map's box
};

ZoneBuilder::ZoneBuilder(const Scenario& scenario, const Tooth& tooth,
                         std::optional<Landmarks> landmarks)
    : tree_(tooth.octree),
      spec_(scenario.zones),
      tooth_(tooth),
      maker_(tooth, scenario.path, std::move(landmarks)),
      own_(maker_.own().octree),
      target_(maker_.make(spec_.target)),
      where_(spec_.target.empty() ? Message(Name{scenario.path})
                                  : Message(location_text(scenario.path, spec_.target[0]))) {}

ZoneMap ZoneBuilder::build() {
  place_box();
  count_work();
  const ShapeField shape = shape_field();
  lay_distances(shape);
  lay_tissues();
  lay_zones(shape);
  require_target();
  measure_target(shape);
  lay_guard_beyond();
  lay_shares();
  return std::move(map_);
}

/// The target's box with its margins, as far as the tooth goes.
void ZoneBuilder::place_box() {
  const LeafBounds box = find_target(*target_, maker_.own(), where_, maker_.work());
  map_.leaf_mm_ = tree_.leaf_mm();
  map_.origin_mm_ = tree_.origin_mm();
  map_.approach_ = approach_of(spec_, maker_);
  map_.facing_ = facing_of(spec_, tooth_.kind);
  const int margin = static_cast<int>(margin_mm(spec_) / map_.leaf_mm_) + 2;
  const IVec3 wide{margin, margin, margin}, high = min(tree_.size(), box.high + wide);
  map_.low_ = max(IVec3{}, box.low - wide);
  map_.size_ = high - map_.low_;
}

/// Throws Error before the work is done when it is too much.
void ZoneBuilder::count_work() {
  const std::size_t cells = cells_of(map_.size_);
  maker_.work().zone_leaves(cells);
  beside_ = maker_.beside(map_.low_, map_.low_ + map_.size_);
  if (!spec_.protected_shapes.empty()) guard_ = maker_.make(spec_.protected_shapes);
  maker_.work().steps(cells, target_->pieces());
  if (guard_ != nullptr) maker_.work().steps(cells + leaves_with_tissue(tree_), guard_->pieces());
}

/// The target at every leaf's centre, without what is protected and what stands beside the tooth.
ShapeField ZoneBuilder::shape_field() const {
  const std::size_t cells = cells_of(map_.size_);
  ShapeField shape{map_.size_, std::vector<float>(cells), std::vector<std::uint8_t>(cells)};
  for_each_cell(shape.size, [&](std::size_t i, IVec3 cell) {
    const Vec3 centre = map_.centre_mm(map_.low_ + cell);
    double d = target_->distance_mm(centre);
    if (guard_ != nullptr) d = std::max(d, -guard_->distance_mm(centre));
    if (beside_ != nullptr) d = std::max(d, -beside_->distance_mm(centre));
    shape.level_mm[i] = static_cast<float>(d);
    shape.inside[i] = d < 0 ? 1 : 0;
  });
  return shape;
}

/// True distances to the target's surface, and the wall that each leaf belongs to.
void ZoneBuilder::lay_distances(const ShapeField& shape) {
  const std::vector<NearestPoint> nearest = nearest_points(shape, map_.facing_);
  map_.wall_.assign(nearest.size(), 0);
  map_.distance_mm_.assign(nearest.size(), 0);
  for_each_cell(map_.size_, [&](std::size_t i, IVec3 cell) {
    const NearestPoint& near = nearest[i];
    const bool in = shape.inside[i] != 0;
    const Vec3 way = to_vec3(cell) - near.at();
    const double d = near.found ? length(way) * map_.leaf_mm_ : margin_mm(spec_);
    map_.distance_mm_[i] = static_cast<float>(in ? -d : d);
    map_.wall_[i] = static_cast<std::uint8_t>(!near.found || length(way) < 1.5
                                                  ? near.wall
                                                  : wall_of(map_.facing_.local(in ? -way : way)));
  });
}

void ZoneBuilder::lay_tissues() {
  tissue_.assign(cells_of(map_.size_), k_air);
  const IVec3 low = map_.low_, high = map_.low_ + map_.size_;
  own_.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    const IVec3 a = max(at, low), b = min(at + IVec3{edge, edge, edge}, high);
    for (int z = a.z; z < b.z; ++z)
      for (int y = a.y; y < b.y; ++y)
        for (int x = a.x; x < b.x; ++x) tissue_[map_.index({x, y, z})] = t;
  });
}

/// The zone of each leaf that holds tissue, and how many leaves each zone has.
void ZoneBuilder::lay_zones(const ShapeField& shape) {
  map_.zone_.assign(tissue_.size(), 0);
  for_each_cell(map_.size_, [&](std::size_t i, IVec3 cell) {
    const IVec3 at = map_.low_ + cell;
    // of what stands beside the tooth only that has a zone which is protected
    if (tissue_[i] == k_air &&
        (beside_ == nullptr || guard_ == nullptr || tree_.tissue(at) == k_air || !guarded(at)))
      return;
    Zone zone = Zone::target;
    if (shape.inside[i] == 0)
      zone = guarded(at) ? Zone::protected_
                         : zone_at(static_cast<double>(map_.distance_mm_[i]),
                                   static_cast<Wall>(map_.wall_[i]) == Wall::floor, spec_);
    map_.zone_[i] = static_cast<std::uint8_t>(zone);
    ++map_.counts_[static_cast<std::size_t>(zone)];
    if (zone == Zone::protected_ && tissue_[i] != k_air &&
        target_->distance_mm(map_.centre_mm(at)) < 0)
      ++map_.guarded_in_target_;
  });
}

void ZoneBuilder::require_target() const {
  if (map_.count(Zone::target) > 0) return;
  if (map_.guarded_in_target_ > 0)
    throw Error(where_, msg("all of the target is protected"),
                msg("move the target, or protect less under [[zones.protected]]"));
  throw Error(where_, msg("the target holds no leaf of the tooth '{}'", tooth_.name),
              msg("make it larger"));
}

/// Of the target's leaves: their box, how many lie at its border, whether there is a way to them,
/// and how high the tooth's surface lies over them.
void ZoneBuilder::measure_target(const ShapeField& shape) {
  const IVec3 size = map_.size_;
  const std::size_t row = shape.row(), layer = shape.layer();
  LeafBounds box;
  double opening_sum = 0;
  std::uint64_t openings = 0;
  Octree::Cursor cursor;
  for_each_cell(size, [&](std::size_t i, IVec3 cell) {
    if (static_cast<Zone>(map_.zone_[i]) != Zone::target) return;
    const IVec3 at = map_.low_ + cell;
    box.add(at);
    const auto ends_along = [&](int place, int count, std::size_t stride) {
      return (place > 0 && shape.inside[i - stride] == 0) ||
             (place + 1 < count && shape.inside[i + stride] == 0);
    };
    if (ends_along(cell.x, size.x, 1) || ends_along(cell.y, size.y, row) ||
        ends_along(cell.z, size.z, layer))
      ++map_.target_border_;
    for (const IVec3 step : k_six_neighbours)
      map_.target_is_open_ = map_.target_is_open_ || own_.tissue(at + step, cursor) == k_air;
    const auto surface = map_.facing_.lateral() ? adjacent_surface(at) : surface_above(at, i);
    if (!surface) return;
    opening_sum += *surface;
    ++openings;
  });
  map_.target_low_mm_ = map_.centre_mm(box.low) - Vec3{0.5, 0.5, 0.5} * map_.leaf_mm_;
  map_.target_high_mm_ = map_.centre_mm(box.high) + Vec3{0.5, 0.5, 0.5} * map_.leaf_mm_;
  map_.opening_z_mm_ =
      openings > 0 ? opening_sum / static_cast<double>(openings) : map_.top_level_mm();
}

/// Height of the tooth's surface over a target leaf that lies right under it.
std::optional<double> ZoneBuilder::surface_above(IVec3 at, std::size_t i) {
  const std::size_t layer =
      static_cast<std::size_t>(map_.size_.x) * static_cast<std::size_t>(map_.size_.y);
  if (at.z - map_.low_.z + 1 != map_.size_.z && tissue_[i + layer] != k_air) return {};
  const double surface = maker_.surface().value[maker_.surface().index(at.x, at.y)];
  if (std::fabs(surface - map_.centre_mm(at).z) > map_.leaf_mm_) return {};
  return surface;
}

/// The same, seen from a side.
std::optional<double> ZoneBuilder::adjacent_surface(IVec3 at) const {
  if (tree_.is_solid(tree_.tissue(at + map_.facing_.in_tooth({0, 0, 1})))) return {};
  const double beyond = std::clamp(-decode_distance(tree_.distance_code(at)), 0.02, 0.98);
  return map_.facing_.local(map_.centre_mm(at)).z + beyond * map_.leaf_mm_;
}

/// What is protected beyond the box, anywhere in the tooth.
void ZoneBuilder::lay_guard_beyond() {
  if (guard_ == nullptr) return;
  map_.tooth_size_ = tree_.size();
  map_.guarded_.assign(cells_of(map_.tooth_size_), false);
  tree_.for_each_cube([&](IVec3 at, int edge, std::uint8_t tissue) {
    if (tissue == k_air) return;
    for_each_cell({edge, edge, edge}, [&](std::size_t, IVec3 in_cube) {
      const IVec3 leaf = at + in_cube;
      if (map_.in_box(leaf) || !guarded(leaf)) return;
      map_.guarded_[map_.tooth_index(leaf)] = true;
      ++map_.counts_[static_cast<std::size_t>(Zone::protected_)];
    });
  });
}

/// What of each leaf lies in the target: on its border, part by part.
void ZoneBuilder::lay_shares() {
  const double leaf_mm = map_.leaf_mm_;
  map_.target_share_.assign(tissue_.size(), 0);
  for_each_cell(map_.size_, [&](std::size_t i, IVec3 cell) {
    const double depth = -static_cast<double>(map_.distance_mm_[i]) / leaf_mm;
    if (tissue_[i] == k_air || depth < -k_parts_reach_leaves) return;
    double share = 1;
    if (depth < k_parts_reach_leaves) {
      const LeafParts parts =
          leaf_parts(map_.low_ + cell, [&](IVec3 l) { return -map_.distance_mm(l) / leaf_mm; });
      share = 0;
      for (const double p : parts) share += share_beyond(p) / k_parts;
    }
    map_.target_share_[i] = static_cast<std::uint16_t>(share * ZoneMap::k_share_units + 0.5);
    map_.target_shares_ += map_.target_share_[i];
  });
}

ZoneMap build_zones(const Scenario& scenario, const Tooth& tooth) {
  return ZoneBuilder(scenario, tooth, {}).build();
}

ZoneMap build_zones(const Scenario& scenario, const Tooth& tooth, const Landmarks& landmarks) {
  return ZoneBuilder(scenario, tooth, landmarks).build();
}

std::string landmarks_to_keep(const Scenario& scenario, const Tooth& tooth) {
  return follows_landmarks(scenario.zones) ? landmarks_text(find_landmarks(tooth)) : "";
}

ZoneMap build_zones_of_exam(const Scenario& scenario, const Tooth& tooth,
                            const std::string& landmarks_json, const std::string& where) {
  if (landmarks_json.empty()) return build_zones(scenario, tooth);
  return build_zones(scenario, tooth, parse_landmarks(landmarks_json, where + ": landmarks.json"));
}

}  // namespace cavum::scenarios
