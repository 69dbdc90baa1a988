#include "scenarios/zones/leaning_column.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/anatomy/polylines.h"
#include "engine/tooth/octree_edit.h"
#include "scenarios/zones/column.h"

namespace cavum::scenarios {
namespace {

constexpr double k_min_cosine = 0.70710678118654752;  // of the lean: 45 degrees
constexpr double k_pad_mm = 0.1;

/// A shape that stands upright in a frame.
class InFrame final : public Shape {
 public:
  InFrame(const ShapeFrame& frame, std::unique_ptr<Shape> inner)
      : frame_(frame), inner_(std::move(inner)) {}
  double distance_mm(Vec3 p) const noexcept override {
    return inner_->distance_mm(frame_.local(p));
  }
  std::uint64_t pieces() const noexcept override { return inner_->pieces(); }

 private:
  ShapeFrame frame_;
  std::unique_ptr<Shape> inner_;
};

double mean_along(const Polyline& line, Vec3 way) {
  double sum = 0;
  for (const Vec3& p : line) sum += dot(p, way);
  return sum / static_cast<double>(line.size());
}

/// Of the leaves of a tissue that count, by their centres in a frame; empty where it has none.
Bounds tissue_box(const Octree& tree, const ShapeFrame& frame, std::uint8_t id,
                  const auto& counts) {
  Bounds box;
  if (id == k_air) return box;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t != id) return;
    for (int i = 0; i < edge * edge * edge; ++i) {
      const Vec3 p = tree.centre_mm(at + IVec3{i % edge, i / edge % edge, i / (edge * edge)});
      if (counts(p)) box.add(frame.local(p));
    }
  });
  return box;
}

/// With a pad around the box; 0 everywhere.
ColumnMap columns_over(const Bounds& box, double leaf_mm) {
  ColumnMap map;
  map.leaf_mm = leaf_mm;
  map.origin_mm = {box.low.x - k_pad_mm, box.low.y - k_pad_mm, 0};
  map.nx = static_cast<int>((box.high.x + k_pad_mm - map.origin_mm.x) / leaf_mm) + 1;
  map.ny = static_cast<int>((box.high.y + k_pad_mm - map.origin_mm.y) / leaf_mm) + 1;
  map.value.assign(static_cast<std::size_t>(map.nx) * static_cast<std::size_t>(map.ny), 0.0);
  return map;
}

}  // namespace

ShapeFrame lingual_way(const Tooth& tooth, const Landmarks& landmarks, const Message& where) {
  if (landmarks.incisal_edge_mm.empty() || landmarks.neck_mm.empty() ||
      landmarks.canal_mouths.empty())
    throw Error(
        where,
        msg("no incisal edge, neck or canal is found on '{}', so no way in from lingual",
            tooth.name),
        msg("look at `cavum tooth landmarks`, or draw a prism (data/scenarios/incisor_access.toml)"));
  const Octree& tree = tooth.octree;
  const Vec3 axis = landmarks.long_axis.occlusal, mouth = landmarks.canal_mouths[0].at_mm;
  const Vec3 lingual = normalized(Vec3{0, -1, 0} + axis * axis.y);
  const double edge = mean_along(landmarks.incisal_edge_mm, axis),
               neck = dot(*furthest_along(landmarks.neck_mm, lingual), axis);
  Vec3 entry = mouth + axis * (0.5 * (edge + neck) - dot(mouth, axis));
  const double step = 0.5 * tree.leaf_mm();
  const auto inside = [&](Vec3 p) {
    const std::uint8_t t = tree.tissue_at(p);
    return t != k_air && t != k_periodontium;
  };
  for (double far = 0; inside(entry) && far < 20.0; far += step) entry += lingual * step;
  ShapeFrame way;
  way.at = mouth;
  way.z = normalized(entry - mouth);
  if (!(dot(way.z, axis) >= k_min_cosine) || !(way.z.z >= k_min_cosine))
    throw Error(
        where,
        msg("the way from the canal through the lingual surface leans by more than 45 degrees"),
        msg("look at `cavum tooth landmarks`, or draw a prism (data/scenarios/incisor_access.toml)"));
  way.x = normalized(Vec3{1, 0, 0} - way.z * way.z.x);
  way.y = cross(way.z, way.x);
  return way;
}

TissueRelief relief_along(const Tooth& tooth, const ShapeFrame& frame, const std::string& tissue,
                          TissuePart part, const Message& where) {
  const Octree& tree = tooth.octree;
  const double leaf = tree.leaf_mm();
  std::uint8_t id = k_air;
  for (const auto& t : tooth.tissues)
    if (t.name == tissue) id = t.id;
  const auto counts = [&](Vec3 p) { return part == TissuePart::all || p.z >= frame.at.z; };
  const Bounds box = tissue_box(tree, frame, id, counts);
  if (box.low.x > box.high.x)
    throw Error(where, msg("the tooth '{}' has no {} along the way in", tooth.name, tissue),
                msg("choose a tooth with it, or another zone"));
  const ColumnMap base = columns_over(box, leaf);
  TissueRelief relief(base);
  Octree::Cursor cursor;
  const double step = 0.5 * leaf;
  relief.lowest_mm = box.high.z;
  relief.highest_mm = box.low.z;
  double count = 0;
  Vec3 sum;
  for (int y = 0; y < base.ny; ++y)
    for (int x = 0; x < base.nx; ++x) {
      const auto i = base.index(x, y);
      for (double z = box.low.z - leaf; z <= box.high.z + leaf; z += step) {
        const Vec3 q{base.origin_mm.x + (x + 0.5) * leaf, base.origin_mm.y + (y + 0.5) * leaf, z};
        const Vec3 p = frame.at + frame.x * q.x + frame.y * q.y + frame.z * q.z;
        if (!counts(p) || tree.tissue_at(p, cursor) != id) continue;
        if (relief.shadow[i] == 0) relief.floor_mm.value[i] = z - 0.5 * step;
        relief.shadow[i] = 1;
        relief.roof_mm.value[i] = z + 0.5 * step;
        sum += p;
        count += 1;
      }
      if (relief.shadow[i] == 0) continue;
      relief.lowest_mm = std::min(relief.lowest_mm, relief.floor_mm.value[i]);
      relief.highest_mm = std::max(relief.highest_mm, relief.roof_mm.value[i]);
    }
  if (count > 0) relief.middle_mm = sum / count;
  relief.go_on_beside_shadow();
  return relief;
}

std::unique_ptr<Shape> leaning_column(const Tooth& tooth, const ShapeSpec& spec,
                                      const ShapeFrame& way, const Message& where, ZoneWork& work) {
  const TissueRelief shadow =
      relief_along(tooth, way, spec.outline.tissue, spec.outline.part, where);
  const TissueRelief part = relief_along(tooth, way, spec.bottom.tissue, spec.bottom.part, where);
  const bool roof = spec.bottom.kind == BottomSpec::Kind::tissue_roof;
  auto outline = make_outline(spec.outline, {}, &shadow);
  ColumnMap bottom = roof ? part.roof_mm : part.floor_mm;
  for (double& z : bottom.value) z -= spec.bottom.deeper_mm;
  work.steps(bottom.value.size(), outline->pieces());
  const double outline_z = (roof ? part.highest_mm : part.lowest_mm) - spec.bottom.deeper_mm;
  return std::make_unique<InFrame>(
      way,
      std::make_unique<Column>(std::move(outline), std::move(bottom), spec.taper_deg, outline_z));
}

}  // namespace cavum::scenarios
