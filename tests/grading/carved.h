// A cavity carved straight into a tooth by analytic shapes, with made-up ticks: what grading is
// tested on.
#pragma once

#include <cmath>
#include <vector>

#include "engine/tooth/octree_edit.h"
#include "grading/marking/grade.h"
#include "scenarios/file/parse.h"
#include "scenarios/zones/zone_map.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::testing {

struct Carved {
  scenarios::Scenario scenario;
  Tooth before;
  scenarios::ZoneMap zones;
  Octree after;
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  std::vector<RemovedAt> removed;
  std::vector<TimedEvent> events;

  Carved(const std::string& scenario_toml, Tooth tooth)
      : scenario(scenarios::parse_scenario(scenario_toml, "s.toml")),
        before(std::move(tooth)),
        zones(scenarios::build_zones(scenario, before)),
        after(before.octree) {
    after.reserve_edits(60000);
  }
  [[nodiscard]] grading::GradeInput input() const {
    return {scenario, before, zones, after, inputs, records, removed, events};
  }
  [[nodiscard]] grading::Result graded() const { return grading::grade(input(), scenario.rubric); }

  /// Removes a shape (signed distance, mm) in the given tick.
  template <class Shape>
  void carve(const Shape& shape, std::int64_t tick, Vec3 low = {-9, -9, -9},
             Vec3 high = {9, 9, 9}) {
    std::vector<RemovedLeaf> leaves;
    leaves.reserve(4000000);
    ASSERT_TRUE(after.carve(low, high, shape, leaves));
    for (const auto& l : leaves) removed.push_back({tick, l});
    while (static_cast<std::int64_t>(inputs.size()) <= tick) {
      inputs.emplace_back();
      records.emplace_back();
    }
    records[static_cast<std::size_t>(tick)].removed += static_cast<std::uint32_t>(leaves.size());
  }
};

/// A target over the whole chamber of chambered_block: 3 x 2 x 1.5 mm with its floor at z = -4.5,
/// canals 0.4 x 0.6 mm at x = ±1.
inline constexpr char k_chamber_target[] =
    "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"polygon\", points_mm = [[-1.5, -1], [1.5, -1], [1.5, 1], [-1.5, 1]] }\nbottom = { "
    "kind = \"level\", z_mm = -4.5 }\n";

/// scenario_text of a task that is to open the pulp, not to spare it.
inline std::string opening_pulp(const std::string& target) {
  std::string text = scenario_text(target);
  const std::string from = "aims = []\nfaults = [\"pulp\", \"periodontium\"]";
  return text.replace(text.find(from), from.size(),
                      "aims = [\"pulp\"]\nfaults = [\"periodontium\"]");
}

/// Distance to a straight-sided hole of cross-section `side(x, y)` (negative inside) and floor at
/// z.
template <class Side>
auto hole(const Side& side, double floor_z) {
  return [=](Vec3 p) {
    const double a = side(p.x, p.y), b = floor_z - p.z;
    return a > 0 && b > 0 ? std::sqrt(a * a + b * b) : std::max(a, b);
  };
}

inline auto round_hole(double x, double y, double radius, double floor_z) {
  return hole(
      [=](double px, double py) {
        return std::sqrt((px - x) * (px - x) + (py - y) * (py - y)) - radius;
      },
      floor_z);
}

inline auto box_hole(double low_x, double high_x, double low_y, double high_y, double floor_z) {
  return hole(
      [=](double px, double py) {
        return std::max(std::max(low_x - px, px - high_x), std::max(low_y - py, py - high_y));
      },
      floor_z);
}

}  // namespace cavum::testing
