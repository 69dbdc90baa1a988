// Whether a candidate's marks changed over the attempts at one exam by more than marks vary by
// themselves.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace cavum::cohort {

/// How far the marks of one person vary from attempt to attempt while the person stays the same.
struct AttemptScatter {
  double sd_percent = 0.0;       ///< standard deviation of one mark, per cent of the scale
  double largest_percent = 0.0;  ///< step from one attempt to the next, from the mean of all steps
  std::size_t steps = 0;         ///< from one attempt to the next, of all candidates
  std::size_t candidates = 0;    ///< with two attempts or more
};
/// Fewer steps, or steps of fewer candidates, say too little.
inline constexpr std::size_t k_min_steps = 8, k_min_repeaters = 5;
/// `marks`: of each candidate, the oldest first, per cent of the scale. The deviation is that of
/// all steps around their mean, over the root of two. People who learn at different rates make it
/// larger, never smaller: then less is told, not more. None where there are too few.
[[nodiscard]] std::optional<AttemptScatter> attempt_scatter(
    const std::vector<std::vector<double>>& marks);

/// What a candidate's marks say after an attempt.
struct Progress {
  std::size_t attempts = 0;
  double change_percent = 0.0;  ///< of the line through all attempts, from the first to the last
  double bound_percent = 0.0;   ///< so much may be chance: a change beyond it is told
  [[nodiscard]] bool told() const noexcept {
    return change_percent > bound_percent || change_percent < -bound_percent;
  }
};
/// After two marks or more. The bound is that of Student's t with one degree of freedom less than
/// candidates, for a chance of 5 % / (n (n - 1)) after the n-th attempt: these add up to 4 %,
/// however many follow. It is never less than the largest step of the class, for marks slip further
/// than a normal distribution says.
[[nodiscard]] std::optional<Progress> progress(std::span<const double> marks,
                                               const AttemptScatter& scatter);

}  // namespace cavum::cohort
