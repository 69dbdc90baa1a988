// A class of simulated students of differing skill who sit an exam by tickets of a ledger: honest
// input for cohort figures, for a school's rehearsal, and for tests.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "grading/records/identities.h"
#include "grading/records/ledger.h"

namespace cavum::cohort {

struct SimulatedClass {
  std::string scenario;  ///< file
  std::string sessions;  ///< folder for their sessions
  int n = 200;
  std::uint64_t seed = 1;  ///< of the students: the same seed, the same class
  int at_once = 2;         ///< exams that run side by side
};
struct ClassSat {
  int sat = 0, filed = 0;
  std::int64_t bytes = 0;  ///< of the sessions
};
/// Student i has a skill level between 0 and 1, spread evenly and drawn by the seed (operator
/// `student-LEVEL`, in percent). Each gets a ticket, sits the exam, and the session is filed.
/// `done(i)` after each. Throws Error; what was filed by then stays.
ClassSat simulate_class(const SimulatedClass& wanted, records::Ledger& ledger,
                        records::Identities& identities, const std::function<void(int)>& done);

}  // namespace cavum::cohort
