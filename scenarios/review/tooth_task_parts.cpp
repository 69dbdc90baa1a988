#include "scenarios/review/tooth_task_parts.h"

#include <fmt/core.h>

#include <algorithm>

#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

// Class V: the gingival third of the buccal surface, walls that follow neck and surface, half a millimetre into dentin, 1 to 1.25 mm at the gingival
// wall and up to 1.5 to 1.75 mm at the occlusal one (operative dentistry lab notes, brainscape.com, "Lab 4: Class V"; the same from memory in
// Sturdevant's Art and Science of Operative Dentistry). One depth is asked for here. Width and height are the house's own: so wide that one direction
// of the handpiece reaches the curved axial wall up to its ends.
constexpr double k_class_5_share = 0.38, k_class_5_narrowest_mm = 2.0, k_class_5_widest_mm = 4.5;
constexpr double k_class_5_height_mm = 2.0, k_corner_mm = 0.55;

// Dexterity: the house's own. As wide and long as the shapes of data/scenarios, a millimetre deep.
constexpr double k_dexterity_up = 0.42;  // of the way from the neck to the cusp or edge: the buccal surface stands upright there
constexpr double k_min_crown_mm = 5.0;

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

std::string pair_text(double x, double y) { return fmt::format("[{}, {}]", fixed(x, 2), fixed(y, 2)); }

}  // namespace

std::string pulp_guard_text(double offset_mm) {
  return fmt::format(
      "[[zones.protected]]                  # must stay, even inside leeway and container: counts as outside; may be left out\n"
      "shape = \"tissue\"\ntissue = \"pulp\"\noffset_mm = {}\n",
      fixed(offset_mm, 1));
}

Message why_no_front_access(const Tooth&, const Landmarks& l) {
  if (l.neck_mm.empty()) return msg("its neck is not found");
  return l.canal_mouths.empty() ? msg("no canal is found in it") : Message();
}

std::vector<TaskChoice> front_access(const Tooth&, const Landmarks&) {
  std::vector<TaskChoice> list;
  for (const double rounding : {0.55, 0.5})
    list.push_back(
        {fmt::format("# The chamber's shadow, a tenth of a millimetre wider, seen along the way in: from the canal's mouth at the neck through the "
                     "middle\n# of the lingual surface. From the lingual surface down to the labial wall of the pulp and the beginning of the "
                     "canal.\n[[zones.target]]\nshape = \"column\"\nlean = \"lingual\"\n"
                     "outline = {{ kind = \"projection\", tissue = \"pulp\", part = \"chamber\", offset_mm = 0.1, rounding_mm = {} }}\n"
                     "bottom = {{ kind = \"tissue_floor\", tissue = \"pulp\", part = \"chamber\" }}\n",
                     plain_number(rounding)),
         "", msg("Enter the middle of the lingual surface. Remove roof, horns and lingual shoulder of the chamber; leave the labial wall."),
         msg("the chamber's shadow along the way through the lingual surface, corners of {}", as_mm(rounding, k_as_needed))});
  return list;
}

Message why_no_class_5(const Tooth&, const Landmarks& l) { return l.neck_mm.empty() ? msg("its neck is not found") : Message(); }

std::vector<TaskChoice> class_5(const Tooth&, const Landmarks& l) {
  std::vector<TaskChoice> list;
  const double width = std::clamp(k_class_5_share * length_in_x(l.neck_mm), k_class_5_narrowest_mm, k_class_5_widest_mm);
  for (const double above : {0.7, 1.0})
    for (const double depth : {1.25, 1.0}) {
      const double half = 0.5 * width - k_corner_mm, low = above + k_corner_mm, high = above + k_class_5_height_mm - k_corner_mm;
      list.push_back(
          {fmt::format(
               "# A box with rounded corners in the buccal surface. Heights count from the neck below each place: it bends with it. The axial "
               "wall follows\n# the surface.\n[[zones.target]]\nshape = \"side_cavity\"\nside = \"buccal\"\ndepth_mm = {}\n"
               "outline = {{ kind = \"polygon\", points_mm = [{}, {}, {}, {}], offset_mm = {} }}\n",
               plain_number(depth), pair_text(-half, low), pair_text(half, low), pair_text(half, high), pair_text(-half, high),
               fixed(k_corner_mm, 2)),
           pulp_guard_text(0.5),
           msg("Cut into the buccal surface, {} above the neck: {} wide, {} high, {} deep; the axial wall follows the surface.", as_mm(above, 1),
               as_mm(width, 1), as_mm(k_class_5_height_mm, 1), as_mm(depth, k_as_needed)),
           msg("{} wide, {} high, {} above the neck, axial wall {} below the surface", as_mm(width, 1), as_mm(k_class_5_height_mm, 1),
               as_mm(above, 1), as_mm(depth, k_as_needed))});
    }
  return list;
}

Message why_no_crown(const Tooth&, const Landmarks& l) {
  if (l.neck_mm.empty()) return msg("its neck is not found");
  if (l.cusps.empty() && l.incisal_edge_mm.empty()) return msg("neither cusps nor an incisal edge are found");
  return buccal_crown_mm(l) < k_min_crown_mm ? msg("its crown is too low for a stump") : Message();
}

// Total occlusal convergence 10 to 20 degrees, a stump at least 4 mm high on molars and 3 mm on others (Goodacre, Campagni and Aquilino, J Prosthet
// Dent 2001; 85: 363). Finish line 1 to 1.5 mm, incisal or occlusal reduction 2 mm (recommended for metal-ceramic, by Al-Omari and Al-Wahadni,
// Quintessence Int 2004; 35: 287). The chamfer of 0.8 mm for a small tooth lies within what is said of metal (0.5 to 0.8 mm).
std::vector<TaskChoice> crown_preparation(const Tooth&, const Landmarks& l) {
  std::vector<TaskChoice> list;
  const bool front = !l.incisal_edge_mm.empty();
  const double occlusal = front ? 2.0 : 1.5;
  for (const double depth : {1.0, 0.8})
    for (const double above : {0.5, 0.8}) {
      const Number depth_mm = as_mm(depth, 1), above_mm = as_mm(above, 1), occlusal_mm = as_mm(occlusal, 1), all_deg = as_deg(12);
      list.push_back(
          {fmt::format("# All outside a stump: finish line above the neck, a chamfer, walls that converge by twice the taper.\n[[zones.target]]\n"
                       "shape = \"crown\"\nabove_neck_mm = {}\ndepth_mm = {}\ntaper_deg = 6\nocclusal_mm = {}\n",
                       fixed(above, 1), fixed(depth, 1), fixed(occlusal, 1)),
           pulp_guard_text(0.5),
           front
               ? msg("Prepare the tooth for a full crown: chamfer {} deep, {} above the neck; walls that converge by {} in all; {} off the incisal "
                     "edge.",
                     depth_mm, above_mm, all_deg, occlusal_mm)
               : msg("Prepare the tooth for a full crown: chamfer {} deep, {} above the neck; walls that converge by {} in all; {} off the occlusal "
                     "surface.",
                     depth_mm, above_mm, all_deg, occlusal_mm),
           front ? msg("chamfer {}, {} above the neck, convergence {}, {} off the incisal edge", depth_mm, above_mm, all_deg, occlusal_mm)
                 : msg("chamfer {}, {} above the neck, convergence {}, {} off the occlusal surface", depth_mm, above_mm, all_deg, occlusal_mm)});
    }
  return list;
}

Message why_no_dexterity(const Tooth&, const Landmarks& l) {
  if (l.neck_mm.empty()) return msg("its neck is not found");
  if (buccal_crown_mm(l) <= 0) return msg("neither a buccal cusp nor an incisal edge is found");
  return buccal_crown_mm(l) < k_min_crown_mm ? msg("its buccal surface is too low") : Message();
}

std::vector<TaskChoice> dexterity(const Landmarks& l, DexterityShape shape) {
  const double up = k_dexterity_up * buccal_crown_mm(l);
  const auto cavity = [](const std::string& outline, double depth) {
    return fmt::format("[[zones.target]]\nshape = \"side_cavity\"\nside = \"buccal\"\nheights = \"level\"\ndepth_mm = {}\noutline = {}\n",
                       fixed(depth, 1), outline);
  };
  const auto stroke = [up](double x, double y) {
    return fmt::format("{{ kind = \"stroke\", points_mm = [{}, {}], width_mm = 1.4, centre_mm = {} }}", pair_text(-x, -y), pair_text(x, y),
                       pair_text(0, up));
  };
  std::vector<TaskChoice> list;
  for (const double depth : {1.0, 0.8}) {
    const Number deep = as_mm(depth, 1), long_mm = as_mm(3.4, 1), wide = as_mm(1.4, 1), across = as_mm(2.8, 1), above = as_mm(up, 1);
    std::string zones = "# In the buccal surface, heights from the neck's middle; one depth below the surface.\n";
    Message what, chosen;
    switch (shape) {
      case DexterityShape::groove:
        zones += cavity(stroke(1.0, 0), depth);
        what = msg("Cut a straight groove, {} long and {} wide, into the buccal surface, {} deep all over.", long_mm, wide, deep);
        chosen = msg("a straight groove, {} long and {} wide, {} deep, {} above the neck's middle", long_mm, wide, deep, above);
        break;
      case DexterityShape::circle:
        zones += cavity(fmt::format("{{ kind = \"circle\", radius_mm = 1.4, centre_mm = {} }}", pair_text(0, up)), depth);
        what = msg("Cut a round pocket, {} wide, into the buccal surface, {} deep all over.", across, deep);
        chosen = msg("a round pocket, {} wide, {} deep, {} above the neck's middle", across, deep, above);
        break;
      case DexterityShape::cross:
        zones += cavity(stroke(1.0, 0), depth) + "\n" + cavity(stroke(0, 1.0), depth);
        what = msg("Cut a cross of two grooves, each {} long and {} wide, into the buccal surface, {} deep all over.", long_mm, wide, deep);
        chosen = msg("a cross of two grooves, each {} long and {} wide, {} deep, {} above the neck's middle", long_mm, wide, deep, above);
        break;
    }
    list.push_back({zones, pulp_guard_text(0.5), what, chosen});
  }
  return list;
}

std::string side_steps_text() {
  return R"([[steps]]
id = "entry"
instruction = "Enter in the middle of the outline, square to the surface, and go to full depth."
complete_when = "target_removed_percent >= 10"

[[steps]]
id = "extension"
instruction = "Extend to the outline; the axial wall follows the surface. Release the pedal and lift off when done."
complete_when = "target_removed_percent >= 87 && pedal < 0.05 && contact == 0"
)";
}

std::string crown_steps_text() {
  return R"([[steps]]
id = "occlusal"
instruction = "Take down the occlusal surface or the incisal edge evenly, along its own shape."
complete_when = "target_removed_percent >= 15"

[[steps]]
id = "axial"
instruction = "Go round the tooth with the handpiece along its long axis: walls that converge, a finish line that follows the neck."
complete_when = "target_removed_percent >= 60"

[[steps]]
id = "finish"
instruction = "Finish walls and chamfer. Release the pedal and lift off when done."
complete_when = "target_removed_percent >= 88 && pedal < 0.05 && contact == 0"
)";
}

std::string crown_criteria_text() {
  return R"([[rubric.criteria]]
id = "taper"
title = "Walls converge as planned"
metric = "taper_error_deg"
full = 4                             # each wall leans by 6 degrees: to there 4 to 20 degrees of convergence in all (published: 10 to 20)
zero = 12
points = 10
)";
}

}  // namespace cavum::scenarios
