#include "scenarios/file/parse_zones.h"

#include <fmt/core.h>

#include <cmath>

#include "scenarios/file/bodies.h"

namespace cavum::scenarios {
namespace {

constexpr std::size_t k_max_bodies = 12;  // of all zones

using Places = std::map<std::string, Place>;

/// True when two sides of a closed polygon meet anywhere but at their common corner.
bool crosses_itself(const std::vector<Vec3>& p) {
  const std::size_t n = p.size();
  const auto side = [](Vec3 a, Vec3 b, Vec3 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      const Vec3 a = p[i], b = p[(i + 1) % n], c = p[j], d = p[(j + 1) % n];
      const double one = side(a, b, c), two = side(a, b, d), three = side(c, d, a),
                   four = side(c, d, b);
      if (((one > 0) != (two > 0)) && ((three > 0) != (four > 0))) return true;
    }
  return false;
}

double area_mm2(const std::vector<Vec3>& p) {
  double twice = 0;
  for (std::size_t i = 0, j = p.size() - 1; i < p.size(); j = i++)
    twice += p[j].x * p[i].y - p[i].x * p[j].y;
  return std::fabs(0.5 * twice);
}

/// Outlines that are none.
void check_outline(CheckedTable& t, const OutlineSpec& o) {
  using Kind = OutlineSpec::Kind;
  if ((o.kind == Kind::circle && o.radius_mm + o.offset_mm <= 0) ||
      ((o.kind == Kind::stroke || o.kind == Kind::fissure) && 0.5 * o.width_mm + o.offset_mm <= 0))
    t.problem("offset_mm", msg("'offset_mm' leaves nothing of the outline"),
              msg("move it inwards by less than half its width"), Mistake::outline);
  if (o.kind != Kind::polygon || o.points_mm.size() < 3) return;
  if (crosses_itself(o.points_mm))
    t.problem("points_mm", msg("the polygon crosses itself"),
              msg("list its corners in their order around the outline"), Mistake::outline);
  else if (area_mm2(o.points_mm) < 0.01)
    t.problem("points_mm", msg("the polygon encloses nothing"),
              msg("give corners that do not lie on one line"), Mistake::outline);
}

/// Fields that bodies, outlines and bottoms have alike.
template <class Spec>
struct ReadShared {
  CheckedTable& t;
  Spec& s;
  const char* key;
  bool required;
  void operator()(const NumberField<Spec>& n) const {
    s.*n.value = t.number(key, n.low, n.high, n.otherwise, required);
  }
  void operator()(const WordField<Spec>& w) const {
    if (const std::size_t i = t.word(key, w.words, 0, required); i != CheckedTable::k_wrong)
      w.choose(s, i);
  }
  void operator()(TissueField) const { s.tissue = t.text(key, "pulp", required); }
};

OutlineSpec read_outline(const toml::table& table, const std::string& name, ProblemList& problems) {
  CheckedTable t(table, name + " outline", problems);
  OutlineSpec o;
  const std::size_t kind = t.word("kind", names_of(outline_kinds()), 0, true);
  if (kind == CheckedTable::k_wrong) return o;  // what else it needs depends on the kind
  o.kind = static_cast<OutlineSpec::Kind>(kind);
  for (const auto& f : kind_of(o).fields)
    std::visit(
        ForEachSort{ReadShared<OutlineSpec>{t, o, f.key, f.required},
                    [&](PointsField p) { o.points_mm = t.points(f.key, p.at_least, f.required); },
                    [&](CentreField) { o.centre_mm = t.vector(f.key, 2, {}, f.required); }},
        f.as);
  check_outline(t, o);
  t.finish();
  return o;
}

BottomSpec read_bottom(const toml::table& table, const std::string& name, ProblemList& problems) {
  CheckedTable t(table, name + " bottom", problems);
  BottomSpec b;
  const std::size_t kind = t.word("kind", names_of(bottom_kinds()), 0, true);
  if (kind == CheckedTable::k_wrong) return b;
  b.kind = static_cast<BottomSpec::Kind>(kind);
  for (const auto& f : kind_of(b).fields)
    std::visit(ReadShared<BottomSpec>{t, b, f.key, f.required}, f.as);
  t.finish();
  return b;
}

void read_axis(CheckedTable& t, ShapeSpec& s) {
  const Vec3 along = t.vector("axis", 3, {0, 0, 1});
  if (length(along) < 1e-6)
    t.problem("axis", msg("'axis' has no direction"), msg("write for example [0, 0, 1]"),
              Mistake::wrong_type);
  s.axis = normalized(along);
}

void read_size(CheckedTable& t, ShapeSpec& s) {
  s.size_mm = t.vector("size_mm", 3, {1, 1, 1}, true);
  if (!(s.size_mm.x > 0 && s.size_mm.y > 0 && s.size_mm.z > 0))
    t.problem("size_mm", msg("'size_mm' must be positive"), msg("write three lengths in mm"),
              Mistake::out_of_range);
}

void read_surface_name(CheckedTable& t, ShapeSpec& s) {
  s.file = t.text("file", "", true);
  const bool named = s.file.ends_with(".stl") || s.file.ends_with(".STL");
  if (!s.file.empty() && !named)
    t.problem("file", msg("'file' is no STL file"),
              msg("name a closed surface in mm, in the tooth's frame, ending in .stl"),
              Mistake::surface);
}

/// An outline that is not seen from occlusal is drawn.
void check_seen(CheckedTable& t, const OutlineSpec& o, OutlineSeen seen) {
  const bool follows =
      o.kind == OutlineSpec::Kind::projection || o.kind == OutlineSpec::Kind::fissure;
  if (seen == OutlineSeen::along_axis && follows)
    t.problem("outline", msg("a prism cannot follow a tissue or a fissure"),
              msg("use shape = \"column\""), Mistake::contradictory);
  if (seen == OutlineSeen::from_side && (follows || o.from_chamber))
    t.problem("outline", msg("a cavity in a side has an outline of its own"),
              msg("use a circle, a polygon or a stroke, counted from the neck's middle"),
              Mistake::contradictory);
}

void check_lean(CheckedTable& t, const ShapeSpec& s) {
  const bool follows = s.outline.kind == OutlineSpec::Kind::projection &&
                       (s.bottom.kind == BottomSpec::Kind::tissue_roof ||
                        s.bottom.kind == BottomSpec::Kind::tissue_floor);
  if (s.leans && !follows)
    t.problem(
        "lean", msg("a leaning column follows a tissue with its outline and its bottom"),
        msg("use an outline of kind projection and a bottom of kind tissue_roof or tissue_floor, or a prism with an axis"),
        Mistake::contradictory);
}

ShapeSpec read_shape(const toml::table& table, const std::string& name, const std::string& at,
                     Places& places, ProblemList& problems) {
  CheckedTable t(table, name, problems);
  ShapeSpec s;
  s.line = static_cast<int>(table.source().begin.line);
  s.column = static_cast<int>(table.source().begin.column);
  places[at] = {s.line, s.column};
  for (const char* key : {"tissue", "outline", "bottom", "file"})
    t.note(places, key, fmt::format("{}/{}", at, key));
  const std::size_t kind = t.word("shape", names_of(body_kinds()), 0, true);
  const std::size_t combine = t.word("combine", {"add", "subtract", "intersect"}, 0);
  if (kind == CheckedTable::k_wrong || combine == CheckedTable::k_wrong) return s;
  s.kind = static_cast<ShapeSpec::Kind>(kind);
  s.combine = static_cast<ShapeSpec::Combine>(combine);
  for (const auto& f : kind_of(s).fields)
    std::visit(ForEachSort{ReadShared<ShapeSpec>{t, s, f.key, f.required},
                           [&](FileField) { read_surface_name(t, s); },
                           [&](PlaceField) { s.at_mm = t.vector(f.key, 3, {}, f.required); },
                           [&](AxisField) { read_axis(t, s); }, [&](SizeField) { read_size(t, s); },
                           [&](BottomField) {
                             if (const auto* b = t.table(f.key, f.required))
                               s.bottom = read_bottom(*b, name, problems);
                           },
                           [&](OutlineField o) {
                             if (const auto* outline = t.table(f.key, f.required))
                               s.outline = read_outline(*outline, name, problems);
                             check_seen(t, s.outline, o.seen);
                           }},
               f.as);
  check_lean(t, s);
  t.finish();
  return s;
}

std::vector<ShapeSpec> read_shapes(CheckedTable& zones, const char* key, bool required,
                                   Places& places, ProblemList& problems) {
  std::vector<ShapeSpec> list;
  for (const auto* table : zones.tables(key, required)) {
    list.push_back(read_shape(*table, fmt::format("[[zones.{}]]", key),
                              fmt::format("zones/{}/{}", key, list.size()), places, problems));
    if (list.size() == 1 && list[0].combine != ShapeSpec::Combine::add)
      problems.add(table->source(), msg("the first shape of a zone must be added"),
                   msg("take out 'combine' or put another shape first"), Mistake::contradictory);
  }
  return list;
}

/// Each list may be as long as is allowed, and all together take too long.
void check_sum(CheckedTable& zones, const ZoneSpec& z) {
  std::size_t bodies = 0, points = 0;
  for (const auto* list : {&z.target, &z.protected_shapes})
    for (const auto& shape : *list) {
      ++bodies;
      points += shape.outline.points_mm.size();
    }
  if (bodies > k_max_bodies)
    zones.problem("target", msg("the zones have {} bodies", bodies),
                  msg("use at most {}", k_max_bodies), Mistake::too_large);
  if (points > k_max_points)
    zones.problem("target", msg("the outlines have {} points in all", points),
                  msg("use at most {}", k_max_points), Mistake::too_large);
}

MarginSpec read_margin(CheckedTable& zones, const char* key, ProblemList& problems) {
  MarginSpec m;
  if (const auto* table = zones.table(key, true)) {
    CheckedTable t(*table, fmt::format("[zones.{}]", key), problems);
    m.sides_mm = t.number("sides_mm", 0, 5, 0, true);
    m.bottom_mm = t.number("bottom_mm", 0, 5, 0, true);
    t.finish();
  }
  return m;
}

}  // namespace

ZoneSpec read_zones(const toml::table& table, std::map<std::string, Place>& places,
                    ProblemList& problems) {
  CheckedTable t(table, "[zones]", problems);
  ZoneSpec z;
  z.target = read_shapes(t, "target", true, places, problems);
  for (const char* key : {"leeway", "container"}) t.note(places, key, fmt::format("zones/{}", key));
  const std::size_t before = problems.size();
  z.leeway = read_margin(t, "leeway", problems);
  z.container = read_margin(t, "container", problems);
  if (problems.size() == before &&
      (z.container.sides_mm < z.leeway.sides_mm || z.container.bottom_mm < z.leeway.bottom_mm))
    t.problem("container", msg("the container is narrower than the leeway"),
              msg("make it at least as wide: it is measured from the target too"),
              Mistake::contradictory);
  z.protected_shapes = read_shapes(t, "protected", false, places, problems);
  check_sum(t, z);
  t.finish();
  return z;
}

}  // namespace cavum::scenarios
