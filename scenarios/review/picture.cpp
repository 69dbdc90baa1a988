#include "scenarios/review/picture.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/svg.h"
#include "scenarios/review/contour.h"
#include "scenarios/review/picture_colours.h"
#include "scenarios/review/section.h"
#include "scenarios/review/section_leaves.h"
#include "scenarios/zones/shape.h"

namespace cavum::scenarios {
namespace {

std::string line(const std::string& path, const char* colour, double leaf_px, double width_px,
                 const char* dash) {
  return path.empty() ? ""
                      : svg_path(path, colour, width_px / leaf_px,
                                 fmt::format("stroke-linecap='round' stroke-dasharray='{}'", dash));
}

/// Of the leaves in any of these zones: it runs where the zone changes.
std::string zone_contour(const Section& section, std::initializer_list<Zone> zones) {
  return contour(section.width(), section.height(), [&](int c, int r) {
    return std::find(zones.begin(), zones.end(), section.zones.zone(section.leaf(c, r))) !=
                   zones.end()
               ? -1.0
               : 1.0;
  });
}

std::string tooth_contour(const Section& section) {
  return contour(section.width(), section.height(),
                 [&](int c, int r) { return section.adjacent_tooth(c, r) ? 1.0 : -1.0; });
}

/// By the distance, so it is smooth.
std::string target_contour(const Section& section) {
  const double half_leaf_mm = 0.5 * section.before.leaf_mm();
  return contour(section.width(), section.height(), [&](int c, int r) {
    const double d = section.zones.distance_mm(section.leaf(c, r));
    return section.air(c, r) ? std::max(d, half_leaf_mm) : d;
  });
}

std::string guard_contour(const Section& section, const Shape& guard) {
  return contour(section.width(), section.height(), [&](int c, int r) {
    const IVec3 at = section.leaf(c, r);
    return section.air(c, r) ? 1.0 : guard.distance_mm(section.before.centre_mm(at));
  });
}

/// Outlines of tooth and zones; `px` is a leaf's edge.
std::string section_lines_svg(const Section& section, const PictureSpec& spec,
                              const Palette& colours, double px) {
  std::string svg = line(tooth_contour(section), "#7a7a7a", px, 0.8, "none");
  svg += line(zone_contour(section, {Zone::target, Zone::leeway_sides, Zone::leeway_bottom,
                                     Zone::container_sides, Zone::container_bottom}),
              colours.container_line, px, colours.line_px, "none");
  svg += line(zone_contour(section, {Zone::target, Zone::leeway_sides, Zone::leeway_bottom}),
              colours.leeway_line, px, colours.line_px, "none");
  svg += line(target_contour(section), colours.target_line, px, 1.8 * colours.line_px, "none");
  if (spec.guard == nullptr || section.from_above()) return svg;
  const std::string dash = fmt::format("{} {}", svg_number(5 / px), svg_number(3 / px));
  return svg + line(guard_contour(section, *spec.guard), colours.guard_line, px,
                    1.4 * colours.line_px, dash.c_str());
}

std::string caption(double x, double y, const std::string& text, const char* anchor) {
  return svg_text(x, y, text, 11, anchor, "fill='#444444'");
}

}  // namespace

std::string section_svg(const Tooth& before, const Octree* after, const ZoneMap& zones,
                        const PictureSpec& spec) {
  const Palette& colours = spec.heat_percent ? grey_palette() : palette_of(spec.high_contrast);
  const Section section(before.octree, after, zones, spec.view, spec.at_mm);
  const double px = spec.scale_px_per_mm * before.octree.leaf_mm();
  constexpr double k_caption_px = 16, k_scale_px = 18;  // bands above and below the picture
  const double title_px = (spec.title.empty() ? 0 : 20) + k_caption_px,
               width_px = section.width() * px, height_px = section.height() * px + k_scale_px;
  std::string svg = fmt::format("<title>{}</title>\n{}", xml_text(spec.title), k_svg_white);
  if (!spec.title.empty()) svg += svg_text(4, 15, spec.title, 13, "start", "fill='#222222'");
  svg += fmt::format("<g transform='translate(0 {}) scale({})'>\n", svg_number(title_px),
                     svg_number(px));
  svg += section_leaves_svg(section, spec, colours) + section_lines_svg(section, spec, colours, px);
  svg += "</g>\n";
  // a millimetre, and which way is which
  const double bottom = height_px + title_px;
  svg += svg_line(6, bottom - 6, 6 + spec.scale_px_per_mm, bottom - 6, "#222222", 2);
  svg += caption(10 + spec.scale_px_per_mm, bottom - 3, spec.in_words(msg("{}", as_mm(1, 0))),
                 "start");
  svg += caption(
      width_px - 4, title_px - 4,
      spec.in_words(spec.view == View::bucco_lingual ? msg("buccal →") : msg("mesial →")), "end");
  svg += caption(4, title_px - 4,
                 spec.in_words(section.upright() ? msg("↑ occlusal") : msg("↑ buccal")), "start");
  return svg_root(width_px, height_px + title_px, svg);
}

std::string scenario_sheet_svg(const Scenario& scenario, const Tooth& tooth, const ZoneMap& zones,
                               InWords in_words) {
  const Vec3 middle = (zones.target_low_mm() + zones.target_high_mm()) * 0.5;
  const double low =
      zones.target_low_mm().z + 0.3 * (zones.target_high_mm().z - zones.target_low_mm().z);
  const bool strong = scenario.accommodations.high_contrast;
  ShapeMaker maker(tooth, scenario.path);
  const auto guard = scenario.zones.protected_shapes.empty()
                         ? nullptr
                         : maker.make(scenario.zones.protected_shapes);
  const PictureSpec specs[] = {
      {View::mesio_distal,
       middle.y,
       30,
       in_words(msg("mesial to distal, y = {}", as_mm(middle.y))),
       strong,
       guard.get(),
       {},
       in_words},
      {View::bucco_lingual,
       middle.x,
       30,
       in_words(msg("buccal to lingual, x = {}", as_mm(middle.x))),
       strong,
       guard.get(),
       {},
       in_words},
      {View::horizontal,
       low,
       30,
       in_words(msg("across, z = {}", as_mm(low))),
       strong,
       guard.get(),
       {},
       in_words},
      {View::occlusal, 0, 30, in_words(msg("from above")), strong, guard.get(), {}, in_words}};
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
    body += svg_group(x, row_y, svg);
    row_height = std::max(row_height, size_of(svg, "height='"));
    x += size_of(svg, "width='") + 14;
    width = std::max(width, x);
  }
  const std::string legend = legend_svg(tooth, false, strong, in_words);
  const std::string title = in_words(msg("{}: {}", Authored{scenario.title}, tooth.name));
  const double title_px = 9.0 * static_cast<double>(title.size());
  width = std::max({width, size_of(legend, "width='") + 20, title_px + 20});
  const double height = row_y + row_height + 18 + size_of(legend, "height='");
  return svg_root(width, height,
                  k_svg_white + svg_text(10, 26, title, 17, "start", "fill='#111111'") + body +
                      svg_group(10, height - 8 - size_of(legend, "height='"), legend));
}

}  // namespace cavum::scenarios
