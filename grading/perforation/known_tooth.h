// What finding a perforation asks of the tooth before the exam, whoever sat it: made when it is
// first asked for, and kept for the next who sat it.
#pragma once

#include <array>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/session/session.h"
#include "engine/tooth/tooth.h"

namespace cavum::grading {

/// Any number of threads may ask; who asks first makes it.
class KnownTooth {
 public:
  /// `seen`: with what stands beside it; `own`: alone. Both must outlive this, and stay as they
  /// are.
  KnownTooth(const Tooth& seen, const Tooth& own) : seen_(seen), own_(own) {}
  /// `tissues_around` of the tooth alone.
  [[nodiscard]] const std::array<bool, 256>& around(const std::array<bool, 256>& of_interest);
  /// `filled_force_n` in the tooth as seen, its cavities of `tissues` (by id) filled. The last
  /// answer is kept, too: who shows a mark proves it next.
  [[nodiscard]] std::vector<double> filled_force_n(const SessionSetup& setup,
                                                   const std::array<bool, 256>& tissues,
                                                   std::span<const TickInput> inputs);

 private:
  const Tooth &seen_, &own_;
  std::mutex mutex_;  // of what follows; what a map holds stays where it is
  std::map<std::array<bool, 256>, std::array<bool, 256>> around_;
  std::map<std::array<bool, 256>, Tooth> filled_;
  std::string last_asked_;  // SHA-256 of all that the answer depends on beside the tooth
  std::vector<double> last_n_;
};

}  // namespace cavum::grading
