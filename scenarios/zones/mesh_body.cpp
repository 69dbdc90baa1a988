#include "scenarios/zones/mesh_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "engine/base/error.h"
#include "engine/tooth/distance.h"

namespace cavum::scenarios {
namespace {

// The sign is found on whole numbers, a millionth of a millimetre apart, so that a line through an
// edge or a corner is decided the same way for every triangle that shares it: the line counts as
// moved aside by an infinitely small step in x, a smaller one in y.
constexpr double k_units_per_mm = 1 << 20;
std::int64_t units(double mm) {
  return static_cast<std::int64_t>(std::floor(mm * k_units_per_mm + 0.5));
}

struct Corner {
  std::int64_t x, y;
  double z_mm;
};

/// Twice the area of (a, b, p), seen from above: positive when p lies left of the way from a to b.
std::int64_t left_of(const Corner& a, const Corner& b, std::int64_t x, std::int64_t y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}
int side_of(const Corner& a, const Corner& b, std::int64_t value) {
  if (value != 0) return value > 0 ? 1 : -1;
  if (a.y != b.y) return a.y > b.y ? 1 : -1;
  return a.x == b.x ? 0 : b.x > a.x ? 1 : -1;
}

/// How often the surface winds around each leaf's centre: along each upright line of centres, +1
/// where it goes into the body, -1 out of it.
std::vector<std::int16_t> winding(const TissueGrid& lattice, const TriangleMesh& mesh) {
  std::vector<std::int16_t> turns(lattice.count(), 0);
  const Vec3 first = lattice.centre_mm({0, 0, 0});
  const auto leaf_at = [&](double mm, double from) { return (mm - from) / lattice.leaf_mm; };
  for (const auto& t : mesh.triangles) {
    std::array<Corner, 3> c{};
    Bounds box;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 v = mesh.vertices_mm[t[i]];
      c[i] = {units(v.x), units(v.y), v.z};
      box.add(v);
    }
    const int x0 = std::max(0, static_cast<int>(std::floor(leaf_at(box.low.x, first.x)))),
              y0 = std::max(0, static_cast<int>(std::floor(leaf_at(box.low.y, first.y))));
    const int x1 =
        std::min(lattice.size.x - 1, static_cast<int>(std::ceil(leaf_at(box.high.x, first.x))));
    const int y1 =
        std::min(lattice.size.y - 1, static_cast<int>(std::ceil(leaf_at(box.high.y, first.y))));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Vec3 centre = lattice.centre_mm({x, y, 0});
        const std::int64_t px = units(centre.x), py = units(centre.y);
        const std::int64_t ab = left_of(c[0], c[1], px, py), bc = left_of(c[1], c[2], px, py),
                           ca = left_of(c[2], c[0], px, py);
        const int side = side_of(c[0], c[1], ab);
        if (side == 0 || side_of(c[1], c[2], bc) != side || side_of(c[2], c[0], ca) != side)
          continue;
        const auto whole = static_cast<double>(ab + bc + ca);
        const double z =
            (c[0].z_mm * static_cast<double>(bc) + c[1].z_mm * static_cast<double>(ca) +
             c[2].z_mm * static_cast<double>(ab)) /
            whole;
        const double above =
            std::floor(leaf_at(z, first.z)) + 1;  // the first centre above the crossing
        if (above >= lattice.size.z) continue;
        const IVec3 at{x, y, std::max(0, static_cast<int>(above))};
        turns[lattice.index(at)] = static_cast<std::int16_t>(
            turns[lattice.index(at)] - side);  // a face seen from above leads out
      }
  }
  for (int z = 1; z < lattice.size.z; ++z)
    for (int y = 0; y < lattice.size.y; ++y)
      for (int x = 0; x < lattice.size.x; ++x) {
        auto& here = turns[lattice.index({x, y, z})];
        here = static_cast<std::int16_t>(here + turns[lattice.index({x, y, z - 1})]);
      }
  return turns;
}

/// The tooth's leaves around some corners, as far as distances are exact.
LeafBounds box_of(const Octree& tree, std::span<const Vec3> corners) {
  Bounds box;
  for (const Vec3 v : corners) box.add(v);
  constexpr int k_pad = static_cast<int>(MeshBody::k_exact_leaves) + 2;
  const Vec3 from = (box.low - tree.origin_mm()) / tree.leaf_mm(),
             to = (box.high - tree.origin_mm()) / tree.leaf_mm();
  const auto clip = [](double leaves, int pad, int n) {
    return std::clamp(static_cast<int>(std::floor(leaves)) + pad, 0, n);
  };
  const IVec3 n = tree.size();
  return {{clip(from.x, -k_pad, n.x), clip(from.y, -k_pad, n.y), clip(from.z, -k_pad, n.z)},
          {clip(to.x, k_pad, n.x), clip(to.y, k_pad, n.y), clip(to.z, k_pad, n.z)}};
}

std::uint64_t leaves_around(const Octree& tree, std::span<const Vec3> corners) {
  const LeafBounds box = box_of(tree, corners);
  return cells_of(box.high - box.low);
}

}  // namespace

void count_mesh_body(const Tooth& tooth, const TriangleMesh& mesh, ZoneWork& work) {
  work.body_leaves(leaves_around(tooth.octree, mesh.vertices_mm));
  for (const auto& t : mesh.triangles) {
    const std::array<Vec3, 3> corners{mesh.vertices_mm[t[0]], mesh.vertices_mm[t[1]],
                                      mesh.vertices_mm[t[2]]};
    work.steps(leaves_around(tooth.octree, corners), 1);
  }
}

MeshBody::MeshBody(const Tooth& tooth, const TriangleMesh& mesh) {
  const Octree& tree = tooth.octree;
  const double leaf = tree.leaf_mm();
  const LeafBounds box = box_of(tree, mesh.vertices_mm);
  lattice_.leaf_mm = leaf;
  lattice_.origin_mm = tree.origin_mm() + to_vec3(box.low) * leaf;
  lattice_.size = box.high - box.low;
  if (lattice_.size.x <= 0 || lattice_.size.y <= 0 ||
      lattice_.size.z <= 0) {  // beside the tooth's box
    lattice_.size = {0, 0, 0};
    return;
  }
  BandDistance band(lattice_, static_cast<float>(k_exact_leaves));
  band.add(mesh);
  const std::vector<std::int16_t> turns = winding(lattice_, mesh);
  value_mm_.resize(turns.size());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double d = std::min(static_cast<double>(band.leaves()[i]), k_exact_leaves) * leaf;
    value_mm_[i] = static_cast<float>(turns[i] > 0 ? -d : d);
  }
}

double MeshBody::distance_mm(Vec3 p) const noexcept {
  const IVec3 n = lattice_.size;
  if (n.x == 0) return k_exact_leaves * lattice_.leaf_mm;
  const Vec3 q = (p - lattice_.origin_mm) / lattice_.leaf_mm - Vec3{0.5, 0.5, 0.5};
  const Vec3 c{std::clamp(q.x, 0.0, n.x - 1.0), std::clamp(q.y, 0.0, n.y - 1.0),
               std::clamp(q.z, 0.0, n.z - 1.0)};
  const IVec3 i{static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z)};
  const double fx = c.x - i.x, fy = c.y - i.y, fz = c.z - i.z;
  double sum = 0;
  for (int k = 0; k < 8; ++k) {
    const IVec3 leaf{std::min(i.x + (k & 1), n.x - 1), std::min(i.y + (k >> 1 & 1), n.y - 1),
                     std::min(i.z + (k >> 2), n.z - 1)};
    const double share = ((k & 1) != 0 ? fx : 1 - fx) * ((k >> 1 & 1) != 0 ? fy : 1 - fy) *
                         ((k >> 2) != 0 ? fz : 1 - fz);
    if (share > 0) sum += share * static_cast<double>(value_mm_[lattice_.index(leaf)]);
  }
  return sum + length(q - c) * lattice_.leaf_mm;
}

std::unique_ptr<Shape> body_stl(const ShapeSpec& spec, ShapeMaker& maker, const Message& where) {
  if (spec.surface == nullptr)
    throw Error(where, msg("the surface '{}' was not read", spec.file), msg("read it first"));
  count_mesh_body(maker.tooth(), *spec.surface, maker.work());
  return std::make_unique<MeshBody>(maker.tooth(), *spec.surface);
}

}  // namespace cavum::scenarios
