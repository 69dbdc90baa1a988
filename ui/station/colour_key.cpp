#include "ui/station/colour_key.h"

#include <algorithm>

#include "engine/language/shown.h"
#include "ui/station/window.h"

namespace cavum::station {

std::vector<ColourKeyEntry> colour_key(const std::vector<Tissue>& tissues, bool high_contrast) {
  std::vector<ColourKeyEntry> key{{{60 / 255.0F, 190 / 255.0F, 235 / 255.0F, 1}, "to be removed"}};
  for (const Tissue& t : tissues) {
    if (t.id == k_enamel) key.push_back({high_contrast ? ImVec4{1, 1, 1, 1} : ImVec4{0.93F, 0.925F, 0.895F, 1}, t.name});
    if (t.id == k_dentin) key.push_back({high_contrast ? ImVec4{0.95F, 0.70F, 0.16F, 1} : ImVec4{0.86F, 0.70F, 0.43F, 1}, t.name});
    if (t.id == k_pulp) key.push_back({high_contrast ? ImVec4{0.62F, 0.02F, 0.14F, 1} : ImVec4{0.70F, 0.20F, 0.20F, 1}, t.name});
    if (t.name == "lesion") key.push_back({high_contrast ? ImVec4{0.45F, 0.25F, 0.05F, 1} : ImVec4{0.58F, 0.40F, 0.22F, 1}, "caries"});
  }
  return key;
}

void draw_colour_key(const Theme& t, const std::vector<ColourKeyEntry>& key, ImVec2 at, ImVec2 size) {
  push_font(Font::small);
  const float row = ImGui::GetFontSize() + t.px(6), side = ImGui::GetFontSize(), pad = t.px(10);
  float words = 0.0F;
  for (const ColourKeyEntry& e : key) words = std::max(words, ImGui::CalcTextSize(shown(e.word).c_str()).x);
  const ImVec2 box{side + t.px(8) + words + 2 * pad, row * static_cast<float>(key.size()) + 2 * pad - t.px(6)};
  ImVec2 corner{at.x + size.x - box.x - t.px(14), at.y + t.px(40)};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImVec4 ground = t.panel;
  ground.w = 0.85F;
  draw.AddRectFilled(corner, {corner.x + box.x, corner.y + box.y}, ink(ground), t.px(6));
  corner = {corner.x + pad, corner.y + pad};
  for (const ColourKeyEntry& e : key) {
    ImGui::LogText("%s\n", shown(e.word).c_str());
    draw.AddRectFilled(corner, {corner.x + side, corner.y + side}, ink(e.colour), t.px(3));
    draw.AddRect(corner, {corner.x + side, corner.y + side}, ink(t.text), t.px(3));
    draw.AddText({corner.x + side + t.px(8), corner.y}, ink(t.text), shown(e.word).c_str());
    corner.y += row;
  }
  pop_font();
}

}  // namespace cavum::station
