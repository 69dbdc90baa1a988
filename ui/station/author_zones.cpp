#include "ui/station/author_zones.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace cavum::station {
namespace {

using Spec = scenarios::ShapeSpec;
using Kind = Spec::Kind;

Term shape_word(Kind kind) {
  constexpr const char* k_words[] = {said("box"),
                                     said("cylinder"),
                                     said("cone"),
                                     said("ball"),
                                     said("prism"),
                                     said("column"),
                                     said("tissue"),
                                     said("STL file"),
                                     said("canal cone"),
                                     said("proximal box"),
                                     said("cavity in a side"),
                                     said("crown")};
  return {k_words[static_cast<std::size_t>(kind)]};
}

/// Numbers of a shape beside those of its outline and bottom.
struct ShapeNumber {
  Kind kind;
  const char *label, *key;
  double Spec::*value;
  double low, high;
  Unit unit = Unit::mm;
};
constexpr ShapeNumber k_numbers[] = {
    {Kind::column, said("taper of the walls"), "taper_deg", &Spec::taper_deg, -30, 45, Unit::deg},
    {Kind::proximal_box, said("width"), "width_mm", &Spec::width_mm, 0.5, 10},
    {Kind::proximal_box, said("axial depth"), "depth_mm", &Spec::depth_mm, 0.2, 5},
    {Kind::proximal_box, said("floor above the neck"), "above_neck_mm", &Spec::above_neck_mm, 0, 6},
    {Kind::side_cavity, said("depth below the surface"), "depth_mm", &Spec::depth_mm, 0.1, 5},
    {Kind::crown, said("finish line above the neck"), "above_neck_mm", &Spec::above_neck_mm, 0, 4},
    {Kind::crown, said("depth of the chamfer"), "depth_mm", &Spec::depth_mm, 0.3, 3},
    {Kind::crown, said("taper of each wall"), "taper_deg", &Spec::taper_deg, 0, 20, Unit::deg},
    {Kind::crown, said("occlusal reduction"), "occlusal_mm", &Spec::occlusal_mm, 0.3, 4},
    {Kind::cylinder, said("height"), "height_mm", &Spec::height_mm, 0.05, 100},
    {Kind::cylinder, said("radius"), "radius_mm", &Spec::radius_mm, 0.05, 100},
    {Kind::cone, said("height"), "height_mm", &Spec::height_mm, 0.05, 100},
    {Kind::cone, said("radius below"), "radius_mm", &Spec::radius_mm, 0, 100},
    {Kind::cone, said("radius above"), "top_radius_mm", &Spec::top_radius_mm, 0, 100},
    {Kind::ball, said("radius"), "radius_mm", &Spec::radius_mm, 0.05, 100},
    {Kind::tissue, said("grown by"), "offset_mm", &Spec::offset_mm, -5, 5},
    {Kind::canal_cone, said("begins below the mouth by"), "deeper_mm", &Spec::deeper_mm, -5, 5},
    {Kind::canal_cone, said("taper"), "taper_deg", &Spec::taper_deg, 0, 45, Unit::deg},
};

/// "target 2, box": the how-manieth of its list, and whether it is laid over or under what stands before it.
Message title_of(AuthorLayer layer, std::size_t number, const scenarios::ShapeSpec& s) {
  switch (s.combine) {
    case scenarios::ShapeSpec::Combine::subtract:
      return msg("{} {}, {}, taken away", word_of(layer), number, shape_word(s.kind));
    case scenarios::ShapeSpec::Combine::intersect:
      return msg("{} {}, {}, in common", word_of(layer), number, shape_word(s.kind));
    default:
      return msg("{} {}, {}", word_of(layer), number, shape_word(s.kind));
  }
}

void add_bottom(AuthorZone& zone, const scenarios::BottomSpec& b, const std::string& at) {
  switch (b.kind) {
    case scenarios::BottomSpec::Kind::below_border:
      zone.numbers.push_back({msg("deeper than the enamel"), at + "/depth_mm", b.depth_mm, -5, 5});
      break;
    case scenarios::BottomSpec::Kind::level:
      zone.numbers.push_back({msg("level of the floor, z"), at + "/z_mm", b.z_mm, -100, 100});
      break;
    case scenarios::BottomSpec::Kind::below_surface:
    case scenarios::BottomSpec::Kind::below_lowest:
    case scenarios::BottomSpec::Kind::below_mean:
      zone.numbers.push_back({msg("depth"), at + "/depth_mm", b.depth_mm, 0.05, 30});
      zone.depth_mm = b.depth_mm;
      zone.depth_place = at + "/depth_mm";
      break;
    default:
      zone.numbers.push_back({msg("floor deeper than the {}'s", Term{b.tissue}), at + "/deeper_mm", b.deeper_mm, -5, 5});
  }
}

void add_outline(AuthorZone& zone, const scenarios::OutlineSpec& o, const std::string& at) {
  switch (o.kind) {
    case scenarios::OutlineSpec::Kind::circle:
      zone.numbers.push_back({msg("radius"), at + "/radius_mm", o.radius_mm, 0.05, 20});
      break;
    case scenarios::OutlineSpec::Kind::stroke:
      zone.numbers.push_back({msg("width"), at + "/width_mm", o.width_mm, 0.1, 20});
      zone.half_width_mm = 0.5 * o.width_mm + o.offset_mm;
      break;
    case scenarios::OutlineSpec::Kind::polygon:
      zone.closed = true;
      zone.least_points = 3;
      break;
    case scenarios::OutlineSpec::Kind::fissure:
      zone.numbers.push_back({msg("width"), at + "/width_mm", o.width_mm, 0.1, 5});
      zone.numbers.push_back({msg("ridges left"), at + "/ridge_mm", o.ridge_mm, 0, 5});
      break;
    case scenarios::OutlineSpec::Kind::projection:
      zone.numbers.push_back({msg("rounding"), at + "/rounding_mm", o.rounding_mm, 0, 5});
      break;
  }
  zone.numbers.push_back({msg("outline wider by"), at + "/offset_mm", o.offset_mm, -5, 5});
  if (o.points_mm.empty()) return;
  zone.points_place = at + "/points_mm";
  zone.points_mm = o.points_mm;
}

AuthorZone zone_of(const Spec& s, const std::string& at, double opening_z_mm, Vec3 chamber_mm) {
  AuthorZone zone;
  zone.line = s.line;
  zone.frame = scenarios::shape_frame(s);
  if (s.kind == Kind::column) {
    add_bottom(zone, s.bottom, at + "/bottom");
    add_outline(zone, s.outline, at + "/outline");
    const Vec3 from = s.outline.from_chamber ? chamber_mm : Vec3{};
    zone.frame = {{from.x + s.outline.centre_mm.x, from.y + s.outline.centre_mm.y, opening_z_mm}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  } else if (s.kind == Kind::prism) {
    zone.numbers.push_back({msg("height"), at + "/height_mm", s.height_mm, 0.05, 100});
    add_outline(zone, s.outline, at + "/outline");
    const scenarios::ShapeFrame f = zone.frame;
    const double up = f.z.z > 0.1 ? std::clamp((opening_z_mm - f.at.z) / f.z.z, 0.0, s.height_mm) : s.height_mm;
    zone.frame.at = f.at + f.z * up + f.x * s.outline.centre_mm.x + f.y * s.outline.centre_mm.y;
  } else if (s.kind == Kind::box) {
    zone.numbers.push_back({msg("size along x"), at + "/size_mm/0", s.size_mm.x, 0.05, 100});
    zone.numbers.push_back({msg("size along y"), at + "/size_mm/1", s.size_mm.y, 0.05, 100});
    zone.numbers.push_back({msg("size along z"), at + "/size_mm/2", s.size_mm.z, 0.05, 100});
  }
  for (const ShapeNumber& n : k_numbers)
    if (n.kind == s.kind) zone.numbers.push_back({msg("{}", Term{n.label}), fmt::format("{}/{}", at, n.key), s.*n.value, n.low, n.high, n.unit});
  if (s.kind == Kind::box || s.kind == Kind::cylinder || s.kind == Kind::cone || s.kind == Kind::ball || s.kind == Kind::prism) {
    zone.numbers.push_back({msg("place, mesial (x)"), at + "/at_mm/0", s.at_mm.x, -100, 100});
    zone.numbers.push_back({msg("place, buccal (y)"), at + "/at_mm/1", s.at_mm.y, -100, 100});
    zone.numbers.push_back({msg("place, occlusal (z)"), at + "/at_mm/2", s.at_mm.z, -100, 100});
  }
  return zone;
}

AuthorZone margin_of(AuthorLayer layer, const scenarios::MarginSpec& m, const std::string& at) {
  AuthorZone zone;
  zone.layer = layer;
  zone.title = word_of(layer);
  zone.numbers = {{msg("width below"), at + "/bottom_mm", m.bottom_mm, 0, 5}, {msg("width beside"), at + "/sides_mm", m.sides_mm, 0, 5}};
  return zone;
}

}  // namespace

Message word_of(AuthorLayer layer) {
  switch (layer) {
    case AuthorLayer::target:
      return msg("target");
    case AuthorLayer::leeway:
      return msg("leeway");
    case AuthorLayer::container:
      return msg("container");
    case AuthorLayer::guarded:
      break;
  }
  return msg("protected");
}

std::array<std::uint8_t, 3> layer_colour(AuthorLayer layer) noexcept {
  constexpr std::array<std::array<std::uint8_t, 3>, k_author_layers> k_colours{{{86, 190, 240}, {240, 228, 66}, {213, 94, 0}, {204, 121, 167}}};
  return k_colours[static_cast<std::size_t>(layer)];
}

std::vector<AuthorZone> author_zones(const scenarios::Scenario& scenario, double opening_z_mm, Vec3 chamber_mm) {
  std::vector<AuthorZone> zones;
  const auto bodies = [&](AuthorLayer layer, const char* key, const std::vector<scenarios::ShapeSpec>& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      zones.push_back(zone_of(list[i], fmt::format("zones/{}/{}", key, i), opening_z_mm, chamber_mm));
      AuthorZone& zone = zones.back();
      zone.layer = layer;
      zone.title = title_of(layer, i + 1, list[i]);
    }
  };
  bodies(AuthorLayer::target, "target", scenario.zones.target);
  zones.push_back(margin_of(AuthorLayer::leeway, scenario.zones.leeway, "zones/leeway"));
  zones.push_back(margin_of(AuthorLayer::container, scenario.zones.container, "zones/container"));
  bodies(AuthorLayer::guarded, "protected", scenario.zones.protected_shapes);
  return zones;
}

}  // namespace cavum::station
