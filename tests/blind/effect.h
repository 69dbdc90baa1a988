// What can be hidden in a recording: each mechanism of docs/laws.md and what no mechanism explains,
// as force added to the base force F = max(0, k·X + c·V) in contact, 0 in air. Written from the
// formulae alone; shares no code with engine/lab/explain.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/blind/motion.h"

namespace cavum::blind {

struct Base {
  double k_n_per_mm = 0.0, c_n_s_per_mm = 0.0;
};

/// A parameter with the value that was hidden. `names`: what a report may call it, separated by
/// `|`.
struct Parameter {
  std::string names;
  double value = 0.0;
};

/// One effect with its shape drawn and its amount still free.
struct Effect {
  std::string name;
  std::string variable;  ///< outside the library: what an honest report names, separated by `|`
  bool linear = true;    ///< force proportional to the amount
  double most = 0.0;     ///< of the amount, where not linear
  std::function<std::vector<double>(double amount)> force_n;   ///< on the fine grid
  std::function<std::vector<Parameter>(double amount)> truth;  ///< what the report should say
};

/// All names of docs/laws.md.
[[nodiscard]] const std::vector<std::string>& mechanisms();
/// `ripple`, `rezeroed`, `unnamed_column`, `lateral_square`.
[[nodiscard]] const std::vector<std::string>& outsiders();

/// Draws the shape of a mechanism or outsider. The motion must outlive the effect. \throws
/// std::invalid_argument for another name.
[[nodiscard]] Effect make_effect(const std::string& name, Draw& draw, const Motion& motion,
                                 const Base& base);

/// Base force on the fine grid, N.
[[nodiscard]] std::vector<double> base_force_n(const Motion& motion, const Base& base);

/// Root mean square over the recorded rows of the part of a force that no change of k and c makes,
/// N. The columns are the derivatives of the base force: X and V in contact, where the base does
/// not rest at its bound of 0.
[[nodiscard]] double beyond_k_and_c_n(const Motion& motion, const Base& base,
                                      const std::vector<double>& force_n);

/// The amount at which `beyond_k_and_c_n` is `target_n`; 0 if no amount up to `most` reaches it.
[[nodiscard]] double amount_for(const Effect& effect, const Motion& motion, const Base& base,
                                double target_n);

}  // namespace cavum::blind
