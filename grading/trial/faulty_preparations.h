// Faulty preparations for a scenario on its tooth: what anybody could hand in that is not the
// target. One table; which rows apply follows from the scenario (aims, faults, a tissue to be
// excavated).
#pragma once

#include <string>
#include <vector>

#include "grading/trial/sitting.h"
#include "grading/trial/target_field.h"

namespace cavum::grading {

/// What of the work is wrong, and so by which measures it should be caught.
enum class Mistake {
  nothing_done,   ///< no tissue removed
  too_little,     ///< a part of the target left standing
  not_deep,       ///< the floor not reached
  roof_left,      ///< what is to be opened stays covered
  too_deep,       ///< below the floor
  too_wide,       ///< beyond the walls
  misplaced,      ///< another place or outline
  lesion_left,    ///< of a tissue that is to be excavated
  fault_opened,   ///< a tissue that must not be
  torn_down,      ///< everything in reach gone
  ragged,         ///< pieces left and pieces too much
  neighbour_cut,  ///< a tooth beside it damaged
  contact_left,   ///< the contact with the neighbour not opened
  gum_cut,        ///< the papilla cut
};

/// Measures that should catch it, the best first.
[[nodiscard]] const std::vector<std::string>& measures_against(Mistake mistake);

struct FaultyPreparation {
  std::string name;  ///< "stops_at_70_percent_of_depth"
  Message what;      ///< what is cut
  Mistake mistake = Mistake::too_little;
  Cut cut;
  /// So like the target where that is symmetric that it may be right: counts only when at least a
  /// quarter of the target is left or removed beyond.
  bool may_be_right = false;
  std::string measure{};  ///< the one that should catch it before all others; may be empty
  bool waits = false;     ///< until time is up
  double below_mm = 2.4;  ///< how far below the target it reaches
};

/// The honest piece of work: exactly the target.
[[nodiscard]] Cut honest_cut(const TargetField& field);
/// All that apply. `field` must outlive them. The random ones are drawn by a fixed seed.
[[nodiscard]] std::vector<FaultyPreparation> faulty_preparations(const Task& task,
                                                                 const TargetField& field);

/// Steps of an error that grows: more of it must never be better.
struct Ladder {
  std::string name;  ///< "deeper"
  Message what;      ///< "the floor deeper"
  Unit unit = Unit::mm;
  std::vector<double> amount;  ///< growing, in `unit`
  std::vector<Cut> cut;        ///< one for each amount
};
[[nodiscard]] std::vector<Ladder> ladders(const Task& task, const TargetField& field);

/// Where work reaches that goes so far below the target, tooth frame.
[[nodiscard]] CutBox box_of_work(const TargetField& field,
                                 double below_mm = FaultyPreparation{}.below_mm);

}  // namespace cavum::grading
