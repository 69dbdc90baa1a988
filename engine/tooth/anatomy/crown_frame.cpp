#include "engine/tooth/anatomy/crown_frame.h"

#include <algorithm>

#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

/// Sum over leaves, in half leaves, as whole numbers: the order of adding does not matter.
struct Moment {
  std::int64_t n = 0, x = 0, y = 0, z = 0;
  void add(IVec3 at, int edge) {
    const std::int64_t leaves = std::int64_t{edge} * edge * edge;
    n += leaves;
    x += leaves * (2 * std::int64_t{at.x} + edge);
    y += leaves * (2 * std::int64_t{at.y} + edge);
    z += leaves * (2 * std::int64_t{at.z} + edge);
  }
  [[nodiscard]] Vec3 centre_mm(const Octree& tree) const {
    const double per = 0.5 * tree.leaf_mm() / static_cast<double>(std::max<std::int64_t>(n, 1));
    return tree.origin_mm() +
           Vec3{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)} * per;
  }
};

}  // namespace

TissueIds tissue_ids(const Tooth& tooth) {
  TissueIds ids;
  for (const auto& t : tooth.tissues) {
    if (t.name == "enamel") ids.enamel = t.id;
    if (t.name == "dentin") ids.dentin = t.id;
    if (t.name == "pulp") ids.pulp = t.id;
  }
  return ids;
}

CrownFrame crown_frame(const Tooth& tooth, const TissueIds& ids) {
  const Octree& tree = tooth.octree;
  Moment enamel, dentin;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (t == ids.enamel) enamel.add(at, edge);
    if (t == ids.dentin) dentin.add(at, edge);
  });
  CrownFrame frame;
  frame.enamel_leaves = static_cast<std::uint64_t>(enamel.n);
  frame.dentin_leaves = static_cast<std::uint64_t>(dentin.n);
  if (enamel.n == 0) return frame;
  frame.origin_mm = enamel.centre_mm(tree);
  const Vec3 along = frame.origin_mm - dentin.centre_mm(tree);
  // centroids that nearly coincide (enamel all round) point nowhere
  frame.own_axis =
      dentin.n > 0 && length(along) > 1.0 && along.z > k_min_axis_cosine * length(along);
  const Vec3 z = frame.own_axis ? normalized(along) : Vec3{0, 0, 1};
  const Vec3 x = normalized(Vec3{1, 0, 0} - z * z.x);
  frame.axes = {x, cross(z, x), z};
  Bounds cap, solid;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t t) {
    if (!tree.is_solid(t)) return;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner{at.x + (i & 1 ? edge : 0.0), at.y + (i & 2 ? edge : 0.0),
                        at.z + (i & 4 ? edge : 0.0)};
      const Vec3 p = frame.from_tooth(tree.origin_mm() + corner * tree.leaf_mm());
      solid.add(p);
      if (t == ids.enamel) cap.add(p);
    }
  });
  frame.enamel_low = cap.low;
  frame.enamel_high = cap.high;
  frame.solid_low = solid.low;
  frame.solid_high = solid.high;
  return frame;
}

}  // namespace cavum
