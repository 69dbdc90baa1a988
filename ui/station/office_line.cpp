#include "ui/station/office_line.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/session/station_key.h"
#include "ui/language/say.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

constexpr auto k_between_tellings = std::chrono::milliseconds(250);
constexpr double k_gone_s = 15.0;

/// At most 200 bytes in one line.
std::string short_line(const std::string& text) {
  constexpr std::size_t k_longest = 180;
  std::string line = one_line(text);
  if (line.size() <= k_longest) return line;
  std::size_t end = k_longest;
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xc0U) == 0x80U)
    --end;  // no letter is cut
  return line.substr(0, end) + "…";
}

bool is_open(const Sitting* sitting) {
  return sitting != nullptr &&
         (sitting->stage() == Stage::running || sitting->stage() == Stage::grading ||
          sitting->stage() == Stage::unsaved || sitting->stage() == Stage::interrupted);
}

}  // namespace

OfficeLine::OfficeLine(const office::LinkOptions& options)
    : link_(options, load_station_key(station_key_path())) {}

office::StationReport office_report(const StationState& state, Sitting* sitting) {
  office::StationReport r;
  switch (state.screen) {
    case Screen::self_check:
    case Screen::preparing:
    case Screen::device_check:
      r.state = office::AtStation::check;
      break;
    case Screen::briefing:
      r.state = office::AtStation::briefing;
      break;
    case Screen::exam:
      r.state = office::AtStation::exam;
      break;
    case Screen::grading:
    case Screen::result:
    case Screen::trouble:
    case Screen::save:
      r.state = office::AtStation::ended;
      break;
    default:
      r.state = office::AtStation::free;
  }
  if (sitting == nullptr) return r;
  constexpr double k_day_s = 86'400;
  r.here_s = static_cast<std::int64_t>(std::min(k_day_s, sitting->here_s()));
  if (sitting->stage() != Stage::preparing) r.candidate = short_line(sitting->candidate());
  if (state.screen == Screen::trouble || state.screen == Screen::save)
    r.alarm = short_line(tr(sitting->trouble()));
  if (sitting->stage() != Stage::running) return r;
  const scenarios::LiveView view = sitting->live().view();
  const auto& steps = sitting->setup().scenario.steps;
  const auto step = static_cast<std::size_t>(view.step);
  r.step = short_line(step < steps.size()
                          ? fmt::format("{}/{} {}", step + 1, steps.size(), steps[step].id)
                          : fmt::format("{0}/{0}", steps.size()));
  if (view.limit_ticks > 0)
    r.left_s = std::max<std::int64_t>(
        0, (view.limit_ticks - view.ticks + view.paused_ticks) / k_ticks_per_second);
  r.held = view.held;
  if (view.paused || view.held) r.state = office::AtStation::paused;
  if (!view.recording_error.empty())
    r.alarm = short_line(tr(view.recording_error));
  else if (const std::optional<Error> problem = sitting->device().problem())
    r.alarm = short_line(tr(problem->where_and_problem()));
  else if (state.attempt_shown_s > 0)
    r.alarm = short_line(tr(state.attempt));
  return r;
}

void OfficeLine::exchange(StationState& state, Sitting* sitting) {
  state.office = link_.view();
  if (sitting != nullptr) {
    sitting->desk().hold.store(state.office->hold != 0, std::memory_order_relaxed);
    if (sitting->stage() == Stage::running) note_what_was_said(state, *sitting);
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - told_at_ < k_between_tellings) return;
  told_at_ = now;
  link_.say(office_report(state, sitting));
  link_.recording(is_open(sitting) ? sitting->path() : std::string());
  if (is_open(sitting)) handed_in_ = false;
  if (!handed_in_ && (sitting == nullptr || sitting->stage() == Stage::done)) {
    handed_in_ = true;
    link_.hand_in();
  }
  if (sitting != nullptr && sitting->stage() == Stage::done)
    state.office_outcome = outcome_text(sitting->path());
}

void OfficeLine::note_what_was_said(const StationState& state, Sitting& sitting) {
  if (noted_in_ != &sitting) noted_hold_ = noted_ = 0;
  noted_in_ = &sitting;
  const office::LinkView& office = *state.office;
  if (office.hold != 0 && office.hold != noted_hold_) {
    noted_hold_ = office.hold;
    sitting.note(OfficeHold{{office.hold, office.hold_reason}});
  }
  for (const auto& t : office.told) {
    if (t.entry <= noted_) continue;
    noted_ = t.entry;
    sitting.note(Announced{{t.entry, t.text}});
  }
}

void OfficeLine::read(StationState& state, Sitting* sitting) {
  if (!state.office || state.office->told.empty()) return;
  const std::uint64_t entry = state.office->told.front().entry;
  link_.read(entry);
  if (sitting != nullptr) sitting->note(AnnouncementRead{{entry}});
  state.office = link_.view();
}

void OfficeLine::release(const StationState& state, Sitting* sitting) {
  if (!may_go_on_without(state)) return;
  link_.release(state.office->hold);
  if (sitting != nullptr) sitting->note(OfficeHoldReleased{{state.office->hold}});
}

void OfficeLine::require_free(const StationState& state) {
  if (state.office && state.office->hold != 0)
    throw Error(msg("the exam office"),
                msg("has paused the exams here ({})", state.office->hold_reason),
                msg("wait until they go on"));
}

Message OfficeLine::outcome_text(const std::string& recording) {
  const auto outcome = office::StationLink::outcome(recording);
  if (!outcome) return msg("It is handed in to the exam office by itself as soon as that answers.");
  if (outcome->filed) return msg("Handed in to the exam office: entry {}.", outcome->entry);
  return msg("The exam office did not take it. Tell the invigilator: {}",
             Authored{outcome->findings.empty() ? "" : outcome->findings.front()});
}

Message announcement_text(const office::ReceivedAnnouncement& told) {
  const auto seconds = static_cast<std::time_t>(told.utc_ns / 1'000'000'000);
  std::tm local{};
  ::localtime_r(&seconds, &local);
  return msg("{}  {}", fmt::format("{:02}:{:02}", local.tm_hour, local.tm_min), told.text);
}

Message office_status(const StationState& state) {
  if (!state.office) return {};
  const office::LinkView& office = *state.office;
  const Message now =
      office.reached
          ? msg("The exam office answers.")
          : msg("The exam office does not answer: exams go on without it, and are handed in later. {}",
                office.trouble);
  return office.waiting > 0 ? msg("{} {}", now, msg("Waiting to be handed in: {}.", office.waiting))
                            : now;
}

bool may_go_on_without(const StationState& state) noexcept {
  return state.office && state.office->hold != 0 && state.office->silent_s > k_gone_s;
}

void office_notice(const ScreenContext& c) {
  StationState& s = c.state;
  s.notice_px = 0;
  if (!s.office || (s.office->hold == 0 && s.office->told.empty())) return;
  if (s.office->hold == 0 && key_pressed(GLFW_KEY_HOME)) s.wish = Wish::read;
  if (s.screen == Screen::exam) return;
  const Theme& t = c.theme;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float width = std::min(t.px(900), screen.x - t.px(40));
  ImGui::SetNextWindowPos({screen.x / 2, t.px(12)}, ImGuiCond_Always, {0.5F, 0.0F});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, screen.y / 2});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, t.raised);
  ImGui::PushStyleColor(ImGuiCol_Border, t.warn);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, t.px(2));
  ImGui::Begin("office", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
  if (s.office->hold != 0) {
    text_line(msg("PAUSED BY THE EXAM OFFICE"));
    wrapped_text(Name{s.office->hold_reason});
    quiet_text(t, msg("No exam begins or goes on here until the office says so."));
  } else {
    text_line(msg("FROM THE EXAM OFFICE"));
    wrapped_text(announcement_text(s.office->told.front()));
    if (side_button(t, msg("I have read it  (Home)"))) s.wish = Wish::read;
  }
  s.notice_px = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y + t.px(12);
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor(2);
}

void ask_whether_to_go_on(const ScreenContext& c, bool locked) {
  StationState& s = c.state;
  if (s.screen == Screen::exam && may_go_on_without(s) && key_pressed(GLFW_KEY_HOME))
    s.confirm_go_on = true;
  if (s.confirm_go_on && !may_go_on_without(s)) s.confirm_go_on = false;
  bool fresh = false;
  if (!begin_question(c.theme, "Go on?", msg("Go on without the exam office?"), s.confirm_go_on,
                      fresh))
    return;
  text_line(
      msg("The office has paused this exam and does not answer. That it goes on is recorded."));
  if (locked) {
    text_line(msg("Supervisor, type your code:"));
    ImGui::SetNextItemWidth(-1);
    if (fresh || std::exchange(s.focus_supervisor, false)) ImGui::SetKeyboardFocusHere();
    ImGui::InputText("##go on", s.supervisor_code.data(), s.supervisor_code.size(),
                     ImGuiInputTextFlags_Password);
    bad_text(c.theme, s.leave_message);
  }
  ImGui::Dummy({0, c.theme.px(6)});
  if (main_button(c.theme, msg("Go on  (Enter)"), true, !fresh)) s.wish = Wish::go_on;
  ImGui::SameLine();
  if (ImGui::Button(shown_label(msg("Back  (Esc)")).c_str(), {0, c.theme.px(44)}) ||
      (!fresh && key_pressed(GLFW_KEY_ESCAPE)))
    s.confirm_go_on = false;
  end_question(s.confirm_go_on);
  if (s.confirm_go_on) return;
  s.supervisor_code = {};
  s.leave_message = {};
}

}  // namespace cavum::station
