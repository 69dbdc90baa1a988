// Compares verdicts with what was hidden, after the verdict is in, and prints the tables of the
// blind test.
#pragma once

#include <vector>

#include "tests/blind/rate.h"
#include "tests/blind/simpler.h"
#include "tests/blind/verdict.h"

namespace cavum::blind {

struct Outcome {
  Hidden hidden;
  Verdict verdict;
  Verdict plain;  ///< of the program without twins, for the comparison
  SimplerAnswers simpler;
};

/// How one verdict compares. For `gain_error`, which k and c take up entirely, `found` means that
/// it was called not testable or put into an alias set.
struct Mark {
  bool found = false;  ///< what the promise of its kind asks for: truth in a set of at most three,
                       ///< both of a pair, no cause on clean data, ...
  bool exact = false;  ///< single: the one name, with no alias
  int causes = 0, true_causes = 0;
  std::vector<double> errors;  ///< of the parameters, relative
  std::vector<bool> covered;   ///< by their intervals
  double gain_ratio =
      0.0;  ///< to the gain of the model that generated the data; 0 where that has none
};
[[nodiscard]] Mark mark(const Outcome& outcome);

/// All rates with a promise, counted over the outcomes.
[[nodiscard]] std::vector<Rate> rates(const std::vector<Outcome>& outcomes);

/// Mechanism × quantum × size, what was said instead, parameters, gain; to standard output.
void print_table(const std::vector<Outcome>& outcomes);

/// What `explain` and the simpler methods name, counted alike; to standard output.
void print_simpler(const std::vector<Outcome>& outcomes);

/// One line for one outcome: hidden, said, and how to repeat it.
[[nodiscard]] std::string line_of(const Outcome& outcome);

}  // namespace cavum::blind
