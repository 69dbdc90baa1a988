#include "ui/report/figures/section_pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "engine/base/svg.h"
#include "engine/base/text.h"
#include "scenarios/review/section.h"
#include "ui/language/say.h"

namespace cavum::report {
namespace {

constexpr double k_scale_px_per_mm = 25;
constexpr double k_min_seen_mm = 0.05;  // what is less deep does not show in a section

/// A section that could be shown, and why.
struct Wish {
  scenarios::View view;
  Vec3 through_mm;
  Message why;
  SectionOf of = SectionOf::target;
};

double at_of(scenarios::View view, Vec3 p) {
  return view == scenarios::View::mesio_distal    ? p.y
         : view == scenarios::View::bucco_lingual ? p.x
                                                  : p.z;
}

Message location_text(scenarios::View view, double at_mm) {
  constexpr double k_shown_mm = 0.005;
  const Number at = as_mm(std::fabs(at_mm) < k_shown_mm ? 0.0 : at_mm);
  return view == scenarios::View::mesio_distal    ? msg("Mesio-distal, y = {}", at)
         : view == scenarios::View::bucco_lingual ? msg("Bucco-lingual, x = {}", at)
                                                  : msg("Horizontal, z = {}", at);
}

struct Worst {
  Vec3 site_mm;
  std::size_t wall = 0;
  double mm = 0;
};
/// The place of the largest deviation of all walls; none where nothing was measured that shows.
std::optional<Worst> worst(const grading::Result& r, double grading::WallMeasures::*largest,
                           grading::Trace grading::WallMeasures::*where) {
  std::optional<Worst> w;
  for (std::size_t i = 0; i < scenarios::k_walls; ++i) {
    const grading::WallMeasures& m = r.shape.wall[i];
    if ((m.*where).tick < 0 || m.*largest < k_min_seen_mm || (w && w->mm >= m.*largest)) continue;
    w = Worst{(m.*where).site_mm, i, m.*largest};
  }
  return w;
}

/// The section in which the deviation of a wall shows.
scenarios::View view_of(std::size_t wall, scenarios::Facing facing) {
  const auto w = static_cast<scenarios::Wall>(wall);
  if (facing.lateral() && w == scenarios::Wall::floor) return scenarios::View::bucco_lingual;
  return w == scenarios::Wall::buccal || w == scenarios::Wall::lingual
             ? scenarios::View::bucco_lingual
             : scenarios::View::mesio_distal;
}
/// A place halfway through what was cut beyond a wall (`side` -1: back from the furthest place), or
/// through what was left before it (+1): a section along the wall itself shows nothing there.
Vec3 halfway(const Worst& w, scenarios::Facing facing, double side) {
  constexpr IVec3 k_out[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, -1}};
  const IVec3 out = facing.in_tooth(k_out[w.wall]);
  return w.site_mm + to_vec3(out) * (0.5 * side * w.mm);
}
scenarios::View other(scenarios::View v) {
  return v == scenarios::View::mesio_distal ? scenarios::View::bucco_lingual
                                            : scenarios::View::mesio_distal;
}

/// Where a neighbour was nicked, and where a contact that was to be opened is narrowest.
void add_compared(const grading::AdjacentMeasures& m, std::vector<Wish>& list) {
  constexpr double k_narrow_mm = 0.2;
  if (m.nick_depth_mm >= k_min_seen_mm)
    for (const scenarios::View v : {scenarios::View::mesio_distal, scenarios::View::horizontal})
      list.push_back({v, m.deepest.site_mm,
                      msg("neighbouring tooth cut, {} deep here", as_mm(m.nick_depth_mm)),
                      SectionOf::nick});
  if (m.clearance_mm && *m.clearance_mm < k_narrow_mm)
    list.push_back({scenarios::View::mesio_distal, m.clearance_from_mm,
                    msg("{} from the neighbour here", as_mm(*m.clearance_mm)), SectionOf::contact});
}

std::vector<Wish> wishes(const grading::Result& r, const grading::GradeInput& input) {
  const Vec3 low = input.zones.target_low_mm(), high = input.zones.target_high_mm(),
             middle = (low + high) * 0.5, extent = high - low;
  const Message through = msg("through the middle of the target");
  std::vector<Wish> list{{scenarios::View::mesio_distal, middle, through},
                         {scenarios::View::bucco_lingual, middle, through},
                         {scenarios::View::horizontal, middle, through}};
  const auto over =
      worst(r, &grading::WallMeasures::max_over_mm, &grading::WallMeasures::worst_over);
  const auto under =
      worst(r, &grading::WallMeasures::max_under_mm, &grading::WallMeasures::worst_under);
  const auto named = [&](bool too_much, const Worst& w) {
    const auto wall = static_cast<scenarios::Wall>(w.wall);
    const Term name{scenarios::wall_name(wall, r.shape.facing)};
    const Number far = as_mm(w.mm);
    if (wall == scenarios::Wall::floor)
      return too_much ? msg("worst overcut, {} at the {}", far, name)
                      : msg("worst undercut, {} at the {}", far, name);
    return too_much ? msg("worst overcut, {} at the wall towards {}", far, name)
                    : msg("worst undercut, {} at the wall towards {}", far, name);
  };
  if (const grading::PerforationTruth& p = r.perforation.fault; p.perforated)
    for (const scenarios::View v : {scenarios::View::mesio_distal, scenarios::View::bucco_lingual})
      list.push_back(
          {v, p.first.site_mm, msg("{} broken into here", Term{p.tissue}), SectionOf::opening});
  else
    for (const auto& e : r.perforation.events)
      if (e.fault && list.size() < 5)
        for (const scenarios::View v :
             {scenarios::View::mesio_distal, scenarios::View::bucco_lingual})
          list.push_back({v, e.site_mm, msg("breakthrough in the force here"), SectionOf::force});
  add_compared(r.beside, list);
  if (over) {
    list.push_back({view_of(over->wall, r.shape.facing), over->site_mm, named(true, *over),
                    SectionOf::overcut});
    list.push_back({other(view_of(over->wall, r.shape.facing)), halfway(*over, r.shape.facing, -1),
                    named(true, *over), SectionOf::overcut});
  }
  if (under) {
    list.push_back({view_of(under->wall, r.shape.facing), under->site_mm, named(false, *under),
                    SectionOf::undercut});
    list.push_back({other(view_of(under->wall, r.shape.facing)), halfway(*under, r.shape.facing, 1),
                    named(false, *under), SectionOf::undercut});
  }
  // what is still free shows more of the target
  for (const double share : {0.2, 0.8, 0.35, 0.65}) {
    const Number at = as_percent(100 * share);
    list.push_back({scenarios::View::horizontal, low + extent * share,
                    msg("through the target at {} of its height", at)});
    list.push_back({scenarios::View::mesio_distal, low + extent * share,
                    msg("through the target at {} of its width", at)});
    list.push_back({scenarios::View::bucco_lingual, low + extent * share,
                    msg("through the target at {} of its length", at)});
  }
  for (int i = 1; list.size() < 64; ++i)  // a target of a few leaves: beside it
    list.push_back({scenarios::View::horizontal, low - Vec3{0, 0, i * input.zones.leaf_mm()},
                    msg("below the target"), SectionOf::beside});
  return list;
}

/// Three sections through the middle of the target, moved to the place of a perforation when there
/// is one.
std::array<std::string, 3> three_sections(const grading::Result& r,
                                          const grading::GradeInput& input) {
  const Vec3 low = input.zones.target_low_mm(), high = input.zones.target_high_mm();
  const Vec3 at =
      r.perforation.fault.perforated ? r.perforation.fault.first.site_mm : (low + high) * 0.5;
  const double across = low.z + 0.35 * (high.z - low.z);
  const auto draw = [&](scenarios::View view, double at_mm) {
    return scenarios::section_svg(input.seen_before(), &input.seen_after(), input.zones,
                                  {view,
                                   at_mm,
                                   k_scale_px_per_mm,
                                   tr(location_text(view, at_mm)),
                                   input.scenario.accommodations.high_contrast,
                                   nullptr,
                                   {},
                                   tr});
  };
  return {draw(scenarios::View::mesio_distal, at.y), draw(scenarios::View::bucco_lingual, at.x),
          draw(scenarios::View::horizontal, across)};
}

/// Leaves of one section near a mistake.
struct Seen {
  int wrong = 0, cut_as_asked = 0, left_as_asked = 0;
  /// Mistake, cavity and wall together, by what there is least of; where one of them is nowhere,
  /// most of the mistake.
  [[nodiscard]] std::pair<int, int> score() const noexcept {
    return {wrong == 0 ? -1 : std::min({wrong, cut_as_asked, left_as_asked}), wrong};
  }
};

/// A ring around a leaf, in leaves of the section: two lines, so that it shows on any colour, and
/// open where it would leave the section for the words around it.
std::string ring_svg(const scenarios::Section& section, IVec3 at, double leaf_px) {
  constexpr double k_radius_px = 16, k_widest_px = 5, k_full_circle = 6.283185307179586;
  constexpr int k_corners = 48;
  const IVec3 corner = section.leaf(0, 0);
  const int across = section.leaf(1, 0).y != corner.y ? at.y - corner.y : at.x - corner.x,
            up = section.upright() ? at.z - corner.z : at.y - corner.y;
  const double half = 0.5 * k_widest_px / leaf_px, low = section.height() - half;
  std::string path;
  bool drawing = false;
  for (int i = 0; i <= k_corners; ++i) {
    const double turn = k_full_circle * i / k_corners,
                 x = across + 0.5 + k_radius_px / leaf_px * std::cos(turn),
                 y = section.height() - up - 0.5 + k_radius_px / leaf_px * std::sin(turn);
    const bool inside = y >= half && y <= low;
    if (inside) path += fmt::format("{}{} {}", drawing ? "L" : "M", fixed(x, 2), fixed(y, 2));
    drawing = inside;
  }
  std::string svg;
  for (const auto& [colour, width] : {std::pair{"#ffffff", k_widest_px}, std::pair{"#111111", 2.0}})
    svg += svg_path(path, colour, width / leaf_px, "class='ring'");
  return svg;
}

/// The number behind the first `key` of an SVG element, px.
double svg_px(const std::string& svg, const std::string& key) {
  double px = 0;
  const char* from = svg.data() + svg.find(key) + key.size();
  std::from_chars(from, svg.data() + svg.size(), px);
  return px;
}

}  // namespace

std::vector<SectionPicture> section_pictures(const grading::Result& r,
                                             const grading::GradeInput& input) {
  std::vector<SectionPicture> pictures;
  std::vector<std::pair<scenarios::View, int>> shown;  // by leaf
  const Octree& tree = input.seen_before().octree;
  for (const Wish& w : wishes(r, input)) {
    if (pictures.size() == k_report_sections) break;
    const IVec3 leaf = tree.leaf_at(w.through_mm);
    const std::pair key{w.view, w.view == scenarios::View::mesio_distal    ? leaf.y
                                : w.view == scenarios::View::bucco_lingual ? leaf.x
                                                                           : leaf.z};
    if (std::find(shown.begin(), shown.end(), key) != shown.end()) continue;
    shown.push_back(key);
    SectionPicture p{w.view, at_of(w.view, w.through_mm), "", "", w.of};
    const Message place = location_text(p.view, p.at_mm);
    p.title = tr("{}: {}", place, w.why);
    p.svg = scenarios::section_svg(input.seen_before(), &input.seen_after(), input.zones,
                                   {p.view,
                                    p.at_mm,
                                    k_scale_px_per_mm,
                                    tr(place),
                                    input.scenario.accommodations.high_contrast,
                                    nullptr,
                                    {},
                                    tr});
    pictures.push_back(std::move(p));
  }
  return pictures;
}

std::optional<SectionPicture> section_of_mistake(const grading::GradeInput& input, Vec3 place_mm) {
  constexpr double k_near_mm = 1.5, k_small_px_per_mm = 20;
  const Octree &before = input.seen_before().octree, &after = input.seen_after();
  const IVec3 at = before.leaf_at(place_mm);
  const int near = static_cast<int>(std::ceil(k_near_mm / before.leaf_mm()));
  std::array<Seen, 3> seen{};
  const auto count = [&](Seen& s, IVec3 leaf) {
    if (!before.is_solid(before.tissue(leaf))) return;
    const bool target = input.zones.zone(leaf) == scenarios::Zone::target,
               stands = after.is_solid(after.tissue(leaf));
    (stands == target ? s.wrong : target ? s.cut_as_asked : s.left_as_asked) += 1;
  };
  for (int u = -near; u <= near; ++u)
    for (int v = -near; v <= near; ++v) {
      count(seen[0], at + IVec3{u, 0, v});
      count(seen[1], at + IVec3{0, u, v});
      count(seen[2], at + IVec3{u, v, 0});
    }
  const auto best = std::max_element(
      seen.begin(), seen.end(), [](const Seen& a, const Seen& b) { return a.score() < b.score(); });
  if (best->wrong == 0) return std::nullopt;
  constexpr std::array k_views{scenarios::View::mesio_distal, scenarios::View::bucco_lingual,
                               scenarios::View::horizontal};
  const std::array titles{msg("Section from mesial to distal"),
                          msg("Section from buccal to lingual"), msg("Section across")};
  const auto which = static_cast<std::size_t>(best - seen.begin());
  SectionPicture p{k_views[which], at_of(k_views[which], place_mm), tr(titles[which]), ""};
  p.svg = scenarios::section_svg(input.seen_before(), &after, input.zones,
                                 {p.view,
                                  p.at_mm,
                                  k_small_px_per_mm,
                                  p.title,
                                  input.scenario.accommodations.high_contrast,
                                  nullptr,
                                  {},
                                  tr});
  const scenarios::Section section(before, &after, input.zones, p.view, p.at_mm);
  p.svg.insert(p.svg.rfind("</g>"), ring_svg(section, at, k_small_px_per_mm * before.leaf_mm()));
  return p;
}

std::string sections_svg(const grading::Result& r, const grading::GradeInput& input) {
  constexpr double k_margin_px = 10, k_text_px = 30;
  const auto pictures = three_sections(r, input);
  const std::string legend = scenarios::legend_svg(input.seen_before(), true,
                                                   input.scenario.accommodations.high_contrast, tr);
  double height = 0, x = k_margin_px;
  for (const auto& p : pictures) height = std::max(height, svg_px(p, "height='"));
  std::string body;
  for (const auto& p : pictures) {  // standing on one line
    body += svg_group(x, k_text_px + height - svg_px(p, "height='"), p);
    x += std::ceil(svg_px(p, "width='")) + k_margin_px;
  }
  const double width = std::max(x, svg_px(legend, "width='") + 2 * k_margin_px),
               legend_px = svg_px(legend, "height='") + 8,
               all = height + k_text_px + legend_px + k_margin_px;
  const std::string title = tr("{}: {} of the target removed", Authored{r.scenario_title},
                               as_percent(r.volumes.target_removed_percent, 1));
  return svg_root(width, all,
                  k_svg_white + svg_text(10, 20, title, 15, "start", "id='cavum-sections'") + body +
                      svg_group(k_margin_px, all - legend_px, legend));
}

}  // namespace cavum::report
