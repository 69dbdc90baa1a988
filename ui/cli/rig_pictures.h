// The rigs' results as pictures (SVG).
#pragma once

#include <string>

#include "engine/lab/rig/cube_rig.h"
#include "engine/lab/rig/press_rig.h"
#include "engine/lab/rig/tooth_rig.h"

namespace cavum::ui {

/// Force over k beside eq. 6, and what a straight line leaves over.
[[nodiscard]] std::string cube_svg(const CubeResult& result);
/// Force over time through the tissues, and around the moment the pulp is reached.
[[nodiscard]] std::string tooth_svg(const ToothRigResult& result);
/// Every press and contact as a coloured field, ours beside the explicit law.
[[nodiscard]] std::string press_svg(const PressResult& result);

}  // namespace cavum::ui
