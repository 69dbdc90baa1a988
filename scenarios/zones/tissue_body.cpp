#include "scenarios/zones/tissue_body.h"

#include <algorithm>
#include <cmath>

#include "engine/tooth/distance_transform.h"
#include "engine/tooth/octree_edit.h"

namespace cavum::scenarios {
namespace {

class TissueBody final : public Shape {
 public:
  TissueBody(const Tooth& tooth, const TissueSet& tissues, double lowest_mm, double offset_mm,
             ZoneWork& work, const LeafRange& asked)
      : offset_mm_(offset_mm) {
    const Octree& tree = tooth.octree;
    leaf_mm_ = tree.leaf_mm();
    LeafBounds box;
    const auto counts = [&](IVec3 at, int edge, std::uint8_t t) {
      return tissues[t] && tree.origin_mm().z + (at.z + edge) * leaf_mm_ > lowest_mm;
    };
    tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
      if (!counts(at, edge, t)) return;
      box.add(at, at + IVec3{edge, edge, edge});
    });
    const int pad = static_cast<int>(std::max(0.0, offset_mm) / leaf_mm_) + 3;
    // leaves beyond the tooth's are not asked for; one layer of them is known, for what reaches the
    // end of the tooth ends there
    const auto padded = [](int v, int n) { return std::clamp(v, -3, n + 3); };
    const IVec3 n = tree.size();
    box.low = {padded(box.low.x - pad, n.x), padded(box.low.y - pad, n.y),
               padded(box.low.z - pad, n.z)};
    box.high = {padded(box.high.x + pad, n.x), padded(box.high.y + pad, n.y),
                padded(box.high.z + pad, n.z)};
    box.low = max(box.low, asked.low);
    box.high = min(box.high, asked.high);
    size_ = box.high - box.low;
    work.body_leaves(cells_of(size_));
    origin_ = tree.origin_mm() + to_vec3(box.low) * leaf_mm_;
    std::vector<std::uint8_t> in(cells_of(size_), 0);
    tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
      if (!counts(at, edge, t)) return;
      for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
          for (int x = 0; x < edge; ++x)
            if (const IVec3 l = at + IVec3{x, y, z};
                within(l, box.low, box.high) && tree.centre_mm(l).z > lowest_mm)
              in[index(l - box.low)] = 1;
    });
    std::vector<std::uint8_t> out;
    out.reserve(in.size());
    for (const auto i : in) out.push_back(i == 0 ? 1 : 0);
    const auto to_in = nearest_seed(size_, in), to_out = nearest_seed(size_, out);
    value_.resize(in.size());
    for (int z = 0; z < size_.z; ++z)
      for (int y = 0; y < size_.y; ++y)
        for (int x = 0; x < size_.x; ++x) {
          const auto i = index({x, y, z});
          const std::int32_t other = in[i] != 0 ? to_out[i] : to_in[i];
          const std::int32_t plane = size_.x * size_.y;
          const double dx = other % size_.x - x, dy = other / size_.x % size_.y - y,
                       dz = other / plane - z;
          const double d = (std::sqrt(dx * dx + dy * dy + dz * dz) - 0.5) * leaf_mm_;
          value_[i] = static_cast<float>(in[i] != 0 ? -d : d);
        }
  }
  double distance_mm(Vec3 p) const noexcept override {
    const Vec3 q = (p - origin_) / leaf_mm_;
    const IVec3 c{static_cast<int>(std::clamp(q.x, 0.0, size_.x - 1.0)),
                  static_cast<int>(std::clamp(q.y, 0.0, size_.y - 1.0)),
                  static_cast<int>(std::clamp(q.z, 0.0, size_.z - 1.0))};
    const Vec3 centre = origin_ + Vec3{c.x + 0.5, c.y + 0.5, c.z + 0.5} * leaf_mm_;
    const bool beyond =
        q.x < 0 || q.y < 0 || q.z < 0 || q.x > size_.x || q.y > size_.y || q.z > size_.z;
    return static_cast<double>(value_[index(c)]) - offset_mm_ + (beyond ? length(p - centre) : 0.0);
  }

 private:
  [[nodiscard]] static bool within(IVec3 l, IVec3 low, IVec3 high) noexcept {
    return l.x >= low.x && l.y >= low.y && l.z >= low.z && l.x < high.x && l.y < high.y &&
           l.z < high.z;
  }
  [[nodiscard]] std::size_t index(IVec3 i) const noexcept { return cell_index(i, size_); }
  double offset_mm_, leaf_mm_ = 0.05;
  IVec3 size_;
  Vec3 origin_;
  std::vector<float> value_;
};

}  // namespace

std::unique_ptr<Shape> tissue_body(const Tooth& tooth, const TissueSet& tissues, double lowest_mm,
                                   double offset_mm, ZoneWork& work, const LeafRange& asked) {
  return std::make_unique<TissueBody>(tooth, tissues, lowest_mm, offset_mm, work, asked);
}

std::unique_ptr<Shape> body_tissue(const ShapeSpec& spec, ShapeMaker& maker, const Message& where) {
  const TissueRelief& part =
      maker.relief(spec.tissue, spec.part, where);  // also tells whether the tissue is there at all
  TissueSet only{};
  only[maker.tooth().tissue_id(spec.tissue)] = true;
  return tissue_body(maker.tooth(), only, spec.part == TissuePart::chamber ? part.lowest_mm : -1e9,
                     spec.offset_mm, maker.work());
}

bool any_within(const Octree& tree, const TissueSet& tissues, const LeafRange& asked) {
  bool any = false;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    any = any ||
          (tissues[t] && at.x < asked.high.x && at.y < asked.high.y && at.z < asked.high.z &&
           at.x + edge > asked.low.x && at.y + edge > asked.low.y && at.z + edge > asked.low.z);
  });
  return any;
}

}  // namespace cavum::scenarios
