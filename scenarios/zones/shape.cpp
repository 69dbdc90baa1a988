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
#include "engine/tooth/adjacent.h"
#include "engine/tooth/octree_edit.h"
#include "scenarios/zones/tissue_body.h"

namespace cavum::scenarios {
namespace {

class Combined final : public Shape {
 public:
  void add(ShapeSpec::Combine how, std::unique_ptr<Shape> shape) {
    parts_.emplace_back(how, std::move(shape));
  }
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

constexpr decltype(&body_box) k_bodies[] = {
#define BODY(KIND, ...) body_##KIND,
#include "scenarios/file/bodies_table.inc"
};

}  // namespace

ShapeFrame shape_frame(const ShapeSpec& s) {
  ShapeFrame f;
  f.at = s.at_mm;
  f.z = s.axis;
  const Vec3 x0 = std::fabs(f.z.x) < 0.9 ? normalized(Vec3{1, 0, 0} - f.z * f.z.x)
                                         : normalized(Vec3{0, 1, 0} - f.z * f.z.y);
  const Vec3 y0 = cross(f.z, x0);
  const SinCos turn = det_sincos(s.turn_deg * k_pi / 180);
  f.x = x0 * turn.cos + y0 * turn.sin;
  f.y = y0 * turn.cos - x0 * turn.sin;
  return f;
}

FileLocation location_text(const std::string& file, const ShapeSpec& spec) {
  return {file, spec.line, spec.column};
}

struct ShapeMaker::Cache {
  std::optional<Tooth> own;  // where something stands beside the tooth
  std::optional<ColumnMap> surface;
  std::optional<Landmarks> landmarks;
  std::map<std::pair<std::string, bool>, TissueRelief> relief;
  std::map<std::pair<int, int>, Vec3>
      way_in;  // that bodies take from landmarks, by their place in the file
};

ShapeMaker::ShapeMaker(const Tooth& tooth, std::string where, std::optional<Landmarks> landmarks)
    : tooth_(tooth), where_(std::move(where)), work_(where_), cache_(std::make_unique<Cache>()) {
  cache_->landmarks = std::move(landmarks);
}
ShapeMaker::~ShapeMaker() = default;

const Tooth& ShapeMaker::own() {
  if (!has_adjacent(tooth_)) return tooth_;
  if (!cache_->own) cache_->own = own_tooth(tooth_);
  return *cache_->own;
}

std::unique_ptr<Shape> ShapeMaker::beside(IVec3 low, IVec3 high) {
  const TissueSet tissues = adjacent_tissues(tooth_);
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

void ShapeMaker::set_way_in(const ShapeSpec& spec, Vec3 way) {
  cache_->way_in[{spec.line, spec.column}] = way;
}

Vec3 ShapeMaker::way_in(const ShapeSpec& spec) const {
  const auto told = cache_->way_in.find({spec.line, spec.column});
  return told == cache_->way_in.end() ? spec.axis : told->second;
}

std::unique_ptr<Shape> ShapeMaker::make(const std::vector<ShapeSpec>& list) {
  auto all = std::make_unique<Combined>();
  for (const auto& spec : list)
    all->add(spec.combine, k_bodies[static_cast<std::size_t>(spec.kind)](
                               spec, *this, location_text(where_, spec)));
  return all;
}

const TissueRelief& ShapeMaker::relief(const std::string& tissue, TissuePart part,
                                       const Message& where) {
  const std::pair<std::string, bool> key{tissue, part == TissuePart::chamber};
  auto found = cache_->relief.find(key);
  if (found == cache_->relief.end())
    found = cache_->relief.emplace(key, tissue_relief(tooth_, tissue, part, where)).first;
  return found->second;
}

}  // namespace cavum::scenarios
