// What the page of a report draws and moves: the tooth before and after with the time of every cut, the motion, the instruments, the events
// and the moments behind each point lost, as one JSON object that stands in the HTML file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ui/report/report_source.h"

namespace cavum {

/// {"schema":1,"kind":"session","title","duration_s","high_contrast","tissues","grid","scale_mm","motion","instruments","events","moments"}; arrays
/// are packed (packed_array.h), their meaning is that of ToothGrid, ChangedCells and MotionTrack.
[[nodiscard]] nlohmann::json report_data(const ReportSource& source);

/// A JSON object as the content of a `<script>` element: nothing in it can end the element.
[[nodiscard]] std::string script_text(const nlohmann::json& data);

}  // namespace cavum
