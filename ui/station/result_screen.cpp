#include <imgui.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "grading/result/mark.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

void criteria(const Theme& t, const grading::Result& r) {
  if (!ImGui::BeginTable(
          "criteria", 3,
          ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_PadOuterX))
    return;
  ImGui::TableSetupColumn(shown_label(msg("Criterion")).c_str(),
                          ImGuiTableColumnFlags_WidthStretch);
  ImGui::TableSetupColumn(shown_label(msg("Points")).c_str(), ImGuiTableColumnFlags_WidthFixed,
                          t.px(130));
  ImGui::TableSetupColumn("##share", ImGuiTableColumnFlags_WidthFixed, t.px(190));
  ImGui::TableHeadersRow();
  for (const grading::CriterionResult& c : r.criteria) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    wrapped_text(msg("{}", Authored{c.title}));
    ImGui::TableNextColumn();
    text_line(msg("{} of {}", as_points(c.points), as_points(c.max, 0)));
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = t.px(180),
                share =
                    c.max > 0 ? static_cast<float>(std::clamp(c.points / c.max, 0.0, 1.0)) : 0.0F,
                top = at.y + t.px(6);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, top}, {at.x + width, top + t.px(8)},
                                              ink(t.raised));
    ImGui::GetWindowDrawList()->AddRect({at.x, top}, {at.x + width, top + t.px(8)}, ink(t.line));
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, top}, {at.x + width * share, top + t.px(8)},
                                              ink(c.critical_failed ? t.bad : t.accent));
    ImGui::Dummy({width, t.px(8)});
  }
  ImGui::EndTable();
}

/// The three mistakes that cost most, in words of the clinic. Figures with their bounds, places in
/// mm and ticks are for the report.
void what_to_work_on(const Theme& t, const std::vector<grading::Lesson>& lessons) {
  constexpr std::size_t k_most = 3;
  if (lessons.empty()) return;
  heading_text(msg("What to work on"));
  for (std::size_t i = 0; i < lessons.size() && i < k_most; ++i) {
    const grading::Lesson& l = lessons[i];
    ImGui::PushStyleColor(ImGuiCol_Text, l.fails_exam ? t.bad : t.accent);
    text_line(l.fails_exam ? msg("{} points; this alone fails the exam", as_points(l.points))
                           : msg("{} points", as_points(l.points)));
    ImGui::PopStyleColor();
    wrapped_text(l.what);
    quiet_text(t, l.instead);
  }
}

/// The school tells the result, not the station.
void held_result_screen(const ScreenContext& c) {
  begin_card(c.theme, msg("Your exam is recorded and sealed"), 640, c.state.notice_px);
  wrapped_text(msg("The result is held until the school releases it."));
  quiet_text(c.theme, msg("{},  candidate {}", Authored{c.sitting->setup().scenario.title},
                          c.sitting->candidate()));
  if (c.state.office) quiet_text(c.theme, c.state.office_outcome);
  ImGui::Dummy({0, c.theme.px(8)});
  if (main_button(c.theme, msg("Done  (Enter)"), true)) c.state.wish = Wish::next_candidate;
  end_area();
}

}  // namespace

void grading_screen(const ScreenContext& c) {
  begin_card(c.theme, msg("The exam is over"), 560);
  wrapped_text(msg("Your work is being graded and sealed. You may put the handpiece down."));
  const double phase = std::fmod(ImGui::GetTime(), 1.0);
  ImGui::ProgressBar(static_cast<float>(phase), {-1, c.theme.px(6)}, "");
  end_area();
}

void trouble_screen(const ScreenContext& c) {
  begin_card(c.theme, msg("The exam was interrupted"), 640);
  wrapped_text(c.state.message);
  ImGui::Dummy({0, c.theme.px(8)});
  if (c.sitting != nullptr && !c.sitting->path().empty()) {
    wrapped_text(msg(
        "Everything up to this moment is recorded. Call the supervisor; the exam can be taken up again:"));
    quiet_text(c.theme, Name{"cavum station --resume " + c.sitting->path()});
  }
  ImGui::Dummy({0, c.theme.px(8)});
  if (main_button(c.theme, msg("Close  (Enter)"), true)) c.state.wish = Wish::quit;
  end_area();
}

void result_screen(const ScreenContext& c) {
  if (c.sitting->setup().scenario.hold_results && !c.practice) return held_result_screen(c);
  const Theme& t = c.theme;
  StationState& s = c.state;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const grading::Result& r = c.sitting->closed().result;
  const float words = std::min(t.px(820), screen.x * 0.66F);
  const float top = s.notice_px, high = screen.y - top;
  begin_area(t, "result", {s.left_handed ? screen.x - words : 0, top}, {words, high}, true);
  ImGui::BeginChild("words",
                    {0, ImGui::GetContentRegionAvail().y -
                            t.px((s.message.empty() ? 96.0F : 126.0F) + (s.office ? 30.0F : 0.0F))},
                    false);
  const ImVec4 colour = r.verdict == grading::Verdict::pass   ? t.good
                        : r.verdict == grading::Verdict::fail ? t.bad
                                                              : t.warn;
  push_font(Font::clock);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  text_line(r.verdict == grading::Verdict::pass   ? msg("Passed")
            : r.verdict == grading::Verdict::fail ? msg("Not passed")
                                                  : msg("To be reviewed"));
  ImGui::PopStyleColor();
  pop_font();
  heading_text(msg("{} of {} points", as_points(r.points), as_points(r.max_points, 0)));
  const Authored title{r.scenario_title};
  const ClockTime time{r.motion.time_s};
  quiet_text(
      t, c.practice
             ? msg("{},  candidate {},  {} minutes,  practice", title, c.sitting->candidate(), time)
             : msg("{},  candidate {},  {} minutes", title, c.sitting->candidate(), time));
  for (const auto& reason : r.verdict_reasons)
    if (reason.kind != grading::FindingKind::critical_limit)
      wrapped_text(reason.message());  // that one is among the mistakes
  ImGui::Dummy({0, t.px(4)});
  what_to_work_on(t, c.sitting->lessons());
  ImGui::Dummy({0, t.px(4)});
  criteria(t, r);
  if (c.sitting->report().first_disagreement >= 0)
    wrapped_text(
        msg("The servo and its recording disagree: this result is doubtful. Tell the supervisor."));
  ImGui::EndChild();
  quiet_text(t, msg("Recorded and sealed: {}", c.sitting->path()));
  if (s.office) quiet_text(t, s.office_outcome);
  if (!s.message.empty()) quiet_text(t, s.message);
  if (main_button(t, msg("Done  (Enter)"), true)) s.wish = Wish::next_candidate;
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Write the report  (F2)")).c_str(), {0, t.px(44)}) ||
      key_pressed(GLFW_KEY_F2))
    s.wish = Wish::report;
  end_area();

  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_area(t, "result tooth", {s.left_handed ? 0 : words, top}, {screen.x - words, high}, false);
  ImGui::PopStyleVar();
  s.view.bur = -1;
  tooth_area(c, ImGui::GetContentRegionAvail());
  end_area();
}

}  // namespace cavum::station
