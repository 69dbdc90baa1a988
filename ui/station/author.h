// The authoring view: the zones of a scenario on its tooth, changed by mouse and keys, with
// everything that the check says beside them. The scenario's text stays the author's own: only the
// bytes of what was changed differ in the file.
#pragma once

#include <string>

#include "ui/station/station.h"

namespace cavum::station {

/// Opens the window on a scenario file and returns when it is closed: 0, or 1 when it was ended
/// from outside with something unsaved, which is kept beside the file then and named on standard
/// error. Size, text, contrast, script and pictures are those of `options`. Throws Error when the
/// file cannot be read or there is no display.
[[nodiscard]] int run_author(const StationOptions& options, const std::string& scenario);

}  // namespace cavum::station
