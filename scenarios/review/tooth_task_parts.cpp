#include "scenarios/review/tooth_task_parts.h"

#include <algorithm>

#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

// Class V: the gingival third of the buccal surface, walls that follow neck and surface, half a
// millimetre into dentin, 1 to 1.25 mm at the gingival wall and up to 1.5 to 1.75 mm at the
// occlusal one (operative dentistry lab notes, brainscape.com, "Lab 4: Class V"; the same from
// memory in Sturdevant's Art and Science of Operative Dentistry). One depth is asked for here.
// Width and height are the house's own: so wide that one direction of the handpiece reaches the
// curved axial wall up to its ends.
constexpr double k_class_5_share = 0.38, k_class_5_narrowest_mm = 2.0, k_class_5_widest_mm = 4.5;
constexpr double k_class_5_height_mm = 2.0, k_corner_mm = 0.55;

// Dexterity: the house's own. As wide and long as the shapes of data/scenarios, a millimetre deep.
constexpr double k_dexterity_up =
    0.42;  // of the way from the neck to the cusp or edge: the buccal surface stands upright there
constexpr double k_min_crown_mm = 5.0;

constexpr char k_front[] = "_front";

/// Extent along x of a line, mm.
double length_in_x(const Polyline& line) {
  double low = 1e9, high = -1e9;
  for (const Vec3& p : line) {
    low = std::min(low, p.x);
    high = std::max(high, p.x);
  }
  return high > low ? high - low : 0.0;
}

/// Lowest place of the neck on the buccal side.
double buccal_neck_mm(const Landmarks& l) {
  double low = 1e9;
  for (const Vec3& p : l.neck_mm)
    if (p.y > l.long_axis.through_mm.y) low = std::min(low, p.z);
  return low;
}

/// From there to the highest buccal cusp or the incisal edge; 0 where neither is found.
double buccal_crown_mm(const Landmarks& l) {
  double high = -1e9;
  for (const auto& c : l.cusps)
    if (c.tip_mm.y > l.long_axis.through_mm.y) high = std::max(high, c.tip_mm.z);
  for (const Vec3& p : l.incisal_edge_mm) high = std::max(high, p.z);
  return l.neck_mm.empty() || high < -1e8 ? 0.0 : high - buccal_neck_mm(l);
}

}  // namespace

Message why_no_front_access(const Tooth&, const Landmarks& l) {
  if (l.neck_mm.empty()) return msg("its neck is not found");
  return l.canal_mouths.empty() ? msg("no canal is found in it") : Message();
}

std::vector<TaskChoice> front_access(const Tooth&, const Landmarks&) {
  std::vector<TaskChoice> list;
  for (const double rounding : {0.55, 0.5})
    list.push_back({.gaps = {gap_mm("rounding", rounding, k_as_needed)}, .variant = k_front});
  return list;
}

Message why_no_class_5(const Tooth&, const Landmarks& l) {
  return l.neck_mm.empty() ? msg("its neck is not found") : Message();
}

std::vector<TaskChoice> class_5(const Tooth&, const Landmarks& l) {
  std::vector<TaskChoice> list;
  const double width = std::clamp(k_class_5_share * length_in_x(l.neck_mm), k_class_5_narrowest_mm,
                                  k_class_5_widest_mm);
  for (const double above : {0.7, 1.0})
    for (const double depth : {1.25, 1.0})
      list.push_back(
          {.gaps = {gap_mm("width", width, 1), gap_mm("height", k_class_5_height_mm, 1),
                    gap_mm("above", above, 1), gap_mm("depth", depth, k_as_needed),
                    gap_mm("corner", k_corner_mm, 2), gap_mm("half", 0.5 * width - k_corner_mm, 2),
                    gap_mm("low", above + k_corner_mm, 2),
                    gap_mm("high", above + k_class_5_height_mm - k_corner_mm, 2)}});
  return list;
}

Message why_no_crown(const Tooth&, const Landmarks& l) {
  if (l.neck_mm.empty()) return msg("its neck is not found");
  if (l.cusps.empty() && l.incisal_edge_mm.empty())
    return msg("neither cusps nor an incisal edge are found");
  return buccal_crown_mm(l) < k_min_crown_mm ? msg("its crown is too low for a stump") : Message();
}

// Total occlusal convergence 10 to 20 degrees, a stump at least 4 mm high on molars and 3 mm on
// others (Goodacre, Campagni and Aquilino, J Prosthet Dent 2001; 85: 363). Finish line 1 to 1.5 mm,
// incisal or occlusal reduction 2 mm (recommended for metal-ceramic, by Al-Omari and Al-Wahadni,
// Quintessence Int 2004; 35: 287). The chamfer of 0.8 mm for a small tooth lies within what is said
// of metal (0.5 to 0.8 mm).
std::vector<TaskChoice> crown_preparation(const Tooth&, const Landmarks& l) {
  std::vector<TaskChoice> list;
  const bool front = !l.incisal_edge_mm.empty();
  for (const double depth : {1.0, 0.8})
    for (const double above : {0.5, 0.8})
      list.push_back({.gaps = {gap_mm("depth", depth, 1),
                               gap_mm("above", above, 1),
                               gap_mm("occlusal", front ? 2.0 : 1.5, 1),
                               {"convergence", "12", as_deg(12)}},
                      .variant = front ? k_front : ""});
  return list;
}

Message why_no_dexterity(const Tooth&, const Landmarks& l) {
  if (l.neck_mm.empty()) return msg("its neck is not found");
  if (buccal_crown_mm(l) <= 0) return msg("neither a buccal cusp nor an incisal edge is found");
  return buccal_crown_mm(l) < k_min_crown_mm ? msg("its buccal surface is too low") : Message();
}

std::vector<TaskChoice> dexterity(const Tooth&, const Landmarks& l) {
  std::vector<TaskChoice> list;
  const double up = k_dexterity_up * buccal_crown_mm(l);
  for (const double depth : {1.0, 0.8})
    list.push_back({.gaps = {gap_mm("depth", depth, 1),
                             gap_mm("long", 3.4, 1),
                             gap_mm("wide", 1.4, 1),
                             gap_mm("across", 2.8, 1),
                             {"above", fixed(up, 2), as_mm(up, 1)}}});
  return list;
}

}  // namespace cavum::scenarios
