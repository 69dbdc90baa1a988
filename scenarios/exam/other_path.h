// Where an exam is recorded when its disk is full or refuses: at the second place that somebody
// named, and as the last in the folder for temporary files.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "scenarios/exam/exam.h"

namespace cavum::scenarios {

/// What `begin` returns at `path`; where that disk refuses already, at `second_path` unless that is
/// empty: RecordingMoved of 0 ticks says why, and the recorder's path says where. Either way the
/// exam knows its second place. Throws what `begin` throws when neither takes it.
[[nodiscard]] std::unique_ptr<Exam> start_on_first_writable_disk(
    const std::string& path, const std::string& second_path,
    const std::function<std::unique_ptr<Exam>(const std::string& path)>& begin);

/// A place in the folder for temporary files ($TMPDIR) that nobody has used, named after the
/// session at `path`: for when nobody answers.
[[nodiscard]] std::string rescue_path(const std::string& path);

}  // namespace cavum::scenarios
