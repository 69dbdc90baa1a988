// How a recording counts: is compression negative, does the position grow out of the material, is
// it a machine's own, where its surface is not at 0. Judged from the data, said in words with the
// option that puts it right, and never changed silently.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/named_enum.h"
#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// Something that does not look as a recording should.
struct Doubt {
  const char* kind;     ///< sign, origin, force_unit, speed_sign
  bool clear = false;   ///< an analysis would be of another thing: `explain` refuses
  Message what;         ///< with figures
  std::string options;  ///< what puts it right: "--negate f"
};

/// Where the force leaves its level in air: a bend of the mean force over the position, flat on one
/// side.
struct ContactSeen {
  double at_mm = 0.0;      ///< position where it begins, as the recording counts
  double air_n = 0.0;      ///< level on the flat side
  double reached_n = 0.0;  ///< mean force at the far end, over air_n; negative when compression is
  int towards = 1;         ///< 1: contact lies at greater positions; -1: at smaller ones
};

struct Conventions {
  std::optional<ContactSeen>
      contact;                ///< none: wholly in air, wholly in contact, or not to be told
  double speed_agrees = 0.0;  ///< correlation of the measured speed with the position's change,
                              ///< -1..1; 0 without speed
  std::vector<Doubt> doubts;
  [[nodiscard]] const Doubt* first_clear() const;
};

/// Looks at no more than 200,000 rows, evenly spaced. Nothing is judged below 50 rows.
[[nodiscard]] Conventions judge_conventions(const Recording& recording);
#define CAVUM_CONVENTION_ERRORS(ERROR) ERROR(data_fault)
CAVUM_NAMED_ENUM(ConventionError, CAVUM_CONVENTION_ERRORS)
/// Throws Error(ConventionError::data_fault, where, what, options) when a doubt is clear and nobody
/// said that all is well (`as_it_is`); the others in words, as notes.
[[nodiscard]] Facts require_conventions(const Recording& recording, const std::string& where,
                                        bool as_it_is = false);

}  // namespace cavum::explain
