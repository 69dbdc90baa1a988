#include <imgui.h>

#include "engine/base/text.h"
#include "ui/language/say.h"
#include "ui/station/office_line.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
void sign_in_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  begin_card(t,
             s.goes_on    ? msg("The exam goes on")
             : c.practice ? msg("Practice")
                          : msg("Examination"),
             620);
  wrapped_text(msg("{}", Authored{c.scenario.title}));
  if (!c.scenario.description.empty()) quiet_text(t, msg("{}", Authored{c.scenario.description}));
  ImGui::Dummy({0, t.px(10)});
  text_line(msg("Your candidate code"));
  ImGui::SetNextItemWidth(-1);
  push_font(Font::heading);
  if (s.focus_code) ImGui::SetKeyboardFocusHere();
  s.focus_code = false;
  const bool entered = ImGui::InputText("##code", s.code.data(), s.code.size(),
                                        ImGuiInputTextFlags_EnterReturnsTrue);
  pop_font();
  quiet_text(
      t, s.goes_on ? msg("The code that it was begun with: what was done so far is kept.")
                   : msg("The code on your card, never your name. It is kept with the recording."));
  ImGui::Dummy({0, t.px(8)});
  ImGui::Checkbox(shown_label(msg("Left-handed layout")).c_str(), &s.left_handed);
  ImGui::SameLine(0, t.px(24));
  ImGui::Checkbox(shown_label(msg("High contrast")).c_str(), &s.high_contrast);
  ImGui::AlignTextToFramePadding();
  text_line(msg("Size of text"));
  ImGui::SameLine();
  ImGui::SetNextItemWidth(t.px(220));
  auto scale = static_cast<float>(s.text_scale);
  ImGui::SliderFloat("##scale", &scale, 0.8F, 1.8F, tr("{}", as_number(s.text_scale, 1)).c_str(),
                     ImGuiSliderFlags_NoInput);
  s.text_scale = static_cast<double>(static_cast<int>(scale * 10.0F + 0.5F)) / 10.0;
  ImGui::Dummy({0, t.px(8)});
  const std::string code = s.code.data();
  const bool usable = !code.empty() && is_plain_text(code);
  if (main_button(t, msg("Continue  (Enter)"), usable,
                  !ImGui::IsAnyItemActive() && !ImGui::IsAnyItemFocused()) ||
      (entered && usable))
    s.wish = Wish::sign_in;
  if (c.practice) {
    ImGui::SameLine(0, t.px(24));
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + (t.px(44) - ImGui::GetFrameHeight()) / 2);
    bool tutorial = s.tutorial_wanted;
    if (ImGui::Checkbox(shown_label(msg("Two-minute tutorial first")).c_str(), &tutorial))
      s.tutorial_wanted = tutorial;
  }
  if (entered && !usable) {
    s.focus_code = true;  // Enter would take it away
    s.message = {};
  }
  s.code_missing = !usable && (s.code_missing || entered);
  bad_text(t, s.code_missing ? msg("Type your candidate code first.") : s.message);
  if (const Message office = office_status(s); !office.empty()) quiet_text(t, office);
  end_area();
}

}  // namespace cavum::station
