// What is proved of a session file, for the end of a report: its hashes and its seal, and, when
// asked for, whether its motion gives the same forces and the same tooth again.
#pragma once

#include <string>

#include "grading/marking/exam_context.h"
#include "ui/report/report_source.h"

namespace cavum::report {

/// Without a replay.
[[nodiscard]] ReportIntegrity read_integrity(const std::string& session_path);
/// With the whole exam simulated again, which takes a fraction of its time; its tooth and zones
/// come out of `grounds`. Both throw Error when the file is no session.
[[nodiscard]] ReportIntegrity replayed_integrity(const std::string& session_path,
                                                 grading::ExamContexts& grounds);

}  // namespace cavum::report
