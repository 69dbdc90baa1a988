#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/base/figures.h"
#include "ui/language/say.h"
#include "ui/station/gauges.h"
#include "ui/station/screens.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

void top_bar(const ScreenContext& c, ImVec2 size) {
  const Theme& t = c.theme;
  const ReplayPlayer& player = *c.replay;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {t.px(20), t.px(10)});
  begin_area(t, "replay top", {0, 0}, size, true);
  ImGui::PopStyleVar();
  ImGui::BeginChild("replay step", {size.x - t.px(260), 0}, false, ImGuiWindowFlags_NoScrollbar);
  quiet_text(t, msg("Replay of {}    candidate {}", player.session().path(),
                    player.session().setup().candidate));
  const std::string& instruction = player.instruction(player.shown().runner);
  wrapped_text(instruction.empty() ? msg("The exam is over.") : msg("{}", Authored{instruction}));
  ImGui::EndChild();
  ImGui::SameLine();
  ImGui::BeginChild("replay clock", {0, 0}, false, ImGuiWindowFlags_NoScrollbar);
  const scenarios::RunnerState& runner = player.shown().runner;
  exam_clock(t, static_cast<double>(runner.ticks - runner.paused_ticks) * k_tick_s, 0.0,
             scenarios::Runner::paused(runner));
  ImGui::EndChild();
  end_area();
}

/// The time line: played up to here, marks for what happened; a click or a pull goes there.
void time_line(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  ReplayPlayer& player = *c.replay;
  const float width = ImGui::GetContentRegionAvail().x, height = t.px(22);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const auto all = static_cast<double>(std::max<std::int64_t>(1, player.ticks()));
  ImGui::InvisibleButton("time line", {width, height});
  if (ImGui::IsItemActive()) {
    s.replay_at =
        std::clamp(static_cast<double>((ImGui::GetIO().MousePos.x - at.x) / width), 0.0, 1.0) * all;
    s.playing = false;
  }
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto x_of = [&](double tick) { return at.x + width * static_cast<float>(tick / all); };
  draw.AddRectFilled(at, {at.x + width, at.y + height}, ink(t.raised), t.px(4));
  draw.AddRectFilled(at, {x_of(static_cast<double>(player.shown().tick)), at.y + height},
                     ink(t.accent), t.px(4));
  draw.AddRectFilled({x_of(s.replay_at) - t.px(2), at.y - t.px(4)},
                     {x_of(s.replay_at) + t.px(2), at.y + height + t.px(4)}, ink(t.text));
  for (const ReplayMoment& m : player.moments()) {
    const float x = x_of(static_cast<double>(m.tick));
    draw.AddTriangleFilled({x - t.px(6), at.y + height + t.px(14)},
                           {x + t.px(6), at.y + height + t.px(14)}, {x, at.y + height + t.px(3)},
                           ink(m.bad ? t.bad : t.good));
    if (ImGui::IsMouseHoveringRect({x - t.px(7), at.y}, {x + t.px(7), at.y + height + t.px(15)}))
      ImGui::SetTooltip(
          "%s", tr("{}, {}", m.what, ClockTime{static_cast<double>(m.tick) * k_tick_s}).c_str());
  }
  ImGui::Dummy({width, t.px(14)});
}

void go_to_moment(const ScreenContext& c, int number) {
  if (number < 0) return;
  c.state.replay_moment = number;
  c.state.replay_at =
      static_cast<double>(c.replay->moments()[static_cast<std::size_t>(number)].tick);
  c.state.playing = false;
}

/// Time, what happened and the points it cost, a row each; a click or PgUp and PgDn go there.
void moment_list(const ScreenContext& c, float height) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  const auto& moments = c.replay->moments();
  const auto now = static_cast<std::int64_t>(s.replay_at);
  const int before = s.replay_moment;
  const int step = (ImGui::IsKeyPressed(GLFW_KEY_PAGE_DOWN) ? 1 : 0) -
                   (ImGui::IsKeyPressed(GLFW_KEY_PAGE_UP) ? 1 : 0);
  if (step != 0) go_to_moment(c, compared_moment(moments, now, s.replay_moment, step));
  text_line(msg("Events  (PgUp, PgDn)"));
  ImGui::BeginChild("moments", {0, height}, false);
  push_font(Font::small);
  const float wide = ImGui::GetContentRegionAvail().x, left = t.px(42), right = t.px(46),
              line = ImGui::GetTextLineHeight();
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const ReplayMoment& m = moments[i];
    const std::string what = tr(m.what), words = in_lines(what, wide - left - right),
                      time = clock_text(static_cast<double>(m.tick) * k_tick_s);
    const std::string points = m.lost ? tr("{}", as_points(-*m.lost)) : "";
    const ImVec2 at = ImGui::GetCursorScreenPos(), box = ImGui::CalcTextSize(words.c_str());
    const bool chosen =
        static_cast<int>(i) == s.replay_moment && m.tick == static_cast<std::int64_t>(s.replay_at);
    ImGui::PushID(static_cast<int>(i));
    if (ImGui::Selectable("##moment", chosen, 0, {0, std::max(box.y, line)}))
      go_to_moment(c, static_cast<int>(i));
    ImGui::PopID();
    if (chosen && s.replay_moment != before) ImGui::SetScrollHereY();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddText(at, ink(t.quiet), time.c_str());
    draw.AddText({at.x + left, at.y}, ink(t.text), words.c_str());
    draw.AddText({at.x + wide - ImGui::CalcTextSize(points.c_str()).x, at.y},
                 ink(m.bad ? t.bad : t.text), points.c_str());
    ImGui::LogText("%s %s %s\n", time.c_str(), what.c_str(), points.c_str());
  }
  pop_font();
  ImGui::EndChild();
}

void controls(const ScreenContext& c, ImVec2 at, ImVec2 size) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  const auto all = static_cast<double>(c.replay->ticks());
  begin_area(t, "replay controls", at, size, true);
  time_line(c);
  const double back_s = ImGui::GetIO().KeyShift ? 10.0 : 1.0;
  const Message stop = msg("Stop  (Space)"), play = msg("Play  (Space)");
  const auto wide = [](const Message& label) {
    return ImGui::CalcTextSize(tr(label).c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
  };
  const float room = std::max(wide(stop), wide(play));  // it stays where it is, whichever it says
  if (side_button(t, s.playing ? stop : play, room) || key_pressed(GLFW_KEY_SPACE)) {
    s.playing = !s.playing;
    if (s.playing && s.replay_at >= all) s.replay_at = 0.0;
  }
  ImGui::SameLine();
  if (side_button(t, msg("-1 s  (,)")) || ImGui::IsKeyPressed(GLFW_KEY_COMMA))
    s.replay_at -= 1000.0 * back_s;
  ImGui::SameLine();
  if (side_button(t, msg("+1 s  (.)")) || ImGui::IsKeyPressed(GLFW_KEY_PERIOD))
    s.replay_at += 1000.0 * back_s;
  ImGui::SameLine();
  if (side_button(t, msg("Begin  (Home)")) || key_pressed(GLFW_KEY_HOME)) s.replay_at = 0.0;
  ImGui::SameLine();
  if (side_button(t, msg("End  (End)")) || key_pressed(GLFW_KEY_END)) s.replay_at = all;
  ImGui::SameLine();
  for (const double speed : {0.25, 1.0, 4.0, 16.0}) {
    const bool chosen = s.replay_speed == speed;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Text, t.accent);
    ImGui::PushID(static_cast<int>(100 * speed));
    if (side_button(t, msg("{} x", as_number(speed)))) s.replay_speed = speed;
    ImGui::PopID();
    if (chosen) ImGui::PopStyleColor();
    ImGui::SameLine();
  }
  if (key_pressed(GLFW_KEY_LEFT_BRACKET)) s.replay_speed = std::max(0.25, s.replay_speed / 4.0);
  if (key_pressed(GLFW_KEY_RIGHT_BRACKET)) s.replay_speed = std::min(16.0, s.replay_speed * 4.0);
  if (side_button(t, s.view.clear ? msg("Opaque  (C)") : msg("Clear  (C)")) ||
      key_pressed(GLFW_KEY_C))
    s.view.clear = !s.view.clear;
  if (key_pressed(GLFW_KEY_ESCAPE)) s.wish = Wish::quit;
  s.replay_at = std::clamp(s.replay_at, 0.0, all);
  end_area();
}

}  // namespace

void replay_screen(const ScreenContext& c) {
  const Theme& t = c.theme;
  StationState& s = c.state;
  ReplayPlayer& player = *c.replay;
  if (s.playing) {
    s.replay_at = std::min(s.replay_at + 1000.0 * c.frame_s * s.replay_speed,
                           static_cast<double>(player.ticks()));
    if (s.replay_at >= static_cast<double>(player.ticks())) s.playing = false;
  }
  player.seek(static_cast<std::int64_t>(s.replay_at));
  // on the way to a far place the window stays awake, and shows the tooth and the figures from
  // where it sets out
  const bool there = player.work(s.playing ? 0.03 : 0.12);
  if (there || s.playing) {
    c.scene->tooth().take(player.tooth());
    c.scene->tooth().update();
    player.show();
    s.view.tool = {player.shown().output.proxy_mm, player.shown().input.pose().rotation};
    s.view.bur = player.shown().input.bur;
    s.view.pressed = player.shown().output.contact;
    if (s.playing) turn_bur(s.view, player.shown().output.rpm, c.frame_s);
  }
  constexpr double k_pale = 0.5;  // of what it cut is not at hand here
  if (s.playing)
    spray_on(s.view.spray, player.shown().output.rpm, player.shown().output.cutting, k_pale, k_pale,
             c.frame_s);
  else
    s.view.spray = {};

  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float top = t.px(98), bottom = t.px(118), side = std::min(t.px(250), screen.x * 0.4F),
              middle = screen.y - top - bottom;
  top_bar(c, {screen.x, top});
  begin_area(t, "replay gauges", {s.left_handed ? 0 : screen.x - side, top}, {side, middle}, true);
  const scenarios::ExamSetup& setup = player.setup();
  const ReplayPlayer::Shown& now = player.shown();
  show_gauges(t, setup, now.output, now.runner.depth_mm, {true, true, true});
  contact_lamp(t, now.output.contact);
  const double removed = static_cast<double>(now.runner.target_shares) /
                         static_cast<double>(setup.zones.target_shares());
  quiet_text(t, msg("Target removed: about {}", as_percent(100.0 * removed, 1)));
  const float help = t.px(84);
  moment_list(c, std::max(t.px(120), ImGui::GetContentRegionAvail().y - help - t.px(30)));
  quiet_text(
      t,
      msg("View: 1 to 5, W A S D, + and -, M mirror, R turn, T both eyes, H handpiece, G ring below the head, N spray"));
  end_area();
  controls(c, {0, screen.y - bottom}, {screen.x, bottom});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  const ImVec2 at{s.left_handed ? side : 0, top}, size{screen.x - side, middle};
  begin_area(t, "replay tooth", at, size, false);
  ImGui::PopStyleVar();
  tooth_area(c, size);
  words_in_picture(t, at, size, there ? msg("REPLAY") : msg("REPLAY, on the way ..."), {},
                   t.accent);
  end_area();
}

}  // namespace cavum::station
