#include <imgui.h>

#include <cstdio>

#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum {

void save_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  begin_card(t, "The disk is full", 680);
  wrapped_text("Your work is safe as long as this window stays open: do not close it, do not switch the computer off. Call the supervisor.");
  ImGui::Dummy({0, t.px(6)});
  char waiting[96] = "The end of the exam, tooth and result, is in memory only.";
  if (const double s_waiting = c.sitting->unwritten_s(); s_waiting > 0)
    std::snprintf(waiting, sizeof waiting, "%.1f s of the exam and its end are in memory only.", s_waiting);
  wrapped_text(waiting);
  quiet_text(t, c.sitting->trouble());
  ImGui::Dummy({0, t.px(8)});
  wrapped_text("Supervisor: make room, and it is saved by itself; or type another folder or file (.cavum), on another disk:");
  ImGui::SetNextItemWidth(-1);
  if (s.focus_place) ImGui::SetKeyboardFocusHere();
  s.focus_place = false;
  const bool entered = ImGui::InputText("##place", s.place.data(), s.place.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::Dummy({0, t.px(8)});
  if (main_button(t, "Save  (Enter)", true, false) || entered) s.wish = Wish::save;
  if (entered) s.focus_place = true;
  bad_text(t, s.message);
  end_area();
}

}  // namespace cavum
