#include <algorithm>

#include "engine/tooth/anatomy/occlusal_marks.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

constexpr double k_tip_to_edge_mm =
    1.2;  // a cusp's tip lies on the table's edge, give or take the scales
constexpr double k_as_low_mm = 0.03;
constexpr double k_lowest_within_mm = 1.2;  // of where the groove passes over a ridge
constexpr double k_short_crest_mm =
    1.5;  // to both sides of the groove, where no cusp tells where a ridge ends
constexpr double k_clear_mm = 0.3;  // of the crest, where the groove is surely inside the table
constexpr std::size_t k_thin = 3;
constexpr int k_crest_passes = 8;

/// Places of a closed line from one to another, both included, in its own direction.
std::vector<std::size_t> arc(std::size_t from, std::size_t to, std::size_t n) {
  std::vector<std::size_t> places{from};
  while (places.back() != to) places.push_back((places.back() + 1) % n);
  return places;
}

std::size_t lowest(const Polyline& edge, const std::vector<std::size_t>& places) {
  return *std::min_element(places.begin(), places.end(),
                           [&](std::size_t a, std::size_t b) { return edge[a].z < edge[b].z; });
}

struct OnEdge {
  std::size_t place;
  CuspSide side;
};

/// The middle of the stretch around the lowest place that is as low: a level crest has its lowest
/// place anywhere.
std::size_t lowest_middle(const Polyline& edge, const std::vector<std::size_t>& places) {
  const auto low = std::find(places.begin(), places.end(), lowest(edge, places));
  const auto as_low = [&](std::size_t p) { return edge[p].z <= edge[*low].z + k_as_low_mm; };
  auto from = low, to = low;
  while (from != places.begin() && as_low(*(from - 1))) --from;
  while (to + 1 != places.end() && as_low(*(to + 1))) ++to;
  return *(from + (to - from) / 2);
}

/// The piece of a closed line that lies within a distance of one of its places.
std::vector<std::size_t> around(const Polyline& edge, std::size_t place, double within_mm) {
  const std::size_t n = edge.size();
  std::size_t first = place, last = place;
  while ((first + n - 1) % n != place &&
         flat_distance(edge[(first + n - 1) % n], edge[place]) < within_mm)
    first = (first + n - 1) % n;
  while ((last + 1) % n != first && flat_distance(edge[(last + 1) % n], edge[place]) < within_mm)
    last = (last + 1) % n;
  return arc(first, last, n);
}

/// Its crest is the edge between two cusps, or a short piece of it where one side has none; its
/// lowest place the one where the groove passes over it.
MarginalRidge ridge_of(const Polyline& edge, Vec3 over, bool is_ridge, const OnEdge* from,
                       const OnEdge* to, bool turn) {
  std::size_t low = 0;
  for (std::size_t i = 1; i < edge.size(); ++i)
    if (flat_distance(edge[i], over) < flat_distance(edge[low], over)) low = i;
  // where a groove runs out without a ridge, the edge goes back along it: that is no crest
  if (is_ridge) low = lowest_middle(edge, around(edge, low, k_lowest_within_mm));
  std::size_t first = low, last = low;
  const std::size_t n = edge.size();
  if (from != nullptr && to != nullptr) {
    first = from->place;
    last = to->place;
  } else {
    const auto piece = around(edge, low, k_short_crest_mm);
    first = piece.front();
    last = piece.back();
  }
  MarginalRidge ridge;
  for (const auto p : arc(first, last, n)) ridge.crest_mm.push_back(edge[p]);
  if (turn) std::reverse(ridge.crest_mm.begin(), ridge.crest_mm.end());
  ridge.crest_mm = thinned(ridge.crest_mm, k_thin, false);
  ridge.lowest_mm = edge[low];
  return ridge;
}

}  // namespace

std::vector<int> lowest_of_table(const CrownMaps& maps, const std::optional<Groove>& groove) {
  std::vector<int> cells;
  const HeightMap& map = maps.fissures;
  if (!groove) {
    for (const Peak& hollow : find_hollows(map, k_table_mm)) cells.push_back(hollow.cell);
    return cells;
  }
  const auto& way = groove->way;
  const Vec3 mesial = map.place(way[groove->mesial.place]),
             distal = map.place(way[groove->distal.place]);
  for (std::size_t i = groove->mesial.place; i <= groove->distal.place; ++i) {
    const Vec3 p = map.place(way[i]);
    if (flat_distance(p, mesial) > k_clear_mm && flat_distance(p, distal) > k_clear_mm)
      cells.push_back(way[i]);
  }
  return cells;
}

void find_ridges(const CrownMaps& maps, const OcclusalTable& table,
                 const std::optional<Groove>& groove, OcclusalMarks& marks) {
  const Polyline edge = line_of(maps.fissures, table.edge, true, k_crest_passes);
  if (edge.size() < 12) return;
  marks.table = thinned(edge, k_thin, true);
  std::vector<OnEdge> tips;
  for (const auto& c : marks.cusps) {
    std::size_t near = 0;
    for (std::size_t i = 1; i < edge.size(); ++i)
      if (flat_distance(edge[i], c.tip_mm) < flat_distance(edge[near], c.tip_mm)) near = i;
    if (flat_distance(edge[near], c.tip_mm) <= k_tip_to_edge_mm) tips.push_back({near, c.side});
  }
  std::sort(tips.begin(), tips.end(),
            [](const OnEdge& a, const OnEdge& b) { return a.place < b.place; });
  const std::size_t n = tips.size();
  std::vector<std::size_t> lows;  // between a tip and the next
  for (std::size_t i = 0; i < n && n > 1; ++i)
    lows.push_back(lowest(edge, arc(tips[i].place, tips[(i + 1) % n].place, edge.size())));
  for (std::size_t i = 0; i < lows.size(); ++i) {
    Polyline ridge;
    for (const auto p : arc(lows[(i + n - 1) % n], lows[i], edge.size())) ridge.push_back(edge[p]);
    if (ridge.size() > 4) marks.cusp_ridges.push_back(thinned(ridge, k_thin, false));
  }
  if (!groove) return;
  // seen from above the edge runs counter-clockwise: lingual to buccal over the mesial side, buccal
  // to lingual over the distal one
  const OnEdge *mesial[2] = {}, *distal[2] = {};
  for (std::size_t i = 0; i < n; ++i) {
    const auto& a = tips[i];
    const auto& b = tips[(i + 1) % n];
    if (a.side == CuspSide::lingual && b.side == CuspSide::buccal) mesial[0] = &a, mesial[1] = &b;
    if (a.side == CuspSide::buccal && b.side == CuspSide::lingual) distal[0] = &a, distal[1] = &b;
  }
  const auto& way = groove->way;
  marks.mesial = ridge_of(edge, maps.fissures.place(way[groove->mesial.place]),
                          groove->mesial.ridge, mesial[0], mesial[1], true);
  marks.distal = ridge_of(edge, maps.fissures.place(way[groove->distal.place]),
                          groove->distal.ridge, distal[0], distal[1], false);
}

}  // namespace cavum
