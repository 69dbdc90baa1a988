#include "scenarios/file/template.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

constexpr std::array<ShippedTooth, 4> k_shipped_teeth{
    {{"molar", "lower_molar.cvt"}, {"premolar", "upper_premolar.cvt"}, {"incisor", "upper_incisor.cvt"}, {"carious_molar", "molar_lesion.cvt"}}};

/// A task on the block. `zones` is what is to be removed.
struct BlockTask {
  std::string_view word, title, what;
  double time_limit_s;
  std::string_view zones;
};

constexpr std::string_view k_cavity_tray = R"(["cylinder-flat-1.0", "cylinder-round-1.0", "round-1.0"])";
constexpr std::string_view k_pulp_guard =
    R"([[zones.protected]]                  # must stay, even inside leeway and container: counts as outside; may be left out
shape = "tissue"
tissue = "pulp"
offset_mm = 0.5
)";
constexpr std::array<BlockTask, 3> k_block_tasks{{
    {"class_1", said("Cavity like a class I in a block"), said("4.4 mm long, 1.4 mm wide, 1.8 mm deep, upright walls, flat floor."), 480,
     R"(# A stroke of 1.4 mm with half circles at its ends, 4.4 mm long in all.
[[zones.target]]
shape = "column"
outline = { kind = "stroke", points_mm = [[-1.5, 0], [1.5, 0]], width_mm = 1.4 }
bottom = { kind = "below_surface", depth_mm = 1.8 }
taper_deg = 0
)"},
    {"slot", said("Slot through a block"), said("1.5 mm wide and 1.8 mm deep, from the middle of the block out through its mesial side."), 480,
     R"(# A box that stands out over the block: only tissue counts. at_mm is its centre.
[[zones.target]]
shape = "box"
at_mm = [3.0, 0, 0]
size_mm = [6, 1.5, 3.6]
)"},
    {"cross", said("Cross in a block"), said("Two grooves, 6 mm long, 1.4 mm wide and 1.5 mm deep, at right angles."), 600,
     R"(# One groove from mesial to distal ...
[[zones.target]]
shape = "column"
outline = { kind = "stroke", points_mm = [[-2.3, 0], [2.3, 0]], width_mm = 1.4 }
bottom = { kind = "below_surface", depth_mm = 1.5 }

# ... and one from lingual to buccal.
[[zones.target]]
shape = "column"
outline = { kind = "stroke", points_mm = [[0, -2.3], [0, 2.3]], width_mm = 1.4 }
bottom = { kind = "below_surface", depth_mm = 1.5 }
)"},
}};

constexpr std::string_view k_head = R"(# A scenario of Cavum. Lengths in mm, times in s, forces in N.
# Frame of a tooth: origin at the crown's centre (of a block: the centre of its top face), +x mesial, +y buccal, +z occlusal.
#   cavum scenario check FILE                every mistake, and what is legal but unwise
#   cavum scenario show FILE --out F.svg     the zones on three sections and from above
#   cavum scenario solve FILE                the built-in expert proves that the task can be passed
)";

constexpr std::string_view k_frame = R"(
[accommodations]                     # for everyone who takes it; `cavum exam` grants others to one candidate
extra_time_percent = 0               # of every time limit
extra_time_s = 0                     # besides, of the exam's limit
left_handed = false
high_contrast = false

# [pauses]                           # breaks, taken with a button of the stylus while the handpiece stands still
# count = 1                          # how many; the clock stands still in them
# longest_s = 120                    # each ends by itself after this
# button = 2

# Steps, one after the other. complete_when and fail_when are conditions over live quantities:
#   time_s step_time_s target_removed_percent removed_mm3 leeway_mm3 container_mm3 outside_mm3 protected_mm3 depth_mm
#   x_mm y_mm z_mm force_n peak_force_n pedal rpm contact cutting bur button_1 button_2 perforated touched_NAME (mm3 of a tissue)
# with + - * / < <= > >= == != && || ?: and min(), max(), abs(). A step may also have
#   fail_when = "outside_mm3 > 5"    time_limit_s = 300    failure_ends_exam = true
)";

constexpr std::string_view k_cavity_steps = R"([[steps]]
id = "entry"
instruction = "Enter in the middle of the outline and go to full depth."
complete_when = "target_removed_percent >= 10"

[[steps]]
id = "extension"
instruction = "Extend to the outline at constant depth. Release the pedal and lift off when done."
complete_when = "target_removed_percent >= 88 && pedal < 0.05 && contact == 0"
)";
constexpr std::string_view k_access_steps = R"([[steps]]
id = "outline"
instruction = "Cut the outline of the access through the enamel."
complete_when = "target_removed_percent >= 20 || touched_pulp > 0"

[[steps]]
id = "chamber"
instruction = "Go deeper in the middle of the outline until you fall into the pulp chamber."
complete_when = "touched_pulp > 0.05"

[[steps]]
id = "roof"
instruction = "Remove the rest of the roof. Do not touch the floor. Release the pedal and lift off when done."
complete_when = "target_removed_percent >= 87 && pedal < 0.05 && contact == 0"
)";

constexpr std::string_view k_shapes = R"(
# What is to be removed: shapes combined in their order (combine = "add", "subtract" or "intersect").
#   box      at_mm (centre), size_mm, axis, turn_deg
#   ball     at_mm, radius_mm
#   cylinder at_mm (middle of the lower face), radius_mm, height_mm, axis
#   cone     the same, and top_radius_mm
#   prism    at_mm, height_mm, axis, turn_deg, outline
#   column   outline, bottom, taper_deg: from the occlusal surface down to the bottom; lean = "lingual": into a front tooth, from lingual
#   tissue   tissue, part, offset_mm: the leaves of a tissue, grown
#   canal_cone  canals = "all" or "mesial", "distobuccal" ..., radius_mm (else the mouth's own), taper_deg, deeper_mm, axis: on the canals' mouths
#   proximal_box  side = "mesial" or "distal", width_mm, depth_mm (from the outer surface), above_neck_mm: a box at the contact area
#   side_cavity  side = "buccal" or "lingual", outline (x mesial, y above the neck), depth_mm (below the surface), heights = "neck" or "level"
#   crown    above_neck_mm (of the finish line), depth_mm (chamfer), taper_deg (each wall), occlusal_mm: all outside a crown's stump
#   stl      file = "zone.stl": a closed surface in mm, in the tooth's frame, beside this file
# outline = { kind = "circle", radius_mm } | { kind = "polygon", points_mm } | { kind = "stroke", points_mm, width_mm }
#         | { kind = "projection", tissue, part = "all" or "chamber", rounding_mm }; all with offset_mm, the first three
#           with centre_mm and from = "tooth" or "chamber"
#         | { kind = "fissure", width_mm, ridge_mm (of each marginal ridge that stays), branches = "none" or "all", through = "mesial" or "distal" }
# bottom  = { kind = "level", z_mm } | { kind = "below_surface" or "below_lowest" or "below_mean", depth_mm }
#         | { kind = "tissue_roof" or "tissue_floor", tissue, part, deeper_mm } | { kind = "below_border" (of enamel and dentin), depth_mm }
)";

/// Titles and instructions that tasks are written with, here and in data/scenarios: the catalogue takes them from here, for a scenario without texts
/// of the reader's language.
[[maybe_unused]] constexpr std::array k_written{
    said("Beginning of the canal kept"),
    said("Cavity complete"),
    said("Contact opened"),
    said("Cross complete"),
    said("Cut the outline of the access through the enamel."),
    said("Enter in the middle of the outline and go to full depth."),
    said("Enter in the middle of the outline, square to the surface, and go to full depth."),
    said("Extend to the outline at constant depth. Release the pedal and lift off when done."),
    said("Extend to the outline; the axial wall follows the surface. Release the pedal and lift off when done."),
    said("Finish walls and chamfer. Release the pedal and lift off when done."),
    said("Floor at the right depth"),
    said("Floor flat, at the right depth"),
    said("Floor not gouged"),
    said("Floor not too deep"),
    said("Floor of the chamber kept"),
    said("Floors at the right depth"),
    said("Go deeper in the middle of the outline until you fall into the pulp chamber."),
    said("Go round the tooth with the handpiece along its long axis: walls that converge, a finish line that follows the neck."),
    said("Gum spared"),
    said("Hard tissue left over the pulp"),
    said("Neighbouring tooth not damaged"),
    said("No perforation"),
    said("No perforation of floor, furcation or root"),
    said("No perforation of the root"),
    said("No pit beside the canal"),
    said("No roof and no shoulder left over the chamber"),
    said("No roof left over the chamber"),
    said("No wall gouged"),
    said("No wall thinned"),
    said("Nothing removed elsewhere"),
    said("One floor, at the right depth"),
    said("Pulp not opened"),
    said("Remove the rest of the roof. Do not touch the floor. Release the pedal and lift off when done."),
    said("Roof of the chamber removed"),
    said("Slot complete"),
    said("Soft dentin removed"),
    said("Sound dentin spared"),
    said("Straight way into every canal"),
    said("Take down the occlusal surface or the incisal edge evenly, along its own shape."),
    said("Time"),
    said("Walls converge as planned"),
    said("Walls flare as planned"),
    said("Walls not overcut"),
    said("Walls upright on the whole"),
    said("Way opened")};

constexpr std::string_view k_margins = R"(
[zones.leeway]                       # tolerated, this far beside and below the target
sides_mm = 0.25
bottom_mm = 0.2

[zones.container]                    # damage, measured from the target too; everything beyond it counts as outside
sides_mm = 1.0
bottom_mm = 0.8

)";

constexpr std::string_view k_rubric = R"(
[rubric]
rule = "compensatory"                # or "non-compensatory": each criterion must reach pass_percent
pass_percent = 65
borderline_percent = 3               # this close to the pass mark a person decides
# Grades in words beside the points, as licensing boards give them: [[rubric.bands]] with a name each, best first, `most` = how many criteria may lie
# in one or in a worse one; and in a criterion bands = [...], where they end.

# Points run linearly from `full` to `zero`. critical_above or critical_below: beyond it the exam is failed.
# `cavum scenario check` marks faulty preparations by this rubric, and none may pass; two criteria that charge the same say so: shares_with.
[[rubric.criteria]]
id = "removed"
title = "Cavity complete"
metric = "target_removed_percent"
full = 92
zero = 60
points = 40
critical_below = 60

[[rubric.criteria]]
id = "walls"
title = "Walls not overcut"
metric = "container_sides_mm3"
full = 0.3
zero = 3
points = 15

[[rubric.criteria]]
id = "wall_gouge"
title = "No wall gouged"
metric = "side_walls_max_over_mm"
full = 0.4
zero = 0.8
points = 10
critical_above = 0.8
shares_with = ["walls"]

[[rubric.criteria]]
id = "floor"
title = "Floor not too deep"
metric = "container_bottom_mm3"
full = 0.1
zero = 1.5
points = 10

[[rubric.criteria]]
id = "floor_gouge"
title = "Floor not gouged"
metric = "floor_max_over_mm"
full = 0.3
zero = 0.7
points = 5
critical_above = 0.7
shares_with = ["floor"]

[[rubric.criteria]]
id = "elsewhere"
title = "Nothing removed elsewhere"
metric = "outside_mm3"
full = 0.05
zero = 1
points = 10

[[rubric.criteria]]
id = "perforation"
title = "No perforation"
metric = "perforated"
full = 0
zero = 1
points = 10
critical_above = 0.5

# What the task exists to catch: the simulated candidate `careless` does it, and must fail by that criterion
# (cavum exam FILE --operator careless ...).
# [careless]
# sides_mm = 0.6                     # beyond the target's sides; bottom_mm: below its floor; both may be negative
# opening_percent = 100              # less: opens only the middle of the outline
# perforates = false                 # true: goes on through the floor into a tissue under faults
# fails_by = "walls"
)";

std::string line(const std::string& text, const std::string& comment) {
  std::string s = text;
  if (!comment.empty()) s += fmt::format("{}# {}", std::string(s.size() < 36 ? 37 - s.size() : 1, ' '), comment);
  return s + "\n";
}
std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", text); }

}  // namespace

std::span<const ShippedTooth> shipped_teeth() { return k_shipped_teeth; }

std::vector<std::string> block_task_words() {
  std::vector<std::string> words;
  for (const auto& t : k_block_tasks) words.emplace_back(t.word);
  return words;
}

std::string block_task(const std::string& word) {
  const auto* const task = std::find_if(k_block_tasks.begin(), k_block_tasks.end(), [&](const BlockTask& t) { return t.word == word; });
  if (task == k_block_tasks.end())
    throw Error("--task " + word, msg("there is no such task for the block"), msg("choose {}", list_of(block_task_words())));
  return scenario_text({.id = fmt::format("block_{}", word),
                        .title = std::string(task->title),
                        .what = std::string(task->what),
                        .tooth_file = "block.cvt",
                        .about = "the block that ships",
                        .burs = std::string(k_cavity_tray),
                        .time_limit_s = task->time_limit_s,
                        .access = false,
                        .aims = "[]",
                        .faults = R"(["pulp"])",
                        .zones = std::string(task->zones),
                        .guard = std::string(k_pulp_guard)});
}

std::string scenario_text(const TaskText& task) {
  std::string s(k_head);
  s += line("id = " + in_quotes(task.id), "small letters, digits, _ and -");
  s += line("title = " + in_quotes(task.title), "what the candidate reads first");
  s += line("description = " + in_quotes(task.what), "");
  s += fmt::format("# {}\n", task.about);
  s += line("tooth = " + in_quotes(task.tooth_file), "beside this file, or in data/teeth");
  s += "# allowed burs (data/burs); the first is mounted\n" + line(fmt::format("burs = {}", task.burs), "");
  s += line("max_rpm = 200000", "a faster handpiece is a violation");
  s += line(fmt::format("time_limit_s = {}", static_cast<int>(task.time_limit_s)), "to the tick of 1 ms; what is done later does not count");
  s += line("force_limit_n = 2.5", "pressing harder is counted; 0 = no limit");
  s += k_frame;
  s += task.steps.empty() ? std::string(task.access ? k_access_steps : k_cavity_steps) : task.steps;
  s += fmt::format("\n[perforation]\n{}{}", line(fmt::format("aims = {}", task.aims), "tissues that are to be opened"),
                   line(fmt::format("faults = {}", task.faults), "tissues that must not be"));
  s += k_shapes;
  s += task.zones;
  s += k_margins;
  s += task.guard;
  std::string rubric(k_rubric);
  if (task.walls_limit_mm3 > 0) {
    const std::size_t walls = rubric.find("id = \"walls\""), points = rubric.find("points = ", walls), end = rubric.find('\n', points) + 1;
    rubric.insert(end, line(fmt::format("critical_above = {}", fixed(task.walls_limit_mm3, 1)),
                            task.walls_limit_of + ": bites that leave its floor and its furthest places alone"));
  }
  rubric.insert(rubric.find("\n# What the task exists to catch"), task.criteria);
  return s + rubric;
}

}  // namespace cavum::scenarios
