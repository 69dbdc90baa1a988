// What a grade is measured from: the tooth before and after, the motion, what happened, and the
// scenario's zones.
#pragma once

#include <array>
#include <span>

#include "engine/session/session.h"
#include "engine/session/session_reader.h"
#include "grading/measures/apart.h"
#include "grading/result/result.h"
#include "scenarios/file/scenario.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::grading {

class KnownTooth;  // grading/perforation/known_tooth.h

/// What stands beside the tooth, and all of what was seen, cut and removed.
struct AdjacentInput {
  const ToothApart& apart;
  const Tooth& before;
  const Octree& after;
  std::span<const RemovedAt> removed;
};

/// Everything a grade depends on. `inputs` and `records` are of one length; `removed` is in order
/// of ticks. Where something stands beside the tooth, `before`, `after` and `removed` are of the
/// tooth alone, and `beside` has the whole.
struct GradeInput {
  const scenarios::Scenario& scenario;
  const Tooth& before;
  const scenarios::ZoneMap& zones;
  const Octree& after;
  std::span<const TickInput> inputs;
  std::span<const TickRecord> records;
  std::span<const RemovedAt> removed;
  std::span<const TimedEvent> events;
  std::int64_t sat_under_ticks = -1;    ///< time limit that the exam ran under when `scenario` came
                                        ///< later; -1 = that of `scenario`
  const SessionSetup* again = nullptr;  ///< to simulate the motion once more; nullptr: it was
                                        ///< recorded under other physics, or there is none
  const std::array<bool, 256>* around =
      nullptr;  ///< by tissue id: it lies around the tooth (perforation/exposure.h); nullptr: to be
                ///< found out
  const AdjacentInput* beside = nullptr;  ///< nullptr: the tooth stands alone
  /// As the candidate saw it.
  [[nodiscard]] const Tooth& seen_before() const noexcept {
    return beside != nullptr ? beside->before : before;
  }
  [[nodiscard]] const Octree& seen_after() const noexcept {
    return beside != nullptr ? beside->after : after;
  }
  [[nodiscard]] std::span<const RemovedAt> all_removed() const noexcept {
    return beside != nullptr ? beside->removed : removed;
  }
  KnownTooth* known =
      nullptr;  ///< of `before` and `seen_before`; nullptr: nobody keeps what is found out of them
  const NotShown* not_shown =
      nullptr;                    ///< a preparation without its recording; nullptr: a recorded exam
  double surface_bound_mm = 0.0;  ///< how far a place of the cut surface of `after` may lie from
                                  ///< the true one beside what leaves round
  double surface_mean_bound_mm =
      0.0;  ///< and how far the surface as a whole, over which noise averages out
};

/// Ticks of `recorded` that count: up to and with the one in which the exam was over.
[[nodiscard]] std::int64_t counted_ticks(std::int64_t recorded, std::span<const TimedEvent> events);

}  // namespace cavum::grading
