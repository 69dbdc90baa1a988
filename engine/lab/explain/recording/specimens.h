// Recordings in which every session is another specimen (meat, extracted teeth): each has its own
// surface, size and stiffness, and one k for all would only measure their differences. They are
// brought to a common scale first.
#pragma once

#include "engine/lab/explain/recording/recording.h"

namespace cavum::explain {

/// True for at least 8 sessions without k in rig.toml, whose peak force over peak depth scatters by
/// more than 20 % (standard deviation over mean; repeats on one specimen scatter far less).
[[nodiscard]] bool are_specimens(const Recording& recording);

/// x from the surface of each specimen (where the force rises and stays above 2 % of its peak and
/// above the noise), times mean peak depth over its own; force times mean peak force over its own.
/// Time, and so time constants, stay as they are. A note says so. The measured speed is scaled with
/// x.
[[nodiscard]] Recording on_common_scale(const Recording& recording);

}  // namespace cavum::explain
