// What all who sit one scenario on one tooth share: the tooth as it is read, and the scenario's
// zones in it. Both take longer to make than an exam to mark, so whoever marks a class makes them
// once.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "engine/tooth/known_fits.h"
#include "grading/measures/apart.h"
#include "grading/perforation/known_tooth.h"
#include "scenarios/exam/exam.h"

namespace cavum::grading {

struct ExamContext {
  ExamContext(Tooth tooth_before, scenarios::ZoneMap zones_of_it, KnownFits fits_of_it = {});
  ExamContext(const ExamContext&) = delete;  // `known` refers to it
  ExamContext& operator=(const ExamContext&) = delete;
  const Tooth tooth;       ///< before the first tick
  const KnownFits fits;    ///< of it; may be null
  const std::string hash;  ///< of it
  const scenarios::ZoneMap zones;
  const std::shared_ptr<const ToothApart> apart;  ///< null: nothing stands beside the tooth
  mutable KnownTooth known;
};

/// Keeps the last few grounds that were asked for. Any number of threads may ask: one makes a
/// ground, those who want the same wait for it.
class ExamContexts {
 public:
  ExamContexts() = default;
  /// Begins with that of an exam that was made ready here.
  explicit ExamContexts(const scenarios::ExamSetup& exam);
  /// Throws Error when the tooth cannot be read or the zones do not fit; `where` names it.
  [[nodiscard]] std::shared_ptr<const ExamContext> of(const scenarios::ExamTask& task,
                                                      const std::string& where);

 private:
  struct Kept {
    std::shared_ptr<const ExamContext> ground;
    std::uint64_t asked = 0;
  };
  std::mutex mutex_;
  std::map<std::string, Kept> by_content_;
  std::uint64_t asked_ = 0;
};

}  // namespace cavum::grading
