#include "ui/station/look.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>

namespace cavum::station {

void Look::follow(Window& window, StationState& state, double most) {
  const bool ctrl = ImGui::GetIO().KeyCtrl;
  if (ctrl && ImGui::IsKeyPressed(GLFW_KEY_EQUAL))
    state.text_scale = std::min(1.8, state.text_scale + 0.1);
  if (ctrl && ImGui::IsKeyPressed(GLFW_KEY_MINUS))
    state.text_scale = std::max(0.8, state.text_scale - 0.1);
  const double scale = std::min(state.text_scale * window.screen_scale(), most);
  const bool scale_differs = scale != scale_;
  if (scale_differs && ImGui::IsMouseDown(ImGuiMouseButton_Left)) return;  // while the slider moves
  if (!scale_differs && state.high_contrast == contrast_) return;
  theme_ = make_theme(state.high_contrast, scale);
  apply_theme(theme_);
  if (scale_differs) window.set_text_scale(scale);
  scale_ = scale;
  contrast_ = state.high_contrast;
}

}  // namespace cavum::station
