#include <imgui.h>

#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

Message pauses_text(const scenarios::PauseSpec& pauses) {
  if (pauses.count == 0) return msg("none");
  return msg("{}, each of at most {}, while the handpiece stands still (P)", pauses.count,
             ClockTime{pauses.longest_s});
}

void fact(const Theme& t, const Message& name, const Message& value) {
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
  begin_area(t, "briefing words", {s.left_handed ? screen.x - words : 0, 0}, {words, screen.y},
             true);
  ImGui::BeginChild("task",
                    {0, ImGui::GetContentRegionAvail().y - t.px(s.message.empty() ? 96 : 140)},
                    false);  // the button below is always in sight
  heading_text(msg("{}", Authored{scenario.title}));
  wrapped_text(msg("{}", Authored{scenario.description}));
  ImGui::Dummy({0, t.px(8)});
  const auto limit = static_cast<double>(scenarios::exam_limit_ticks(scenario)) * k_tick_s;
  fact(t, msg("Candidate"), Name{c.sitting->candidate()});
  const std::optional<Begun>& begun = c.sitting->begun();
  fact(t, msg("Time"),
       begun && limit > 0 ? msg("{} of {} minutes left", ClockTime{begun->left_s}, ClockTime{limit})
                          : msg("{} minutes", ClockTime{limit}));
  if (begun)
    fact(t, msg("Mounted"),
         msg("{}",
             Authored{c.sitting->setup().burs.at(static_cast<std::size_t>(begun->bur)).title}));
  const Message granted = scenarios::accommodations_text(scenario.accommodations);
  if (!granted.empty()) fact(t, msg("Granted"), granted);
  fact(t, msg("Pauses"), pauses_text(scenario.pauses));
  if (scenario.force_limit_n > 0)
    fact(t, msg("Force"), msg("at most {}", as_n(scenario.force_limit_n, 1)));
  List burs{{}, true};
  for (const auto& p : c.sitting->setup().burs) burs.items.push_back(msg("{}", Authored{p.title}));
  fact(t, msg("Burs"), msg("{}", burs));
  ImGui::Dummy({0, t.px(8)});
  ImGui::Separator();
  ImGui::Dummy({0, t.px(4)});
  for (std::size_t i = 0; i < scenario.steps.size(); ++i) {
    push_font(Font::heading);
    ImGui::Text("%zu", i + 1);
    pop_font();
    ImGui::SameLine(t.px(50));
    ImGui::BeginGroup();
    wrapped_text(msg("{}", Authored{scenario.steps[i].instruction}));
    if (scenario.steps[i].time_limit_s)
      quiet_text(t, msg("within {} minutes", ClockTime{*scenario.steps[i].time_limit_s}));
    ImGui::EndGroup();
  }
  if (c.practice) {
    ImGui::Dummy({0, t.px(12)});
    wrapped_text(
        msg("This is practice: the target is shown, a coach speaks, and the recording says so."));
  }
  ImGui::EndChild();
  const Message button = begun        ? msg("Go on with the exam  (Enter)")
                         : c.practice ? msg("Begin to practise  (Enter)")
                                      : msg("Begin the exam  (Enter)");
  if (main_button(t, button, true)) s.wish = Wish::begin;
  quiet_text(t, msg("The clock runs from then on."));
  bad_text(t, s.message);
  end_area();

  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_area(t, "briefing tooth", {s.left_handed ? 0 : words, 0}, {screen.x - words, screen.y},
             false);
  ImGui::PopStyleVar();
  s.view.bur = -1;
  tooth_area(c, ImGui::GetContentRegionAvail());
  end_area();
}

}  // namespace cavum::station
