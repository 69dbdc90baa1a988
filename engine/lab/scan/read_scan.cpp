#include "engine/lab/scan/read_scan.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/mesh/read_mesh.h"

namespace cavum {
namespace {

constexpr double k_scan_point_mm = 0.12;

double area_of(const TriangleMesh& mesh) {
  double twice = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices_mm[t[0]];
    twice += length(cross(mesh.vertices_mm[t[1]] - a, mesh.vertices_mm[t[2]] - a));
  }
  return 0.5 * twice;
}

/// The largest connected part.
TriangleMesh main_part(const TriangleMesh& mesh, const std::string& path, Scan& scan) {
  constexpr double k_max_beside = 0.1;
  std::vector<TriangleMesh> parts = connected_parts(mesh);
  if (parts.size() == 1) return std::move(parts.front());
  std::size_t largest = 0;
  double all = 0, most = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double area = area_of(parts[i]);
    all += area;
    if (area > most) most = area, largest = i;
  }
  if (all - most > k_max_beside * all)
    throw Error(path,
                msg("is in {} parts, and the largest has {} of the surface only", parts.size(),
                    as_percent(100 * most / all, 0)),
                msg("give a mesh of the one tooth, whose triangles share their corners"));
  scan.parts_left_out = parts.size() - 1;
  scan.left_out_percent = 100 * (all - most) / all;
  return std::move(parts[largest]);
}

void require_few_holes(const std::vector<Rim>& rims, const std::string& path) {
  constexpr double k_largest_mm = 5.0, k_all_mm = 20.0;
  double all = 0;
  for (std::size_t i = 1; i < rims.size(); ++i) all += rims[i].length_mm;
  if (all > k_all_mm || (rims.size() > 1 && rims[1].length_mm > k_largest_mm))
    throw Error(
        path,
        msg("is open in {} places beside its end: holes of {} around in all, the largest of {}",
            rims.size() - 1, as_mm(all, 1), as_mm(rims[1].length_mm, 1)),
        msg("close the holes in the scanner's program, and export one surface whose triangles share their corners"));
}

}  // namespace

Scan read_scan(const std::string& path, double unit_mm) {
  constexpr std::size_t k_fewest = 2000;
  TriangleMesh mesh = read_open_mesh(path);
  for (Vec3& v : mesh.vertices_mm) v = v * unit_mm;
  if (mesh.triangles.size() < k_fewest)
    throw Error(path,
                msg("has {} triangles, which is too few to measure a cavity by: {} is the least",
                    mesh.triangles.size(), k_fewest),
                msg("export the scan as fine as it is"));
  Scan scan;
  scan.mesh = main_part(mesh, path, scan);
  std::vector<Rim> rims = rims_of(scan.mesh);
  require_few_holes(rims, path);
  scan.caps = caps_over(scan.mesh, rims);
  if (signed_volume_mm3(scan.mesh) + signed_volume_mm3(scan.caps) < 0) {
    for (auto* m : {&scan.mesh, &scan.caps})
      for (auto& t : m->triangles) std::swap(t[1], t[2]);
    scan.faces_turned = true;
  }
  scan.end_mm = rims.empty() ? 0.0 : rims.front().length_mm;
  scan.holes = rims.empty() ? 0 : static_cast<int>(rims.size()) - 1;
  scan.points = surface_points(scan.mesh, k_scan_point_mm, path);
  return scan;
}

Scan mirrored(Scan scan) {
  for (TriangleMesh* mesh : {&scan.mesh, &scan.caps}) {
    for (Vec3& v : mesh->vertices_mm) v.y = -v.y;
    for (auto& t : mesh->triangles) std::swap(t[1], t[2]);
  }
  for (SurfacePoint& p : scan.points) {
    p.at_mm.y = -p.at_mm.y;
    p.normal.y = -p.normal.y;
  }
  return scan;
}

}  // namespace cavum
