// Work on many sessions: what is to be done with each, and the line of JSON that comes of one. A
// line depends on the session, on what is asked and on this program alone, so it is the same bytes
// whoever made it.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/session/damage.h"
#include "grading/marking/exam_context.h"
#include "scenarios/file/surface_files.h"

namespace cavum::pool {

enum class What {
  verify,   ///< simulated, run and marked again: `verified`, `findings`, `result`
  mark,     ///< marked as it stands: `result`
  regrade,  ///< marked by another rubric, or by a corrected scenario: `result`
};

struct Work {
  What what = What::verify;
  std::string folder;                 ///< where the names begin; may be another one on each machine
  std::vector<std::string> sessions;  ///< files below it, in the order of the lines
  std::string rubric_toml,
      scenario_toml;  ///< of a regrade; with both, the scenario's zones and the rubric count
  scenarios::SurfaceFiles surfaces;  ///< of the scenario
  bool another_task = false;         ///< the scenario may be that of another task
};

/// All but the folder, and the versions of this program: the same work has the same text.
[[nodiscard]] std::string to_text(const Work& work);
/// Throws Error when the text is none, or of another version of the program. `folder` is left
/// empty.
[[nodiscard]] Work parse_work(const std::string& text, const std::string& where);
/// SHA-256 of the text, hexadecimal.
[[nodiscard]] std::string id_of(const Work& work);

/// One line of JSON without its end: `session` (name), `sha256` (of the file), and what comes of
/// it, or `error`. Throws std::bad_alloc only.
[[nodiscard]] std::string line_of(const Work& work, std::size_t index,
                                  grading::ExamContexts& grounds);
// Of such a line, to be told in any language. Each throws std::invalid_argument where it was
// written by something else.
[[nodiscard]] Message error_in(const nlohmann::json& line);
[[nodiscard]] Damages findings_in(const nlohmann::json& line);

}  // namespace cavum::pool
