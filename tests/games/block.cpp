#include "tests/games/block.h"

#include "tests/scenarios/test_teeth.h"

namespace cavum::games {
namespace {

Tooth block() {
  const auto in_box = [](Vec3 p, Vec3 low, Vec3 high) {
    return p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y &&
           p.z < high.z;
  };
  const auto pulp = [in_box](Vec3 p) {
    p.x = std::fabs(p.x);
    return in_box(p, {-0.1, -1, -4.5}, {1.5, 1, -3}) ||
           in_box(p, {0.9, -0.3, -3}, {1.4, 0.3, -2.5}) ||
           in_box(p, {0.8, -0.3, -5.3}, {1.2, 0.3, -4.5});
  };
  return testing::make_tooth(
      {-3, -2.5, -5.7}, {3, 2.5, 0.3}, 0.1,
      [pulp](Vec3 p) -> std::uint8_t {
        return p.z > 0      ? k_air
               : p.z < -5.3 ? k_periodontium
               : pulp(p)    ? k_pulp
               : p.z > -1.5 ? k_enamel
                            : k_dentin;
      },
      [pulp](Vec3 p) {
        return p.z > 0       ? p.z
               : p.z < -5.3  ? -5.3 - p.z
               : pulp(p)     ? 0.1
               : p.z > -0.15 ? p.z
               : p.z < -5.15 ? -5.3 - p.z
                             : -0.1;
      });
}

constexpr char k_text[] = R"(title = "Games"
tooth = "none.cvt"
burs = ["round-1.0"]
max_rpm = 200000
time_limit_s = 100
force_limit_n = 2.5
[[steps]]
id = "first"
instruction = "Cut."
complete_when = "target_removed_percent >= 30"
[[steps]]
id = "last"
instruction = "Finish and lift off."
complete_when = "target_removed_percent >= 80 && pedal < 0.05 && contact == 0"
[zones.leeway]
sides_mm = 0.2
bottom_mm = 0.3
[zones.container]
sides_mm = 0.5
bottom_mm = 0.5
[rubric]
rule = "compensatory"
pass_percent = 60
borderline_percent = 2
[[rubric.criteria]]
id = "removed"
metric = "target_removed_percent"
full = 100
zero = 50
points = 60
[[zones.target]]
shape = "column"
outline = { kind = "polygon", points_mm = [[-1.5, -1], [1.5, -1], [1.5, 1], [-1.5, 1]] }
)";
constexpr char k_cavity[] = R"(bottom = { kind = "level", z_mm = -1.6 }
[[zones.protected]]
shape = "tissue"
tissue = "pulp"
offset_mm = 0.2
[perforation]
aims = []
faults = ["pulp", "periodontium"]
)";
constexpr char k_access[] = R"(bottom = { kind = "level", z_mm = -4.5 }
[[zones.protected]]
shape = "tissue"
tissue = "periodontium"
offset_mm = 0.2
[perforation]
aims = ["pulp"]
faults = ["periodontium"]
)";

}  // namespace

const Task& block_task(bool access) {
  static const Task cavity = task_on(std::string("id = \"block_cavity\"\n") + k_text + k_cavity,
                                     "block_cavity", block()),
                    way_in = task_on(std::string("id = \"block_access\"\n") + k_text + k_access,
                                     "block_access", block());
  return access ? way_in : cavity;
}

}  // namespace cavum::games
