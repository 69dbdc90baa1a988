#include "ui/station/author_zones.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "scenarios/file/bodies.h"

namespace cavum::station {
namespace {

using Spec = scenarios::ShapeSpec;

/// "target 2, box": the how-manieth of its list, and whether it is laid over or under what stands
/// before it.
Message title_of(AuthorLayer layer, std::size_t number, const scenarios::ShapeSpec& s) {
  const Term word{kind_of(s).word};
  switch (s.combine) {
    case scenarios::ShapeSpec::Combine::subtract:
      return msg("{} {}, {}, taken away", word_of(layer), number, word);
    case scenarios::ShapeSpec::Combine::intersect:
      return msg("{} {}, {}, in common", word_of(layer), number, word);
    default:
      return msg("{} {}, {}", word_of(layer), number, word);
  }
}

/// Fields that bodies, outlines and bottoms have alike.
template <class AnySpec>
struct AddShared {
  AuthorZone& zone;
  const AnySpec& s;
  std::string at;
  void operator()(const scenarios::NumberField<AnySpec>& n) const {
    if (n.label != nullptr)
      zone.numbers.push_back({msg("{}", Term{n.label}), at, s.*n.value, n.low, n.high,
                              at.ends_with("_deg") ? Unit::deg : Unit::mm});
  }
  void operator()(const scenarios::WordField<AnySpec>&) const {}
  void operator()(scenarios::TissueField) const {}
};

void add_bottom(AuthorZone& zone, const scenarios::BottomSpec& b, const std::string& at) {
  using Kind = scenarios::BottomSpec::Kind;
  for (const auto& f : kind_of(b).fields)
    std::visit(AddShared<scenarios::BottomSpec>{zone, b, fmt::format("{}/{}", at, f.key)}, f.as);
  if (b.kind != Kind::below_surface && b.kind != Kind::below_lowest && b.kind != Kind::below_mean)
    return;
  zone.depth_mm = b.depth_mm;
  zone.depth_place = at + "/depth_mm";
}

void add_outline(AuthorZone& zone, const scenarios::OutlineSpec& o, const std::string& outline) {
  for (const auto& f : kind_of(o).fields) {
    const std::string at = fmt::format("{}/{}", outline, f.key);
    std::visit(scenarios::ForEachSort{AddShared<scenarios::OutlineSpec>{zone, o, at},
                                      [&](scenarios::PointsField p) {
                                        zone.closed = p.closed;
                                        zone.least_points = p.at_least;
                                        if (!p.closed)
                                          zone.half_width_mm = 0.5 * o.width_mm + o.offset_mm;
                                        if (o.points_mm.empty()) return;
                                        zone.points_place = at;
                                        zone.points_mm = o.points_mm;
                                      },
                                      [](scenarios::CentreField) {}},
               f.as);
  }
}

void add_vector(AuthorZone& zone, Vec3 v, const std::string& at, double low,
                const std::array<Message, 3>& labels) {
  const double values[] = {v.x, v.y, v.z};
  for (std::size_t i = 0; i < 3; ++i)
    zone.numbers.push_back({labels[i], fmt::format("{}/{}", at, i), values[i], low, 100});
}

/// Where the outline's points lie, on the level of the opening. One that is seen from a side is not
/// drawn.
void add_seen(AuthorZone& zone, const Spec& s, scenarios::OutlineSeen seen, const std::string& at,
              double opening_z_mm, Vec3 chamber_mm) {
  if (seen == scenarios::OutlineSeen::from_side) return;
  add_outline(zone, s.outline, at);
  const Vec3 centre = s.outline.centre_mm;
  if (seen == scenarios::OutlineSeen::from_occlusal) {
    const Vec3 from = s.outline.from_chamber ? chamber_mm : Vec3{};
    zone.frame = {
        {from.x + centre.x, from.y + centre.y, opening_z_mm}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    return;
  }
  const scenarios::ShapeFrame f = zone.frame;
  const double up =
      f.z.z > 0.1 ? std::clamp((opening_z_mm - f.at.z) / f.z.z, 0.0, s.height_mm) : s.height_mm;
  zone.frame.at = f.at + f.z * up + f.x * centre.x + f.y * centre.y;
}

AuthorZone zone_of(const Spec& s, const std::string& body, double opening_z_mm, Vec3 chamber_mm) {
  using namespace scenarios;
  AuthorZone zone;
  zone.line = s.line;
  zone.frame = shape_frame(s);
  for (const auto& f : kind_of(s).fields) {
    const std::string at = fmt::format("{}/{}", body, f.key);
    std::visit(ForEachSort{
                   AddShared<Spec>{zone, s, at},
                   [&](PlaceField) {
                     add_vector(zone, s.at_mm, at, -100,
                                {msg("place, mesial (x)"), msg("place, buccal (y)"),
                                 msg("place, occlusal (z)")});
                   },
                   [&](SizeField) {
                     add_vector(zone, s.size_mm, at, 0.05,
                                {msg("size along x"), msg("size along y"), msg("size along z")});
                   },
                   [&](BottomField) { add_bottom(zone, s.bottom, at); },
                   [&](OutlineField o) { add_seen(zone, s, o.seen, at, opening_z_mm, chamber_mm); },
                   [](FileField) {}, [](AxisField) {}},
               f.as);
  }
  return zone;
}

AuthorZone margin_of(AuthorLayer layer, const scenarios::MarginSpec& m, const std::string& at) {
  AuthorZone zone;
  zone.layer = layer;
  zone.title = word_of(layer);
  zone.numbers = {{msg("width below"), at + "/bottom_mm", m.bottom_mm, 0, 5},
                  {msg("width beside"), at + "/sides_mm", m.sides_mm, 0, 5}};
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
  constexpr std::array<std::array<std::uint8_t, 3>, k_author_layers> k_colours{
      {{86, 190, 240}, {240, 228, 66}, {213, 94, 0}, {204, 121, 167}}};
  return k_colours[static_cast<std::size_t>(layer)];
}

std::vector<AuthorZone> author_zones(const scenarios::Scenario& scenario, double opening_z_mm,
                                     Vec3 chamber_mm) {
  std::vector<AuthorZone> zones;
  const auto bodies = [&](AuthorLayer layer, const char* key,
                          const std::vector<scenarios::ShapeSpec>& list) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      zones.push_back(
          zone_of(list[i], fmt::format("zones/{}/{}", key, i), opening_z_mm, chamber_mm));
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
