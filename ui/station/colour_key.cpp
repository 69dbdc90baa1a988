#include "ui/station/colour_key.h"

#include <algorithm>

#include "engine/tooth/adjacent.h"
#include "ui/language/say.h"
#include "ui/station/tissue_colours.h"
#include "ui/station/window.h"

namespace cavum::station {

std::vector<ColourKeyEntry> colour_key(const std::vector<Tissue>& tissues, bool high_contrast) {
  const auto part = [](int i) {
    return static_cast<float>(k_target_colour[static_cast<std::size_t>(i)]) / 255.0F;
  };
  std::vector<ColourKeyEntry> key{{{part(0), part(1), part(2), 1}, msg("to be removed")}};
  for (const Tissue& t : tissues) {
    if (is_adjacent(t.name) || known_tissue(t.name).kind == TissueKind::around) continue;
    const glm::vec3 colour = tissue_colour(t.name, high_contrast);
    key.push_back({{colour.x, colour.y, colour.z, 1}, tissue_words(t.name)});
  }
  return key;
}

void draw_colour_key(const Theme& t, const std::vector<ColourKeyEntry>& key, ImVec2 at,
                     ImVec2 size) {
  push_font(Font::small);
  const float row = ImGui::GetFontSize() + t.px(6), side = ImGui::GetFontSize(), pad = t.px(10);
  float words = 0.0F;
  for (const ColourKeyEntry& e : key)
    words = std::max(words, ImGui::CalcTextSize(tr(e.word).c_str()).x);
  const ImVec2 box{side + t.px(8) + words + 2 * pad,
                   row * static_cast<float>(key.size()) + 2 * pad - t.px(6)};
  ImVec2 corner{at.x + size.x - box.x - t.px(14), at.y + t.px(40)};
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImVec4 ground = t.panel;
  ground.w = 0.85F;
  draw.AddRectFilled(corner, {corner.x + box.x, corner.y + box.y}, ink(ground), t.px(6));
  corner = {corner.x + pad, corner.y + pad};
  for (const ColourKeyEntry& e : key) {
    const std::string word = tr(e.word);
    ImGui::LogText("%s\n", word.c_str());
    draw.AddRectFilled(corner, {corner.x + side, corner.y + side}, ink(e.colour), t.px(3));
    draw.AddRect(corner, {corner.x + side, corner.y + side}, ink(t.text), t.px(3));
    draw.AddText({corner.x + side + t.px(8), corner.y}, ink(t.text), word.c_str());
    corner.y += row;
  }
  pop_font();
}

}  // namespace cavum::station
