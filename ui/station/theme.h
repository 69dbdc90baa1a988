// Colours and sizes of the station's screens. Every colour that means something differs in
// lightness from its neighbours and comes with a word or a sign, so that nobody needs to tell red
// from green; high contrast is black, white and yellow.
#pragma once

#include <imgui.h>

#include <string>

#include "engine/base/message.h"

namespace cavum::station {

struct Theme {
  ImVec4 back, panel, raised, line, text, quiet, faint, accent, on_accent, good, warn, bad;
  float scale = 1.0F;  ///< of text and everything measured in it
  [[nodiscard]] float px(float at_scale_1) const noexcept { return at_scale_1 * scale; }
};
[[nodiscard]] Theme make_theme(bool high_contrast, double scale);
/// To Dear ImGui's own widgets.
void apply_theme(const Theme& theme);

[[nodiscard]] inline ImU32 ink(const ImVec4& colour) {
  return ImGui::ColorConvertFloat4ToU32(colour);
}

// Widgets beyond Dear ImGui's own.

/// A window without frame at a place of the screen, pixels. Always pair with end_area.
void begin_area(const Theme& theme, const char* id, ImVec2 at, ImVec2 size, bool panel);
void end_area();
/// The same in the middle of the screen below `top`, with a heading, as high as what it holds.
void begin_card(const Theme& theme, const Message& heading, float width, float top = 0.0F);
void quiet_text(const Theme& theme, const Message& text);
/// What went wrong, in the colour for that; nothing for an empty message.
void bad_text(const Theme& theme, const Message& text);
/// A text of the reader's language in lines of at most `width` pixels of the present font, parted
/// by line ends. Only spaces part lines, and none between a number and its unit. A longer word
/// stays whole.
[[nodiscard]] std::string in_lines(const std::string& text, float width);
void heading_text(const Message& text);
void wrapped_text(const Message& text);
void text_line(const Message& text);
/// A label of Dear ImGui's own widgets in the reader's language. The widget is known by the English
/// sentence, without its values.
[[nodiscard]] std::string shown_label(const Message& label);
/// A question over everything else, with a heading, that shows while `asked`. When true, pair with
/// end_question; `fresh` is true in its first frame, in which the key that raised it is still held
/// and answers nothing.
bool begin_question(const Theme& theme, const char* name, const Message& heading, bool asked,
                    bool& fresh);
/// Closes it when it is not `asked` any more.
void end_question(bool asked);
/// What goes on; also by Enter, unless `by_enter` is false.
bool main_button(const Theme& theme, const Message& label, bool enabled, bool by_enter = true);
/// One that stays quiet.
bool side_button(const Theme& theme, const Message& label, float width = 0.0F);
/// Pressed in this frame, with nothing held beside it; a key of GLFW. Not for what lies under a
/// question: its keys answer it alone.
[[nodiscard]] bool key_pressed(int key);
[[nodiscard]] bool key_held(int key);

}  // namespace cavum::station
