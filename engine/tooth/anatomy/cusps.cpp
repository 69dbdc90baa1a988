#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/text.h"
#include "engine/tooth/anatomy/occlusal_marks.h"
#include "engine/tooth/anatomy/polylines.h"

namespace cavum {
namespace {

constexpr double k_sides_apart_mm =
    1.5;  // without a table: the least gap between buccal and lingual cusps
constexpr double k_on_edge_mm = 0.8;  // how far a worn cusp may lie from the table's edge
constexpr double k_ends =
    0.36;  // of the table's length to each side of its middle: beyond are the marginal ridges

struct Extent {
  double low = 1e9, high = -1e9;
  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

/// The line between buccal and lingual cusps, as y; none where it cannot be told.
std::optional<double> middle_of(const std::vector<Vec3>& tips, const HeightMap& map,
                                const std::optional<OcclusalTable>& table) {
  if (table) {
    double sum = 0;
    int n = 0;
    for (int c = 0; c < map.count(); ++c)
      if (table->inside[static_cast<std::size_t>(c)] != 0) {
        sum += map.place(c).y;
        ++n;
      }
    return sum / n;
  }
  std::vector<double> y;
  for (const Vec3 t : tips) y.push_back(t.y);
  std::sort(y.begin(), y.end());
  double widest = k_sides_apart_mm;
  std::optional<double> middle;
  for (std::size_t i = 1; i < y.size(); ++i)
    if (y[i] - y[i - 1] > widest) {
      widest = y[i] - y[i - 1];
      middle = 0.5 * (y[i] + y[i - 1]);
    }
  return middle;
}

void name_side(std::vector<CuspTip>& side, bool buccal, std::size_t before) {
  std::sort(side.begin(), side.end(),
            [](const CuspTip& a, const CuspTip& b) { return a.tip_mm.x > b.tip_mm.x; });
  static constexpr std::array<std::array<const char*, 3>, 3> k_buccal{
      {{noop("buccal"), "", ""},
       {noop("mesiobuccal"), noop("distobuccal"), ""},
       {noop("mesiobuccal"), noop("distobuccal"), noop("distal")}}};
  static constexpr std::array<std::array<const char*, 2>, 2> k_lingual{
      {{noop("lingual"), ""}, {noop("mesiolingual"), noop("distolingual")}}};
  const std::size_t n = side.size();
  const bool named = n <= (buccal ? 3 : 2);
  for (std::size_t i = 0; i < n; ++i) {
    side[i].name = !named   ? fmt::format("cusp {}", before + i + 1)
                   : buccal ? k_buccal[n - 1][i]
                            : k_lingual[n - 1][i];
    if (named) side[i].side = buccal ? CuspSide::buccal : CuspSide::lingual;
  }
}

}  // namespace

std::vector<CuspTip> find_cusps(const CrownMaps& maps, const std::optional<OcclusalTable>& table,
                                double least_z, std::vector<Message>& notes) {
  auto peaks = find_peaks(maps.cusps, k_worn_cusp_mm);
  std::erase_if(peaks, [&](const Peak& p) { return maps.cusps.at(p.cell) < least_z; });
  std::vector<Vec3> clear;
  for (const auto& p : peaks)
    if (p.prominence_mm >= k_cusp_mm) clear.push_back(maps.cusps.place(p.cell));
  const auto middle = middle_of(clear, maps.cusps, table);
  std::array<std::vector<CuspTip>, 2> sides;  // buccal, lingual
  const auto take = [&](const Peak& p, std::vector<CuspTip>& side) {
    Vec3 tip = refined_peak(maps.cusps, p.cell);
    tip.z = maps.raw.height(tip.x, tip.y);
    side.push_back({"", tip, p.prominence_mm});
  };
  const auto side_of = [&](const Peak& p) -> std::size_t {
    return !middle || maps.cusps.place(p.cell).y > *middle ? 0 : 1;
  };
  for (const auto& p : peaks)
    if (p.prominence_mm >= k_cusp_mm) take(p, sides[side_of(p)]);
  if (table && middle) {
    Extent along;
    for (const int c : table->edge) along.add(maps.cusps.place(c).x);
    const double centre = 0.5 * (along.low + along.high), reach = k_ends * (along.high - along.low);
    for (std::size_t s = 0; s < 2; ++s) {
      if (!sides[s].empty()) continue;
      for (const auto& p : peaks) {
        const Vec3 at = maps.cusps.place(p.cell);
        if (side_of(p) != s || std::fabs(at.x - centre) > reach) continue;
        if (std::any_of(table->edge.begin(), table->edge.end(), [&](int c) {
              return flat_distance(maps.cusps.place(c), at) < k_on_edge_mm;
            }))
          take(p, sides[s]);
      }
      const Number out = as_mm(k_worn_cusp_mm, 2);
      const bool none = sides[s].empty();
      notes.push_back(
          s == 0 ? none ? msg("no buccal cusp stands out by {}", out)
                        : msg("the buccal cusps are worn or small: they stand out by less than {}",
                              out)
          : none ? msg("no lingual cusp stands out by {}", out)
                 : msg("the lingual cusps are worn or small: they stand out by less than {}", out));
    }
  }
  const std::size_t buccal = sides[0].size();
  if (middle) {
    name_side(sides[0], true, 0);
    name_side(sides[1], false, buccal);
  } else {
    for (std::size_t i = 0; i < buccal; ++i) sides[0][i].name = fmt::format("cusp {}", i + 1);
  }
  sides[0].insert(sides[0].end(), sides[1].begin(), sides[1].end());
  return sides[0];
}

}  // namespace cavum
