#include <imgui.h>

#include "engine/base/text.h"
#include "ui/station/office_line.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {
constexpr char k_no_code[] = "Type your candidate code first.";
}

void sign_in_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  begin_card(t, s.goes_on ? "The exam goes on" : c.practice ? "Practice" : "Examination", 620);
  wrapped_text(c.scenario.title);
  if (!c.scenario.description.empty()) quiet_text(t, c.scenario.description);
  ImGui::Dummy({0, t.px(10)});
  text_line("Your candidate code");
  ImGui::SetNextItemWidth(-1);
  push_font(Font::heading);
  if (s.focus_code) ImGui::SetKeyboardFocusHere();
  s.focus_code = false;
  const bool entered = ImGui::InputText("##code", s.code.data(), s.code.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  pop_font();
  quiet_text(t, s.goes_on ? "The code that it was begun with: what was done so far is kept."
                          : "The code on your card, never your name. It is kept with the recording.");
  ImGui::Dummy({0, t.px(8)});
  ImGui::Checkbox(shown_label("Left-handed layout").c_str(), &s.left_handed);
  ImGui::SameLine(0, t.px(24));
  ImGui::Checkbox(shown_label("High contrast").c_str(), &s.high_contrast);
  ImGui::AlignTextToFramePadding();
  text_line("Size of text");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(t.px(220));
  auto scale = static_cast<float>(s.text_scale);
  ImGui::SliderFloat("##scale", &scale, 0.8F, 1.8F, number_text("%.1f", s.text_scale).c_str(), ImGuiSliderFlags_NoInput);
  s.text_scale = static_cast<double>(static_cast<int>(scale * 10.0F + 0.5F)) / 10.0;
  ImGui::Dummy({0, t.px(8)});
  const std::string code = s.code.data();
  const bool usable = !code.empty() && is_plain_text(code);
  if (main_button(t, "Continue  (Enter)", usable, !ImGui::IsAnyItemActive() && !ImGui::IsAnyItemFocused()) || (entered && usable))
    s.wish = Wish::sign_in;
  if (c.practice) {
    ImGui::SameLine(0, t.px(24));
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + (t.px(44) - ImGui::GetFrameHeight()) / 2);
    bool tutorial = s.tutorial_wanted;
    if (ImGui::Checkbox(shown_label("Two-minute tutorial first").c_str(), &tutorial)) s.tutorial_wanted = tutorial;
  }
  if (entered && !usable) {
    s.focus_code = true;  // Enter would take it away
    s.message = k_no_code;
  }
  if (usable && s.message == k_no_code) s.message.clear();
  bad_text(t, s.message);
  if (const std::string office = office_status(s); !office.empty()) quiet_text(t, office);
  end_area();
}

}  // namespace cavum::station
