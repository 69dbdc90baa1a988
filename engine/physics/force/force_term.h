// A force beyond the Voigt law: friction, compliance, run-out. Each is one small class with one
// evaluate function, listed by name in a force model's [[terms]]. Exam and rigs call the same
// function: it knows scalars only, X and V along the contact normal (the feed, for a rig) and the
// speed of the tip.
#pragma once

#include <array>
#include <cstdint>

#include "engine/base/det_math.h"

namespace cavum {

/// What a term may look at in one tick. Terms add up; none sees another.
struct TermInput {
  bool touching = false;
  double penetration_mm = 0.0;  ///< X, 0 out of contact
  double approach_mm_s = 0.0;   ///< V along the contact normal, positive = deeper; 0 in air
  double speed_mm_s = 0.0;      ///< of the tip along its own way, in air too. Servo: >= 0. Along a
                                ///< feed: signed, positive = advancing
  double stiffness_n_per_mm = 0.0;  ///< k of the tissues touched
  double damping_n_s_per_mm = 0.0;  ///< c of the tissues touched
  double voigt_n = 0.0;             ///< voigt_force_n of the above
  double rpm = 0.0;                 ///< of the handpiece
  std::int64_t tick = 0;
  double dt_s = 0.0;    ///< since the last evaluation; 0: the first one of a recording, which may
                        ///< begin in contact
  double time_s = 0.0;  ///< since the start of the exam or of the recording
  double wet = 0.0;     ///< 0 dry … 1 water on. Servo: the spray runs while the handpiece turns
  double removed_mm3 =
      0.0;  ///< by the mounted bur since it was new. Servo: every bur is new at the start
  double removed_on_mm3 = 0.0;  ///< the same, where a recording counts anew in each session though
                                ///< the bur stayed; else equal
  SinCos approach{};  ///< of 2φ, φ the angle of approach: of the contact normal from the tooth's z
                      ///< towards x, 0 = from above. Servo: shorter than 1 as the normal leaves
                      ///< that plane
  double warmer_k = 0.0;      ///< tissue above its first temperature, where it was measured
  bool warmth_known = false;  ///< false: a term that needs it goes by a law of its own
};

/// What a term adds.
struct TermForce {
  double tissue_n = 0.0;  ///< along the contact normal, positive = out of the tooth. Part of the
                          ///< tissue's force: none in air, and the sum never pulls
  double drag_n = 0.0;    ///< against the tip's motion, with the sign of `speed_mm_s`; in air too,
                          ///< and it may pull
};

/// What a term remembers from tick to tick; zero at the start. Plain, so that state can be copied
/// and hashed.
using TermMemory = std::array<double, 4>;

/// Constant; whatever changes is in the memory.
class ForceTerm {
 public:
  virtual ~ForceTerm() = default;
  /// A function of its two arguments alone, by + - * / and sqrt (det_math.h for more). The servo
  /// may try it on copies of the memory with other speeds before the call that counts. A drag must
  /// not fall below 0 at positive speed.
  [[nodiscard]] virtual TermForce evaluate(const TermInput& in,
                                           TermMemory& memory) const noexcept = 0;
  /// True when it looks at `removed_mm3`: the servo then counts, and the count is part of its
  /// state.
  [[nodiscard]] virtual bool counts_removed() const noexcept { return false; }
};

}  // namespace cavum
