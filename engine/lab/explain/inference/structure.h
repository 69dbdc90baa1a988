// Is anything left in the residual that depends on some variable, known or not? Each numeric column
// is tried with a flexible curve (everywhere, in contact, and in proportion to the force), with
// lags, and for what curves miss: a ripple in position, and a step at some instant. No mechanism is
// meant by it: it says where to look.
#pragma once

#include "engine/lab/explain/model/view.h"

namespace cavum::explain {

struct Structure {
  std::string
      variable;  ///< name of the column; `t_s` for steps and trends in time, `session` for offsets
  Message form;  ///< what kind of dependence, for a person
  double gain = 0;      ///< fall of chi², less the penalty for its parameters
  double raw_gain = 0;  ///< without the penalty
  double effect_n = 0;  ///< root mean square of the fitted dependence
};

/// The best form of each variable, in the order of the columns. Needs a view with products.
[[nodiscard]] std::vector<Structure> structures(const View& view);

/// Penalty of each parameter beyond the first, in chi²: what a search over forms and shapes finds
/// in noise alone grows with the number of parameters, so a simple explanation must not lose to a
/// flexible one by chance.
inline constexpr double k_parameter_penalty = 8.0;

}  // namespace cavum::explain
