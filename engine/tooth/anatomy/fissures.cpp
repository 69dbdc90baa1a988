#include <algorithm>

#include "engine/tooth/anatomy/occlusal_marks.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

constexpr double k_hollow_mm = 0.03;  // least depth of a pit that is a hollow of its own
constexpr double k_on_way_mm = 0.5;   // how far from the fissure's way a pit may lie
constexpr double k_end_share = 0.38;  // of the way: an end's pit lies in it
constexpr double k_pits_apart_mm = 1.0;
constexpr double k_least_branch_mm = 0.8;
constexpr int k_passes = 4;

std::size_t place(int cell) { return static_cast<std::size_t>(cell); }

/// Mean curvature of five cells of the way around place i.
double bend_at(const std::vector<int>& way, const std::vector<double>& curvature, std::size_t i) {
  double sum = 0;
  int n = 0;
  for (std::size_t k = i >= 2 ? i - 2 : 0; k <= std::min(i + 2, way.size() - 1); ++k) {
    sum += curvature[place(way[k])];
    ++n;
  }
  return sum / n;
}

double median_bend(const std::vector<int>& way, const std::vector<double>& curvature, std::size_t from, std::size_t to) {
  std::vector<double> bends;
  for (std::size_t i = from; i < to; ++i) bends.push_back(curvature[place(way[i])]);
  std::sort(bends.begin(), bends.end());
  return bends.empty() ? 0.0 : bends[bends.size() / 2];
}

/// Where on the way the nearest place to a cell is.
std::size_t nearest_on(const HeightMap& map, const std::vector<int>& way, int cell) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < way.size(); ++i)
    if (flat_distance(map.place(way[i]), map.place(cell)) < flat_distance(map.place(way[best]), map.place(cell))) best = i;
  return best;
}

/// The end of the fissure on the first part of a way: the outermost hollow there, else where the way begins to be a valley.
std::optional<std::size_t> end_pit(const HeightMap& map, const std::vector<int>& way, const std::vector<double>& curvature,
                                   const std::vector<Peak>& hollows, double valley) {
  const auto reach = static_cast<std::size_t>(k_end_share * static_cast<double>(way.size()));
  std::optional<std::size_t> hollow;
  for (const auto& h : hollows) {
    const auto at = nearest_on(map, way, h.cell);
    if (at > 1 && at <= reach && flat_distance(map.place(way[at]), map.place(h.cell)) <= k_on_way_mm && (!hollow || at < *hollow)) hollow = at;
  }
  if (hollow) return hollow;
  for (std::size_t i = 0; i + 2 < reach; ++i)
    if (bend_at(way, curvature, i) >= valley && bend_at(way, curvature, i + 2) >= valley) return i;
  return std::nullopt;
}

int cell_of(const HeightMap& map, Vec3 p) { return map.cell_at(p.x, p.y); }

Vec3 on_map(const HeightMap& map, int cell) { return map.place(cell); }

}  // namespace

void find_fissures(const CrownMaps& maps, const OcclusalTable& table, OcclusalMarks& marks) {
  const HeightMap& map = maps.fissures;
  if (!marks.mesial.lowest_mm || !marks.distal.lowest_mm) {
    marks.notes.emplace_back("no fissures: a marginal ridge is missing to run between");
    return;
  }
  const auto curvature = valley_curvature(map);
  auto way = valley_way(map, table.inside, curvature, cell_of(map, *marks.mesial.lowest_mm), {cell_of(map, *marks.distal.lowest_mm)});
  if (way.size() < 12) return;
  const double usual = median_bend(way, curvature, way.size() / 4, way.size() - way.size() / 4);
  if (usual < k_fissure_per_mm) {
    marks.notes.emplace_back("no central fissure: the valley between the cusps is too flat");
    return;
  }
  const auto hollows = find_hollows(map, k_hollow_mm);
  const double valley = 0.5 * std::min(usual, 4.0);
  const auto mesial = end_pit(map, way, curvature, hollows, valley);
  std::reverse(way.begin(), way.end());
  auto distal = end_pit(map, way, curvature, hollows, valley);
  std::reverse(way.begin(), way.end());
  if (distal) distal = way.size() - 1 - *distal;
  if (!mesial || !distal || *mesial + 8 > *distal) {
    marks.notes.emplace_back("no central fissure: its ends cannot be told");
    return;
  }
  marks.mesial_pit = on_map(map, way[*mesial]);
  marks.distal_pit = on_map(map, way[*distal]);
  double lowest = 1e9;
  for (const auto& h : hollows) {
    const auto at = nearest_on(map, way, h.cell);
    const Vec3 p = map.place(h.cell);
    if (at <= *mesial || at >= *distal || flat_distance(map.place(way[at]), p) > k_on_way_mm || p.z >= lowest) continue;
    if (flat_distance(p, *marks.mesial_pit) < k_pits_apart_mm || flat_distance(p, *marks.distal_pit) < k_pits_apart_mm) continue;
    lowest = p.z;
    marks.central_pit = p;
  }
  const std::vector<int> fissure(way.begin() + static_cast<std::ptrdiff_t>(*mesial), way.begin() + static_cast<std::ptrdiff_t>(*distal) + 1);
  marks.central_fissure = thinned(line_of(map, fissure, false, k_passes), 2, false);
  // a branch runs out between two cusps of one side, over the lowest place of the edge between them
  for (std::size_t i = 0; i + 1 < marks.cusps.size(); ++i) {
    const auto& ridges = marks.cusp_ridges;
    const Vec3 a = marks.cusps[i].tip_mm, b = marks.cusps[i + 1].tip_mm;
    const bool same_side =
        (marks.cusps[i].name.find("lingual") != std::string::npos) == (marks.cusps[i + 1].name.find("lingual") != std::string::npos);
    if (!same_side) continue;
    // the common end of the two cusps' ridges
    std::optional<Vec3> notch;
    for (const auto& r : ridges)
      for (const Vec3 end : {r.front(), r.back()})
        if (flat_distance(end, a) + flat_distance(end, b) < 1.35 * flat_distance(a, b) + 0.4 && (!notch || end.z < notch->z)) notch = end;
    if (!notch) continue;
    auto branch = valley_way(map, table.inside, curvature, cell_of(map, *notch), fissure);
    if (branch.size() < 3) continue;
    std::reverse(branch.begin(), branch.end());
    const Polyline line = line_of(map, branch, false, k_passes);
    if (flat_length(line) >= k_least_branch_mm && median_bend(branch, curvature, 0, branch.size()) >= k_fissure_per_mm)
      marks.branches.push_back(thinned(line, 2, false));
  }
}

}  // namespace cavum
