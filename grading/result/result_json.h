// A result as JSON (names fixed by tests, and more detail under further names), and as text for a
// terminal.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "engine/base/lines.h"
#include "grading/result/result.h"

namespace cavum::grading {

/// Every name is always present; a figure that could not be measured is null. No words: what is
/// sealed and compared.
[[nodiscard]] nlohmann::ordered_json to_json(const Result& result);
/// The same for readers: each finding with its "text", each criterion with its "reason" and the
/// "kind" and "values" of its first fact, in English.
[[nodiscard]] nlohmann::ordered_json with_words(nlohmann::ordered_json result);
/// Of a result as JSON. Throws Error where it has none of ours.
[[nodiscard]] Verdict verdict_in(const nlohmann::json& result);
[[nodiscard]] Lines to_text(const Result& result);

/// To a millionth, so that a figure reads the same wherever it is printed; never -0.
[[nodiscard]] double rounded(double v);

}  // namespace cavum::grading
