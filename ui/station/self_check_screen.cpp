#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <utility>

#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

constexpr float k_check_width = 720;

void found_figures(const Theme& t, const ArmFigures& f) {
  quiet_text(
      t,
      msg("Friction {}, {} and {}; moved mass {} g; step {}; {} readings a second.",
          as_n(f.axes[0].friction_n), as_n(f.axes[1].friction_n), as_n(f.axes[2].friction_n),
          as_number(1000.0 / 3.0 * (f.axes[0].mass_kg + f.axes[1].mass_kg + f.axes[2].mass_kg), 0),
          as_mm(f.quantum_mm, 3), as_number(f.rate_hz, 0)));
}

/// Something changed, or nothing can be said: again, or on with it.
void ask_to_go_on(const ScreenContext& c, bool fresh_code) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  if (side_button(t, msg("Check again"))) s.wish = Wish::check;
  if (c.locked) {
    text_line(msg("Supervisor, type your code to go on with it:"));
    ImGui::SetNextItemWidth(-1);
    if (fresh_code || std::exchange(s.focus_supervisor, false)) ImGui::SetKeyboardFocusHere();
    if (ImGui::InputText("##supervisor", s.supervisor_code.data(), s.supervisor_code.size(),
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_Password))
      s.wish = Wish::check_go_on;
  } else {
    ImGui::SameLine();
    if (side_button(t, msg("Go on with it  (G)")) || key_pressed(GLFW_KEY_G))
      s.wish = Wish::check_go_on;
  }
  quiet_text(t, msg("What is decided is kept, and the exam says it."));
}

}  // namespace

void self_check_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  begin_card(t, msg("The station checks its stylus"), k_check_width);
  const StationCheck& check = *c.check;
  if (check.running()) {
    const ArmProgress p = check.progress();
    wrapped_text(p.words);
    ImGui::ProgressBar(static_cast<float>(p.share), {-1, t.px(16)}, "");
    quiet_text(t, msg("It takes a minute. Hands off the stylus and the table."));
  } else if (check.found()) {
    const CheckEntry& e = check.found()->entry;
    heading_text(msg("{}: {}", e.station, Term{outcome_name(e.verdict.outcome)}));
    wrapped_text(in_words(e.verdict));
    if (e.figures.doubt.empty()) found_figures(t, e.figures);
    ImGui::Dummy({0, t.px(8)});
    if (check.good()) {
      if (main_button(t, msg("Continue  (Enter)"), true)) s.wish = Wish::check_go_on;
    } else {
      if (e.verdict.outcome == CheckOutcome::changed)
        quiet_text(t, msg("Since {}.", utc_text(e.since_utc_ns)));
      ask_to_go_on(c, false);
    }
  } else {
    bad_text(t, check.error());
    wrapped_text(msg(
        "Put the stylus into the middle of its reach, out of its holder. Then let go of it: it is pushed gently, by 1 N at most."));
    ImGui::Dummy({0, t.px(8)});
    if (main_button(t, msg("Begin the check  (Enter)"), true)) s.wish = Wish::check;
  }
  bad_text(t, s.message);
  end_area();
}

}  // namespace cavum::station
