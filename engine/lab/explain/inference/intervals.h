// Parameters of the causes, and how sure they are: 95 % intervals that hold what noise, the
// surrogates, single sessions and other forms of the same mechanism leave open.
#pragma once

#include "engine/lab/explain/inference/explain.h"

namespace cavum::explain {

/// Fills parameters and effects of `e.causes`, and k and c. `view` and `null`: the last look, with
/// the causes in it; `inflation` of its judgement.
void set_parameters(Explanation& e, const View& view, const Null& null, double inflation);

}  // namespace cavum::explain
