#include "engine/tooth/surface_mesh.h"

#include <fmt/core.h>

#include <cmath>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/tooth/marching.h"
#include "engine/tooth/octree_edit.h"

namespace cavum {
namespace {

/// Leaves of the tooth with one layer of air around them, cut to the box that holds the body.
struct Body {
  TissueGrid grid;
  std::vector<std::uint8_t> inside;
};

Body body_of(const Octree& octree, const std::array<bool, 256>& wanted) {
  LeafBounds box = octree.bounds([&](std::uint8_t t) { return wanted[t]; });
  Body body;
  if (box.empty()) return body;
  box.low = box.low - IVec3{2, 2, 2};
  body.grid.allocate(box.high - box.low + IVec3{2, 2, 2}, octree.leaf_mm(),
                     octree.origin_mm() + to_vec3(box.low) * octree.leaf_mm());
  body.inside.resize(body.grid.count());
  for (std::int32_t z = 0; z < body.grid.size.z; ++z)
    for (std::int32_t y = 0; y < body.grid.size.y; ++y)
      for (std::int32_t x = 0; x < body.grid.size.x; ++x) {
        const auto i = body.grid.index({x, y, z});
        const IVec3 leaf = box.low + IVec3{x, y, z};
        body.grid.tissue[i] = octree.tissue(leaf);
        body.grid.distance[i] = static_cast<std::int8_t>(octree.distance_code(leaf));
        body.inside[i] = wanted[body.grid.tissue[i]];
      }
  return body;
}

/// Share of the 27 leaves around `at` that are in the body.
double smoothed(const Body& body, IVec3 at) {
  int n = 0;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const IVec3 l = at + IVec3{dx, dy, dz};
        n += body.grid.inside(l) && body.inside[body.grid.index(l)];
      }
  return n / 27.0;
}

void put_vec(ByteWriter& out, Vec3 v) {
  for (const double d : {v.x, v.y, v.z}) out.put(static_cast<float>(d));
}

Vec3 corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t i) {
  return mesh.vertices_mm[mesh.triangles[triangle][i]];
}

}  // namespace

double signed_volume_mm3(const TriangleMesh& mesh) {
  double six = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six += dot(corner(mesh, t, 0), cross(corner(mesh, t, 1), corner(mesh, t, 2)));
  return six / 6.0;
}

namespace {

/// The surface around all wanted tissues together; `named` is what they are called.
TriangleMesh surface_around(const Tooth& tooth, const std::array<bool, 256>& wanted,
                            const std::string& named) {
  const Body body = body_of(tooth.octree, wanted);
  if (body.inside.empty())
    throw Error(msg("tooth '{}'", tooth.name), msg("holds no {}", named),
                msg("choose a tissue that `cavum tooth info` shows a volume for"));
  const auto fraction = [&](IVec3 a, IVec3 b) {
    const auto ia = body.grid.index(a), ib = body.grid.index(b);
    const double da = body.grid.distance[ia], db = body.grid.distance[ib];
    if ((da < 0) != (db < 0)) return da / (da - db);  // the solid surface runs between them
    const double sa = smoothed(body, a) - 0.5, sb = smoothed(body, b) - 0.5;
    return sa > 0 && sb < 0 ? std::clamp(sa / (sa - sb), 0.05, 0.95) : 0.5;
  };
  return march_tetrahedra(body.grid.size, body.grid.centre_mm({0, 0, 0}), body.grid.leaf_mm,
                          body.inside, fraction);
}

}  // namespace

TriangleMesh surface_mesh(const Tooth& tooth, const std::string& tissue) {
  std::array<bool, 256> wanted{};
  if (tissue == "solid") {
    for (const auto& t : tooth.tissues) wanted[t.id] = t.solid;
  } else {
    wanted[tooth.tissue_id(tissue)] = true;
  }
  return surface_around(tooth, wanted, tissue);
}

bool lies_around(const Octree& tooth, std::uint8_t tissue) {
  constexpr double k_of_its_wall = 0.45;  // a sheath's outer side
  constexpr IVec3 k_six[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::uint64_t air = 0, hard = 0;
  tooth.for_each_cube([&](IVec3 at, int edge, std::uint8_t label) {
    if (label != tissue) return;
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x) {
          if (x > 0 && y > 0 && z > 0 && x < edge - 1 && y < edge - 1 && z < edge - 1) continue;
          for (const IVec3 step : k_six) {
            const std::uint8_t beside = tooth.tissue(at + IVec3{x, y, z} + step);
            air += beside == k_air ? 1 : 0;
            hard += tooth.is_solid(beside) ? 1 : 0;
          }
        }
  });
  return air > 0 && static_cast<double>(air) >= k_of_its_wall * static_cast<double>(air + hard);
}

std::array<bool, 256> tissues_around_tooth(const Tooth& tooth) {
  std::array<bool, 256> around{};
  for (const auto& t : tooth.tissues) around[t.id] = !t.solid && lies_around(tooth.octree, t.id);
  return around;
}

TriangleMesh outer_surface(const Tooth& tooth, const std::array<bool, 256>& around) {
  std::array<bool, 256> wanted{};
  for (const auto& t : tooth.tissues) wanted[t.id] = !around[t.id];
  return surface_around(tooth, wanted, "tissue");
}

Bytes to_stl(const TriangleMesh& mesh) {
  ByteWriter out;
  std::string title = "Cavum surface, mm";  // must not begin with "solid"
  title.resize(80, ' ');
  for (const char c : title) out.put(c);
  out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = corner(mesh, t, 0), b = corner(mesh, t, 1), c = corner(mesh, t, 2);
    put_vec(out, normalized(cross((b - a) * 1e3,
                                  (c - a) * 1e3)));  // scaled: a sliver's area is tiny in mm2
    for (const Vec3 v : {a, b, c}) put_vec(out, v);
    out.put(std::uint16_t{0});
  }
  return out.take();
}

Bytes to_ply(const TriangleMesh& mesh) {
  ByteWriter out;
  const std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Cavum surface, mm\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices_mm.size(), mesh.triangles.size());
  for (const char c : header) out.put(c);
  for (const Vec3 v : mesh.vertices_mm) put_vec(out, v);
  for (const auto& t : mesh.triangles) {
    out.put(std::uint8_t{3});
    for (const auto v : t) out.put(static_cast<std::int32_t>(v));
  }
  return out.take();
}

void write_mesh_file(const TriangleMesh& mesh, const std::string& path) {
  std::string extension = path.substr(std::min(path.size(), path.find_last_of('.')));
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (extension != ".stl" && extension != ".ply")
    throw Error(path, msg("the mesh format is not known by this name"),
                msg("end the name in .stl or .ply"));
  write_file(path, extension == ".stl" ? to_stl(mesh) : to_ply(mesh));
}

}  // namespace cavum
