#include "grading/measures/cavity_outline.h"

#include <algorithm>
#include <optional>

#include "grading/measures/solid_surface.h"
#include "scenarios/zones/relief.h"

namespace cavum::grading {
namespace {

/// How far inside an area each column's topmost leaf lies (leaves, negative outside), over a box of
/// columns.
struct TopArea {
  int x0, y0, nx, ny;
  std::vector<double> inside;       // x fastest
  std::vector<std::uint8_t> tooth;  // 1 where the column holds tooth
  [[nodiscard]] std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x);
  }
};

/// The furthest of a border known on parallel lines one apart. Between two lines it may run up to a
/// corner: where the straight continuations from both sides meet, but half a leaf beyond the lines
/// at most.
double furthest(const std::vector<double>& border) {
  constexpr double k_none = -1e9;
  double best = k_none;
  const auto n = border.size();
  for (std::size_t i = 0; i < n; ++i) {
    best = std::max(best, border[i]);
    if (i == 0 || i + 2 >= n ||
        std::min({border[i - 1], border[i], border[i + 1], border[i + 2]}) == k_none)
      continue;
    const double rise = border[i] - border[i - 1], fall = border[i + 1] - border[i + 2];
    if (!(rise + fall > 0)) continue;
    const double at = (border[i + 1] - border[i] + fall) / (rise + fall);  // from line i on
    if (at > 0 && at < 1)
      best =
          std::max(best, std::min(border[i] + rise * at, std::max(border[i], border[i + 1]) + 0.5));
  }
  return best;
}

/// Where the area's border crosses the rows and files of the columns' centres: interpolated along
/// them, at the leaf's face beside the tooth.
Extent extent_of(const TopArea& area) {
  Extent e;
  const auto along = [&](int n, int lines, auto index, double first, double& low, double& high) {
    std::vector<double> lows(static_cast<std::size_t>(lines), -1e9),
        highs = lows;  // lows with their sign turned
    for (int line = 0; line < lines; ++line)
      for (int i = 0; i < n; ++i) {
        const double v = area.inside[index(i, line)];
        if (area.tooth[index(i, line)] == 0 || !(v > 0)) continue;
        const auto reach = [&](int to) {
          if (to < 0 || to >= n || area.tooth[index(to, line)] == 0) return 0.5;
          const double w = area.inside[index(to, line)];
          return w > 0 ? 0.0 : v / (v - w);
        };
        auto& l = lows[static_cast<std::size_t>(line)];
        auto& h = highs[static_cast<std::size_t>(line)];
        l = std::max(l, -(first + i + 0.5 - reach(i - 1)));
        h = std::max(h, first + i + 0.5 + reach(i + 1));
      }
    low = -furthest(lows);
    high = furthest(highs);
  };
  along(
      area.nx, area.ny, [&](int i, int line) { return area.at(i, line); }, area.x0, e.low_x,
      e.high_x);
  along(
      area.ny, area.nx, [&](int i, int line) { return area.at(line, i); }, area.y0, e.low_y,
      e.high_y);
  return e;
}

/// The outermost solid leaf of a column, its place in it negative without tooth: from above by the
/// relief, from a side by going in.
class Tops {
 public:
  explicit Tops(const GradeInput& input)
      : tree_(input.before.octree), facing_(input.zones.facing()) {
    if (!facing_.lateral()) surface_ = scenarios::surface_relief(input.before);
  }
  /// In the tooth's leaves, of a column as `Facing::local` has it.
  [[nodiscard]] std::optional<IVec3> at(int x, int y) const {
    if (!facing_.lateral()) {
      const int z = scenarios::top_leaf(surface_, tree_, x, y);
      return z < 0 ? std::optional<IVec3>() : IVec3{x, y, z};
    }
    const int n = tree_.size().y;
    for (int i = 0; i < n; ++i)
      if (const IVec3 leaf{x, facing_.side > 0 ? n - 1 - i : i, y};
          tree_.is_solid(tree_.tissue(leaf)))
        return leaf;
    return {};
  }

 private:
  const Octree& tree_;
  scenarios::Facing facing_;
  scenarios::ColumnMap surface_;
};

/// The columns over all of the cut and all of the target, and one more on each side; each holds
/// nothing yet.
TopArea area_around(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick) {
  const scenarios::Facing facing = input.zones.facing();
  LeafBounds box;
  const auto hold = [&](IVec3 in_tooth) { box.add(facing.local(in_tooth)); };
  for_each_removed(input.removed, removed, last_tick,
                   [&](const RemovedAt& r) { hold(r.leaf.leaf()); });
  input.zones.for_each_target_leaf(hold);
  return {
      box.low.x - 1, box.low.y - 1, box.high.x - box.low.x + 3, box.high.y - box.low.y + 3, {}, {}};
}

}  // namespace

Outlines cavity_outlines(const GradeInput& input, const RemovedMap& removed,
                         std::int64_t last_tick) {
  const Tops tops(input);
  TopArea cut = area_around(input, removed, last_tick);
  TopArea target = cut, common = cut, either = cut;
  for (int y = 0; y < cut.ny; ++y)
    for (int x = 0; x < cut.nx; ++x) {
      const std::optional<IVec3> top = tops.at(cut.x0 + x, cut.y0 + y);
      const IVec3 leaf = top.value_or(IVec3{});
      const double in_cut = !top                ? -1.0
                            : removed.has(leaf) ? gone_by(input.after, leaf)
                                                : -stays_by(input.after, leaf);
      const double in_target = !top ? -1.0 : -input.zones.distance_mm(leaf) / input.zones.leaf_mm();
      cut.inside.push_back(in_cut);
      target.inside.push_back(in_target);
      common.inside.push_back(std::min(in_cut, in_target));
      either.inside.push_back(std::max(in_cut, in_target));
      cut.tooth.push_back(top ? 1 : 0);
    }
  target.tooth = common.tooth = either.tooth = cut.tooth;
  return {extent_of(cut), extent_of(target), extent_of(common), extent_of(either)};
}

}  // namespace cavum::grading
