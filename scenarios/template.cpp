#include "scenarios/parse.h"

namespace cavum {

std::string scenario_template() {
  return R"(# A scenario of Cavum. Lengths in mm, times in s, forces in N.
# Frame of a tooth: origin at the crown's centre, +x mesial, +y buccal, +z occlusal.
# Check it with `cavum scenario check FILE`, look at it with `cavum scenario show FILE --out F.svg`.
id = "my_task"
title = "What the candidate reads first"
description = "A sentence or two more."
tooth = "lower_molar.cvt"            # beside this file, or in data/teeth
points = ["round-1.0", "cylinder-round-1.0"]   # allowed diamond points (data/points); the first is mounted
max_rpm = 200000
time_limit_s = 600
force_limit_n = 2.5                  # pressing harder is counted; 0 = no limit

[accommodations]                     # for one candidate; recorded with the result
extra_time_percent = 0
left_handed = false
high_contrast = false

# Steps, one after the other. complete_when and fail_when are conditions over live quantities:
#   time_s step_time_s target_removed_percent removed_mm3 leeway_mm3 container_mm3 outside_mm3 protected_mm3 depth_mm
#   x_mm y_mm z_mm force_n peak_force_n pedal rpm contact cutting point button_1 button_2 perforated touched_NAME (mm3 of a tissue)
# with + - * / < <= > >= == != && || ?: and min(), max(), abs().
[[steps]]
id = "cut"
instruction = "Cut the cavity. Release the pedal and lift off when done."
complete_when = "target_removed_percent >= 90 && pedal < 0.05 && contact == 0"
# fail_when = "outside_mm3 > 5"
# time_limit_s = 300
# failure_ends_exam = true

[perforation]
aims = []                            # tissues that are to be opened
faults = ["pulp", "periodontium"]    # tissues that must not be

# What is to be removed: shapes combined in their order (combine = "add", "subtract" or "intersect").
#   box      at_mm (centre), size_mm, axis, turn_deg
#   ball     at_mm, radius_mm
#   cylinder at_mm (middle of the lower face), radius_mm, height_mm, axis
#   cone     the same, and top_radius_mm
#   prism    at_mm, height_mm, axis, turn_deg, outline
#   column   outline, bottom, taper_deg: from the occlusal surface down to the bottom
#   tissue   tissue, part, offset_mm: the leaves of a tissue, grown
# outline = { kind = "circle", radius_mm } | { kind = "polygon", points_mm } | { kind = "stroke", points_mm, width_mm }
#         | { kind = "projection", tissue, part = "all" or "chamber", rounding_mm }; all with offset_mm, the first three
#           with centre_mm and from = "tooth" or "chamber"
# bottom  = { kind = "level", z_mm } | { kind = "below_surface" or "below_lowest" or "below_mean", depth_mm }
#         | { kind = "tissue_roof" or "tissue_floor", tissue, part, deeper_mm }
[[zones.target]]
shape = "column"
outline = { kind = "stroke", points_mm = [[-1.5, 0], [1.5, 0]], width_mm = 1.4 }
bottom = { kind = "below_lowest", depth_mm = 1.8 }
taper_deg = 0

[zones.leeway]                       # tolerated, this far beside and below the target
sides_mm = 0.25
bottom_mm = 0.2

[zones.container]                    # damage; beyond it everything counts as outside
sides_mm = 1.0
bottom_mm = 0.8

[[zones.protected]]                  # must stay, even inside leeway and container; may be left out
shape = "tissue"
tissue = "pulp"
offset_mm = 0.5

[rubric]
rule = "compensatory"                # or "non-compensatory": each criterion must reach pass_percent
pass_percent = 60
borderline_percent = 3               # this close to the pass mark a person decides

# Points run linearly from `full` to `zero`. critical_above or critical_below: beyond it the exam is failed.
[[rubric.criteria]]
id = "removed"
title = "Cavity complete"
metric = "target_removed_percent"
full = 95
zero = 60
points = 50

[[rubric.criteria]]
id = "walls"
title = "Walls not overcut"
metric = "container_sides_mm3"
full = 0.2
zero = 2.5
points = 30

[[rubric.criteria]]
id = "pulp"
title = "Pulp not opened"
metric = "perforated"
full = 0
zero = 1
points = 20
critical_above = 0.5
)";
}

}  // namespace cavum
