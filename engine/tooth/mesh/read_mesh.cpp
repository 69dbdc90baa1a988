#include "engine/tooth/mesh/read_mesh.h"

#include <fmt/core.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "engine/tooth/mesh/polygon_files.h"

namespace cavum {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Surface = OpenMesh::TriMesh_ArrayKernelT<Traits>;

std::string place(Vec3 p) {
  std::ostringstream s;
  s.precision(5);
  s << '(' << p.x << ", " << p.y << ", " << p.z << ')';
  return s.str();
}

Vec3 point(const Surface& surface, Surface::VertexHandle v) {
  const auto& p = surface.point(v);
  return {p[0], p[1], p[2]};
}

constexpr std::size_t k_stl_head = 84, k_stl_facet = 50;

/// Facets that a binary STL says it holds.
std::size_t stl_facets(const Bytes& file) {
  std::uint32_t facets = 0;
  if (file.size() >= k_stl_head) std::memcpy(&facets, file.data() + k_stl_head - 4, 4);
  return facets;
}
bool is_binary_stl(const Bytes& file) {
  return file.size() >= k_stl_head && file.size() == k_stl_head + k_stl_facet * stl_facets(file);
}

/// A binary STL of another length than its count of triangles asks for, and a text one that ends
/// within a facet.
void require_whole_stl(const Bytes& file, const std::string& name) {
  if (file.empty() || is_binary_stl(file)) return;
  const auto printable = [](unsigned char c) {
    return c >= 32 || c == '\n' || c == '\r' || c == '\t' || c == '\f' || c == '\v';
  };
  if (std::all_of(file.begin(), file.end(), printable)) {
    std::istringstream text(std::string(file.begin(), file.end()));
    std::size_t begun = 0, ended = 0;
    bool solid = false, whole = false;
    for (std::string word; text >> word;) {
      begun += word == "facet" ? 1 : 0;
      ended += word == "endfacet" ? 1 : 0;
      solid = solid || word == "solid";
      whole = whole || word == "endsolid";
    }
    if (begun != ended)
      throw Error(FileError::truncated, Name{name},
                  msg("is cut off: it begins {} facets and ends {}", begun, ended),
                  msg("copy or export the whole file again"));
    if (begun > 0 && solid && !whole)
      throw Error(FileError::truncated, Name{name}, msg("is cut off: its 'endsolid' is missing"),
                  msg("copy or export the whole file again"));
    return;
  }
  if (file.size() < k_stl_head)
    throw Error(
        FileError::truncated, Name{name},
        msg("is cut off: it has {} bytes, and the head of a binary STL alone has 84", file.size()),
        msg("copy or export the whole file again"));
  const std::size_t held = (file.size() - k_stl_head) / k_stl_facet, stated = stl_facets(file);
  throw Error(
      FileError::inconsistent, Name{name},
      held < stated
          ? msg("is cut off: it says that it holds {} triangles, and its length is that of {}",
                stated, held)
          : msg("says that it holds {} triangles, and its length is that of {}: the count is wrong",
                stated, held),
      msg("copy or export the whole file again, as STL"));
}

/// OpenMesh walks around a corner for each triangle that it joins there: at one that 190,000 share
/// it would walk for minutes.
constexpr std::size_t k_max_at_corner = 2000;

[[noreturn]] void fail_crowded(const std::string& name) {
  throw Error(FileError::too_large, Name{name},
              msg("more than {} triangles meet at one corner", k_max_at_corner),
              msg("remesh the surface in a mesh editor"));
}

using Corner = std::array<float, 3>;
/// `corners` of all triangles, in any order.
void require_few_at_each(std::vector<Corner> corners, const std::string& name) {
  std::sort(corners.begin(), corners.end());
  for (std::size_t i = k_max_at_corner; i < corners.size(); ++i)
    if (corners[i] == corners[i - k_max_at_corner]) fail_crowded(name);
}

/// The same of polygons, which become fans about their first corners.
void require_few_at_each(const Polygons& polygons, const std::string& name) {
  std::vector<std::size_t> at(polygons.corners_mm.size());
  for (const auto& polygon : polygons.polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i)
      if ((at[polygon[i]] += i == 0 ? polygon.size() - 2 : 1) > k_max_at_corner) fail_crowded(name);
}

/// The corners of an STL's facets, three each, in their order. Throws Error when the file is cut
/// off, a corner is no number, or too many meet in one: OpenMesh joins the equal corners of an STL
/// while it reads; one that is no number is equal to any other, vanishes in that, and leaves a
/// hole.
std::vector<Corner> stl_corners(const Bytes& file, const std::string& name) {
  require_whole_stl(file, name);
  const auto fail = [&](const Message& where) {
    throw Error(FileError::malformed, Name{name}, msg("{} has a corner that is no number", where),
                msg("export the mesh again, in mm"));
  };
  constexpr std::size_t k_normal = 12;
  std::vector<Corner> corners;
  if (is_binary_stl(file)) {
    for (std::size_t f = 0; f < stl_facets(file); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        Corner c{};
        std::memcpy(c.data(), file.data() + k_stl_head + f * k_stl_facet + k_normal + i * sizeof c,
                    sizeof c);
        for (float& value : c) {
          if (!std::isfinite(value)) fail(msg("facet {}", f + 1));
          value += 0.0F;  // no zero below zero
        }
        corners.push_back(c);
      }
    require_few_at_each(corners, name);
    return corners;
  }
  std::istringstream text(std::string(file.begin(), file.end()));
  std::size_t number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    std::istringstream words(line);
    std::string word;
    for (bool first = true; words >> word; first = false) {
      if (first && (word == "solid" || word == "endsolid")) break;  // its name may be anything
      if (word != "vertex") continue;
      Corner c{};
      for (float& value : c) {
        words >> word;
        char* end = nullptr;
        value = static_cast<float>(std::clamp(std::strtod(word.c_str(), &end), -1e30, 1e30)) + 0.0F;
        if (!words || !std::isfinite(std::strtod(word.c_str(), nullptr)) || *end != '\0')
          fail(msg("line {}", number));
      }
      corners.push_back(c);
    }
  }
  require_few_at_each(corners, name);
  return corners;
}

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

/// OpenMesh reports on the console; our errors say the same with the file's name.
void quieten_openmesh() {
  omout().disable();
  omlog().disable();
  omerr().disable();
}

/// The bytes of an STL as OpenMesh joins them, once they are known to be sound.
Surface surface_of_stl(const Bytes& file, const std::string& name) {
  static_cast<void>(stl_corners(file, name));
  quieten_openmesh();
  std::istringstream bytes(std::string(file.begin(), file.end()));
  OpenMesh::IO::Options options =
      is_binary_stl(file) ? OpenMesh::IO::Options::Binary : OpenMesh::IO::Options::Default;
  Surface surface;
  if (!OpenMesh::IO::read_mesh(surface, bytes, ".stl", options) || surface.n_faces() == 0)
    throw Error(FileError::malformed, Name{name}, msg("holds no triangle of an STL surface"),
                msg("export the surface again as STL, text or binary"));
  return surface;
}

/// Polygons as triangles. One that does not fit among its neighbours gets corners of its own, and
/// so shows as open.
Surface surface_of(const Polygons& polygons, const std::string& name) {
  require_few_at_each(polygons, name);
  quieten_openmesh();
  Surface surface;
  for (const Vec3& p : polygons.corners_mm) surface.add_vertex({p.x, p.y, p.z});
  for (const auto& polygon : polygons.polygons) {
    std::vector<Surface::VertexHandle> corners;
    for (const auto i : polygon) corners.emplace_back(static_cast<int>(i));
    std::vector<std::uint32_t> once = polygon;
    std::sort(once.begin(), once.end());
    if (std::adjacent_find(once.begin(), once.end()) != once.end())
      continue;  // a corner twice: it encloses nothing
    if (surface.add_face(corners).is_valid()) continue;
    for (auto& c : corners) c = surface.add_vertex(Surface::Point(surface.point(c)));
    surface.add_face(corners);
  }
  return surface;
}

Surface load(const std::string& path) {
  require_mesh_file(path);
  const std::string extension = extension_of(path);
  const Bytes file = read_file(path);
  Surface surface;
  if (extension == ".stl")
    surface = surface_of_stl(file, path);
  else if (extension == ".ply")
    surface = surface_of(read_ply(file, path), path);
  else if (extension == ".obj")
    surface = surface_of(read_obj(file, path), path);
  else if (extension == ".off")
    surface = surface_of(read_off(file, path), path);
  if (surface.n_faces() == 0)
    throw Error(FileError::malformed, Name{path}, msg("cannot be read as a triangle mesh"),
                msg("give an intact STL, PLY, OBJ or OFF file"));
  return surface;
}

constexpr double k_farthest_place = 1e6;
[[noreturn]] void fail_place(const std::string& path, std::size_t number, Vec3 p) {
  throw Error(FileError::malformed, Name{path},
              msg("vertex {} is not a place: {}", number, place(p)),
              msg("export the mesh again, in mm"));
}

/// Facets whose equal corners are one; those that have a corner twice are left out.
TriangleMesh joined(const std::vector<Corner>& corners) {
  std::vector<Corner> each = corners;
  std::sort(each.begin(), each.end());
  each.erase(std::unique(each.begin(), each.end()), each.end());
  TriangleMesh mesh;
  mesh.vertices_mm.reserve(each.size());
  for (const Corner& c : each) mesh.vertices_mm.push_back({c[0], c[1], c[2]});
  const auto number = [&](const Corner& c) {
    return static_cast<std::uint32_t>(std::lower_bound(each.begin(), each.end(), c) - each.begin());
  };
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{number(corners[i]), number(corners[i + 1]),
                                         number(corners[i + 2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  return mesh;
}

/// Polygons as fans about their first corners.
TriangleMesh fans_of(const Polygons& polygons) {
  TriangleMesh mesh;
  mesh.vertices_mm = polygons.corners_mm;
  for (const auto& polygon : polygons.polygons)
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const std::array<std::uint32_t, 3> t{polygon[0], polygon[i], polygon[i + 1]};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
    }
  return mesh;
}

TriangleMesh without_unused(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> renumbered(mesh.vertices_mm.size(), ~0u);
  TriangleMesh out;
  for (auto t : mesh.triangles) {
    for (auto& corner : t) {
      if (renumbered[corner] == ~0u) {
        renumbered[corner] = static_cast<std::uint32_t>(out.vertices_mm.size());
        out.vertices_mm.push_back(mesh.vertices_mm[corner]);
      }
      corner = renumbered[corner];
    }
    out.triangles.push_back(t);
  }
  return out;
}

/// Its triangles, without the corners that none has.
TriangleMesh triangles_of(const Surface& surface) {
  TriangleMesh mesh;
  std::vector<std::uint32_t> renumbered(surface.n_vertices(), ~0u);
  for (const auto v : surface.vertices()) {
    if (surface.is_isolated(v)) continue;
    renumbered[static_cast<std::size_t>(v.idx())] =
        static_cast<std::uint32_t>(mesh.vertices_mm.size());
    mesh.vertices_mm.push_back(point(surface, v));
  }
  for (const auto f : surface.faces()) {
    std::array<std::uint32_t, 3> t{};
    std::size_t i = 0;
    for (const auto v : surface.fv_range(f)) t[i++] = renumbered[static_cast<std::size_t>(v.idx())];
    mesh.triangles.push_back(t);
  }
  return mesh;
}

/// The surface checked, and its faces turned outwards. `path` names it in errors.
ReadMesh closed(const Surface& surface, const std::string& path);

}  // namespace

void require_mesh_file(const std::string& path) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none))
    throw Error(FileError::not_a_file, Name{path}, msg("is a folder, not a mesh"),
                msg("name an STL, PLY, OBJ or OFF file"));
  if (!std::filesystem::is_regular_file(path, none))
    throw Error(FileError::missing, Name{path}, msg("no such mesh file"), msg("check the path"));
}

std::vector<TriangleMesh> connected_parts(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices_mm.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh.triangles)
    for (const std::size_t i : {1u, 2u})
      parent[std::max(root(t[0]), root(t[i]))] = std::min(root(t[0]), root(t[i]));
  std::vector<std::uint32_t> part_of(parent.size(), ~0u), place_of(parent.size(), ~0u);
  std::vector<TriangleMesh> parts;
  for (const auto& t : mesh.triangles) {
    auto& part = part_of[root(t[0])];
    if (part == ~0u) {
      part = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    TriangleMesh& to = parts[part];
    std::array<std::uint32_t, 3> copy{};
    for (std::size_t i = 0; i < 3; ++i) {
      if (place_of[t[i]] == ~0u) {
        place_of[t[i]] = static_cast<std::uint32_t>(to.vertices_mm.size());
        to.vertices_mm.push_back(mesh.vertices_mm[t[i]]);
      }
      copy[i] = place_of[t[i]];
    }
    to.triangles.push_back(copy);
  }
  return parts;
}

ReadMesh read_closed_mesh(const std::string& path) { return closed(load(path), path); }

TriangleMesh read_open_mesh(const std::string& path) {
  require_mesh_file(path);
  const std::string extension = extension_of(path);
  const Bytes file = read_file(path);
  TriangleMesh mesh;
  if (extension == ".stl")
    mesh = joined(stl_corners(file, path));
  else if (extension == ".ply")
    mesh = fans_of(read_ply(file, path));
  else if (extension == ".obj")
    mesh = fans_of(read_obj(file, path));
  else if (extension == ".off")
    mesh = fans_of(read_off(file, path));
  if (mesh.triangles.empty())
    throw Error(FileError::malformed, Name{path}, msg("cannot be read as a triangle mesh"),
                msg("give an intact STL, PLY, OBJ or OFF file"));
  if (mesh.triangles.size() > k_max_scan_triangles)
    throw Error(
        FileError::too_large, Name{path},
        msg("has {} triangles, {} is the most", mesh.triangles.size(), k_max_scan_triangles),
        msg("reduce the mesh, or cut out the one tooth"));
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i)
    if (const Vec3 p = mesh.vertices_mm[i]; !is_finite(p) || length(p) > k_farthest_place)
      fail_place(path, i, p);
  return without_unused(mesh);
}

ReadMesh read_closed_stl(const Bytes& file, const std::string& name) {
  return closed(surface_of_stl(file, name), name);
}

namespace {

ReadMesh closed(const Surface& surface, const std::string& path) {
  for (const auto v : surface.vertices())  // first: a vertex that is no place cannot be joined to
                                           // its neighbours, and would pass for a hole
    if (const Vec3 p = point(surface, v);
        !surface.is_isolated(v) && (!is_finite(p) || length(p) > k_farthest_place))
      fail_place(path, static_cast<std::size_t>(v.idx()), p);
  std::size_t open_edges = 0;
  Vec3 open_at;
  for (const auto e : surface.edges()) {
    if (!surface.is_boundary(e)) continue;
    const auto h = surface.halfedge_handle(e, 0);
    if (open_edges++ == 0)
      open_at = (point(surface, surface.from_vertex_handle(h)) +
                 point(surface, surface.to_vertex_handle(h))) *
                0.5;
  }
  if (open_edges > 0)
    throw Error(FileError::inconsistent, Name{path},
                msg("the surface is not closed: {} open or non-manifold edges, one at {}",
                    open_edges, place(open_at)),
                msg("close the holes in a mesh editor and export again"));

  ReadMesh out;
  out.mesh = triangles_of(surface);
  const auto pinched = std::count_if(
      surface.vertices_begin(), surface.vertices_end(),
      [&](const auto v) { return !surface.is_isolated(v) && !surface.is_manifold(v); });
  const auto isolated = surface.n_vertices() - out.mesh.vertices_mm.size();
  out.unused_vertices = isolated;
  if (pinched > 0)
    throw Error(FileError::inconsistent, Name{path}, msg("{} non-manifold vertices", pinched),
                msg("repair the mesh in a mesh editor and export again"));
  out.volume_mm3 = signed_volume_mm3(out.mesh);
  if (!(std::fabs(out.volume_mm3) > 1e-12))
    throw Error(FileError::inconsistent, Name{path}, msg("the surface encloses no volume"),
                msg("check the file"));
  if (out.volume_mm3 < 0) {
    for (auto& t : out.mesh.triangles) std::swap(t[1], t[2]);
    out.volume_mm3 = -out.volume_mm3;
    out.turned = true;
  }
  Vec3 moment;
  for (const auto& t : out.mesh.triangles) {
    const Vec3 a = out.mesh.vertices_mm[t[0]], b = out.mesh.vertices_mm[t[1]],
               c = out.mesh.vertices_mm[t[2]];
    moment += (a + b + c) * (dot(a, cross(b, c)) / 24);
  }
  out.centroid_mm = moment / out.volume_mm3;
  return out;
}

}  // namespace

}  // namespace cavum
