// What is proved of a session file, for the end of a report: its hashes and its seal, and, when asked for, whether its motion gives the same forces
// and the same tooth again.
#pragma once

#include <string>

#include "ui/report/report_source.h"

namespace cavum::report {

/// With `replay` the whole exam is simulated again, which takes a fraction of its time. Throws Error when the file is no session.
[[nodiscard]] ReportIntegrity read_integrity(const std::string& session_path, bool replay);

}  // namespace cavum::report
