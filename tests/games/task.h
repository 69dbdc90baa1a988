// A shipped task with its tooth and zones, read once for all games.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grading/measures/apart.h"
#include "scenarios/file/scenario.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::games {

/// Signed distance to a body, mm, negative inside; changes by at most 1 mm per mm.
using Body = std::function<double(Vec3)>;

struct Task {
  std::string name;
  scenarios::Scenario scenario;
  Tooth tooth;
  std::shared_ptr<const grading::ToothApart> apart;  ///< null: nothing stands beside the tooth
  scenarios::ZoneMap zones;
  Vec3 low_mm, high_mm;       ///< box of the target
  Vec3 middle_mm;             ///< mean of the target's leaves
  std::vector<Vec3> leaves;   ///< centres of the target's leaves, mm
  std::vector<bool> is_hard;  ///< of each of them
  /// The last distance asked for, and where: bodies put together of several ask for it again and
  /// again.
  mutable Vec3 asked_mm{1e9, 1e9, 1e9};
  mutable double answer_mm = 0.0;
};

/// Names of all data/scenarios/*.toml, sorted.
[[nodiscard]] const std::vector<std::string>& task_names();
/// By its name; kept once read. Throws Error.
[[nodiscard]] const Task& task(const std::string& name);
/// The same with its tooth in leaves of twice the edge and without the root's lower end, for many
/// sittings.
[[nodiscard]] const Task& coarse_task(const std::string& name);
/// A task of a text and a tooth of its own.
[[nodiscard]] Task task_on(const std::string& toml, const std::string& name, Tooth tooth);

/// The target itself, grown by `by_mm` (negative: shrunk).
[[nodiscard]] Body grown_target(const Task& task, double by_mm = 0.0);

}  // namespace cavum::games
