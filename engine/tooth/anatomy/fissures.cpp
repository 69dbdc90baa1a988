#include <algorithm>
#include <array>

#include "engine/tooth/anatomy/occlusal_marks.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

constexpr double k_pit_mm = 0.012;  // least depth of a pit below the lowest way out of it
constexpr double k_deep_pit_mm = 0.03;
constexpr double k_end_bend = 0.65;    // of the usual curvature: a fissure ends where it has less
constexpr double k_pit_bend = 0.4;     // of the fissure's usual curvature: a pit has as much
constexpr double k_pit_per_mm = 0.8;   // least curvature of a pit: a dip of a broad crest is none
constexpr double k_central_mm = 0.03;  // of the central pit
constexpr double k_fossa_mm =
    0.3;  // of the central pit where no ridge tells the table's ends: the central fossa
constexpr double k_end_share = 0.32;     // of the table's length: an end's pit lies in it
constexpr double k_from_crest_mm = 0.2;  // a hollow nearer to the ridge is a fault of its crest
constexpr double k_knee_from_crest_mm =
    0.35;  // a valley that begins on the crest itself has no end to be told
constexpr double k_usual_from_crest_mm = 1.0;  // a pit
constexpr double k_pits_apart_mm = 1.0;
constexpr double k_min_branch_mm = 0.8;
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

double median_bend(const std::vector<int>& way, const std::vector<double>& curvature,
                   std::size_t from, std::size_t to) {
  std::vector<double> bends;
  for (std::size_t i = from; i < to; ++i) bends.push_back(curvature[place(way[i])]);
  std::sort(bends.begin(), bends.end());
  return bends.empty() ? 0.0 : bends[bends.size() / 2];
}

/// Hollows of the table, and its mesial and distal ends.
struct Ground {
  const HeightMap& map;
  const std::vector<std::uint8_t>& inside;
  const std::vector<double>& curvature;
  std::vector<Peak> hollows;
  double low_x = 1e9, high_x = -1e9;

  /// `end` is 1 at the mesial end of the table, -1 at the distal one.
  [[nodiscard]] bool at_end(Vec3 p, int end) const {
    const double share = (p.x - low_x) / (high_x - low_x);
    return end > 0 ? share > 1 - k_end_share : share < k_end_share;
  }
};

/// The deepest hollow at an end of the table, away from the ridge's crest.
std::optional<Peak> end_hollow(const Ground& g, Vec3 crest, int end, double least_bend) {
  std::optional<Peak> best;
  for (const auto& h : g.hollows) {
    const Vec3 p = g.map.place(h.cell);
    if (g.curvature[place(h.cell)] < least_bend) continue;
    if (g.at_end(p, end) && flat_distance(p, crest) >= k_from_crest_mm && p.z < crest.z &&
        (!best || h.prominence_mm > best->prominence_mm))
      best = h;
  }
  return best;
}

/// Where the way from a ridge's crest inwards begins to be a valley as the whole of it is.
std::optional<int> knee(const Ground& g, Vec3 crest, const std::vector<int>& way, double usual,
                        int end) {
  if (usual < k_fissure_per_mm) return std::nullopt;
  const double valley = k_end_bend * usual;
  for (std::size_t i = 0; i + 2 < way.size() && g.at_end(g.map.place(way[i]), end); ++i)
    if (bend_at(way, g.curvature, i) >= valley && bend_at(way, g.curvature, i + 2) >= valley)
      return std::min(flat_distance(g.map.place(way[i]), g.map.place(way[0])),
                      flat_distance(g.map.place(way[i]), crest)) >= k_knee_from_crest_mm
                 ? std::optional(way[i])
                 : std::nullopt;
  return std::nullopt;
}

/// `way` is the groove from this end's crest to the other's.
std::optional<int> end_pit(const Ground& g, Vec3 crest, const std::vector<int>& way, int end) {
  if (way.size() < 12) return std::nullopt;
  const double usual = median_bend(way, g.curvature, way.size() / 4, way.size() - way.size() / 4);
  const auto bend = knee(g, crest, way, usual, end);
  const auto hollow = end_hollow(g, crest, end, std::max(k_pit_per_mm, k_pit_bend * usual));
  // what holds water is the pit; a fissure of even depth has its lowest place anywhere, and its end
  // tells the pit better
  if (hollow && (!bend || hollow->prominence_mm >= k_deep_pit_mm)) return hollow->cell;
  return bend;
}

/// The lowest hollow of the table's middle that is as deep as this, away from other pits.
std::optional<Vec3> middle_hollow(const Ground& g, double least_mm,
                                  const std::vector<Vec3>& others) {
  std::optional<Vec3> best;
  for (const auto& h : g.hollows) {
    const Vec3 p = g.map.place(h.cell);
    if (h.prominence_mm < least_mm || g.at_end(p, 1) || g.at_end(p, -1) || (best && p.z >= best->z))
      continue;
    if (std::all_of(others.begin(), others.end(),
                    [&](Vec3 o) { return flat_distance(o, p) >= k_pits_apart_mm; }))
      best = p;
  }
  return best;
}

int cell_of(const HeightMap& map, Vec3 p) { return map.cell_at(p.x, p.y); }

/// Where the fissure begins on the way from a crest inwards: at the pit's height along it, or where
/// no pit is told, as far from the crest as pits lie.
std::size_t fissure_begin(const HeightMap& map, const std::vector<int>& way,
                          const std::optional<int>& pit) {
  std::size_t at = 0;
  if (pit) {
    for (std::size_t i = 1; i < way.size(); ++i)
      if (flat_distance(map.place(way[i]), map.place(*pit)) <
          flat_distance(map.place(way[at]), map.place(*pit)))
        at = i;
  } else {
    while (at + 1 < way.size() &&
           flat_distance(map.place(way[at]), map.place(way[0])) < k_usual_from_crest_mm)
      ++at;
  }
  return at;
}

}  // namespace

void find_fissures(const CrownMaps& maps, const OcclusalTable& table,
                   const std::optional<Groove>& groove, OcclusalMarks& marks) {
  const HeightMap& map = maps.fissures;
  const auto curvature = curvatures(map).larger;
  Ground ground{map, table.inside, curvature, find_hollows(map, k_pit_mm)};
  std::erase_if(ground.hollows, [&](const Peak& h) { return table.inside[place(h.cell)] == 0; });
  for (const int c : table.edge) {
    ground.low_x = std::min(ground.low_x, map.place(c).x);
    ground.high_x = std::max(ground.high_x, map.place(c).x);
  }
  if (!groove || !marks.mesial.lowest_mm || !marks.distal.lowest_mm) {
    marks.notes.emplace_back(msg(
        "no ridges and fissures: no groove runs from end to end between a buccal and a lingual side"));
    marks.central_pit = middle_hollow(ground, k_fossa_mm, {});
    return;
  }
  const auto place_of = [&](const GrooveEnd& end) {
    return groove->way.begin() + static_cast<std::ptrdiff_t>(end.place);
  };
  const std::vector<int> inwards(place_of(groove->mesial), place_of(groove->distal) + 1),
      back(inwards.rbegin(), inwards.rend());
  const auto mesial = end_pit(ground, *marks.mesial.lowest_mm, inwards, 1);
  const auto distal = end_pit(ground, *marks.distal.lowest_mm, back, -1);
  if (mesial) marks.mesial_pit = map.place(*mesial);
  if (distal) marks.distal_pit = map.place(*distal);
  std::vector<Vec3> pits;
  for (const auto& pit : std::array{marks.mesial_pit, marks.distal_pit})
    if (pit) pits.push_back(*pit);
  marks.central_pit = middle_hollow(ground, k_central_mm, pits);
  for (const auto& [pit, is_mesial] : {std::pair{mesial, true}, {distal, false}})
    if (!pit)
      marks.notes.push_back(
          is_mesial
              ? msg("no mesial pit: the groove runs over the ridge; the fissure is drawn to {} from its crest",
                    as_mm(k_usual_from_crest_mm, 1))
              : msg("no distal pit: the groove runs over the ridge; the fissure is drawn to {} from its crest",
                    as_mm(k_usual_from_crest_mm, 1)));
  const std::size_t first = fissure_begin(map, inwards, mesial),
                    last = inwards.size() - 1 - fissure_begin(map, back, distal);
  if (first + 8 > last) {
    marks.notes.emplace_back(msg("no central fissure: its ends lie too near together"));
    return;
  }
  std::vector<int> fissure(inwards.begin() + static_cast<std::ptrdiff_t>(first),
                           inwards.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  marks.central_fissure = thinned(line_of(map, fissure, false, k_passes), 2, false);
  // a branch runs out between two cusps of one side, over the lowest place of the edge between them
  for (std::size_t i = 0; i + 1 < marks.cusps.size(); ++i) {
    const auto& ridges = marks.cusp_ridges;
    const Vec3 a = marks.cusps[i].tip_mm, b = marks.cusps[i + 1].tip_mm;
    if ((marks.cusps[i].side == CuspSide::lingual) !=
        (marks.cusps[i + 1].side == CuspSide::lingual))
      continue;
    // the common end of the two cusps' ridges
    std::optional<Vec3> notch;
    for (const auto& r : ridges)
      for (const Vec3 end : {r.front(), r.back()})
        if (flat_distance(end, a) + flat_distance(end, b) < 1.35 * flat_distance(a, b) + 0.4 &&
            (!notch || end.z < notch->z))
          notch = end;
    if (!notch) continue;
    auto branch = valley_path(map, table.inside, curvature, {cell_of(map, *notch)}, fissure);
    if (branch.size() < 3) continue;
    std::reverse(branch.begin(), branch.end());
    const Polyline line = line_of(map, branch, false, k_passes);
    if (flat_length(line) >= k_min_branch_mm &&
        median_bend(branch, curvature, 0, branch.size()) >= k_fissure_per_mm)
      marks.branches.push_back(thinned(line, 2, false));
  }
}

}  // namespace cavum
