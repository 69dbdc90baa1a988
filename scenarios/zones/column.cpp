#include "scenarios/zones/column.h"

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "scenarios/zones/leaning_column.h"
#include "scenarios/zones/placed.h"

namespace cavum::scenarios {
namespace {

/// Heights of the tooth's surface inside an outline.
struct SurfaceHeights {
  double lowest_mm = 1e9, mean_mm = 0;
  int columns = 0;
};
SurfaceHeights surface_heights(const ColumnMap& top, const Outline& outline) {
  SurfaceHeights heights;
  double sum = 0;
  for (int y = 0; y < top.ny; ++y)
    for (int x = 0; x < top.nx; ++x) {
      const double z = top.value[top.index(x, y)];
      const Vec3 at = top.origin_mm + Vec3{x + 0.5, y + 0.5, 0} * top.leaf_mm;
      if (z == k_no_tooth_mm || outline.distance_mm(at.x, at.y) >= 0) continue;
      heights.lowest_mm = std::min(heights.lowest_mm, z);
      sum += z;
      ++heights.columns;
    }
  if (heights.columns > 0) heights.mean_mm = sum / heights.columns;
  return heights;
}

/// Of a line's own points.
SurfaceHeights heights_along(const std::vector<Vec3>& line) {
  SurfaceHeights heights;
  for (const Vec3& p : line) {
    heights.lowest_mm = std::min(heights.lowest_mm, p.z);
    heights.mean_mm += p.z / static_cast<double>(line.size());
    ++heights.columns;
  }
  return heights;
}

/// Where a column ends: the height for each of the tooth's columns, and the one at which its
/// outline is as drawn.
struct ColumnBottom {
  ColumnMap height_mm;
  double outline_z_mm = 0.0;
};

/// Of the enamel's underside: under a fissure's bottom, else anywhere inside the outline.
double lowest_border_mm(ShapeMaker& maker, const Outline& outline, const OutlineSpec& placed,
                        const Message& where) {
  const TissueRelief& enamel = maker.relief("enamel", TissuePart::all, where);
  const ColumnMap& floor = enamel.floor_mm;
  double lowest = 1e9;
  for (const Vec3& p : placed.bottom_line_mm) lowest = std::min(lowest, floor.at(p.x, p.y));
  for (int y = 0; y < floor.ny && placed.bottom_line_mm.empty(); ++y)
    for (int x = 0; x < floor.nx; ++x) {
      const Vec3 at = floor.origin_mm + Vec3{x + 0.5, y + 0.5, 0} * floor.leaf_mm;
      if (enamel.shadow[floor.index(x, y)] != 0 && outline.distance_mm(at.x, at.y) < 0)
        lowest = std::min(lowest, floor.value[floor.index(x, y)]);
    }
  if (lowest > 1e8)
    throw Error(where, msg("there is no enamel under the outline"),
                msg("move it over the crown, or let the bottom follow something else"));
  return lowest;
}

ColumnBottom bottom_of(ShapeMaker& maker, const BottomSpec& b, const Outline& outline,
                       const OutlineSpec& placed, const Message& where) {
  using Kind = BottomSpec::Kind;
  const auto level_at = [&](double z_mm) {
    ColumnBottom level{maker.surface(), z_mm};
    std::fill(level.height_mm.value.begin(), level.height_mm.value.end(), z_mm);
    return level;
  };
  switch (b.kind) {
    case Kind::level:
      return level_at(b.z_mm);
    case Kind::below_border:
      return level_at(lowest_border_mm(maker, outline, placed, where) - b.depth_mm);
    case Kind::tissue_roof:
    case Kind::tissue_floor: {
      const TissueRelief& part = maker.relief(b.tissue, b.part, where);
      const bool roof = b.kind == Kind::tissue_roof;
      ColumnBottom tissue{roof ? part.roof_mm : part.floor_mm,
                          (roof ? part.highest_mm : part.lowest_mm) - b.deeper_mm};
      for (double& z : tissue.height_mm.value) z -= b.deeper_mm;
      return tissue;
    }
    case Kind::below_surface:
    case Kind::below_lowest:
    case Kind::below_mean:
      break;
  }
  const SurfaceHeights inside = placed.bottom_line_mm.empty()
                                    ? surface_heights(maker.surface(), outline)
                                    : heights_along(placed.bottom_line_mm);
  if (inside.columns == 0)
    throw Error(where, msg("the outline lies beside the tooth '{}'", maker.tooth().name),
                msg("move it over the crown"));
  ColumnBottom below{
      maker.surface(),
      (b.kind == Kind::below_lowest ? inside.lowest_mm : inside.mean_mm) - b.depth_mm};
  for (double& z : below.height_mm.value)
    z = b.kind == Kind::below_surface && z != k_no_tooth_mm ? z - b.depth_mm : below.outline_z_mm;
  return below;
}

}  // namespace

Column::Column(std::unique_ptr<Outline> outline, ColumnMap bottom, double taper_deg,
               double outline_z)
    : outline_(std::move(outline)), bottom_(std::move(bottom)), outline_z_(outline_z) {
  at_centre_.reserve(bottom_.value.size());
  for (int y = 0; y < bottom_.ny; ++y)
    for (int x = 0; x < bottom_.nx; ++x)
      at_centre_.push_back(
          outline_->distance_mm(centre(bottom_.origin_mm.x, x), centre(bottom_.origin_mm.y, y)));
  const SinCos a = det_sincos(taper_deg * k_pi / 180);
  tan_ = a.sin / a.cos;
  cos_ = a.cos;
}

double Column::outline_mm(double x_mm, double y_mm) const noexcept {
  const double qx = (x_mm - bottom_.origin_mm.x) / bottom_.leaf_mm,
               qy = (y_mm - bottom_.origin_mm.y) / bottom_.leaf_mm;
  if (qx >= 0 && qy >= 0 && qx < bottom_.nx && qy < bottom_.ny) {
    const int x = static_cast<int>(qx), y = static_cast<int>(qy);
    if (centre(bottom_.origin_mm.x, x) == x_mm && centre(bottom_.origin_mm.y, y) == y_mm)
      return at_centre_[bottom_.index(x, y)];
  }
  return outline_->distance_mm(x_mm, y_mm);
}

std::unique_ptr<Shape> body_column(const ShapeSpec& spec, ShapeMaker& maker, const Message& where) {
  if (spec.leans) {
    const ShapeFrame way = lingual_way(maker.own(), maker.landmarks(), where);
    maker.set_way_in(spec, way.z);
    return leaning_column(maker.own(), spec, way, where, maker.work());
  }
  const OutlineSpec o = spec.outline.kind == OutlineSpec::Kind::fissure
                            ? place_fissure(spec.outline, maker.landmarks(), where)
                            : spec.outline;
  Vec3 centre = o.centre_mm;
  if (o.from_chamber) {
    const Vec3 middle = maker.relief("pulp", TissuePart::chamber, where).middle_mm;
    centre += Vec3{middle.x, middle.y, 0};
  }
  const TissueRelief* shadow =
      o.kind == OutlineSpec::Kind::projection ? &maker.relief(o.tissue, o.part, where) : nullptr;
  auto outline = make_outline(o, centre, shadow);
  ColumnBottom bottom = bottom_of(maker, spec.bottom, *outline, o, where);
  maker.work().steps(bottom.height_mm.value.size(), outline->pieces());
  return std::make_unique<Column>(std::move(outline), std::move(bottom.height_mm), spec.taper_deg,
                                  bottom.outline_z_mm);
}

}  // namespace cavum::scenarios
