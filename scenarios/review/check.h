// Everything that can be said of a scenario file before anyone takes it: mistakes of the text, what
// its tooth and its tray do not have, and warnings of what is legal but unwise. `cavum scenario
// check` prints it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/file/parse.h"
#include "scenarios/review/advice.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {

/// A scenario laid into its tooth.
struct LaidScenario {
  Scenario scenario;
  Tooth tooth;
  ZoneMap zones;
};

struct CheckedScenario {
  std::vector<Problem> problems;  ///< mistakes and warnings, in the order of the file
  ExpertsPart expert;             ///< what the built-in expert can do of it; nothing with mistakes
  std::shared_ptr<const LaidScenario> laid =
      {};                            ///< what was checked; none with mistakes, or without its tooth
  [[nodiscard]] bool sound() const;  ///< no mistakes; warnings may be
};

/// `tooth_file`: lay the zones into this tooth instead of the scenario's own. Throws Error when
/// that one cannot be read. Not whether a faulty preparation passes: grading/trial tries that.
[[nodiscard]] CheckedScenario check_whole(const std::string& text, const std::string& path,
                                          const std::string& tooth_file = "");

/// The same on the scenario's own tooth as it is in memory: with landmarks that its file does not
/// have yet.
[[nodiscard]] CheckedScenario check_whole_on(const Tooth& tooth, const std::string& text,
                                             const std::string& path);

/// The same in zones that are laid already: of a text that says the same of tooth and zones as that
/// of `laid`, and differs in steps, time or rubric.
[[nodiscard]] CheckedScenario check_whole_in(const LaidScenario& laid, const std::string& text,
                                             const std::string& path);

/// Into the order of the file; what stands at one place keeps its order.
void sort_problems(std::vector<Problem>& problems);

}  // namespace cavum::scenarios
