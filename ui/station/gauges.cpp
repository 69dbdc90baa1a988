#include "ui/station/gauges.h"

#include <algorithm>
#include <cmath>

#include "ui/language/say.h"
#include "ui/station/window.h"

namespace cavum::station {

namespace {

/// A name, and at the other end of the line its value. Returns where the value begins.
ImVec2 named_value(const Message& name, const Message& value) {
  const float width = ImGui::GetContentRegionAvail().x;
  text_line(name);
  ImGui::SameLine(width - ImGui::CalcTextSize(tr(value).c_str()).x + ImGui::GetCursorStartPos().x);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  text_line(value);
  return at;
}

}  // namespace

void bar_gauge(const Theme& t, const Message& name, const Message& value, double share,
               double mark) {
  const float width = ImGui::GetContentRegionAvail().x, height = t.px(18);
  named_value(name, value);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float full = width * static_cast<float>(std::clamp(share, 0.0, 1.0));
  const float limit = mark > 0 ? width * static_cast<float>(std::min(mark, 1.0)) : width;
  draw.AddRectFilled(at, {at.x + width, at.y + height}, ink(t.raised), t.px(3));
  draw.AddRectFilled(at, {at.x + std::min(full, limit), at.y + height}, ink(t.accent), t.px(3));
  if (full > limit) {
    draw.AddRectFilled({at.x + limit, at.y}, {at.x + full, at.y + height}, ink(t.bad));
    draw.PushClipRect({at.x + limit, at.y}, {at.x + full, at.y + height}, true);
    for (float x = at.x + limit - height; x < at.x + full; x += t.px(7))
      draw.AddLine({x, at.y + height}, {x + height, at.y}, ink(t.panel), t.px(2));
    draw.PopClipRect();
  }
  if (mark > 0)
    draw.AddLine({at.x + limit, at.y - t.px(3)}, {at.x + limit, at.y + height + t.px(3)},
                 ink(t.text), t.px(2));
  ImGui::Dummy({width, height + t.px(6)});
}

Message depth_text(double below_mm) {
  constexpr double k_shown_as_0_mm = 0.05;
  return below_mm <= -k_shown_as_0_mm ? msg("{} above", as_mm(-below_mm, 1))
                                      : msg("{}", as_mm(std::max(0.0, below_mm), 1));
}

void depth_gauge(const Theme& t, double tip_mm, double deepest_mm, double most_mm, float height) {
  const float width = ImGui::GetContentRegionAvail().x;
  named_value(msg("Depth"), depth_text(tip_mm));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float left = at.x + t.px(42), right = left + t.px(26);
  const auto y_of = [&](double mm) {
    return at.y + height * static_cast<float>(std::clamp(mm / most_mm, 0.0, 1.0));
  };
  draw.AddRectFilled({left, at.y}, {right, at.y + height}, ink(t.raised), t.px(3));
  draw.AddRectFilled({left, at.y}, {right, y_of(deepest_mm)}, ink(t.line));
  draw.AddRectFilled({left, at.y}, {right, y_of(tip_mm)}, ink(t.accent));
  push_font(Font::small);
  const int every = most_mm > 6.5 ? 2 : 1;
  for (int mm = 0; mm <= static_cast<int>(most_mm); mm += every) {
    const float y = y_of(mm);
    draw.AddLine({left - t.px(7), y}, {left, y}, ink(t.quiet), 1.0F);
    const std::string text = std::to_string(mm);
    draw.AddText({left - t.px(12) - ImGui::CalcTextSize(text.c_str()).x, y - t.px(8)}, ink(t.quiet),
                 text.c_str());
  }
  const std::string deepest = tr("deepest {}", as_number(deepest_mm, 1));
  draw.AddLine({right, y_of(deepest_mm)}, {right + t.px(10), y_of(deepest_mm)}, ink(t.text),
               t.px(2));
  draw.AddText({right + t.px(14), std::min(y_of(deepest_mm) - t.px(8), at.y + height - t.px(14))},
               ink(t.quiet), deepest.c_str());
  ImGui::LogText("%s\n", deepest.c_str());
  pop_font();
  ImGui::Dummy({width, height + t.px(12)});
}

void show_gauges(const Theme& t, const scenarios::ExamSetup& setup, const TickOutput& now,
                 double deepest_mm, const scenarios::GaugeSpec& shown) {
  if (shown.speed) {
    const double thousands = std::round(now.rpm / 1000.0);
    bar_gauge(t, msg("Speed"),
              thousands > 0 ? msg("{} 000 /min", as_number(thousands, 0)) : msg("0 /min"),
              now.rpm / setup.scenario.max_rpm);
  }
  if (shown.force) {
    const double most_n = 4.0, force_n = length(now.rendered_force_n);
    bar_gauge(t, msg("Force"), msg("{}", as_n(force_n, 1)), force_n / most_n,
              setup.scenario.force_limit_n / most_n);
  }
  if (shown.depth) {
    const double floor_mm = setup.zones.opening_z_mm() - setup.zones.floor_level_mm();
    depth_gauge(t, setup.zones.below_opening_mm(now.proxy_mm), deepest_mm,
                std::ceil(std::max(floor_mm + 1.0, deepest_mm)), t.px(90));
  }
}

void contact_lamp(const Theme& t, bool touches) {
  const float r = t.px(7);
  const ImVec2 at = named_value(msg("Contact"), touches ? msg("touches") : msg("free"));
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 lamp{at.x - 2.0F * r, at.y + 0.5F * ImGui::GetTextLineHeight()};
  if (touches) draw.AddCircleFilled(lamp, r, ink(t.warn));
  draw.AddCircle(lamp, r, ink(touches ? t.text : t.quiet), 0, t.px(2));
  ImGui::Dummy({0, t.px(4)});
}

void exam_clock(const Theme& t, double passed_s, double limit_s, bool standing) {
  const double shown_s = limit_s > 0 ? limit_s - passed_s : passed_s;
  constexpr double k_soon_s = 60.0;
  const bool soon = limit_s > 0 && shown_s < k_soon_s;
  const Message clock = msg(
      "{}", ClockTime{limit_s > 0 ? std::ceil(shown_s) : shown_s});  // 0:00 means that time is up
  const Message label = standing      ? msg("CLOCK STANDS")
                        : soon        ? msg("LAST MINUTE")
                        : limit_s > 0 ? msg("time left")
                                      : msg("time");
  push_font(Font::clock);
  ImGui::PushStyleColor(ImGuiCol_Text, soon || standing ? t.warn : t.text);
  const float width = ImGui::GetContentRegionAvail().x, x = ImGui::GetCursorPosX();
  ImGui::SetCursorPosX(x + width - ImGui::CalcTextSize(tr(clock).c_str()).x);
  text_line(clock);
  pop_font();
  push_font(Font::small);
  ImGui::SetCursorPos(
      {x + width - ImGui::CalcTextSize(tr(label).c_str()).x, ImGui::GetCursorPosY() - t.px(10)});
  text_line(label);
  pop_font();
  ImGui::PopStyleColor();
}

}  // namespace cavum::station
