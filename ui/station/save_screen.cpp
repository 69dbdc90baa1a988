#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

/// The window was asked to close: what would be lost, and how it is not.
void ask_whether_to_close(const ScreenContext& c) {
  StationState& s = c.state;
  bool fresh = false;
  if (!begin_question(c.theme, "Close?", msg("This exam is not saved yet"), s.confirm_close, fresh))
    return;
  text_line(msg("If the window closes now, its end and its result are lost."));
  text_line(msg(
      "It can be saved to this computer's folder for temporary files first; copy it from there."));
  if (s.rescue_failed)
    bad_text(c.theme, msg("There it cannot be written either: make room, or type another place."));
  ImGui::Dummy({0, c.theme.px(6)});
  if (main_button(c.theme, msg("Save it there and close  (Enter)"), true, !fresh))
    s.wish = Wish::rescue;
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Back  (Esc)")).c_str(), {0, c.theme.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_ESCAPE)))
    s.confirm_close = false;
  if (s.rescue_failed) {
    ImGui::SameLine();
    if (ImGui::Button(shown_label(msg("Close and lose it")).c_str(), {0, c.theme.px(44)}))
      s.wish = Wish::abandon;
  }
  end_question(s.confirm_close);
}

}  // namespace

void save_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  begin_card(t, msg("The disk is full"), 680);
  wrapped_text(msg(
      "Your work is safe as long as this window stays open: do not close it, do not switch the computer off. Call the supervisor."));
  ImGui::Dummy({0, t.px(6)});
  const double s_waiting = c.sitting->unwritten_s();
  wrapped_text(s_waiting > 0
                   ? msg("{} of the exam and its end are in memory only.", as_s(s_waiting, 1))
                   : msg("The end of the exam, tooth and result, is in memory only."));
  quiet_text(t, c.sitting->trouble());
  ImGui::Dummy({0, t.px(8)});
  wrapped_text(msg(
      "Supervisor: make room, and it is saved by itself; or type another folder or file (.cavum), on another disk:"));
  ImGui::SetNextItemWidth(-1);
  if (s.focus_place) ImGui::SetKeyboardFocusHere();
  s.focus_place = false;
  const bool entered = ImGui::InputText("##place", s.place.data(), s.place.size(),
                                        ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::Dummy({0, t.px(8)});
  if (main_button(t, msg("Save  (Enter)"), true, false) || (entered && !s.confirm_close))
    s.wish = Wish::save;
  if (entered) s.focus_place = true;
  bad_text(t, s.message);
  end_area();
  ask_whether_to_close(c);
}

}  // namespace cavum::station
