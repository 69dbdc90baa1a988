// How the three arms of a Novint Falcon carry its grip: a delta mechanism whose shins are
// parallelograms on short links, after Tsai and Stamper (R. E. Stamper, "A three degree of freedom
// parallel manipulator with only translational degrees of freedom", 1997). Only sqrt is needed: the
// angles come from encoders, their sine and cosine from det_math.
//
// Arm i stands at `leg_rad` about z. In its frame u points out, v around, w along z, and the grip's
// place P obeys
//   U^2 + W^2 = (links + sqrt(b^2 - V^2))^2,   U = P_u - r + c - a cos theta,  V = P_v - s + f,  W
//   = P_w - a sin theta.
#pragma once

#include <array>

#include "engine/base/det_math.h"
#include "engine/base/vec.h"

namespace cavum {

/// Lengths of the mechanism, mm; letters of Stamper's page 30. Values as published for libnifalcon.
struct FalconGeometry {
  double a = 60.0;             ///< thigh, from the motor's axis to the knee
  double b = 102.5;            ///< shin: long side of the parallelogram
  double links = 22.5;         ///< d + e: short links between shin and knee, and shin and grip
  double c = 14.0, f = -25.0;  ///< from the grip's centre to a shin: out, around
  double r = 37.233758;        ///< from the origin to a motor's axis: out
  double s = -27.330909;       ///< the same: around
  std::array<double, 3> leg_rad{105.0 * k_pi / 180.0, -15.0 * k_pi / 180.0, -135.0 * k_pi / 180.0};
};

/// Angle of each thigh, rad; 0 lies in the plane of the motors, positive leans to the user.
using FalconAngles = std::array<double, 3>;

/// Thigh angles that put the grip at `position_mm` (x right, y up, z to the user), knees outside.
/// False when it is out of reach.
[[nodiscard]] bool falcon_angles(const FalconGeometry& g, Vec3 position_mm,
                                 FalconAngles& angles_rad) noexcept;
/// The grip's place for these angles, found by Newton's method from `position_mm` on. False when
/// there is none near: then it is left as it was.
[[nodiscard]] bool falcon_position(const FalconGeometry& g, const FalconAngles& angles_rad,
                                   Vec3& position_mm) noexcept;
/// dP/dtheta: column i is the way of the grip per angle of arm i, mm/rad. False where the mechanism
/// is singular.
[[nodiscard]] bool falcon_jacobian(const FalconGeometry& g, const FalconAngles& angles_rad,
                                   Vec3 position_mm, std::array<Vec3, 3>& columns) noexcept;
/// What the arms must hold against for `force_n` on the hand: the transposed Jacobian, N·mm.
[[nodiscard]] std::array<double, 3> falcon_torques_nmm(const std::array<Vec3, 3>& columns,
                                                       Vec3 force_n) noexcept;

/// In the middle of the workspace: where a search may begin.
inline constexpr Vec3 k_falcon_middle_mm{0.0, 0.0, 120.0};

}  // namespace cavum
