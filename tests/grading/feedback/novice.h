// Simulated beginners of several kinds who sit an exam by a way of their own, and sit it again
// after they heard what to do instead: only what was said is changed, and the hand, its tremor and
// the seed stay.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "grading/feedback/lessons.h"
#include "grading/measures/grade_input.h"
#include "scenarios/exam/exam.h"
#include "scenarios/operators/operator.h"

namespace cavum::testing {

/// A task on its tooth, and all that does not depend on who sits it.
struct NoviceTask {
  std::unique_ptr<scenarios::ExamSetup> setup;
  std::vector<ContactTool> tray;
  scenarios::ChosenBur chosen;
};
/// `scenario`: name in data/scenarios.
[[nodiscard]] NoviceTask novice_task(const std::string& scenario, const std::string& tooth_file);

/// What a beginner is like. Those of one seed are equal.
struct Beginner {
  std::string kind;
  scenarios::Skill skill;
  Vec3 shift_mm;                ///< of his whole way: he leans there
  double shift_down_mm = 0.0;   ///< he misjudges the depth: positive too deep
  double short_share = 0.0;     ///< of the cavity's depth that he never reaches
  double middle_percent = 100;  ///< of length and width that he opens
  bool perforates = false;
  std::uint64_t seed = 0;
};
/// Kinds: leaner (the program's novice), student (student-0 to student-60), deep, wide, timid
/// (opens the middle alone), piercer.
[[nodiscard]] Beginner beginner(const std::string& kind, std::uint64_t seed);
[[nodiscard]] const std::vector<std::string>& beginner_kinds();

/// An exam that was sat.
struct Sat {
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  std::vector<RemovedAt> removed;
  std::vector<TimedEvent> events;
  Tooth after;
  [[nodiscard]] grading::GradeInput input(const NoviceTask& t) const {
    return {t.setup->scenario, t.setup->tooth, t.setup->zones, after.octree, inputs,
            records,           removed,        events};
  }
};
/// `heard`: what he does otherwise than the first time. `file` is where it is recorded.
[[nodiscard]] Sat sit(const NoviceTask& task, const Beginner& who,
                      const std::vector<grading::Lesson>& heard, const std::string& file);

}  // namespace cavum::testing
