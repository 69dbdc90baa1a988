// Apparent mass along one axis: a force of constant size that changes its sign keeps the arm
// swinging about home, whatever it weighs. Under the same friction the motor both drives and brakes
// it; the difference of the two accelerations is that of the commanded forces over mass, without
// friction.
#pragma once

#include <span>
#include <vector>

#include "engine/device/selfcheck/arm/arm_servo.h"
#include "engine/device/selfcheck/arm_figures.h"

namespace cavum {

/// One axis of a swing.
struct SwingSample {
  double t_s = 0.0, at_mm = 0.0, force_n = 0.0;
  bool fresh = true;
};

struct SwingFit {
  double mass_kg = 0.0, friction_n = 0.0, weight_n = 0.0,
         viscous_n_s_per_mm = 0.0;  ///< per N commanded
  double delay_s = 0.0;             ///< from command to place told
  double mass_error = 0.0;          ///< standard error as a share, from five parts of the swing
  double residual_n = 0.0;          ///< root mean square
  bool solved = false;
};

/// m x'' + friction·sign(x') + viscous·x' + weight = F(t − delay), fitted without differentiating:
/// both sides are weighed by a smooth bump within each run from one turning point to the next, and
/// integrated by parts, so that derivatives fall on the bump (modulating functions, M. Shinbrot, On
/// the analysis of linear and nonlinear systems, Trans. ASME 79, 1957). One delay for all the
/// swings, which are of one device: the one that leaves the least of their accelerations.
[[nodiscard]] std::vector<SwingFit> fit_swings(std::span<const std::vector<SwingSample>> swings);

/// Why a newton does not swing the arm along `axis` as it was dragged; empty when it does.
[[nodiscard]] Message too_heavy_to_swing(const ArmServo& servo, std::size_t axis,
                                         const ArmFigures& figures);
/// Swings the arm along `axis`, whose friction and weight are known from its drag; leaves it at
/// home. Throws ArmStopped when it does not swing.
[[nodiscard]] std::vector<SwingSample> swing_axis(ArmServo& servo, std::size_t axis,
                                                  const ArmFigures& figures);

}  // namespace cavum
