#include "engine/tooth/import/import_meshes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "engine/base/error.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/import/fill_mesh.h"
#include "engine/tooth/import/hollows.h"
#include "engine/tooth/import/import_error.h"
#include "engine/tooth/import/layers_fit.h"
#include "engine/tooth/make/periodontium.h"
#include "engine/tooth/mesh/read_mesh.h"

namespace cavum {
namespace {

constexpr float k_widest_gap_leaves = 2.0f;

TissueGrid lattice_around(const Bounds& box, double leaf_mm, const std::string& where) {
  if (!(leaf_mm > 0 && std::isfinite(leaf_mm)))
    throw Error(ImportError::bad_option, Name{"--leaf-mm"},
                msg("the leaf must be larger than 0 mm"), msg("give 0.05, for example"));
  const auto low = [&](double v) {
    return static_cast<std::int32_t>(std::clamp(std::floor(v / leaf_mm), -1e8, 1e8)) - 4;
  };
  const auto high = [&](double v) {
    return static_cast<std::int32_t>(std::clamp(std::ceil(v / leaf_mm), -1e8, 1e8)) + 4;
  };
  const IVec3 first{low(box.low.x), low(box.low.y), low(box.low.z)};
  const IVec3 size = IVec3{high(box.high.x), high(box.high.y), high(box.high.z)} - first;
  check_lattice(size, leaf_mm, where);
  TissueGrid grid;
  grid.allocate(size, leaf_mm, to_vec3(first) * leaf_mm);
  return grid;
}

Vec3 direction(const TissueGrid& grid, const std::vector<float>& field, IVec3 l) {
  const auto at = [&](IVec3 i) { return static_cast<double>(field[grid.index(i)]); };
  return normalized({at(l + IVec3{1, 0, 0}) - at(l - IVec3{1, 0, 0}),
                     at(l + IVec3{0, 1, 0}) - at(l - IVec3{0, 1, 0}),
                     at(l + IVec3{0, 0, 1}) - at(l - IVec3{0, 0, 1})},
                    {0, 0, 0});
}

/// Marks the air leaves that are joined to the grid's border.
std::vector<std::uint8_t> outside_air(const TissueGrid& grid) {
  std::vector<std::uint8_t> reached(grid.count(), 0);
  std::vector<std::size_t> front{0};  // a corner of the margin
  reached[0] = 1;
  const std::size_t nx = static_cast<std::size_t>(grid.size.x),
                    nxy = nx * static_cast<std::size_t>(grid.size.y);
  while (!front.empty()) {
    const std::size_t i = front.back();
    front.pop_back();
    const std::size_t x = i % nx, y = i / nx % static_cast<std::size_t>(grid.size.y), z = i / nxy;
    const auto visit = [&](bool exists, std::size_t j) {
      if (!exists || reached[j] || grid.tissue[j] != k_air) return;
      reached[j] = 1;
      front.push_back(j);
    };
    visit(x > 0, i - 1);
    visit(x + 1 < nx, i + 1);
    visit(y > 0, i - nx);
    visit(y + 1 < static_cast<std::size_t>(grid.size.y), i + nx);
    visit(z > 0, i - nxy);
    visit(z + 1 < static_cast<std::size_t>(grid.size.z), i + nxy);
  }
  return reached;
}

struct Layers {
  std::vector<float> enamel, dentin, pulp;
  std::vector<std::uint8_t> chamber;  // left empty by the dentin's surface
};

/// Rule 1 of the header.
Overlaps label_by_precedence(TissueGrid& grid, const Layers& f) {
  Overlaps overlaps;
  std::uint64_t enamel = 0, pulp = 0, chamber = 0, enamel_in_dentin = 0, pulp_in_dentin = 0;
  for (std::size_t i = 0; i < grid.tissue.size(); ++i) {
    const bool e = f.enamel[i] < 0, d = f.dentin[i] < 0, p = f.pulp[i] < 0,
               in_dentin = d && f.chamber[i] == 0;
    overlaps.leaves += e + in_dentin + p > 1;
    const std::uint8_t t = p ? k_pulp : e ? k_enamel : d ? k_dentin : k_air;
    grid.tissue[i] = t;
    chamber += f.chamber[i];
    enamel += t == k_enamel;
    enamel_in_dentin += t == k_enamel && in_dentin;
    pulp += p;
    pulp_in_dentin += p && in_dentin;
  }
  const auto share = [](std::uint64_t part, std::uint64_t of) {
    return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : 0.0;
  };
  overlaps.of_the_enamel = share(enamel_in_dentin, enamel);
  overlaps.of_the_pulp = share(pulp_in_dentin, pulp);
  overlaps.chamber = share(chamber, pulp);
  return overlaps;
}

/// Rule 2 of the header.
std::uint64_t close_gaps(TissueGrid& grid, const Layers& f) {
  std::vector<std::size_t> gaps;
  for (std::int32_t z = 1; z + 1 < grid.size.z; ++z)
    for (std::int32_t y = 1; y + 1 < grid.size.y; ++y)
      for (std::int32_t x = 1; x + 1 < grid.size.x; ++x) {
        const IVec3 l{x, y, z};
        const auto i = grid.index(l);
        if (grid.tissue[i] != k_air) continue;
        const auto facing = [&](const std::vector<float>& a, const std::vector<float>& b) {
          return a[i] + b[i] <= k_widest_gap_leaves &&
                 dot(direction(grid, a, l), direction(grid, b, l)) < -0.5;
        };
        if (facing(f.enamel, f.dentin) || facing(f.dentin, f.pulp) || facing(f.enamel, f.pulp))
          gaps.push_back(i);
      }
  const auto give = [&](std::size_t i) {
    grid.tissue[i] = f.enamel[i] < f.dentin[i] ? k_enamel : k_dentin;
  };
  for (const auto i : gaps) give(i);
  std::uint64_t closed = gaps.size();
  const auto reached = outside_air(grid);
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (grid.tissue[i] == k_air && !reached[i]) {
      give(i);
      ++closed;
    }
  return closed;
}

/// Whether the three files are what they are said to be, by the rule of layers_fit.h.
void check_layers(const TissueGrid& grid, const MeshPaths& paths) {
  const auto touched = pulp_faces(grid.size, grid.tissue);
  const auto all = touched[k_air] + touched[k_enamel] + touched[k_dentin];
  if (all == 0)
    throw Error(ImportError::no_tissue, Name{paths.pulp}, msg("the pulp is smaller than a leaf"),
                msg("check the unit (mm), or use a smaller --leaf-mm"));
  require_layer_order(touched, fmt::format("{}, {}", paths.enamel, paths.dentin),
                      msg("exchange --enamel and --dentin"));
  if (touched[k_air] * 5 > all)
    throw Error(ImportError::layers_apart, Name{paths.pulp},
                msg("the pulp is not enclosed by the dentin: {} % of its surface is bare",
                    100 * touched[k_air] / all),
                msg("check which file is enamel, dentin and pulp, and that all share one frame"));
}

/// From the file's unit and frame into the tooth's axes.
void turn_into(TriangleMesh& mesh, const Mat3& axes, bool mirror) {
  for (auto& v : mesh.vertices_mm) v = axes * v;
  if (mirror)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

void scale(ReadMesh& read, double mm) {
  if (mm == 1.0) return;
  for (auto& v : read.mesh.vertices_mm) v = v * mm;
  read.centroid_mm = read.centroid_mm * mm;
  read.volume_mm3 *= mm * mm * mm;
}

struct ThreeMeshes {
  ReadMesh enamel, dentin, pulp;
};

/// What each leaf is, and that the three files can be of one tooth.
void label_leaves(const ThreeMeshes& m, const MeshPaths& paths, const SenseOptions& sense,
                  TissueGrid& grid, MeshImport& out) {
  check_triangle_work(grid, m.enamel.mesh, paths.enamel);
  check_triangle_work(grid, m.dentin.mesh, paths.dentin);
  check_triangle_work(grid, m.pulp.mesh, paths.pulp);
  Layers fields{fill_mesh(m.enamel.mesh, grid),
                fill_mesh(m.dentin.mesh, grid),
                fill_mesh(m.pulp.mesh, grid),
                {}};
  fields.chamber = hollows(m.dentin.mesh, fields.dentin, grid);
  const Overlaps overlaps = label_by_precedence(grid, fields);
  out.overlap_leaves = overlaps.leaves;
  check_layers(grid, paths);
  const LayersApart apart = layers_apart(grid);
  require_layers_that_fit(apart, overlaps, fmt::format("{}, {}", paths.enamel, paths.dentin));
  tell_loose_layers(apart, overlaps, out.sense);
  out.gap_leaves = close_gaps(grid, fields);
  check_closed_pulp(open_pulp(grid), sense, paths.pulp, out.sense);
  require_pulp_in_root(pulp_below_dentin_mm(grid), paths.pulp);
  const EnamelPieces pieces = enamel_pieces(grid);
  require_no_floating_enamel(pieces, paths.enamel);
  tell_bare_dentin(bare_dentin(grid), out.sense);
  tell_pieces(pieces, out.sense);
}

/// Only what parts solid from void is a surface: enamel on dentin is not, nor a dentin face near
/// the pulp's.
void encode_surfaces(const ThreeMeshes& m, TissueGrid& grid, const std::vector<Tissue>& tissues) {
  const auto label = [&](Vec3 mm) {
    const Vec3 p = (mm - grid.origin_mm) / grid.leaf_mm;
    return grid.tissue[grid.index({static_cast<std::int32_t>(p.x), static_cast<std::int32_t>(p.y),
                                   static_cast<std::int32_t>(p.z)})];
  };
  const auto hard = [](std::uint8_t t) { return t == k_enamel || t == k_dentin; };
  const AcceptSurface outer = [&](Vec3 q, Vec3 n) {
    return label(q + n * grid.leaf_mm) == k_air && hard(label(q - n * (0.75 * grid.leaf_mm)));
  };
  const AcceptSurface inner = [&](Vec3 q, Vec3 n) {
    return hard(label(q + n * grid.leaf_mm)) && label(q - n * (0.75 * grid.leaf_mm)) == k_pulp;
  };
  BandDistance band(grid);
  band.add(m.enamel.mesh, outer);
  band.add(m.dentin.mesh, outer);
  band.add(m.pulp.mesh, inner);
  band.encode(grid, tissues);
}

}  // namespace

MeshImport import_meshes(const MeshPaths& paths, const MeshImportOptions& options) {
  ThreeMeshes meshes{read_closed_mesh(paths.enamel), read_closed_mesh(paths.dentin),
                     read_closed_mesh(paths.pulp)};
  auto& [enamel, dentin, pulp] = meshes;
  const double unit_mm = options.sense.units.empty() ? 1.0 : mm_per_unit(options.sense.units);
  for (auto* m : {&enamel, &dentin, &pulp}) scale(*m, unit_mm);
  const FrameOptions settled = settled_frame(options.frame, options.sense);
  const ToothAxes frame = tooth_axes(dentin.centroid_mm, enamel.centroid_mm, settled);
  for (auto* m : {&enamel.mesh, &dentin.mesh, &pulp.mesh})
    turn_into(*m, frame.axes, settled.mirror);
  Bounds crown, all;
  for (const Vec3 v : enamel.mesh.vertices_mm) crown.add(v);
  MeshImport out;
  check_crown_size(crown.high - crown.low, options.sense, paths.enamel, false, out.sense);
  const Vec3 origin = (crown.low + crown.high) * 0.5;
  for (auto* m : {&enamel.mesh, &dentin.mesh, &pulp.mesh}) {
    for (auto& v : m->vertices_mm) all.add(v = v - origin);
  }
  TissueGrid grid = lattice_around(all, options.leaf_mm, paths.dentin);

  out.mesh_enamel_mm3 = enamel.volume_mm3;
  out.mesh_dentin_mm3 = dentin.volume_mm3;
  out.mesh_pulp_mm3 = pulp.volume_mm3;
  label_leaves(meshes, paths, options.sense, grid, out);
  encode_surfaces(meshes, grid, out.tooth.tissues);
  // exchanged layers have the plainer name, and were refused above
  check_upright(frame.axes.row_z, dentin.centroid_mm, enamel.centroid_mm, options.sense,
                paths.enamel, out.sense);
  out.periodontium_leaves = add_periodontium(grid, options.periodontium_mm);
  out.tooth.octree = Octree(grid, out.tooth.tissues);

  const auto read = [](const std::string& path, const ReadMesh& mesh) {
    return SourceMesh{std::filesystem::path(path).filename().string(), mesh.unused_vertices,
                      mesh.turned};
  };
  out.tooth.source = {ImportedMeshes{read(paths.enamel, enamel), read(paths.dentin, dentin),
                                     read(paths.pulp, pulp), options.sense.units, options.leaf_mm,
                                     frame.source, out.overlap_leaves, out.gap_leaves,
                                     out.periodontium_leaves > 0 ? options.periodontium_mm : 0.0}};
  out.tooth.name = "tooth from " + std::filesystem::path(paths.enamel).stem().string();
  sense_tooth(out.tooth, settled, options.sense, paths.enamel, out.sense);
  name_tooth(out.sense, options.sense, settled.mirror, out.tooth);
  return out;
}

}  // namespace cavum
