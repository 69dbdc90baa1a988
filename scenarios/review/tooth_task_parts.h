// The parts that tasks for any tooth are put together from: what there is to choose from, best
// first, and why a tooth is not fit.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/tooth/anatomy/landmarks.h"
#include "scenarios/review/task_texts.h"

namespace cavum::scenarios {

/// One way to lay a task out on a tooth; the first that fits is taken.
struct TaskChoice {
  Gaps gaps;                        ///< the lengths, as the task's texts name them
  std::string variant{};            ///< "_front": texts of that ending go before
  bool shell = false;               ///< leaves a shell before the neighbour out of the target
  std::array<bool, 2> pits_left{};  ///< mesial, distal: beside the cavity
  std::string floor{};  ///< TOML; later choices of the same floor lie no further from the pulp;
                        ///< empty: nothing is said
};

/// A front tooth's access, leaning towards lingual. Empty `why_not`: the tooth shows what it needs.
[[nodiscard]] Message why_no_front_access(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> front_access(const Tooth& tooth, const Landmarks& landmarks);

/// A cervical cavity in the buccal surface.
[[nodiscard]] Message why_no_class_5(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> class_5(const Tooth& tooth, const Landmarks& landmarks);

/// A full crown's preparation.
[[nodiscard]] Message why_no_crown(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> crown_preparation(const Tooth& tooth,
                                                        const Landmarks& landmarks);

/// Shapes of one depth in the buccal surface: manual dexterity.
[[nodiscard]] Message why_no_dexterity(const Tooth& tooth, const Landmarks& landmarks);
[[nodiscard]] std::vector<TaskChoice> dexterity(const Tooth& tooth, const Landmarks& landmarks);

}  // namespace cavum::scenarios
