// The search for causes: one after the other, as long as a candidate gains what no surrogate does;
// then each is held against all others in its place.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/lab/explain/inference/explain.h"

namespace cavum::explain {

/// One look at the recording with the causes known so far, judged.
struct Step {
  View view;
  Scores scores;
  Null null;
  Judgement judgement;
};

inline constexpr double k_alias_chi2 =
    10.0;  ///< a rival this close fits as well, in noise that is what it seems

/// How far in chi² one explanation may be behind another that earned `earned`, and count as fitting
/// as well.
[[nodiscard]] inline double within_alias(double earned, double inflation) {
  return k_alias_chi2 * inflation + 0.003 * earned;
}

/// What is known so far. `recording` and `options` must outlive it.
struct CauseSearch {
  const Recording& recording;
  const ExplainOptions& options;
  std::function<void()> done;  ///< called after each look
  Shared<Motion> motion;
  std::vector<Term> causes;
  std::vector<double> p_values;  ///< of causes
  std::vector<int> barred;       ///< mechanisms that said no more than a plainer one
  double doubted_percent = 0;    ///< the largest gain of a cause that was taken back
  Step step;                     ///< the last look
};

/// Looks at the recording without any cause.
[[nodiscard]] CauseSearch begin_search(const Recording& recording, const ExplainOptions& options,
                                       std::function<void()> done);
/// Looks again, with the causes as they are now; refines their shapes first, for with a cause in
/// the model k and c move, and with them who is in contact and clipped.
void look_again(CauseSearch& search);
/// Adds causes until no candidate is left that is worth it; what then depends on a variable that no
/// mechanism describes.
[[nodiscard]] std::optional<Unexplained> add_causes(CauseSearch& search);
/// Does every cause still earn its place, and is there a better one in that place? The causes with
/// their aliases. True: some changed since the last look.
[[nodiscard]] bool weigh_causes(CauseSearch& search, std::vector<Cause>& weighed);

}  // namespace cavum::explain
