// One window with an OpenGL 3.3 context and Dear ImGui in it. Everything of GLFW stays behind it; keys that a script presses come in by the same
// door as those of a keyboard.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

struct GLFWwindow;

namespace cavum::station {

/// A renderer on the computer's processor takes one core and leaves the others to the servo, unless LP_NUM_THREADS says otherwise. Changes the
/// environment, so before there are other threads; a Window asks for it too.
void spare_the_processor() noexcept;

class Window {
 public:
  /// Throws Error when there is no display or no OpenGL 3.3. `width`, `height` in pixels.
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Takes what keyboard and mouse did, and begins a frame.
  void begin_frame();
  /// Draws the frame's ImGui content over what was drawn and shows it, unless the window is hidden.
  void end_frame();
  /// Fonts for another size of text, 1 = normal; between frames.
  void set_text_scale(double scale);

  [[nodiscard]] bool closing() const;
  void ask_to_close();
  void stay_open();  ///< after all
  void set_visible(bool visible);
  [[nodiscard]] int width() const;   ///< pixels
  [[nodiscard]] int height() const;  ///< pixels
  /// The computer's processor draws: slow, and every core it takes is one less for the servo.
  [[nodiscard]] bool software() const noexcept { return software_; }

  /// As if a hand did it; `key` of GLFW. It is released after this frame, unless it is `held`: then by `release`, or the next press that does not
  /// hold it.
  void press(int key, bool held = false);
  void release(int key);
  /// The mouse from now on, pixels; `pressed`: its left button.
  void point_at(float x, float y, bool pressed);
  void type(const std::string& text);
  /// A field waits for letters.
  [[nodiscard]] bool wants_text() const;
  /// The running frame is written as PNG by end_frame, which throws Error when it cannot.
  void keep_picture(const std::string& path) { picture_ = path; }

 private:
  GLFWwindow* window_ = nullptr;
  bool software_ = false;
  std::optional<std::array<float, 2>> mouse_;  // of `point_at`
  bool mouse_pressed_ = false;
  int pressed_ = 0;      // by `press`, to be released
  std::string picture_;  // of the running frame
};

/// Fonts of the last set_text_scale.
enum class Font : int { body, heading, clock, small };
void push_font(Font font);
void pop_font();

}  // namespace cavum::station
