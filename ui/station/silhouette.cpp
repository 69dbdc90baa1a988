#include <imgui.h>

#include <algorithm>

#include "ui/station/screens.h"

namespace cavum::station {

void draw_silhouette(const Bur& bur, ImVec2 at, ImVec2 size, ImU32 colour, ImU32 coated) {
  constexpr int k_slices = 90;
  constexpr float k_shown_mm = 7.0F;
  const float scale = size.y / k_shown_mm, middle = at.x + size.x / 2;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  for (int i = 0; i < k_slices; ++i) {
    const float low = k_shown_mm * static_cast<float>(i) / k_slices,
                high = k_shown_mm * static_cast<float>(i + 1) / k_slices;
    const auto r_low = static_cast<float>(bur.profile.radius_mm(low)) * scale,
               r_high = static_cast<float>(bur.profile.radius_mm(high)) * scale;
    const float y_low = at.y + size.y - low * scale, y_high = at.y + size.y - high * scale;
    draw.AddQuadFilled({middle - r_low, y_low}, {middle + r_low, y_low}, {middle + r_high, y_high},
                       {middle - r_high, y_high}, low < bur.cutting_length_mm ? coated : colour);
  }
}

}  // namespace cavum::station
