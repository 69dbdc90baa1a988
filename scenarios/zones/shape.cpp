#include "scenarios/zones/shape.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "engine/base/det_math.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/beside.h"
#include "engine/tooth/octree_edit.h"
#include "scenarios/zones/column.h"
#include "scenarios/zones/crown_shell.h"
#include "scenarios/zones/leaning_column.h"
#include "scenarios/zones/mesh_body.h"
#include "scenarios/zones/outline.h"
#include "scenarios/zones/placed.h"
#include "scenarios/zones/side_cavity.h"
#include "scenarios/zones/tissue_body.h"

namespace cavum::scenarios {
namespace {

class Box final : public Shape {
 public:
  explicit Box(const ShapeSpec& s) : frame_(shape_frame(s)), half_(s.size_mm * 0.5) {}
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = frame_.local(p);
    const Vec3 d{std::fabs(q.x) - half_.x, std::fabs(q.y) - half_.y, std::fabs(q.z) - half_.z};
    const double inside = std::max({d.x, d.y, d.z});
    if (inside <= 0) return inside;
    return length({std::max(d.x, 0.0), std::max(d.y, 0.0), std::max(d.z, 0.0)});
  }

 private:
  ShapeFrame frame_;
  Vec3 half_;
};

class Ball final : public Shape {
 public:
  explicit Ball(const ShapeSpec& s) : centre_(s.at_mm), radius_(s.radius_mm) {}
  double distance_mm(Vec3 p) const noexcept override { return length(p - centre_) - radius_; }

 private:
  Vec3 centre_;
  double radius_;
};

/// Cylinder and cone: a four-cornered profile turned about the axis.
class Frustum final : public Shape {
 public:
  Frustum(const ShapeSpec& s, double top) : frame_(shape_frame(s)), low_(s.radius_mm), top_(top), height_(s.height_mm) {}
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = frame_.local(p);
    const double r = std::sqrt(q.x * q.x + q.y * q.y), z = q.z;
    const std::array<Vec3, 4> corner{{{0, 0, 0}, {low_, 0, 0}, {top_, height_, 0}, {0, height_, 0}}};
    double nearest = 1e300;
    for (std::size_t i = 0; i < 3; ++i) nearest = std::min(nearest, segment_distance({r, z, 0}, corner[i], corner[i + 1]));
    const double side = (r - low_) * height_ - (top_ - low_) * z;  // sign of being outside the slanted wall
    return z > 0 && z < height_ && side < 0 ? -nearest : nearest;
  }
  std::uint64_t pieces() const noexcept override { return 3; }

 private:
  ShapeFrame frame_;
  double low_, top_, height_;
};

class Prism final : public Shape {
 public:
  explicit Prism(const ShapeSpec& s)
      : frame_(shape_frame(s)), height_(s.height_mm), outline_(make_outline(s.outline, s.outline.centre_mm, nullptr)) {}
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = frame_.local(p);
    return meet(outline_->distance_mm(q.x, q.y), std::fabs(q.z - 0.5 * height_) - 0.5 * height_);
  }
  std::uint64_t pieces() const noexcept override { return 1 + outline_->pieces(); }

 private:
  ShapeFrame frame_;
  double height_;
  std::unique_ptr<Outline> outline_;
};

TissueSet only(std::uint8_t tissue) {
  TissueSet set{};
  set[tissue] = true;
  return set;
}

class Combined final : public Shape {
 public:
  void add(ShapeSpec::Combine how, std::unique_ptr<Shape> shape) { parts_.emplace_back(how, std::move(shape)); }
  double distance_mm(Vec3 p) const noexcept override {
    double d = 1e3;
    for (const auto& [how, shape] : parts_) {
      const double s = shape->distance_mm(p);
      switch (how) {
        case ShapeSpec::Combine::add:
          d = std::min(d, s);
          break;
        case ShapeSpec::Combine::subtract:
          d = std::max(d, -s);
          break;
        case ShapeSpec::Combine::intersect:
          d = std::max(d, s);
          break;
      }
    }
    return d;
  }
  std::uint64_t pieces() const noexcept override {
    std::uint64_t sum = 0;
    for (const auto& part : parts_) sum += part.second->pieces();
    return sum;
  }

 private:
  std::vector<std::pair<ShapeSpec::Combine, std::unique_ptr<Shape>>> parts_;
};

/// Cones that stand on the canals' mouths and open towards occlusal; like a column they have no upper end.
std::unique_ptr<Shape> canal_cones(const Tooth& tooth, const ShapeSpec& spec, Vec3 middle, const Message& where) {
  constexpr double k_out_of_any_tooth_mm = 60;
  const SinCos taper = det_sincos(spec.taper_deg * k_pi / 180);
  auto all = std::make_unique<Combined>();
  std::string found;
  bool any = false;
  const auto mouths = canal_mouths(tooth, spec.tissue, where);
  if (mouths.empty())
    throw Error(where, msg("no canal leaves the {} of '{}'", spec.tissue, tooth.name), msg("choose a tooth with canals, or another shape"));
  for (const CanalMouth& mouth : mouths) {
    found += fmt::format("{}{}, {}, {}]", found.empty() ? "[" : ", [", fixed(mouth.at_mm.x, 2), fixed(mouth.at_mm.y, 2), fixed(mouth.at_mm.z, 2));
    const Vec3 off = mouth.at_mm - middle;
    if (spec.canals_x * off.x < 0 || spec.canals_y * off.y < 0) continue;
    any = true;
    ShapeSpec cone = spec;
    cone.at_mm = mouth.at_mm - spec.axis * spec.deeper_mm;
    if (cone.radius_mm == 0) cone.radius_mm = mouth.radius_mm;
    cone.height_mm = k_out_of_any_tooth_mm;
    all->add(ShapeSpec::Combine::add, std::make_unique<Frustum>(cone, cone.radius_mm + cone.height_mm * taper.sin / taper.cos));
  }
  if (!any)
    throw Error(where, msg("no canal lies on that side of the chamber's middle; the mouths are at {} mm", found),
                msg("choose another side in 'canals', or \"all\""));
  return all;
}

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

}  // namespace

ShapeFrame shape_frame(const ShapeSpec& s) {
  ShapeFrame f;
  f.at = s.at_mm;
  f.z = s.axis;
  const Vec3 x0 = std::fabs(f.z.x) < 0.9 ? normalized(Vec3{1, 0, 0} - f.z * f.z.x) : normalized(Vec3{0, 1, 0} - f.z * f.z.y);
  const Vec3 y0 = cross(f.z, x0);
  const SinCos turn = det_sincos(s.turn_deg * k_pi / 180);
  f.x = x0 * turn.cos + y0 * turn.sin;
  f.y = y0 * turn.cos - x0 * turn.sin;
  return f;
}

FilePlace place_text(const std::string& file, const ShapeSpec& spec) { return {file, spec.line, spec.column}; }

struct ShapeMaker::Cache {
  std::optional<Tooth> own;  // where something stands beside the tooth
  std::optional<ColumnMap> surface;
  std::optional<Landmarks> landmarks;
  std::map<std::pair<std::string, bool>, TissueRelief> relief;
  std::map<std::pair<int, int>, Vec3> side_way;  // of side cavities, by their place in the file
};

ShapeMaker::ShapeMaker(const Tooth& tooth, std::string where, std::optional<Landmarks> landmarks)
    : tooth_(tooth), where_(std::move(where)), work_(where_), cache_(std::make_unique<Cache>()) {
  cache_->landmarks = std::move(landmarks);
}
ShapeMaker::~ShapeMaker() = default;

const Tooth& ShapeMaker::own() {
  if (!has_beside(tooth_)) return tooth_;
  if (!cache_->own) cache_->own = own_tooth(tooth_);
  return *cache_->own;
}

std::unique_ptr<Shape> ShapeMaker::beside(IVec3 low, IVec3 high) {
  const TissueSet tissues = tissues_beside(tooth_);
  const LeafRange asked{low, high};
  if (!any_within(tooth_.octree, tissues, asked)) return nullptr;
  return tissue_body(tooth_, tissues, -1e9, 0.0, work_, asked);
}

const ColumnMap& ShapeMaker::surface() {
  if (!cache_->surface) cache_->surface = surface_relief(own());
  return *cache_->surface;
}

const Landmarks& ShapeMaker::landmarks() {
  if (!cache_->landmarks) cache_->landmarks = find_landmarks(own());
  return *cache_->landmarks;
}

Vec3 ShapeMaker::way_in(const ShapeSpec& spec) {
  if (spec.leans) return lingual_way(own(), landmarks(), place_text(where_, spec)).z;
  if (spec.kind == ShapeSpec::Kind::side_cavity) return cache_->side_way.at({spec.line, spec.column});
  return spec.axis;
}

std::unique_ptr<Shape> ShapeMaker::make(const std::vector<ShapeSpec>& list) {
  auto all = std::make_unique<Combined>();
  for (const auto& spec : list) all->add(spec.combine, make_one(spec));
  return all;
}

const TissueRelief& ShapeMaker::relief(const std::string& tissue, TissuePart part, const Message& where) {
  const std::pair<std::string, bool> key{tissue, part == TissuePart::chamber};
  auto found = cache_->relief.find(key);
  if (found == cache_->relief.end()) found = cache_->relief.emplace(key, tissue_relief(tooth_, tissue, part, where)).first;
  return found->second;
}

std::unique_ptr<Shape> ShapeMaker::make_one(const ShapeSpec& spec) {
  const Message where = place_text(where_, spec);
  switch (spec.kind) {
    case ShapeSpec::Kind::box:
      return std::make_unique<Box>(spec);
    case ShapeSpec::Kind::ball:
      return std::make_unique<Ball>(spec);
    case ShapeSpec::Kind::cylinder:
      return std::make_unique<Frustum>(spec, spec.radius_mm);
    case ShapeSpec::Kind::cone:
      return std::make_unique<Frustum>(spec, spec.top_radius_mm);
    case ShapeSpec::Kind::prism:
      return std::make_unique<Prism>(spec);
    case ShapeSpec::Kind::tissue: {
      const TissueRelief& part = relief(spec.tissue, spec.part, where);  // also tells whether the tissue is there at all
      return tissue_body(tooth_, only(tooth_.tissue_id(spec.tissue)), spec.part == TissuePart::chamber ? part.lowest_mm : -1e9, spec.offset_mm,
                         work_);
    }
    case ShapeSpec::Kind::stl:
      if (spec.surface == nullptr) throw Error(where, msg("the surface '{}' was not read", spec.file), msg("read it first"));
      count_mesh_body(tooth_, *spec.surface, work_);
      return std::make_unique<MeshBody>(tooth_, *spec.surface);
    case ShapeSpec::Kind::canal_cone:
      return canal_cones(tooth_, spec, relief(spec.tissue, TissuePart::chamber, where).middle_mm, where);
    case ShapeSpec::Kind::proximal_box:
      return std::make_unique<Box>(place_proximal_box(spec, own(), landmarks(), where));
    case ShapeSpec::Kind::side_cavity:
      return make_side_cavity(spec, where);
    case ShapeSpec::Kind::crown:
      return crown_shell(own(), spec, landmarks(), surface(), where, work_);
    case ShapeSpec::Kind::column:
      break;
  }
  return make_column(spec, where);
}

std::unique_ptr<Shape> ShapeMaker::make_side_cavity(const ShapeSpec& spec, const Message& where) {
  PlacedSideCavity placed = side_cavity(own(), spec, landmarks(), where, work_);
  cache_->side_way[{spec.line, spec.column}] = placed.way;
  return std::move(placed.body);
}

std::unique_ptr<Shape> ShapeMaker::make_column(const ShapeSpec& spec, const Message& where) {
  if (spec.leans) return leaning_column(own(), spec, lingual_way(own(), landmarks(), where), where, work_);
  const OutlineSpec o = spec.outline.kind == OutlineSpec::Kind::fissure ? place_fissure(spec.outline, landmarks(), where) : spec.outline;
  Vec3 centre = o.centre_mm;
  if (o.from_chamber) {
    const Vec3 middle = relief("pulp", TissuePart::chamber, where).middle_mm;
    centre += Vec3{middle.x, middle.y, 0};
  }
  const TissueRelief* shadow = o.kind == OutlineSpec::Kind::projection ? &relief(o.tissue, o.part, where) : nullptr;
  auto outline = make_outline(o, centre, shadow);
  ColumnBottom bottom = bottom_of(spec.bottom, *outline, o, where);
  work_.steps(bottom.height_mm.value.size(), outline->pieces());
  return std::make_unique<Column>(std::move(outline), std::move(bottom.height_mm), spec.taper_deg, bottom.outline_z_mm);
}

/// Of the enamel's underside: under a fissure's bottom, else anywhere inside the outline.
double ShapeMaker::lowest_border_mm(const Outline& outline, const OutlineSpec& placed, const Message& where) {
  const TissueRelief& enamel = relief("enamel", TissuePart::all, where);
  const ColumnMap& floor = enamel.floor_mm;
  double lowest = 1e9;
  for (const Vec3& p : placed.bottom_line_mm) lowest = std::min(lowest, floor.at(p.x, p.y));
  for (int y = 0; y < floor.ny && placed.bottom_line_mm.empty(); ++y)
    for (int x = 0; x < floor.nx; ++x) {
      const Vec3 at = floor.origin_mm + Vec3{x + 0.5, y + 0.5, 0} * floor.leaf_mm;
      if (enamel.shadow[floor.index(x, y)] != 0 && outline.distance_mm(at.x, at.y) < 0) lowest = std::min(lowest, floor.value[floor.index(x, y)]);
    }
  if (lowest > 1e8)
    throw Error(where, msg("there is no enamel under the outline"), msg("move it over the crown, or let the bottom follow something else"));
  return lowest;
}

ShapeMaker::ColumnBottom ShapeMaker::bottom_of(const BottomSpec& b, const Outline& outline, const OutlineSpec& placed, const Message& where) {
  using Kind = BottomSpec::Kind;
  const auto level_at = [&](double z_mm) {
    ColumnBottom level{surface(), z_mm};
    std::fill(level.height_mm.value.begin(), level.height_mm.value.end(), z_mm);
    return level;
  };
  switch (b.kind) {
    case Kind::level:
      return level_at(b.z_mm);
    case Kind::below_border:
      return level_at(lowest_border_mm(outline, placed, where) - b.depth_mm);
    case Kind::tissue_roof:
    case Kind::tissue_floor: {
      const TissueRelief& part = relief(b.tissue, b.part, where);
      const bool roof = b.kind == Kind::tissue_roof;
      ColumnBottom tissue{roof ? part.roof_mm : part.floor_mm, (roof ? part.highest_mm : part.lowest_mm) - b.deeper_mm};
      for (double& z : tissue.height_mm.value) z -= b.deeper_mm;
      return tissue;
    }
    case Kind::below_surface:
    case Kind::below_lowest:
    case Kind::below_mean:
      break;
  }
  const SurfaceHeights inside = placed.bottom_line_mm.empty() ? surface_heights(surface(), outline) : heights_along(placed.bottom_line_mm);
  if (inside.columns == 0) throw Error(where, msg("the outline lies beside the tooth '{}'", tooth_.name), msg("move it over the crown"));
  ColumnBottom below{surface(), (b.kind == Kind::below_lowest ? inside.lowest_mm : inside.mean_mm) - b.depth_mm};
  for (double& z : below.height_mm.value) z = b.kind == Kind::below_surface && z != k_no_tooth_mm ? z - b.depth_mm : below.outline_z_mm;
  return below;
}

}  // namespace cavum::scenarios
