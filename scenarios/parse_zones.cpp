#include "scenarios/parse_zones.h"

#include <cmath>

namespace cavum {
namespace {

constexpr double k_largest_mm = 100.0;

TissuePart read_part(CheckedTable& t) { return t.word("part", {"all", "chamber"}, 0) == 1 ? TissuePart::chamber : TissuePart::all; }

OutlineSpec read_outline(const toml::table& table, const std::string& name, ProblemList& problems) {
  using Kind = OutlineSpec::Kind;
  CheckedTable t(table, name + " outline", problems);
  OutlineSpec o;
  const std::size_t kind = t.word("kind", {"circle", "polygon", "stroke", "projection"}, 0, true);
  if (kind == CheckedTable::k_wrong) return o;  // what else it needs depends on the kind
  o.kind = static_cast<Kind>(kind);
  o.offset_mm = t.number("offset_mm", -5, 5, 0);
  switch (o.kind) {
    case Kind::circle:
      o.radius_mm = t.number("radius_mm", 0.05, 20, 1, true);
      break;
    case Kind::polygon:
      o.points_mm = t.points("points_mm", 3, true);
      break;
    case Kind::stroke:
      o.points_mm = t.points("points_mm", 2, true);
      o.width_mm = t.number("width_mm", 0.1, 20, 1, true);
      break;
    case Kind::projection:
      o.tissue = t.text("tissue", "pulp");
      o.part = read_part(t);
      o.rounding_mm = t.number("rounding_mm", 0, 5, 0);
      break;
  }
  if (o.kind != Kind::projection) {
    o.centre_mm = t.vector("centre_mm", 2, {});
    o.from_chamber = t.word("from", {"tooth", "chamber"}, 0) == 1;
  }
  t.finish();
  return o;
}

BottomSpec read_bottom(const toml::table& table, const std::string& name, ProblemList& problems) {
  using Kind = BottomSpec::Kind;
  CheckedTable t(table, name + " bottom", problems);
  BottomSpec b;
  const std::size_t kind = t.word("kind", {"level", "below_surface", "below_lowest", "below_mean", "tissue_roof", "tissue_floor"}, 0, true);
  if (kind == CheckedTable::k_wrong) return b;
  b.kind = static_cast<Kind>(kind);
  switch (b.kind) {
    case Kind::level:
      b.z_mm = t.number("z_mm", -k_largest_mm, k_largest_mm, 0, true);
      break;
    case Kind::below_surface:
    case Kind::below_lowest:
    case Kind::below_mean:
      b.depth_mm = t.number("depth_mm", 0.05, 30, 1, true);
      break;
    default:
      b.tissue = t.text("tissue", "pulp");
      b.part = read_part(t);
      b.deeper_mm = t.number("deeper_mm", -5, 5, 0);
  }
  t.finish();
  return b;
}

ShapeSpec read_shape(const toml::table& table, const std::string& name, ProblemList& problems) {
  using Kind = ShapeSpec::Kind;
  CheckedTable t(table, name, problems);
  ShapeSpec s;
  s.line = static_cast<int>(table.source().begin.line);
  const std::size_t kind = t.word("shape", {"box", "cylinder", "cone", "ball", "prism", "column", "tissue"}, 0, true);
  const std::size_t combine = t.word("combine", {"add", "subtract", "intersect"}, 0);
  if (kind == CheckedTable::k_wrong || combine == CheckedTable::k_wrong) return s;
  s.kind = static_cast<Kind>(kind);
  s.combine = static_cast<ShapeSpec::Combine>(combine);
  const auto outline = [&] {
    if (const auto* o = t.table("outline", true)) s.outline = read_outline(*o, name, problems);
  };
  const auto pose = [&](bool turnable) {
    s.at_mm = t.vector("at_mm", 3, {}, true);
    const Vec3 axis = t.vector("axis", 3, {0, 0, 1});
    if (length(axis) < 1e-6) t.problem("axis", "'axis' has no direction", "write for example [0, 0, 1]");
    s.axis = normalized(axis);
    if (turnable) s.turn_deg = t.number("turn_deg", -360, 360, 0);
  };
  switch (s.kind) {
    case Kind::box: {
      pose(true);
      s.size_mm = t.vector("size_mm", 3, {1, 1, 1}, true);
      if (!(s.size_mm.x > 0 && s.size_mm.y > 0 && s.size_mm.z > 0)) t.problem("size_mm", "'size_mm' must be positive", "write three lengths in mm");
      break;
    }
    case Kind::cylinder:
      pose(false);
      s.radius_mm = t.number("radius_mm", 0.05, k_largest_mm, 1, true);
      s.height_mm = t.number("height_mm", 0.05, k_largest_mm, 1, true);
      break;
    case Kind::cone:
      pose(false);
      s.radius_mm = t.number("radius_mm", 0, k_largest_mm, 1, true);
      s.top_radius_mm = t.number("top_radius_mm", 0, k_largest_mm, 1, true);
      s.height_mm = t.number("height_mm", 0.05, k_largest_mm, 1, true);
      break;
    case Kind::ball:
      s.at_mm = t.vector("at_mm", 3, {}, true);
      s.radius_mm = t.number("radius_mm", 0.05, k_largest_mm, 1, true);
      break;
    case Kind::prism:
      pose(true);
      s.height_mm = t.number("height_mm", 0.05, k_largest_mm, 1, true);
      outline();
      if (s.outline.kind == OutlineSpec::Kind::projection) t.problem("outline", "a prism cannot use a projection", "use shape = \"column\"");
      break;
    case Kind::column:
      s.taper_deg = t.number("taper_deg", -30, 45, 0);
      outline();
      if (const auto* b = t.table("bottom", true)) s.bottom = read_bottom(*b, name, problems);
      break;
    case Kind::tissue:
      s.tissue = t.text("tissue", "pulp", true);
      s.part = read_part(t);
      s.offset_mm = t.number("offset_mm", -5, 5, 0);
      break;
  }
  t.finish();
  return s;
}

std::vector<ShapeSpec> read_shapes(CheckedTable& zones, const char* key, bool required, ProblemList& problems) {
  std::vector<ShapeSpec> list;
  for (const auto* table : zones.tables(key, required)) {
    list.push_back(read_shape(*table, std::string("[[zones.") + key + "]]", problems));
    if (list.size() == 1 && list[0].combine != ShapeSpec::Combine::add)
      problems.add(table->source(), "the first shape of a zone must be added", "take out 'combine' or put another shape first");
  }
  return list;
}

MarginSpec read_margin(CheckedTable& zones, const char* key, ProblemList& problems) {
  MarginSpec m;
  if (const auto* table = zones.table(key, true)) {
    CheckedTable t(*table, std::string("[zones.") + key + "]", problems);
    m.sides_mm = t.number("sides_mm", 0, 5, 0, true);
    m.bottom_mm = t.number("bottom_mm", 0, 5, 0, true);
    t.finish();
  }
  return m;
}

}  // namespace

ZoneSpec read_zones(const toml::table& table, ProblemList& problems) {
  CheckedTable t(table, "[zones]", problems);
  ZoneSpec z;
  z.target = read_shapes(t, "target", true, problems);
  z.leeway = read_margin(t, "leeway", problems);
  z.container = read_margin(t, "container", problems);
  if (t.has("leeway") && t.has("container") && (z.container.sides_mm < z.leeway.sides_mm || z.container.bottom_mm < z.leeway.bottom_mm))
    t.problem("container", "the container is narrower than the leeway", "make it at least as wide: it is measured from the target too");
  z.protected_shapes = read_shapes(t, "protected", false, problems);
  t.finish();
  return z;
}

}  // namespace cavum
