// The STL files that zones are made of. They are read beside the scenario's file when it is
// checked, shown or run; an exam keeps their bytes in its session, and marking it again takes them
// from there: it needs no file, and none can be slipped in.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/base/bytes.h"
#include "scenarios/file/parse.h"

namespace cavum::scenarios {

/// Bytes by the name that the scenario writes, each once.
using SurfaceFiles = std::vector<std::pair<std::string, Bytes>>;

/// Reads what the zones name, relative to the scenario's file, into its shapes, and adds the bytes
/// to `files`. A problem, at the place of its 'file', for each that is absent, no STL, open, larger
/// than 32 MB, or reaches further than 200 mm from the tooth's origin.
[[nodiscard]] std::vector<Problem> read_surfaces(Scenario& scenario, SurfaceFiles& files);

/// The same from what a session holds. Throws Error when one is missing or wrong.
void use_surfaces(Scenario& scenario, const SurfaceFiles& files);

/// Throws Error when `scenario` names a file that `recorded` ran with and its content is another
/// one by now.
void require_same_surfaces(const Scenario& scenario, const Scenario& recorded);

}  // namespace cavum::scenarios
