// The recording protocol that separates the mechanisms: what to do in each session, and the motion for a rig.
// Parts after docs/physics.md, section 13: air strokes with reversals, four speeds, holds of 10 s, spindle off and on, three postures,
// the first site repeated last, six sessions.
#pragma once

#include <string>

namespace cavum::explain {

/// Self-contained HTML page for the person at the rig.
[[nodiscard]] std::string protocol_page();
/// Motion CSV of docs/contracts.md for one session: t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,pedal; straight down along -z onto a
/// surface at z = 0, 200 rows a second. Speeds 0.1 to 1 mm/s, accelerations of at most 10 mm/s².
[[nodiscard]] std::string protocol_motion_csv();

}  // namespace cavum::explain
