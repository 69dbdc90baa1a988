#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <utility>

#include "ui/language/say.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

void ask_for_code(const ScreenContext& c, bool fresh) {
  StationState& s = c.state;
  text_line(msg("Only the supervisor closes this station. Supervisor, type your code:"));
  ImGui::SetNextItemWidth(-1);
  if (fresh || std::exchange(s.focus_supervisor, false)) ImGui::SetKeyboardFocusHere();
  const bool entered =
      ImGui::InputText("##supervisor", s.supervisor_code.data(), s.supervisor_code.size(),
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_Password);
  bad_text(c.theme, s.leave_message);
  ImGui::Dummy({0, c.theme.px(6)});
  if (main_button(c.theme, msg("Close the station  (Enter)"), true, false) || entered)
    s.wish = Wish::leave;
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Back  (Esc)")).c_str(), {0, c.theme.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_ESCAPE)))
    s.confirm_leave = false;
}

void ask_plainly(const ScreenContext& c, bool fresh) {
  StationState& s = c.state;
  text_line(msg("The exam is not handed in: it stays open, and can be gone on with."));
  text_line(msg("That it was left is recorded."));
  ImGui::Dummy({0, c.theme.px(6)});
  if (main_button(c.theme, msg("Back to the exam  (Esc)"), true, !fresh) ||
      (!fresh && key_pressed(GLFW_KEY_ESCAPE)))
    s.confirm_leave = false;
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Close the window  (F4)")).c_str(), {0, c.theme.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_F4)))
    s.wish = Wish::leave;
}

}  // namespace

void ask_whether_to_leave(const ScreenContext& c, bool locked) {
  StationState& s = c.state;
  bool fresh = false;
  if (!begin_question(c.theme, "Leave?",
                      locked ? msg("This station is locked") : msg("Leave the exam?"),
                      s.confirm_leave, fresh))
    return;
  locked ? ask_for_code(c, fresh) : ask_plainly(c, fresh);
  end_question(s.confirm_leave);
  if (s.confirm_leave) return;
  s.supervisor_code = {};
  s.leave_message = {};
  s.focus_code = s.screen == Screen::sign_in;  // the question took it away
}

void demonstration_in_picture(const Theme& t, ImVec2 at, ImVec2 size) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  push_font(Font::clock);
  const std::string word = tr("DEMONSTRATION");
  const ImVec2 text = ImGui::CalcTextSize(word.c_str());
  ImVec4 colour = t.warn;
  colour.w = 0.30F;
  draw.PushClipRect(at, {at.x + size.x, at.y + size.y}, true);
  int row = 0;
  for (float y = at.y + 0.5F * text.y; y < at.y + size.y; y += 2.2F * text.y, ++row)
    for (float x = at.x - (row % 2 == 0 ? 0.2F : 0.75F) * text.x; x < at.x + size.x;
         x += 1.25F * text.x)
      draw.AddText({x, y}, ink(colour), word.c_str());
  draw.PopClipRect();
  pop_font();
}

}  // namespace cavum::station
