#include "scenarios/review/section_leaves.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace cavum::scenarios {
namespace {

/// Leaves of one colour as one path of runs.
struct Runs {
  std::map<std::string, std::string> path;  // by fill
  void add(const std::string& fill, int column, int row_from_top, int n) {
    if (fill.empty()) return;
    path[fill] += fmt::format("M{} {}h{}v1h-{}z", column, row_from_top, n, n);
  }
};

/// What is seen of one leaf: colours of its tissue and of what was found there, opacity of the
/// shade over both. Empty: none.
struct LeafLook {
  std::string tissue, finding, shade;
  bool operator==(const LeafLook&) const = default;
};

LeafLook look_of_leaf(const Section& section, const PictureSpec& spec, const Palette& colours,
                      IVec3 at) {
  const auto t = section.before.tissue(at);
  if (t == k_air) return {};
  if (section.after != nullptr && section.after->tissue(at) == k_air)
    return {"", finding_colour(colours, section.zones.zone(at)), ""};
  return {tissue_colour(colours, t), spec.heat_percent ? heat_colour(spec.heat_percent(at)) : "",
          ""};
}

/// Slopes facing away from the light at the upper left are darkened: the fissures show.
std::string shade_from_above(const Section& section, int column, int row) {
  const auto height = [&](int c, int r) {
    const int z = section.top_after(std::clamp(c, 0, section.width() - 1),
                                    std::clamp(r, 0, section.height() - 1));
    return z < 0 ? section.top_after(column, row) : z;
  };
  const int slope = height(column + 3, row - 3) - height(column - 3, row + 3);
  return slope < -5 ? "0.24" : slope < -2 ? "0.14" : slope < 0 ? "0.07" : "";
}

/// Of a column's leaves: the most frequent overcut, else what was left most often.
double heat_of_column(const PictureSpec& spec, int column, int row, int top) {
  double over = 0, left = 0;
  for (int z = top; z >= 0; --z) {
    const double heat = spec.heat_percent({column, row, z});
    over = std::max(over, heat);
    left = std::min(left, heat);
  }
  return over >= k_min_heat_percent ? over : left;
}

/// The worst zone of what was removed from a column, between its tops after and before.
Zone worst_zone_of_column(const ZoneMap& zones, int column, int row, int top_after, int top) {
  Zone worst = Zone::target;
  for (int z = top_after + 1; z <= top; ++z) {
    const Zone zone = zones.zone({column, row, z});
    if (zone == Zone::target) continue;
    const bool mild = zone == Zone::leeway_sides || zone == Zone::leeway_bottom;
    if (!mild || worst == Zone::target) worst = zone;
    if (!mild) break;
  }
  return worst;
}

LeafLook look_from_above(const Section& section, const PictureSpec& spec, const Palette& colours,
                         int column, int row) {
  const int top = section.top(column, row), top_after = section.top_after(column, row);
  if (top < 0) return {};
  if (top_after < 0) return {"", colours.overcut, ""};
  LeafLook look{tissue_colour(colours, section.before.tissue({column, row, top})), "",
                shade_from_above(section, column, row)};
  if (spec.heat_percent)
    look.finding = heat_colour(heat_of_column(spec, column, row, top));
  else if (top_after < top)
    look.finding =
        finding_colour(colours, worst_zone_of_column(section.zones, column, row, top_after, top));
  return look;
}

}  // namespace

std::string section_leaves_svg(const Section& section, const PictureSpec& spec,
                               const Palette& colours) {
  Runs tissue, removed, shade;
  for (int row = 0; row < section.height(); ++row) {
    LeafLook current;
    int start = 0;
    for (int column = 0; column <= section.width(); ++column) {
      LeafLook here;
      if (column < section.width())
        here = section.from_above()
                   ? look_from_above(section, spec, colours, column, row)
                   : look_of_leaf(section, spec, colours, section.leaf(column, row));
      if (column > 0 && column < section.width() && here == current) continue;
      const int from_top = section.height() - 1 - row, run = column - start;
      if (run > 0) {
        tissue.add(current.tissue, start, from_top, run);
        removed.add(current.finding, start, from_top, run);
        shade.add(current.shade, start, from_top, run);
      }
      current = here;
      start = column;
    }
  }
  std::string svg;
  for (const auto& [fill, path] : tissue.path)
    svg += fmt::format("<path shape-rendering='crispEdges' fill='{}' d='{}'/>\n", fill, path);
  for (const auto& [fill, path] : removed.path)
    svg += fmt::format("<path shape-rendering='crispEdges' fill='{}'{} d='{}'/>\n", fill,
                       section.from_above() ? " fill-opacity='0.75'" : "", path);
  for (const auto& [opacity, path] : shade.path)
    svg += fmt::format(
        "<path shape-rendering='crispEdges' fill='#000000' fill-opacity='{}' d='{}'/>\n", opacity,
        path);
  return svg;
}

}  // namespace cavum::scenarios
