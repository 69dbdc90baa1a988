// The parts that tasks for any tooth are put together from: what there is to choose from, best first, and why a tooth is not fit.
#pragma once

#include <string>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"

namespace cavum::scenarios {

/// One way to lay a task out on a tooth; the first that fits is taken.
struct TaskChoice {
  std::string zones, guard;  ///< TOML
  Message what, chosen;      ///< what the candidate reads; the lengths, for people
  std::string floor{};       ///< TOML; later choices of the same floor lie no further from the pulp; empty: nothing is said
};

/// [[zones.protected]]: pulp with so much around it.
[[nodiscard]] std::string pulp_guard_text(double offset_mm);

/// A front tooth's access, leaning towards lingual. Empty `why_not`: the tooth shows what it needs.
[[nodiscard]] Message why_no_front_access(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> front_access(const Tooth& tooth, const Landmarks& landmarks);

/// A cervical cavity in the buccal surface.
[[nodiscard]] Message why_no_class_5(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> class_5(const Tooth& tooth, const Landmarks& landmarks);

/// A full crown's preparation.
[[nodiscard]] Message why_no_crown(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> crown_preparation(const Tooth& tooth, const Landmarks& landmarks);

/// Shapes of one depth in the buccal surface: manual dexterity.
enum class DexterityShape { groove, circle, cross };
[[nodiscard]] Message why_no_dexterity(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> dexterity(const Landmarks& landmarks, DexterityShape shape);

/// Steps of a cavity in a side, TOML: its axial wall is curved, so a straight bur leaves a little more of it.
[[nodiscard]] std::string side_steps_text();
/// Steps and further criteria that a crown's rubric has of its own, TOML.
[[nodiscard]] std::string crown_steps_text();
[[nodiscard]] std::string crown_criteria_text();

}  // namespace cavum::scenarios
