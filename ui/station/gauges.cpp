#include "ui/station/gauges.h"

#include <algorithm>
#include <cmath>

#include "engine/base/figures.h"
#include "engine/language/shown.h"
#include "ui/station/window.h"

namespace cavum::station {

void bar_gauge(const Theme& t, const char* name, const std::string& english, double share, double mark) {
  const std::string value = shown(english);
  const float width = ImGui::GetContentRegionAvail().x, height = t.px(18);
  text_line(name);
  ImGui::SameLine(width - ImGui::CalcTextSize(value.c_str()).x + ImGui::GetCursorStartPos().x);
  text_line(value);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float full = width * static_cast<float>(std::clamp(share, 0.0, 1.0));
  const float limit = mark > 0 ? width * static_cast<float>(std::min(mark, 1.0)) : width;
  draw.AddRectFilled(at, {at.x + width, at.y + height}, ink(t.raised), t.px(3));
  draw.AddRectFilled(at, {at.x + std::min(full, limit), at.y + height}, ink(t.accent), t.px(3));
  if (full > limit) {
    draw.AddRectFilled({at.x + limit, at.y}, {at.x + full, at.y + height}, ink(t.bad));
    draw.PushClipRect({at.x + limit, at.y}, {at.x + full, at.y + height}, true);
    for (float x = at.x + limit - height; x < at.x + full; x += t.px(7)) draw.AddLine({x, at.y + height}, {x + height, at.y}, ink(t.panel), t.px(2));
    draw.PopClipRect();
  }
  if (mark > 0) draw.AddLine({at.x + limit, at.y - t.px(3)}, {at.x + limit, at.y + height + t.px(3)}, ink(t.text), t.px(2));
  ImGui::Dummy({width, height + t.px(6)});
}

std::string depth_text(double below_mm) {
  constexpr double k_shown_as_0_mm = 0.05;
  return below_mm <= -k_shown_as_0_mm ? number_text("%.1f mm above", -below_mm) : number_text("%.1f mm", std::max(0.0, below_mm));
}

void depth_gauge(const Theme& t, double tip_mm, double deepest_mm, double most_mm, float height) {
  const float width = ImGui::GetContentRegionAvail().x;
  const std::string value = depth_text(tip_mm);
  text_line("Depth");
  ImGui::SameLine(width - ImGui::CalcTextSize(value.c_str()).x + ImGui::GetCursorStartPos().x);
  text_line(value);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float left = at.x + t.px(42), right = left + t.px(26);
  const auto y_of = [&](double mm) { return at.y + height * static_cast<float>(std::clamp(mm / most_mm, 0.0, 1.0)); };
  draw.AddRectFilled({left, at.y}, {right, at.y + height}, ink(t.raised), t.px(3));
  draw.AddRectFilled({left, at.y}, {right, y_of(deepest_mm)}, ink(t.line));
  draw.AddRectFilled({left, at.y}, {right, y_of(tip_mm)}, ink(t.accent));
  push_font(Font::small);
  const int every = most_mm > 6.5 ? 2 : 1;
  for (int mm = 0; mm <= static_cast<int>(most_mm); mm += every) {
    const float y = y_of(mm);
    draw.AddLine({left - t.px(7), y}, {left, y}, ink(t.quiet), 1.0F);
    const std::string text = std::to_string(mm);
    draw.AddText({left - t.px(12) - ImGui::CalcTextSize(text.c_str()).x, y - t.px(8)}, ink(t.quiet), text.c_str());
  }
  const std::string deepest = number_text("deepest %.1f", deepest_mm);
  draw.AddLine({right, y_of(deepest_mm)}, {right + t.px(10), y_of(deepest_mm)}, ink(t.text), t.px(2));
  draw.AddText({right + t.px(14), std::min(y_of(deepest_mm) - t.px(8), at.y + height - t.px(14))}, ink(t.quiet), deepest.c_str());
  ImGui::LogText("%s\n", deepest.c_str());
  pop_font();
  ImGui::Dummy({width, height + t.px(12)});
}

void show_gauges(const Theme& t, const scenarios::ExamSetup& setup, const TickOutput& now, double deepest_mm, const scenarios::GaugeSpec& shown) {
  if (shown.speed) {
    const double thousands = std::round(now.rpm / 1000.0);
    bar_gauge(t, "Speed", thousands > 0 ? number_text("%.0f 000 /min", thousands) : "0 /min", now.rpm / setup.scenario.max_rpm);
  }
  if (shown.force) {
    const double most_n = 4.0, force_n = length(now.rendered_force_n);
    bar_gauge(t, "Force", number_text("%.1f N", force_n), force_n / most_n, setup.scenario.force_limit_n / most_n);
  }
  if (shown.depth) {
    const double floor_mm = setup.zones.opening_z_mm() - setup.zones.floor_level_mm();
    depth_gauge(t, setup.zones.below_opening_mm(now.proxy_mm), deepest_mm, std::ceil(std::max(floor_mm + 1.0, deepest_mm)), t.px(90));
  }
}

void contact_lamp(const Theme& t, bool touches) {
  const std::string word = shown(touches ? "touches" : "free");
  const float width = ImGui::GetContentRegionAvail().x, r = t.px(7);
  text_line("Contact");
  ImGui::SameLine(width - ImGui::CalcTextSize(word.c_str()).x + ImGui::GetCursorStartPos().x);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  text_line(word);
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
  const std::string text = clock_text(limit_s > 0 ? std::ceil(shown_s) : shown_s);  // 0:00 means that time is up
  std::string label = shown(limit_s > 0 ? "time left" : "time");
  if (soon) label = shown("LAST MINUTE");
  if (standing) label = shown("CLOCK STANDS");
  push_font(Font::clock);
  ImGui::PushStyleColor(ImGuiCol_Text, soon || standing ? t.warn : t.text);
  const float width = ImGui::GetContentRegionAvail().x, x = ImGui::GetCursorPosX();
  ImGui::SetCursorPosX(x + width - ImGui::CalcTextSize(text.c_str()).x);
  text_line(text);
  pop_font();
  push_font(Font::small);
  ImGui::SetCursorPos({x + width - ImGui::CalcTextSize(label.c_str()).x, ImGui::GetCursorPosY() - t.px(10)});
  text_line(label);
  pop_font();
  ImGui::PopStyleColor();
}

}  // namespace cavum::station
