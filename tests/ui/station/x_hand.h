// A hand on the keyboard and mouse of an X server, for tests: the events are those of real devices
// (extension XTEST), not of our program.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace cavum::testing_station {

class XHand {
 public:
  /// On the display of the environment. `there` tells whether the server and libXtst can.
  XHand();
  ~XHand();
  XHand(const XHand&) = delete;
  XHand& operator=(const XHand&) = delete;
  [[nodiscard]] bool there() const { return fake_key_ != nullptr; }

  /// `key` as X names it: "space", "Next", "Up", "a".
  void key(const std::string& key, bool down) const;
  /// Down, and up again after so many ms.
  void tap(const std::string& key, int ms) const;
  /// The mouse by so many pixels.
  void move(int x, int y) const;
  /// The mouse to this place of the screen.
  void point_at(int x, int y) const;
  /// A button of the mouse: 1 left, 2 middle, 3 right; 4 and 5 are one notch of the wheel away from
  /// the person and back.
  void button(unsigned number, bool down) const;
  void click(unsigned number, int ms) const;
  /// Middle of the largest patch of this colour (0xRRGGBB) on the screen, 60 pixels wide or wider;
  /// nothing when there is none.
  [[nodiscard]] std::optional<std::pair<int, int>> see(unsigned long colour) const;
  /// Another window opens, takes the keyboard, and goes after so many ms.
  void take_the_keyboard(int ms) const;
  /// Asks the window with this title to close, as a desktop does. False when there is none.
  [[nodiscard]] bool ask_to_close(const std::string& title) const;
  /// Takes the screen away and gives it back, as a cable does (RandR). False when the server
  /// cannot.
  [[nodiscard]] bool unplug_screen();
  [[nodiscard]] bool plug_screen();
  /// Width, height and place of the window with this title.
  [[nodiscard]] std::string size_of(const std::string& title) const;

 private:
  [[nodiscard]] unsigned long window_of(const std::string& title) const;
  void* display_ = nullptr;
  void* library_ = nullptr;
  unsigned long mode_ = 0;  // of the screen that was taken away
  int (*fake_key_)(void*, unsigned, int, unsigned long) = nullptr;
  int (*fake_motion_)(void*, int, int, unsigned long) = nullptr;
  int (*fake_place_)(void*, int, int, int, unsigned long) = nullptr;
  int (*fake_button_)(void*, unsigned, int, unsigned long) = nullptr;
};

}  // namespace cavum::testing_station
