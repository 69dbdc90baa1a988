#include "engine/tooth/anatomy/landmarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/tooth/adjacent.h"
#include "engine/tooth/anatomy/crown_walls.h"
#include "engine/tooth/anatomy/occlusal_marks.h"
#include "engine/tooth/anatomy/placed.h"
#include "engine/tooth/anatomy/pulp_marks.h"
#include "engine/tooth/anatomy/tooth_class.h"

namespace cavum {
namespace {

constexpr double k_min_crown_mm = 2.0, k_largest_crown_mm = 25.0;
constexpr double k_high_share =
    0.45;  // cusps stand above this share of the way from the neck to the top
constexpr double k_degrees = 57.29577951308232;

/// Everything from the crown's frame into the tooth's.
class Turned {
 public:
  explicit Turned(const CrownFrame& frame) : frame_(frame) {}
  void operator()(Vec3& p) const { p = frame_.to_tooth(p); }
  void operator()(std::optional<Vec3>& p) const {
    if (p) *p = frame_.to_tooth(*p);
  }
  void operator()(Polyline& line) const {
    for (auto& p : line) (*this)(p);
  }
  void operator()(std::vector<Polyline>& lines) const {
    for (auto& line : lines) (*this)(line);
  }
  void operator()(std::vector<CuspTip>& cusps) const {
    for (auto& c : cusps) (*this)(c.tip_mm);
  }
  void operator()(std::vector<CanalOpening>& openings) const {
    for (auto& o : openings) (*this)(o.at_mm);
  }
  void operator()(MarginalRidge& r) const {
    (*this)(r.crest_mm);
    (*this)(r.lowest_mm);
  }

 private:
  const CrownFrame& frame_;
};

/// Angle of two unit vectors that are nearly parallel, degrees: by the length of what parts them,
/// for arcsin is no part of every libm alike.
double small_angle_deg(Vec3 a, Vec3 b) {
  const double half = 0.5 * length(a - b);
  return 2 * k_degrees * half * (1 + half * half / 6);
}

/// Why the enamel is no crown; none: it is one.
std::optional<Message> why_no_crown(const TissueIds& ids, const CrownFrame& frame) {
  if (ids.enamel == k_air || frame.enamel_leaves == 0) return msg("no enamel, so no crown");
  const Vec3 crown = frame.enamel_high - frame.enamel_low;
  if (std::min({crown.x, crown.y, crown.z}) >= k_min_crown_mm &&
      std::max({crown.x, crown.y, crown.z}) <= k_largest_crown_mm)
    return {};
  return msg("enamel of {} x {} x {} is no crown", as_number(crown.x, 1), as_number(crown.y, 1),
             as_mm(crown.z, 1));
}

/// What runs round the crown, in its frame.
struct Girth {
  Polyline neck, widest;
  Vec3 middle;  ///< of the neck, else of the crown
};
Girth find_girth(const CrownWalls& walls, const std::vector<int>& contour, const TissueIds& ids,
                 std::vector<Message>& notes) {
  Girth out;
  out.neck = neck_line(walls, contour, ids);
  out.middle = walls.middle;
  if (out.neck.empty()) {
    notes.emplace_back(msg("the neck cannot be followed round the crown"));
  } else {
    Vec3 sum;
    for (const Vec3 p : out.neck) sum += p;
    out.middle = sum / static_cast<double>(out.neck.size());
  }
  for (int d = 0; d < CrownWalls::k_directions; ++d)
    if (contour[static_cast<std::size_t>(d)] >= 0)
      out.widest.push_back(walls.place(contour[static_cast<std::size_t>(d)], d));
  return out;
}

/// Everything found goes into the tooth's frame.
void put_in_tooth(const CrownFrame& frame, OcclusalMarks& marks, Polyline& edge, Girth& girth,
                  PulpMarks& pulp, Landmarks& out) {
  const Turned turn(frame);
  const auto move_in = [&](auto& to, auto& from) {
    turn(from);
    to = std::move(from);
  };
  move_in(out.long_axis.through_mm, girth.middle);
  move_in(out.cusps, marks.cusps);
  move_in(out.cusp_ridges, marks.cusp_ridges);
  move_in(out.mesial_ridge, marks.mesial);
  move_in(out.distal_ridge, marks.distal);
  move_in(out.central_fissure_mm, marks.central_fissure);
  move_in(out.fissure_branches_mm, marks.branches);
  move_in(out.mesial_pit_mm, marks.mesial_pit);
  move_in(out.central_pit_mm, marks.central_pit);
  move_in(out.distal_pit_mm, marks.distal_pit);
  move_in(out.incisal_edge_mm, edge);
  move_in(out.occlusal_table_mm, marks.table);
  move_in(out.height_of_contour_mm, girth.widest);
  move_in(out.neck_mm, girth.neck);
  move_in(out.pulp_horns_mm, pulp.horns);
  move_in(out.chamber_roof_mm, pulp.roof);
  move_in(out.chamber_floor_mm, pulp.floor);
  move_in(out.canal_mouths, pulp.mouths);
  turn(out.apices_mm);
  for (const auto* notes : {&marks.notes, &pulp.notes})
    out.notes.insert(out.notes.end(), notes->begin(), notes->end());
}

Landmarks found_landmarks(const Tooth& tooth) {
  Landmarks out;
  const TissueIds ids = tissue_ids(tooth);
  const CrownFrame frame = crown_frame(tooth, ids);
  if (auto none = why_no_crown(ids, frame)) {
    out.notes.push_back(*std::move(none));
    return out;
  }
  CrownMaps maps;
  maps.raw = crown_heights(tooth, frame);
  maps.cusps = maps.raw.smoothed(k_cusp_scale_mm);
  maps.fissures = maps.raw.smoothed(k_fissure_scale_mm);
  const CrownWalls walls = crown_walls(tooth, frame);
  const auto contour = contour_rows(walls, ids);
  const double low_z = frame.enamel_low.z,
               least_z = low_z + k_high_share * (frame.enamel_high.z - low_z);
  const auto groove = find_groove(maps.fissures, least_z, k_fissure_per_mm);
  const auto table = occlusal_table(maps.fissures, lowest_of_table(maps, groove));
  OcclusalMarks marks;
  marks.cusps = find_cusps(maps, table, least_z, marks.notes);
  const ClassSigns signs =
      class_signs(walls, contour, maps.fissures, marks.cusps.size(), table.has_value());
  out.tooth_class = guess_class(signs);
  out.long_axis.occlusal = frame.axes.row_z;
  out.long_axis.tilt_deg = small_angle_deg(frame.axes.row_z, {0, 0, 1});
  if (!frame.own_axis)
    out.notes.emplace_back(
        msg("the tissues tell no long axis within 25 degrees of +z: +z was taken"));
  if (signs.level_share > 0.3) {
    out.long_axis.through_mm = frame.origin_mm;
    out.notes.emplace_back(msg("the top is level, as no crown's is: no landmarks"));
    return out;
  }
  const bool front =
      out.tooth_class.kind == ToothClass::incisor || out.tooth_class.kind == ToothClass::canine;
  if (table && !front) {
    find_ridges(maps, *table, groove, marks);
    find_fissures(maps, *table, groove, marks);
    if (out.tooth_class.kind != ToothClass::molar) marks.central_pit.reset();
  } else if (!front) {
    marks.notes.emplace_back(
        msg("no hollow between the cusps, so no occlusal table and no fissures"));
  }
  Polyline edge;
  if (front) edge = find_incisal_edge(maps);
  if (out.tooth_class.kind == ToothClass::incisor) marks.cusps.clear();
  Girth girth = find_girth(walls, contour, ids, out.notes);
  const auto neck_z = girth.neck.empty() ? std::nullopt : std::optional(girth.middle.z);
  PulpMarks pulp = find_pulp_marks(tooth, frame, ids.pulp, neck_z, front);
  if (frame.dentin_leaves > 0)
    out.apices_mm = find_apices(tooth, frame, neck_z.value_or(low_z), out.notes);
  put_in_tooth(frame, marks, edge, girth, pulp, out);
  return out;
}

}  // namespace

std::string_view name_of(ToothClass kind) noexcept {
  switch (kind) {
    case ToothClass::incisor:
      return "incisor";
    case ToothClass::canine:
      return "canine";
    case ToothClass::premolar:
      return "premolar";
    case ToothClass::molar:
      return "molar";
    default:
      return "unknown";
  }
}

Message in_words(ToothClass kind) {
  switch (kind) {
    case ToothClass::incisor:
      return msg("an incisor");
    case ToothClass::canine:
      return msg("a canine");
    case ToothClass::premolar:
      return msg("a premolar");
    case ToothClass::molar:
      return msg("a molar");
    default:
      return msg("a tooth of no known class");
  }
}

Landmarks find_landmarks(const Tooth& tooth) {
  Landmarks out = has_adjacent(tooth) ? found_landmarks(own_tooth(tooth)) : found_landmarks(tooth);
  place_landmarks(tooth.placed_landmarks, out);
  return out;
}

}  // namespace cavum
