#include <algorithm>

#include "engine/tooth/anatomy/occlusal_marks.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

constexpr double k_tip_to_edge_mm = 1.2;  // a cusp's tip lies on the table's edge, give or take the scales
constexpr double k_as_low_mm = 0.03;
constexpr std::size_t k_thin = 3;
constexpr int k_crest_passes = 8;

/// Places of a closed line from one to another, both included, in its own direction.
std::vector<std::size_t> arc(std::size_t from, std::size_t to, std::size_t n) {
  std::vector<std::size_t> places{from};
  while (places.back() != to) places.push_back((places.back() + 1) % n);
  return places;
}

std::size_t lowest(const Polyline& edge, const std::vector<std::size_t>& places) {
  return *std::min_element(places.begin(), places.end(), [&](std::size_t a, std::size_t b) { return edge[a].z < edge[b].z; });
}

/// The middle of the stretch around the lowest place that is as low: a level crest has its lowest place anywhere.
std::size_t lowest_middle(const Polyline& edge, const std::vector<std::size_t>& places) {
  const auto low = std::find(places.begin(), places.end(), lowest(edge, places));
  const auto as_low = [&](std::size_t p) { return edge[p].z <= edge[*low].z + k_as_low_mm; };
  auto from = low, to = low;
  while (from != places.begin() && as_low(*(from - 1))) --from;
  while (to + 1 != places.end() && as_low(*(to + 1))) ++to;
  return *(from + (to - from) / 2);
}

bool is_buccal(const CuspTip& c) { return c.name.find("buccal") != std::string::npos || c.name == "distal"; }
bool is_lingual(const CuspTip& c) { return c.name.find("lingual") != std::string::npos; }

struct OnEdge {
  std::size_t place;
  bool buccal, lingual;
};

MarginalRidge ridge_of(const Polyline& edge, std::size_t from, std::size_t to, bool turn) {
  const auto places = arc(from, to, edge.size());
  MarginalRidge ridge;
  for (const auto p : places) ridge.crest_mm.push_back(edge[p]);
  if (turn) std::reverse(ridge.crest_mm.begin(), ridge.crest_mm.end());
  ridge.crest_mm = thinned(ridge.crest_mm, k_thin, false);
  ridge.lowest_mm = edge[lowest_middle(edge, places)];
  return ridge;
}

}  // namespace

void find_ridges(const CrownMaps& maps, const OcclusalTable& table, OcclusalMarks& marks) {
  const Polyline edge = line_of(maps.fissures, table.edge, true, k_crest_passes);
  if (edge.size() < 12) return;
  marks.table = thinned(edge, k_thin, true);
  std::vector<OnEdge> tips;
  for (const auto& c : marks.cusps) {
    std::size_t near = 0;
    for (std::size_t i = 1; i < edge.size(); ++i)
      if (flat_distance(edge[i], c.tip_mm) < flat_distance(edge[near], c.tip_mm)) near = i;
    if (flat_distance(edge[near], c.tip_mm) <= k_tip_to_edge_mm) tips.push_back({near, is_buccal(c), is_lingual(c)});
  }
  std::sort(tips.begin(), tips.end(), [](const OnEdge& a, const OnEdge& b) { return a.place < b.place; });
  const std::size_t n = tips.size();
  if (n < 2) return;
  std::vector<std::size_t> lows;  // between a tip and the next
  for (std::size_t i = 0; i < n; ++i) lows.push_back(lowest(edge, arc(tips[i].place, tips[(i + 1) % n].place, edge.size())));
  for (std::size_t i = 0; i < n; ++i) {
    Polyline ridge;
    for (const auto p : arc(lows[(i + n - 1) % n], lows[i], edge.size())) ridge.push_back(edge[p]);
    if (ridge.size() > 4) marks.cusp_ridges.push_back(thinned(ridge, k_thin, false));
  }
  // where one side's cusps are worn away, nothing tells where a marginal ridge ends and a cusp begins
  double buccal_mm = 0, lingual_mm = 0;
  for (const auto& c : marks.cusps) {
    if (is_buccal(c)) buccal_mm = std::max(buccal_mm, c.prominence_mm);
    if (is_lingual(c)) lingual_mm = std::max(lingual_mm, c.prominence_mm);
  }
  if (std::min(buccal_mm, lingual_mm) < k_cusp_mm) {
    marks.notes.emplace_back("no marginal ridges: one side has no cusp that stands out clearly");
    return;
  }
  // seen from above the edge runs counter-clockwise: lingual to buccal over the mesial side, buccal to lingual over the distal one
  int mesial = 0, distal = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto& a = tips[i];
    const auto& b = tips[(i + 1) % n];
    if (a.lingual && b.buccal && ++mesial == 1) marks.mesial = ridge_of(edge, a.place, b.place, true);
    if (a.buccal && b.lingual && ++distal == 1) marks.distal = ridge_of(edge, a.place, b.place, false);
  }
  if (mesial > 1) marks.mesial = {};
  if (distal > 1) marks.distal = {};
}

}  // namespace cavum
