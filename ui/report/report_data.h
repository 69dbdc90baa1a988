// What the page of a report draws and moves: the tooth before and after with the time of every cut,
// the motion, the instruments, the events and the moments behind each point lost, as one JSON
// object that stands in the HTML file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ui/report/figures/tooth_grid.h"
#include "ui/report/report_source.h"

namespace cavum::report {

/// {"schema":1,"kind":"session","title","duration_s","high_contrast","tissues","grid","scale_mm","motion","instruments","events","moments"};
/// arrays are packed (figures/packed_array.h), their meaning is that of ToothGrid, ChangedCells and
/// MotionTrack; with "steps_s", when each step was completed, and "beside", another session of the
/// same exam without what both have in common, with its "name". Of a scan ("kind":"scan") all that
/// needs time is absent.
[[nodiscard]] nlohmann::json report_data(const ReportSource& source);

/// Adds `words`, the page's messages in the reader's language, and `decimal_sign`; nothing in
/// English.
void add_words(nlohmann::json& data);

/// Of the page's data: the tissues by id, and the cells before and after, without the times.
[[nodiscard]] nlohmann::json tissues_json(const Tooth& tooth, bool high_contrast);
[[nodiscard]] nlohmann::json cells_json(const ToothGrid& grid, const ChangedCells& box);
inline constexpr double k_colours_end_mm =
    0.5;  ///< beyond this deviation from the target colours differ no more

}  // namespace cavum::report
