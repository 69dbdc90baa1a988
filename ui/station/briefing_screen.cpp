#include <fmt/core.h>
#include <imgui.h>

#include "engine/base/figures.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

std::string pauses_text(const scenarios::PauseSpec& pauses) {
  if (pauses.count == 0) return "none";
  return fmt::format("{}, each of at most {}, while the handpiece stands still (P)", pauses.count, clock_text(pauses.longest_s));
}

void fact(const Theme& t, const char* name, const std::string& value) {
  ImGui::PushStyleColor(ImGuiCol_Text, t.quiet);
  text_line(name);
  ImGui::PopStyleColor();
  ImGui::SameLine(t.px(170));
  wrapped_text(value);
}

}  // namespace

void briefing_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const scenarios::Scenario& scenario = c.sitting->setup().scenario;
  const float words = std::min(t.px(600), screen.x * 0.55F);
  begin_area(t, "briefing words", {s.left_handed ? screen.x - words : 0, 0}, {words, screen.y}, true);
  ImGui::BeginChild("task", {0, ImGui::GetContentRegionAvail().y - t.px(s.message.empty() ? 96 : 140)},
                    false);  // the button below is always in sight
  heading_text(scenario.title);
  wrapped_text(scenario.description);
  ImGui::Dummy({0, t.px(8)});
  const auto limit = static_cast<double>(scenarios::exam_limit_ticks(scenario)) * k_tick_s;
  fact(t, "Candidate", c.sitting->candidate());
  const std::optional<Begun>& begun = c.sitting->begun();
  fact(t, "Time",
       begun && limit > 0 ? fmt::format("{} of {} minutes left", clock_text(begun->left_s), clock_text(limit)) : clock_text(limit) + " minutes");
  if (begun) fact(t, "Mounted", c.sitting->setup().points.at(static_cast<std::size_t>(begun->point)).title);
  const std::string granted = scenarios::accommodations_text(scenario.accommodations);
  if (!granted.empty()) fact(t, "Granted", granted);
  fact(t, "Pauses", pauses_text(scenario.pauses));
  if (scenario.force_limit_n > 0) fact(t, "Force", number_text("at most %.1f N", scenario.force_limit_n));
  std::string points;
  for (const auto& p : c.sitting->setup().points) points += (points.empty() ? "" : "; ") + p.title;
  fact(t, "Diamond points", points);
  ImGui::Dummy({0, t.px(8)});
  ImGui::Separator();
  ImGui::Dummy({0, t.px(4)});
  for (std::size_t i = 0; i < scenario.steps.size(); ++i) {
    push_font(Font::heading);
    ImGui::Text("%zu", i + 1);
    pop_font();
    ImGui::SameLine(t.px(50));
    ImGui::BeginGroup();
    wrapped_text(scenario.steps[i].instruction);
    if (scenario.steps[i].time_limit_s) quiet_text(t, fmt::format("within {} minutes", clock_text(*scenario.steps[i].time_limit_s)));
    ImGui::EndGroup();
  }
  if (c.practice) {
    ImGui::Dummy({0, t.px(12)});
    wrapped_text("This is practice: the target is shown, a coach speaks, and the recording says so.");
  }
  ImGui::EndChild();
  const char* button = begun ? "Go on with the exam  (Enter)" : c.practice ? "Begin to practise  (Enter)" : "Begin the exam  (Enter)";
  if (main_button(t, button, true)) s.wish = Wish::begin;
  quiet_text(t, "The clock runs from then on.");
  bad_text(t, s.message);
  end_area();

  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_area(t, "briefing tooth", {s.left_handed ? 0 : words, 0}, {screen.x - words, screen.y}, false);
  ImGui::PopStyleVar();
  s.view.point = -1;
  tooth_area(c, ImGui::GetContentRegionAvail());
  end_area();
}

}  // namespace cavum::station
