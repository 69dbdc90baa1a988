// The recording protocol that separates the mechanisms: the motion for a rig.
// Parts after docs/physics.md, section 13: air strokes with reversals, four speeds, holds of 10 s,
// spindle off and on, three postures, the first site repeated last, six sessions.
#pragma once

#include <string>

namespace cavum::explain {

/// Motion CSV of docs/contracts.md for one session: t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal; straight
/// down along -z onto a surface at z = 0, 200 rows a second. Speeds 0.1 to 1 mm/s, accelerations of
/// at most 10 mm/s².
[[nodiscard]] std::string protocol_motion_csv();

}  // namespace cavum::explain
