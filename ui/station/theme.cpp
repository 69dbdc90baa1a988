#include "ui/station/theme.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <string_view>

#include "ui/language/say.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

ImVec4 rgb(unsigned hex) {
  return {static_cast<float>(hex >> 16U & 255U) / 255.0F,
          static_cast<float>(hex >> 8U & 255U) / 255.0F, static_cast<float>(hex & 255U) / 255.0F,
          1.0F};
}

ImVec4 mixed(const ImVec4& a, const ImVec4& b, float share) {
  const auto part = [share](float x, float y) { return x + (y - x) * share; };
  return {part(a.x, b.x), part(a.y, b.y), part(a.z, b.z), 1.0F};
}

}  // namespace

Theme make_theme(bool high_contrast, double scale) {
  Theme t;
  t.scale = static_cast<float>(scale);
  if (high_contrast) {
    t.back = rgb(0x000000);
    t.panel = rgb(0x000000);
    t.raised = rgb(0x1c1c1c);
    t.line = rgb(0xffffff);
    t.text = rgb(0xffffff);
    t.quiet = rgb(0xe0e0e0);
    t.faint = rgb(0x5a5a5a);
    t.accent = rgb(0xffe14d);
    t.on_accent = rgb(0x000000);
    t.good = rgb(0x7fe0ff);
    t.warn = rgb(0xffe14d);
    t.bad = rgb(0xff9d5c);
    return t;
  }
  t.back = rgb(0x12171d);
  t.panel = rgb(0x1a2129);
  t.raised = rgb(0x27313c);
  t.line = rgb(0x35424f);
  t.text = rgb(0xe9eef2);
  t.quiet = rgb(0xa3b1bd);
  t.faint = rgb(0x465462);
  t.accent = rgb(0x56b4e9);
  t.on_accent = rgb(0x07121a);
  t.good = rgb(0x4cc9a4);
  t.warn = rgb(0xf0b74d);
  t.bad = rgb(0xf0814d);
  return t;
}

void apply_theme(const Theme& t) {
  ImGuiStyle style;
  style.WindowRounding = 0;
  style.ChildRounding = 6;
  style.FrameRounding = 5;
  style.PopupRounding = 6;
  style.GrabRounding = 5;
  style.WindowBorderSize = 0;
  style.FramePadding = {10, 6};
  style.ItemSpacing = {10, 8};
  style.WindowPadding = {18, 16};
  style.ScaleAllSizes(t.scale);
  style.FrameBorderSize = 1;
  auto* c = style.Colors;
  c[ImGuiCol_Text] = t.text;
  c[ImGuiCol_TextDisabled] = t.quiet;
  c[ImGuiCol_WindowBg] = t.back;
  c[ImGuiCol_ChildBg] = t.panel;
  c[ImGuiCol_PopupBg] = t.panel;
  c[ImGuiCol_Border] = t.line;
  c[ImGuiCol_FrameBg] = t.raised;
  c[ImGuiCol_FrameBgHovered] = mixed(t.raised, t.accent, 0.2F);
  c[ImGuiCol_FrameBgActive] = mixed(t.raised, t.accent, 0.35F);
  c[ImGuiCol_Button] = t.raised;
  c[ImGuiCol_ButtonHovered] = mixed(t.raised, t.accent, 0.3F);
  c[ImGuiCol_ButtonActive] = mixed(t.raised, t.accent, 0.5F);
  c[ImGuiCol_Header] = mixed(t.raised, t.accent, 0.25F);
  c[ImGuiCol_HeaderHovered] = mixed(t.raised, t.accent, 0.35F);
  c[ImGuiCol_HeaderActive] = mixed(t.raised, t.accent, 0.5F);
  c[ImGuiCol_CheckMark] = t.accent;
  c[ImGuiCol_SliderGrab] = t.accent;
  c[ImGuiCol_SliderGrabActive] = t.accent;
  c[ImGuiCol_Separator] = t.line;
  c[ImGuiCol_NavHighlight] = t.accent;
  c[ImGuiCol_TableHeaderBg] = t.raised;
  c[ImGuiCol_TableBorderLight] = t.line;
  c[ImGuiCol_TableBorderStrong] = t.line;
  c[ImGuiCol_TableRowBgAlt] = mixed(t.panel, t.raised, 0.35F);
  c[ImGuiCol_PlotHistogram] = t.accent;
  c[ImGuiCol_ScrollbarBg] = t.panel;
  c[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.6F};
  ImGui::GetStyle() = style;
}

namespace {

constexpr ImGuiWindowFlags k_plain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                     ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_NoBringToFrontOnFocus;

/// Into the window's file, where one is wanted (Window::keep_words); until the end of this area.
void keep_words() {
  if (ImGui::GetIO().LogFilename != nullptr) ImGui::LogToFile();
}

}  // namespace

void begin_area(const Theme& theme, const char* id, ImVec2 at, ImVec2 size, bool panel) {
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, panel ? theme.panel : theme.back);
  ImGui::Begin(id, nullptr, k_plain);
  keep_words();
}

void end_area() {
  ImGui::End();
  ImGui::PopStyleColor();
}

void begin_card(const Theme& theme, const Message& heading, float width, float top) {
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  width = std::fmin(theme.px(width), screen.x - 20.0F);
  ImGui::SetNextWindowPos({screen.x / 2, (top + screen.y) / 2}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, screen.y - top - 20.0F});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {theme.px(36), theme.px(30)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, theme.px(10));
  ImGui::PushStyleColor(ImGuiCol_WindowBg, theme.panel);
  ImGui::Begin(heading.english(), nullptr, k_plain | ImGuiWindowFlags_AlwaysAutoResize);
  keep_words();
  ImGui::PopStyleVar(2);
  ImGui::Dummy({width - theme.px(72), 0});
  heading_text(heading);
  ImGui::Dummy({0, theme.px(4)});
}

void bad_text(const Theme& theme, const Message& text) {
  if (text.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, theme.bad);
  wrapped_text(text);
  ImGui::PopStyleColor();
}

void quiet_text(const Theme& theme, const Message& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, theme.quiet);
  push_font(Font::small);
  wrapped_text(text);
  pop_font();
  ImGui::PopStyleColor();
}

void heading_text(const Message& text) {
  push_font(Font::heading);
  wrapped_text(text);
  pop_font();
}

bool begin_question(const Theme& theme, const char* name, const Message& heading, bool asked,
                    bool& fresh) {
  fresh = asked && !ImGui::IsPopupOpen(name);
  if (fresh) ImGui::OpenPopup(name);
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x / 2, screen.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
  if (!ImGui::BeginPopupModal(name, nullptr,
                              ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_NoTitleBar))
    return false;
  keep_words();
  heading_text(heading);
  ImGui::Dummy({0, theme.px(2)});
  return true;
}

void end_question(bool asked) {
  if (!asked) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void text_line(const Message& text) {
  const std::string line = tr(text);
  ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size());
}

void wrapped_text(const Message& text) {
  const std::string words = tr(text), lines = in_lines(words, ImGui::GetContentRegionAvail().x);
  ImGui::GetWindowDrawList()->AddText(ImGui::GetCursorScreenPos(),
                                      ImGui::GetColorU32(ImGuiCol_Text), lines.c_str(),
                                      lines.c_str() + lines.size());
  ImGui::LogText("%s\n", words.c_str());
  ImGui::Dummy(ImGui::CalcTextSize(lines.c_str(), lines.c_str() + lines.size()));
}

std::string in_lines(const std::string& text, float width) {
  static const std::set<std::string, std::less<>> k_units{"mm", "mm²", "mm³", "mm2", "mm3",
                                                          "N",  "s",   "%",   "rpm", "ms"};
  std::string lines;
  float used = 0.0F;
  const float space = ImGui::CalcTextSize(" ").x;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string word = text.substr(at, end - at);
    std::string bare = word;
    while (!bare.empty() && std::string_view(",.;:)").find(bare.back()) != std::string_view::npos)
      bare.pop_back();
    const bool first = lines.empty() || lines.back() == '\n',
               unit = !first && std::isdigit(static_cast<unsigned char>(lines.back())) != 0 &&
                      k_units.contains(bare);
    const float wide = ImGui::CalcTextSize(word.c_str()).x;
    if (!first && used + space + wide > width) {
      // the number goes along with its unit
      const std::size_t number = unit ? lines.find_last_of(" \n") : lines.npos;
      if (number != lines.npos && lines[number] == ' ') {
        used = ImGui::CalcTextSize(lines.c_str() + number + 1).x + space + wide;
        lines[number] = '\n';
        lines += " " + word;
      } else {
        lines += "\n" + word;
        used = wide;
      }
    } else {
      lines += (first ? "" : " ") + word;
      used += (first ? 0.0F : space) + wide;
    }
    if (end < text.size() && text[end] == '\n') {
      lines += '\n';
      used = 0.0F;
    }
    at = end + 1;
  }
  return lines;
}

std::string shown_label(const Message& label) {
  return fmt::format("{}###{}", tr(label), label.english());
}

bool main_button(const Theme& theme, const Message& label, bool enabled, bool by_enter) {
  ImGui::PushStyleColor(ImGuiCol_Button, enabled ? theme.accent : theme.raised);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered,
                        enabled ? mixed(theme.accent, theme.text, 0.25F) : theme.raised);
  ImGui::PushStyleColor(ImGuiCol_Text, enabled ? theme.on_accent : theme.quiet);
  ImGui::BeginDisabled(!enabled);
  const bool clicked = ImGui::Button(shown_label(label).c_str(), {0, theme.px(44)});
  ImGui::EndDisabled();
  ImGui::PopStyleColor(3);
  return enabled &&
         (clicked || (by_enter && (key_pressed(GLFW_KEY_ENTER) || key_pressed(GLFW_KEY_KP_ENTER))));
}

bool side_button(const Theme& theme, const Message& label, float width) {
  return ImGui::Button(shown_label(label).c_str(), {width, theme.px(36)});
}

namespace {
/// A question stands before the window that asks.
bool is_covered() {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup) &&
         !ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows);
}
}  // namespace

bool key_pressed(int key) {
  const ImGuiIO& io = ImGui::GetIO();
  return !is_covered() && ImGui::IsKeyPressed(key, false) && !io.KeyCtrl && !io.KeyAlt;
}
bool key_held(int key) { return !is_covered() && ImGui::IsKeyDown(key); }

}  // namespace cavum::station
