#include "scenarios/review/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "scenarios/review/picture_colours.h"
#include "scenarios/zones/relief.h"
#include "scenarios/zones/shape.h"

namespace cavum {
namespace {

/// The window of a picture, in leaves, and how it turns into three dimensions.
struct Window {
  View view;
  IVec3 low, high;  // of the tooth
  int depth = 0;    // leaf along the axis looked at
  int width = 0, height = 0;

  [[nodiscard]] IVec3 leaf(int column, int row) const {  // row counts upwards
    switch (view) {
      case View::mesio_distal:
        return {low.x + column, depth, low.z + row};
      case View::bucco_lingual:
        return {depth, low.y + column, low.z + row};
      default:
        return {low.x + column, low.y + row, depth};
    }
  }
};

/// Leaves of one colour as one path of runs.
struct Runs {
  std::map<std::string, std::string> path;  // by fill
  void add(const std::string& fill, int column, int row_from_top, int n) {
    path[fill] += "M" + std::to_string(column) + " " + std::to_string(row_from_top) + "h" + std::to_string(n) + "v1h-" + std::to_string(n) + "z";
  }
};

/// Where a field on the window's leaf centres crosses a level: marching squares, in leaf units, y down.
template <class Field>
std::string contour(int width, int height, const Field& field, double level) {
  std::string path;
  const auto segment = [&](double ax, double ay, double bx, double by) {
    path += "M" + svg_number(ax + 0.5) + " " + svg_number(height - ay - 0.5) + "L" + svg_number(bx + 0.5) + " " + svg_number(height - by - 0.5);
  };
  std::vector<double> now(static_cast<std::size_t>(width)), next(static_cast<std::size_t>(width));
  for (int x = 0; x < width; ++x) next[static_cast<std::size_t>(x)] = field(x, 0) - level;
  for (int y = 0; y + 1 < height; ++y) {
    now.swap(next);
    for (int x = 0; x < width; ++x) next[static_cast<std::size_t>(x)] = field(x, y + 1) - level;
    for (int x = 0; x + 1 < width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      const double a = now[i], b = now[i + 1], c = next[i + 1], d = next[i];
      std::array<std::pair<double, double>, 4> at;
      int n = 0;
      const auto cross = [&](double p, double q, double px, double py, double qx, double qy) {
        if ((p < 0) == (q < 0)) return;
        const double t = p / (p - q);
        at[static_cast<std::size_t>(n++)] = {px + t * (qx - px), py + t * (qy - py)};
      };
      cross(a, b, x, y, x + 1, y);
      cross(b, c, x + 1, y, x + 1, y + 1);
      cross(c, d, x + 1, y + 1, x, y + 1);
      cross(d, a, x, y + 1, x, y);
      for (int k = 0; k + 1 < n; k += 2)
        segment(at[static_cast<std::size_t>(k)].first, at[static_cast<std::size_t>(k)].second, at[static_cast<std::size_t>(k + 1)].first,
                at[static_cast<std::size_t>(k + 1)].second);
    }
  }
  return path;
}

std::string line(const std::string& path, const char* colour, double leaf_px, double width_px, const char* dash) {
  if (path.empty()) return "";
  return "<path fill='none' stroke='" + std::string(colour) + "' stroke-width='" + svg_number(width_px / leaf_px) + "' stroke-linecap='round'" +
         (dash[0] != 0 ? " stroke-dasharray='" + std::string(dash) + "'" : "") + " d='" + path + "'/>\n";
}

/// Highest leaf of a column with tissue that is not periodontium; -1 without.
int top_of(const Octree& tree, int x, int y) {
  for (int z = tree.size().z - 1; z >= 0; --z) {
    const auto t = tree.tissue({x, y, z});
    if (t != k_air && t != k_periodontium) return z;
  }
  return -1;
}

}  // namespace

std::string section_svg(const Tooth& before, const Octree* after, const ZoneMap& zones, const PictureSpec& spec) {
  const Palette& colours = spec.heat_percent ? grey_palette() : palette_of(spec.high_contrast);
  const Octree& tree = before.octree;
  const double leaf = tree.leaf_mm();
  Window w{spec.view, {0, 0, 0}, tree.size(), 0, 0, 0};
  // the crown and what lies around the target; the tips of the roots are not needed
  w.low.z = std::max(0, tree.leaf_at(zones.target_low_mm() - Vec3{0, 0, 4.0}).z);
  constexpr double k_above_mm = 0.4;  // over the crown's highest place
  int crown = 0;
  tree.for_each_cube([&](IVec3 at, int edge, std::uint8_t) { crown = std::max(crown, at.z + edge); });
  const int over_target = tree.leaf_at(zones.target_high_mm() + Vec3{0, 0, 0.8}).z + 1;
  w.high.z = std::min(w.high.z, std::max(over_target, crown + static_cast<int>(k_above_mm / leaf)));
  const int below_target = w.low.z;
  const IVec3 probe = tree.leaf_at({spec.at_mm, spec.at_mm, spec.at_mm});
  w.depth = spec.view == View::mesio_distal ? probe.y : spec.view == View::bucco_lingual ? probe.x : probe.z;
  // nor is a channel cut off that was drilled deeper
  const bool upright = spec.view == View::mesio_distal || spec.view == View::bucco_lingual;
  const int across = spec.view == View::bucco_lingual ? w.high.y : w.high.x;
  const auto drilled = [&](int z) {
    for (int i = 0; i < across; ++i) {
      const IVec3 at = spec.view == View::bucco_lingual ? IVec3{w.depth, i, z} : IVec3{i, w.depth, z};
      if (tree.tissue(at) != k_air && after->tissue(at) == k_air) return true;
    }
    return false;
  };
  constexpr double k_room_mm = 0.6;  // below it
  for (int z = 0; after != nullptr && upright && z < below_target + static_cast<int>(k_room_mm / leaf); ++z)
    if (drilled(z)) {
      w.low.z = std::clamp(z - static_cast<int>(k_room_mm / leaf), 0, below_target);
      break;
    }
  w.width = spec.view == View::bucco_lingual ? w.high.y - w.low.y : w.high.x - w.low.x;
  w.height = spec.view == View::mesio_distal || spec.view == View::bucco_lingual ? w.high.z - w.low.z : w.high.y - w.low.y;

  const double px = spec.scale_px_per_mm * leaf;
  constexpr double k_caption_px = 16, k_scale_px = 18;  // bands above and below the picture
  const double title_px = (spec.title.empty() ? 0 : 20) + k_caption_px, width_px = w.width * px, height_px = w.height * px + k_scale_px;
  std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='" + svg_number(width_px) + "' height='" + svg_number(height_px + title_px) +
                    "' viewBox='0 0 " + svg_number(width_px) + " " + svg_number(height_px + title_px) + "' font-family='sans-serif'>\n<title>" +
                    xml_text(spec.title) + "</title>\n" + "<rect width='100%' height='100%' fill='#ffffff'/>\n";
  if (!spec.title.empty()) svg += "<text x='4' y='15' font-size='13' fill='#222222'>" + xml_text(spec.title) + "</text>\n";
  svg += "<g transform='translate(0 " + svg_number(title_px) + ") scale(" + svg_number(px) + ")'>\n";

  // For the view from above each column shows its highest leaf.
  std::vector<int> top, top_after;
  const auto flat = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(w.width) + static_cast<std::size_t>(column);
  };
  if (spec.view == View::occlusal)
    for (int row = 0; row < w.height; ++row)
      for (int column = 0; column < w.width; ++column) {
        top.push_back(top_of(tree, column, row));
        top_after.push_back(after != nullptr ? top_of(*after, column, row) : top.back());
      }
  Runs tissue, removed, shade;
  const auto look = [&](int column, int row) -> std::array<std::string, 3> {  // tissue, finding, shade
    if (spec.view == View::occlusal) {
      const auto i = flat(column, row);
      if (top[i] < 0) return {};
      // slopes facing away from the light at the upper left are darkened: the fissures show
      const auto height = [&](int c, int r) {
        const int z = top_after[flat(std::clamp(c, 0, w.width - 1), std::clamp(r, 0, w.height - 1))];
        return z < 0 ? top_after[i] : z;
      };
      const int slope = height(column + 3, row - 3) - height(column - 3, row + 3);
      std::string dark = slope < -5 ? "#000000;0.24" : slope < -2 ? "#000000;0.14" : slope < 0 ? "#000000;0.07" : "";
      if (top_after[i] < 0) return {"", colours.overcut, ""};
      if (spec.heat_percent) {
        double over = 0, left = 0;
        for (int z = top[i]; z >= 0; --z) {
          const double heat = spec.heat_percent({column, row, z});
          over = std::max(over, heat);
          left = std::min(left, heat);
        }
        return {tissue_colour(colours, tree.tissue({column, row, top[i]})), heat_colour(over >= k_least_heat_percent ? over : left), dark};
      }
      std::string found;
      if (top_after[i] < top[i]) {
        Zone worst = Zone::target;  // of the removed leaves of this column
        for (int z = top_after[i] + 1; z <= top[i]; ++z) {
          const Zone zone = zones.zone({column, row, z});
          if (zone == Zone::target) continue;
          const bool mild = zone == Zone::leeway_sides || zone == Zone::leeway_bottom;
          if (!mild || worst == Zone::target) worst = zone;
          if (!mild) break;
        }
        found = finding_colour(colours, worst);
      }
      return {tissue_colour(colours, tree.tissue({column, row, top[i]})), found, dark};
    }
    const IVec3 at = w.leaf(column, row);
    const auto t = tree.tissue(at);
    if (t == k_air) return {};
    if (after != nullptr && after->tissue(at) == k_air) return {"", finding_colour(colours, zones.zone(at)), ""};
    if (spec.heat_percent) return {tissue_colour(colours, t), heat_colour(spec.heat_percent(at)), ""};
    return {tissue_colour(colours, t), "", ""};
  };
  for (int row = 0; row < w.height; ++row) {
    std::array<std::string, 3> current;
    int start = 0;
    for (int column = 0; column <= w.width; ++column) {
      const auto here = column < w.width ? look(column, row) : std::array<std::string, 3>{};
      if (column > 0 && column < w.width && here == current) continue;
      if (column > 0) {
        const int from_top = w.height - 1 - row;
        if (!current[0].empty()) tissue.add(current[0], start, from_top, column - start);
        if (!current[1].empty()) removed.add(current[1], start, from_top, column - start);
        if (!current[2].empty()) shade.add(current[2], start, from_top, column - start);
      }
      current = here;
      start = column;
    }
  }
  for (const auto& [fill, path] : tissue.path) svg += "<path shape-rendering='crispEdges' fill='" + fill + "' d='" + path + "'/>\n";
  for (const auto& [fill, path] : removed.path)
    svg += "<path shape-rendering='crispEdges' fill='" + fill + "'" + (spec.view == View::occlusal ? " fill-opacity='0.75'" : "") + " d='" + path +
           "'/>\n";
  for (const auto& [fill, path] : shade.path)
    svg += "<path shape-rendering='crispEdges' fill='" + fill.substr(0, 7) + "' fill-opacity='" + fill.substr(8) + "' d='" + path + "'/>\n";

  // outlines of tooth and zones
  const auto solid = [&](int c, int r) {
    if (spec.view == View::occlusal) return top[flat(c, r)] >= 0 ? -1.0 : 1.0;
    const auto t = tree.tissue(w.leaf(c, r));
    return t != k_air && t != k_periodontium ? -1.0 : 1.0;
  };
  svg += line(contour(w.width, w.height, solid, 0.0), "#7a7a7a", px, 0.8, "");
  const auto place = [&](int c, int r) {
    IVec3 at = w.leaf(c, r);
    if (spec.view == View::occlusal) at.z = std::max(top[flat(c, r)], 0);
    return at;
  };
  const auto distance = [&](int c, int r) {
    const IVec3 at = place(c, r);
    const bool air = spec.view == View::occlusal ? top[flat(c, r)] < 0 : tree.tissue(at) == k_air;
    return air ? std::max(zones.distance_mm(at), 0.5 * leaf) : zones.distance_mm(at);
  };
  // leeway and container end where the zone changes; the target's own line is smooth
  const auto in_zones = [&](std::initializer_list<Zone> list) {
    return [&, list = std::vector<Zone>(list)](int c, int r) {
      const Zone z = zones.zone(place(c, r));
      return std::find(list.begin(), list.end(), z) != list.end() ? -1.0 : 1.0;
    };
  };
  svg += line(contour(w.width, w.height,
                      in_zones({Zone::target, Zone::leeway_sides, Zone::leeway_bottom, Zone::container_sides, Zone::container_bottom}), 0.0),
              colours.container_line, px, colours.line_px, "");
  svg += line(contour(w.width, w.height, in_zones({Zone::target, Zone::leeway_sides, Zone::leeway_bottom}), 0.0), colours.leeway_line, px,
              colours.line_px, "");
  svg += line(contour(w.width, w.height, distance, 0.0), colours.target_line, px, 1.8 * colours.line_px, "");
  if (spec.guard != nullptr && spec.view != View::occlusal) {
    const auto guarded = [&](int c, int r) {
      const IVec3 at = w.leaf(c, r);
      return tree.tissue(at) == k_air ? 1.0 : spec.guard->distance_mm(tree.centre_mm(at));
    };
    const std::string dash = svg_number(5 / px) + " " + svg_number(3 / px);
    svg += line(contour(w.width, w.height, guarded, 0.0), colours.guard_line, px, 1.4 * colours.line_px, dash.c_str());
  }
  svg += "</g>\n";
  // a millimetre, and which way is which
  const auto caption = [&](double x, double y, const std::string& text, const char* anchor) {
    svg +=
        "<text x='" + svg_number(x) + "' y='" + svg_number(y) + "' font-size='11' fill='#444444' text-anchor='" + anchor + "'>" + text + "</text>\n";
  };
  const double bottom = height_px + title_px;
  svg += "<path d='M6 " + svg_number(bottom - 6) + "h" + svg_number(spec.scale_px_per_mm) + "' stroke='#222222' stroke-width='2'/>\n";
  caption(10 + spec.scale_px_per_mm, bottom - 3, "1 mm", "start");
  const bool from_side = spec.view == View::mesio_distal || spec.view == View::bucco_lingual;
  caption(width_px - 4, title_px - 4, spec.view == View::bucco_lingual ? "buccal &#8594;" : "mesial &#8594;", "end");
  caption(4, title_px - 4, from_side ? "&#8593; occlusal" : "&#8593; buccal", "start");
  svg += "</svg>\n";
  return svg;
}

std::string scenario_sheet_svg(const Scenario& scenario, const Tooth& tooth, const ZoneMap& zones) {
  const Vec3 middle = (zones.target_low_mm() + zones.target_high_mm()) * 0.5;
  const double low = zones.target_low_mm().z + 0.3 * (zones.target_high_mm().z - zones.target_low_mm().z);
  const bool strong = scenario.accommodations.high_contrast;
  ShapeMaker maker(tooth, scenario.path);
  const auto guard = scenario.zones.protected_shapes.empty() ? nullptr : maker.make(scenario.zones.protected_shapes);
  const PictureSpec specs[] = {
      {View::mesio_distal, middle.y, 30, "section mesial-distal, y = " + svg_number(middle.y) + " mm", strong, guard.get()},
      {View::bucco_lingual, middle.x, 30, "section buccal-lingual, x = " + svg_number(middle.x) + " mm", strong, guard.get()},
      {View::horizontal, low, 30, "section across, z = " + svg_number(low) + " mm", strong, guard.get()},
      {View::occlusal, 0, 30, "from above", strong, guard.get()}};
  const auto size_of = [](const std::string& svg, const char* key) {
    const auto at = svg.find(key);
    return std::stod(svg.substr(at + std::string(key).size()));
  };
  double row_y = 40, row_height = 0, x = 10, width = 0;
  std::string body;
  for (int i = 0; i < 4; ++i) {
    if (i == 2) {
      row_y += row_height + 14;
      row_height = 0;
      x = 10;
    }
    const std::string svg = section_svg(tooth, nullptr, zones, specs[i]);
    body += "<g transform='translate(" + svg_number(x) + " " + svg_number(row_y) + ")'>" + svg + "</g>\n";
    row_height = std::max(row_height, size_of(svg, "height='"));
    x += size_of(svg, "width='") + 14;
    width = std::max(width, x);
  }
  const std::string legend = legend_svg(false, strong);
  const double title_px = 9.0 * static_cast<double>(scenario.title.size() + tooth.name.size() + 2);
  width = std::max({width, size_of(legend, "width='") + 20, title_px + 20});
  const double height = row_y + row_height + 40;
  return "<svg xmlns='http://www.w3.org/2000/svg' width='" + svg_number(width) + "' height='" + svg_number(height) + "' font-family='sans-serif'>\n" +
         "<rect width='100%' height='100%' fill='#ffffff'/>\n<text x='10' y='26' font-size='17' fill='#111111'>" +
         xml_text(scenario.title + ": " + tooth.name) + "</text>\n" + body + "<g transform='translate(10 " + svg_number(height - 30) + ")'>" +
         legend + "</g>\n</svg>\n";
}

}  // namespace cavum
