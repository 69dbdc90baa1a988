// One window with an OpenGL 3.3 context and Dear ImGui in it. Everything of GLFW stays behind it;
// keys that a script presses come in by the same door as those of a keyboard.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "ui/station/input_queue.h"
#include "ui/station/server_times.h"

struct GLFWwindow;

namespace cavum::station {

/// A renderer on the computer's processor takes one core and leaves the others to the servo, unless
/// LP_NUM_THREADS says otherwise. Changes the environment, so before there are other threads; a
/// Window asks for it too.
void spare_the_processor() noexcept;
/// Takes the memory that a cavity's surface will need, here and in a renderer on the processor, as
/// an exam begins: it does not grow any more then. The allocator keeps it, instead of giving it
/// back at once.
void reserve_picture_memory();

[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point t) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - t).count();
}

struct WindowOptions {
  std::string title = "Cavum";
  int width = 1280, height = 800;  ///< pixels, unless it fills the screen
  std::string monitor;             ///< number from 1 or name; empty: where the desktop puts it
  bool full_screen = false;        ///< fills that monitor, and stays in front
};

class Window {
 public:
  /// Throws Error when there is no display, no OpenGL 3.3, or no such monitor.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Takes what keyboard and mouse did, and begins a frame.
  void begin_frame();
  /// Draws the frame's ImGui content over what was drawn and shows it, unless the window is hidden.
  void end_frame();
  /// No more pictures than eyes need, fewer where the processor draws, which the servo shares:
  /// waits while the one that `began` then is to stay. `hz`: so many instead, unless 0.
  void rest(std::chrono::steady_clock::time_point began, double hz = 0.0) const;
  /// Whether keys walk from button to button.
  void walk_by_keys(bool may);
  /// Fonts for another size of text, 1 = normal; between frames.
  void set_text_scale(double scale);

  /// What this frame plays: keys with their times, the mouse's way, focus, screens.
  [[nodiscard]] const InputQueue& input() const noexcept { return input_; }
  /// While true the mouse has no pointer and no edge: only its way counts.
  void capture_mouse(bool captured);
  [[nodiscard]] bool mouse_captured() const noexcept { return captured_; }

  [[nodiscard]] bool closing() const;
  void ask_to_close();
  void stay_open();  ///< after all
  void set_visible(bool visible);
  /// To the front, with the keyboard; over the whole monitor again when it fills the screen.
  void come_back();
  [[nodiscard]] int width() const;   ///< pixels
  [[nodiscard]] int height() const;  ///< pixels
  /// How large text must be to look as it does at 1280 x 800: by the desktop's scale and by the
  /// window's size, 1 or more.
  [[nodiscard]] double screen_scale() const;
  /// The computer's processor draws: slow, and every core it takes is one less for the servo.
  [[nodiscard]] bool software() const noexcept { return software_; }

  /// As if a hand did it; `key` of GLFW. It is released after this frame, unless it is `held`: then
  /// by `release`, or the next press that does not hold it.
  void press(int key, bool held = false);
  void release(int key);
  /// The mouse from now on, pixels; `pressed`: its left button.
  void point_at(float x, float y, bool pressed);
  void type(const std::string& text);
  /// A field waits for letters.
  [[nodiscard]] bool wants_text() const;
  /// The running frame is written as PNG by end_frame, which throws Error when it cannot.
  void keep_picture(const std::string& path) { picture_ = path; }
  /// Writes the words of the next frame into a file, anew.
  void keep_words(const std::string& path);

 private:
  void open(const WindowOptions& options);
  void listen();
  void take_events();
  void push(InputEvent event);
  void moved_to(double x, double y);

  GLFWwindow* window_ = nullptr;
  std::string monitor_;
  bool full_screen_ = false, software_ = false, captured_ = false;
  std::unique_ptr<ServerTimes> times_;
  InputQueue input_;
  float mouse_x_ = 0.0F, mouse_y_ = 0.0F;
  bool mouse_known_ = false;  // where it is
  int pressed_ = 0;           // by `press`, to be released
  std::string picture_;       // of the running frame
  std::string words_;         // file for those of the running frame
};

/// Fonts of the last set_text_scale.
enum class Font : int { body, heading, clock, small };
void push_font(Font font);
void pop_font();

}  // namespace cavum::station
