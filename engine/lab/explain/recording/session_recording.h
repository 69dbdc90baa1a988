// A recorded exam as a recording: the engine replays it and supplies X and V; the force is a
// measured one when there is one, else that of the session's own law. What is then found is what
// the load cell shows beyond the session's own k and c, or what its force terms add to them.
#pragma once

#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// Contacts of at least half a second, one session of the recording each, at 200 Hz; air is left
/// out, for a load cell has no feed to go by there. Columns: spindle_rpm, removed_mm3, bur_id,
/// approach_deg, slide_mm_s (speed across the contact), tilt_deg. k and c of the tissue touched are
/// known row by row (`relative_k`, `relative_c`). Force: `force_csv` (columns t_s since the start
/// of the exam, f_n) when it is named; else the session's MeasuredForce events; else the model's
/// force along the contact normal. A note says which, and how far rendering was from it. Throws
/// Error when the session cannot be replayed, its replay differs from the record, or no contact
/// lasts.
[[nodiscard]] Recording read_session_recording(const std::string& path,
                                               const std::string& force_csv = "");

}  // namespace cavum::explain
