#include "engine/tooth/import/layers_fit.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/tooth/import/import_error.h"
#include "engine/tooth/make/neck_by_sector.h"

namespace cavum {
namespace {
constexpr IVec3 k_sides[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Enamel that hangs together by its faces.
struct Piece {
  std::uint64_t leaves = 0;
  bool on_dentin = false;
  Vec3 sum;  // of its leaves' middles, mm
};
struct PiecesOfEnamel {
  std::vector<std::uint32_t> of_cell;  // number of its piece, from 1; 0 = no enamel
  std::vector<Piece> list;
};
PiecesOfEnamel pieces_of_enamel(const TissueGrid& grid) {
  PiecesOfEnamel found;
  found.of_cell.assign(grid.count(), 0);
  const IVec3 n = grid.size;
  std::vector<IVec3> open;
  const auto take = [&](IVec3 cell) {
    const std::size_t i = grid.index(cell);
    if (grid.tissue[i] != k_enamel || found.of_cell[i] != 0) return false;
    found.of_cell[i] = static_cast<std::uint32_t>(found.list.size() + 1);
    open.push_back(cell);
    return true;
  };
  for (std::int32_t z = 1; z + 1 < n.z; ++z)
    for (std::int32_t y = 1; y + 1 < n.y; ++y)
      for (std::int32_t x = 1; x + 1 < n.x; ++x) {
        if (!take({x, y, z})) continue;
        Piece piece;
        while (!open.empty()) {
          const IVec3 at = open.back();
          open.pop_back();
          ++piece.leaves;
          piece.sum += grid.centre_mm(at);
          for (const IVec3 step : k_sides) {
            const IVec3 next = at + step;
            if (next.x < 1 || next.y < 1 || next.z < 1 || next.x + 1 >= n.x || next.y + 1 >= n.y ||
                next.z + 1 >= n.z)
              continue;
            piece.on_dentin = piece.on_dentin || grid.tissue[grid.index(next)] == k_dentin;
            take(next);
          }
        }
        found.list.push_back(piece);
      }
  return found;
}

}  // namespace

std::array<std::uint64_t, 256> pulp_faces(IVec3 size, const std::vector<std::uint8_t>& tissue) {
  std::array<std::uint64_t, 256> faces{};
  const auto nx = static_cast<std::size_t>(size.x), nxy = nx * static_cast<std::size_t>(size.y);
  std::size_t i = 0;
  for (std::int32_t z = 0; z < size.z; ++z)
    for (std::int32_t y = 0; y < size.y; ++y)
      for (std::int32_t x = 0; x < size.x; ++x, ++i) {
        if (tissue[i] != k_pulp) continue;
        if (x > 0) ++faces[tissue[i - 1]];
        if (x + 1 < size.x) ++faces[tissue[i + 1]];
        if (y > 0) ++faces[tissue[i - nx]];
        if (y + 1 < size.y) ++faces[tissue[i + nx]];
        if (z > 0) ++faces[tissue[i - nxy]];
        if (z + 1 < size.z) ++faces[tissue[i + nxy]];
      }
  return faces;
}

void require_layer_order(const std::array<std::uint64_t, 256>& faces, const std::string& where,
                         const Message& what_to_do) {
  if (faces[k_enamel] > faces[k_dentin] && faces[k_enamel] >= faces[k_air])
    throw Error(ImportError::layers_exchanged, Name{where},
                msg("enamel and dentin look exchanged: the pulp lies in the enamel"), what_to_do);
}

LayersApart layers_apart(const TissueGrid& grid) {
  constexpr double k_widest_mm = 3.0, k_seam_mm = 0.15;
  std::uint64_t runs = 0, together = 0;
  const int most = static_cast<int>(k_widest_mm / grid.leaf_mm),
            seam = std::max(2, static_cast<int>(k_seam_mm / grid.leaf_mm));
  std::vector<std::uint64_t> voids(static_cast<std::size_t>(most) + 1);  // by their width, leaves
  // along each axis: enamel and dentin one after the other, or with a void between them
  const auto walk = [&](int n, const auto& cell) {
    std::uint8_t before = k_air, last = k_air;  // last hard tissue, last cell
    int gap = 0;
    for (int i = 0; i < n; ++i) {
      const std::uint8_t t = cell(i);
      runs += t == k_enamel && last != k_enamel;
      last = t;
      if (t == k_air) {
        ++gap;
        continue;
      }
      if ((t == k_enamel && before == k_dentin) || (t == k_dentin && before == k_enamel)) {
        if (gap <= seam)
          ++together;
        else if (gap <= most)
          ++voids[static_cast<std::size_t>(gap)];
      }
      before = t;
      gap = 0;
    }
  };
  const IVec3 n = grid.size;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      walk(n.x, [&](int x) { return grid.tissue[grid.index({x, y, z})]; });
  for (int z = 0; z < n.z; ++z)
    for (int x = 0; x < n.x; ++x)
      walk(n.y, [&](int y) { return grid.tissue[grid.index({x, y, z})]; });
  for (int y = 0; y < n.y; ++y)
    for (int x = 0; x < n.x; ++x)
      walk(n.z, [&](int z) { return grid.tissue[grid.index({x, y, z})]; });
  std::uint64_t apart = 0, below = 0;
  for (const auto count : voids) apart += count;
  LayersApart found;
  if (runs > 0) found.facing = static_cast<double>(apart + together) / static_cast<double>(runs);
  if (apart == 0) return found;
  found.share = static_cast<double>(apart) / static_cast<double>(apart + together);
  std::size_t usual = 0;
  while ((below += voids[usual]) * 2 < apart) ++usual;
  found.usual_mm = static_cast<double>(usual) * grid.leaf_mm;
  return found;
}

OpenPulp open_pulp(const TissueGrid& grid) {
  constexpr double k_above_neck_mm = 0.5;
  const IVec3 n = grid.size;
  OpenPulp found;
  int lowest = n.z;
  for (int z = 0; z < n.z && lowest == n.z; ++z)
    for (int y = 0; y < n.y && lowest == n.z; ++y)
      for (int x = 0; x < n.x; ++x)
        if (grid.tissue[grid.index({x, y, z})] == k_enamel) {
          lowest = z;
          break;
        }
  std::uint64_t open = 0;
  for (int z = std::max(1, lowest + static_cast<int>(k_above_neck_mm / grid.leaf_mm)); z + 1 < n.z;
       ++z)
    for (int y = 1; y + 1 < n.y; ++y)
      for (int x = 1; x + 1 < n.x; ++x) {
        if (grid.tissue[grid.index({x, y, z})] != k_pulp) continue;
        for (const IVec3 step : k_sides)
          if (grid.tissue[grid.index(IVec3{x, y, z} + step)] == k_air) {
            ++open;
            found.at_mm = grid.origin_mm + Vec3{x + 0.5, y + 0.5, z + 0.5} * grid.leaf_mm;
          }
      }
  found.mm2 = static_cast<double>(open) * grid.leaf_mm * grid.leaf_mm;
  return found;
}

BareDentin bare_dentin(const TissueGrid& grid) {
  constexpr double k_above_neck_mm = 1.0;
  const PiecesOfEnamel pieces =
      pieces_of_enamel(grid);  // a pearl on a root is no part of the crown
  const auto crown =
      std::max_element(pieces.list.begin(), pieces.list.end(),
                       [](const Piece& a, const Piece& b) { return a.leaves < b.leaves; });
  const auto number = static_cast<std::uint32_t>(crown - pieces.list.begin() + 1);
  const NeckBySector neck(grid, [&](std::size_t cell) { return pieces.of_cell[cell] == number; });
  const auto above = static_cast<std::int32_t>(k_above_neck_mm / grid.leaf_mm);
  const IVec3 n = grid.size;
  std::vector<std::uint8_t> faces(
      grid.count());  // on air, of dentin that is bare and was not yet counted
  for (std::int32_t z = 1; z + 1 < n.z; ++z)
    for (std::int32_t y = 1; y + 1 < n.y; ++y)
      for (std::int32_t x = 1; x + 1 < n.x; ++x) {
        const IVec3 cell{x, y, z};
        if (grid.tissue[grid.index(cell)] != k_dentin || z <= neck.lowest_enamel(cell) + above)
          continue;
        for (const IVec3 step : k_sides)
          if (grid.tissue[grid.index(cell + step)] == k_air) ++faces[grid.index(cell)];
      }
  BareDentin found;
  std::vector<IVec3> place;
  for (std::int32_t z = 1; z + 1 < n.z; ++z)
    for (std::int32_t y = 1; y + 1 < n.y; ++y)
      for (std::int32_t x = 1; x + 1 < n.x; ++x) {
        if (faces[grid.index({x, y, z})] == 0) continue;
        std::uint64_t count = 0;
        Vec3 sum;
        const auto take = [&](IVec3 cell) {
          std::uint8_t& f = faces[grid.index(cell)];
          if (f == 0) return;
          count += f;
          f = 0;
          sum += grid.centre_mm(cell);
          place.push_back(cell);
        };
        place.clear();
        take({x, y, z});
        for (std::size_t next = 0; next < place.size(); ++next)
          for (std::int32_t dz = -1; dz <= 1; ++dz)
            for (std::int32_t dy = -1; dy <= 1; ++dy)
              for (std::int32_t dx = -1; dx <= 1; ++dx) take(place[next] + IVec3{dx, dy, dz});
        const double mm2 = static_cast<double>(count) * grid.leaf_mm * grid.leaf_mm;
        found.mm2 += mm2;
        if (mm2 <= found.largest_mm2) continue;
        found.largest_mm2 = mm2;
        found.at_mm = sum / static_cast<double>(place.size());
      }
  return found;
}

double pulp_below_dentin_mm(const TissueGrid& grid) {
  const auto layer = static_cast<std::size_t>(grid.size.x) * static_cast<std::size_t>(grid.size.y);
  const auto lowest = [&](std::uint8_t tissue) {
    return static_cast<std::size_t>(std::find(grid.tissue.begin(), grid.tissue.end(), tissue) -
                                    grid.tissue.begin()) /
           layer;
  };
  return (static_cast<double>(lowest(k_dentin)) - static_cast<double>(lowest(k_pulp))) *
         grid.leaf_mm;
}

void require_pulp_in_root(double below_mm, const std::string& where) {
  constexpr double k_max_mm = 0.5;
  if (below_mm > k_max_mm)
    throw Error(
        ImportError::layers_apart, Name{where},
        msg("pulp and dentin do not fit: the pulp hangs {} out of the root", as_mm(below_mm, 1)),
        msg("check that both surfaces are of one tooth and in one frame"));
}

void require_layers_that_fit(const LayersApart& apart, const Overlaps& overlaps,
                             const std::string& where) {
  // thirteen human teeth: see docs/anatomy.md
  constexpr double k_min_facing = 0.5, k_max_apart = 0.03, k_max_overlap = 0.1, k_pulp_in = 0.8,
                   k_chamber = 0.3;
  constexpr const char* k_what_to_do = noop(
      "check that all surfaces are of one tooth and in one frame, and that enamel is the enamel alone, not the whole crown");
  if (apart.facing < k_min_facing)
    throw Error(
        ImportError::layers_apart, Name{where},
        msg("enamel and dentin do not fit: along {} of the ways through the enamel no dentin is met",
            as_percent(100 * (1 - apart.facing), 0)),
        msg(k_what_to_do));
  if (apart.share > k_max_apart)
    throw Error(
        ImportError::layers_apart, Name{where},
        msg("enamel and dentin do not fit: at {} of the places where they face each other there is a void between them, half of them {} wide "
            "or more along the lattice",
            as_percent(100 * apart.share, 0), as_mm(apart.usual_mm, 1)),
        msg(k_what_to_do));
  if (overlaps.of_the_enamel > k_max_overlap)
    throw Error(ImportError::layers_apart, Name{where},
                msg("enamel and dentin do not fit: {} of the enamel lie in the dentin, too",
                    as_percent(100 * overlaps.of_the_enamel, 0)),
                msg(k_what_to_do));
  const bool has_chamber = overlaps.chamber > k_chamber;
  if (has_chamber ? overlaps.of_the_pulp > k_max_overlap
                  : overlaps.of_the_pulp > k_max_overlap && overlaps.of_the_pulp < k_pulp_in)
    throw Error(ImportError::layers_apart, Name{where},
                msg("pulp and dentin do not fit: {} of the pulp lie in the dentin, {}",
                    as_percent(100 * overlaps.of_the_pulp, 0),
                    has_chamber ? msg("which has a chamber of its own for it")
                                : msg("where all of it should, or none")),
                msg("check that both surfaces are of one tooth and in one frame"));
}

EnamelPieces enamel_pieces(const TissueGrid& grid) {
  constexpr double k_min_mm3 = 0.02;
  std::vector<Piece> pieces = pieces_of_enamel(grid).list;
  EnamelPieces found;
  std::sort(pieces.begin(), pieces.end(),
            [](const Piece& a, const Piece& b) { return a.leaves > b.leaves; });
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const double mm3 =
        static_cast<double>(pieces[i].leaves) * grid.leaf_mm * grid.leaf_mm * grid.leaf_mm;
    if (mm3 < k_min_mm3) break;
    double& sum = pieces[i].on_dentin ? found.apart_mm3 : found.floating_mm3;
    if (sum == 0)
      (pieces[i].on_dentin ? found.apart_mm : found.floating_mm) =
          pieces[i].sum / static_cast<double>(pieces[i].leaves);
    sum += mm3;
  }
  return found;
}

void require_no_floating_enamel(const EnamelPieces& pieces, const std::string& where) {
  if (pieces.floating_mm3 > 0)
    throw Error(ImportError::layers_apart, Name{where},
                msg("{} of the enamel touch neither the crown nor any dentin, about ({} {} {}) mm",
                    as_mm3(pieces.floating_mm3, 2), as_number(pieces.floating_mm.x, 1),
                    as_number(pieces.floating_mm.y, 1), as_number(pieces.floating_mm.z, 1)),
                msg("take what is not of this tooth out of the mesh"));
}

}  // namespace cavum
