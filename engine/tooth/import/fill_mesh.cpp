#include "engine/tooth/import/fill_mesh.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>

#include "engine/tooth/mesh/read_mesh.h"

namespace cavum {
namespace {

std::vector<float> fill_without_cavities(const TriangleMesh& mesh_mm, const TissueGrid& lattice) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  points.reserve(mesh_mm.vertices_mm.size());
  const Vec3 first = lattice.centre_mm({0, 0, 0});
  for (const Vec3 v : mesh_mm.vertices_mm) {
    const Vec3 p = (v - first) /
                   lattice.leaf_mm;  // one voxel of OpenVDB = one leaf, so distances come in leaves
    points.emplace_back(p.x, p.y, p.z);
  }
  triangles.reserve(mesh_mm.triangles.size());
  for (const auto& t : mesh_mm.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
  const auto grid =
      openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(*unit, points, triangles, k_fill_band);
  std::vector<float> out(lattice.count());
  const openvdb::CoordBBox box({0, 0, 0},
                               {lattice.size.x - 1, lattice.size.y - 1, lattice.size.z - 1});
  openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, out.data());
  openvdb::tools::copyToDense(*grid, dense);
  return out;
}

void append(TriangleMesh& to, const TriangleMesh& part, bool turn) {
  const auto shift = static_cast<std::uint32_t>(to.vertices_mm.size());
  to.vertices_mm.insert(to.vertices_mm.end(), part.vertices_mm.begin(), part.vertices_mm.end());
  for (const auto& t : part.triangles)
    to.triangles.push_back({t[0] + shift, t[turn ? 2 : 1] + shift, t[turn ? 1 : 2] + shift});
}

}  // namespace

std::vector<float> fill_mesh(const TriangleMesh& mesh_mm, const TissueGrid& lattice) {
  openvdb::initialize();
  TriangleMesh bodies, cavities;
  for (const auto& part : connected_parts(mesh_mm)) {
    const bool cavity = signed_volume_mm3(part) < 0;
    append(cavity ? cavities : bodies, part, cavity);
  }
  auto field = fill_without_cavities(bodies, lattice);
  if (!cavities.triangles.empty()) {
    const auto holes = fill_without_cavities(cavities, lattice);
    for (std::size_t i = 0; i < field.size(); ++i) field[i] = std::max(field[i], -holes[i]);
  }
  return field;
}

}  // namespace cavum
