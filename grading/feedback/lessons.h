// What a candidate should take away: the mistakes behind the points that were lost, each once, in
// words of the clinic, with what to do instead. Several criteria may charge one mistake; a lesson
// gathers them. Figures, coordinates and ticks are for `why` and for the report's tables.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "grading/measures/grade_input.h"

namespace cavum::grading {

enum class Topic : std::uint8_t {
  left_standing,
  roof,
  canals,
  beside,
  too_deep,
  elsewhere,
  opened,
  taper,
  neighbour,
  contact,
  gum,
  force,
  time,
  steps,
  other
};
/// "left_standing", "too_deep", ...
[[nodiscard]] const char* topic_name(Topic topic) noexcept;

struct Lesson {
  Topic topic = Topic::other;
  double points = 0.0;      ///< lost by this mistake, of all criteria together
  bool fails_exam = false;  ///< a critical limit was passed by it
  Message what;             ///< one sentence or two: what happened, where and when
  Message instead;          ///< one or two: what to do differently
  Trace where;              ///< to look at; tick -1: no moment of its own
  std::optional<Vec3> look_mm =
      {};  ///< of a mistake that shows in the tooth: a section through here shows it
};

/// Those that fail the exam by themselves first, then by points. Their points add up to what all
/// judged criteria lost, each of more than 0.005 points or a failed limit; what is smaller is left
/// out.
[[nodiscard]] std::vector<Lesson> lessons(const GradeInput& input, const Result& result);

/// Where a place lies in the cavity, as a dentist says it: "mesiobuccally", "in the middle"; from a
/// side "towards mesial and occlusal".
[[nodiscard]] Message side_words(Vec3 place_mm, const scenarios::ZoneMap& zones);

}  // namespace cavum::grading
