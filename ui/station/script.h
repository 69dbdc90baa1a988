// Keys pressed by a file instead of a hand, for demonstrations and tests of the station: they come
// in by the door of the keyboard. What takes longer than 10 s says on standard error what it waits
// for; no screen, field or exam is awaited for more than 300 s. One command a line, # begins a
// comment:
//   wait SCREEN      until that screen shows: sign-in, self-check, preparing, device-check,
//   briefing, exam, grading, result, trouble,
//                    save, author, author-busy
//   go SCREEN        presses enter now and then until that screen shows
//   until SECONDS    until the exam's clock has come so far
//   type TEXT        letters, once there is a field for them
//   key NAME         enter, escape, space, tab, pageup, pagedown, left, right, up, down, f1 to f12,
//   home, end, ctrl, shift,
//                    a letter, a digit, [ ] + - , . ; a second word holds it so many seconds
//   hold NAME        a key, while other commands go on
//   release NAME     lets it go
//   mouse X Y        there from now on, pixels; with its left button when a third word says pressed
//   sleep SECONDS    the window goes on meanwhile
//   stall SECONDS    the window stands still, as with a graphics card that hangs
//   hide, show       the window
//   picture NAME     of the screen, NAME.png in the folder of pictures
//   words NAME       that the screen says, NAME.txt beside the pictures; a screen that says nothing
//   in widgets adds none pace PICTURES    a second from now on, as near as the computer can tell
//   NAME        from now on, of each picture, a line in NAME.txt beside the pictures: its screen,
//   the exam's clock in seconds, and where it
//                    shows the tip (tooth frame, mm)
//   memory NAME      prints NAME and what the program holds in memory, MB
//   fail             throws in the window's thread
//   close            the window, as its cross does
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ui/station/state.h"

namespace cavum::station {

class Window;

class Script {
 public:
  Script() = default;
  /// Throws Error(path:line, ...) for a command that is none.
  Script(const std::string& text, const std::string& path, std::string pictures);
  /// Before each frame: does what is due. `exam_s`: the exam's clock. Throws Error when a wait is
  /// in vain, or for `fail`.
  void step(Window& window, Screen screen, double exam_s, double now_s);
  [[nodiscard]] bool done() const noexcept { return next_ >= commands_.size(); }
  /// Pictures a second that it asked for; 0 = none.
  [[nodiscard]] double pace_hz() const noexcept { return pace_hz_; }
  /// After each frame, for `tell`.
  void shown(Screen screen, double exam_s, Vec3 tip_mm);

 private:
  struct Command {
    std::string word, text;
    double number = 0.0;
    double x = 0.0;
    bool pressed = false;  // of the mouse
    int key = 0, line = 0;
  };
  /// False: not yet done, look again in the next frame.
  bool run(const Command& command, Window& window, Screen screen, double exam_s, double now_s);
  /// On standard error, what `command` waits for.
  void tell(const Command& command, Screen screen, double exam_s) const;

  std::string path_, pictures_;
  std::string told_to_;  // file of `tell`; empty = none
  double pace_hz_ = 0.0;
  std::vector<Command> commands_;
  std::size_t next_ = 0;
  bool let_go_ = false;
  bool told_ = false;        // what the running command waits for
  double since_s_ = -1.0;    // when the running command began
  double pressed_s_ = -1.0;  // when `go` last pressed enter
};

}  // namespace cavum::station
