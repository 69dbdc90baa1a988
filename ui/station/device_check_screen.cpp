#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cmath>

#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

/// A tick, a ring or a cross in front of a line: the sign says it, the colour repeats it.
void sign(const Theme& t, CheckItem::State state) {
  const float size = t.px(26);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 middle{at.x + size / 2, at.y + size / 2};
  const float r = size * 0.5F, w = t.px(3);
  if (state == CheckItem::State::good) {
    draw.AddCircleFilled(middle, r, ink(t.good));
    draw.AddLine({middle.x - r * 0.45F, middle.y}, {middle.x - r * 0.1F, middle.y + r * 0.4F},
                 ink(t.on_accent), w);
    draw.AddLine({middle.x - r * 0.1F, middle.y + r * 0.4F},
                 {middle.x + r * 0.5F, middle.y - r * 0.4F}, ink(t.on_accent), w);
  } else if (state == CheckItem::State::bad) {
    draw.AddCircleFilled(middle, r, ink(t.bad));
    draw.AddLine({middle.x - r * 0.4F, middle.y - r * 0.4F},
                 {middle.x + r * 0.4F, middle.y + r * 0.4F}, ink(t.on_accent), w);
    draw.AddLine({middle.x - r * 0.4F, middle.y + r * 0.4F},
                 {middle.x + r * 0.4F, middle.y - r * 0.4F}, ink(t.on_accent), w);
  } else {
    draw.AddCircle(middle, r - 1, ink(t.quiet), 24, w * 0.7F);
  }
  ImGui::Dummy({size, size});
}

Message title() { return msg("Stylus, pedal, finger rest"); }
Message continue_label() { return msg("Continue  (Enter)"); }
constexpr float k_width = 660;

}  // namespace

void preparing_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  begin_card(t, title(), k_width);
  wrapped_text(msg("The tooth is being prepared ..."));
  const double phase = std::fmod(ImGui::GetTime(), 1.0);
  ImGui::ProgressBar(static_cast<float>(phase), {-1, t.px(6)}, "");
  ImGui::Dummy({0, t.px(10)});
  main_button(t, continue_label(), false);
  if (!c.state.message.empty()) quiet_text(t, c.state.message);
  end_area();
}

void device_check_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  begin_card(t, title(), k_width);
  if (PointerStylus* pointer = c.sitting->device().pointer()) {
    PointerIntent still;
    still.tip_mm = s.wanted_mm;
    still.rotation = s.wanted_rotation;
    still.pedal = key_held(GLFW_KEY_SPACE) ||
                          (ImGui::IsMouseDown(ImGuiMouseButton_Left) && !ImGui::IsAnyItemHovered())
                      ? 1.0
                      : 0.0;
    pointer->want(still);
    quiet_text(t, msg("Mouse and keyboard: the pedal is the space bar or the left button."));
  }
  const DeviceSight sight = c.sitting->sight();
  const auto items = check_items(sight);
  for (const CheckItem& item : items) {
    ImGui::Dummy({0, t.px(4)});
    sign(t, item.state);
    ImGui::SameLine(0, t.px(16));
    ImGui::BeginGroup();
    text_line(item.title);
    quiet_text(t, item.detail);
    ImGui::EndGroup();
  }
  ImGui::Dummy({0, t.px(6)});
  text_line(msg("Pedal"));
  ImGui::SameLine(t.px(110));
  ImGui::ProgressBar(sight.pedal_known ? static_cast<float>(sight.pedal) : 0.0F, {-1, t.px(16)},
                     "");
  ImGui::Dummy({0, t.px(10)});
  if (main_button(t, continue_label(), all_good(items))) s.wish = Wish::to_briefing;
  if (!s.message.empty()) quiet_text(t, s.message);
  end_area();
}

}  // namespace cavum::station
