// Everything that the screens show and change, apart from the sitting itself: plain values of the
// window's thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ui/office/station_link.h"
#include "ui/station/scene.h"
#include "ui/station/side_words.h"
#include "ui/station/tutorial.h"

namespace cavum::station {

enum class Screen {
  sign_in,
  self_check,
  preparing,
  device_check,
  briefing,
  exam,
  grading,
  result,
  replay,
  trouble,
  save,
  author,
  author_busy
};
[[nodiscard]] const char* screen_name(Screen screen) noexcept;
/// Of all of them, in their order.
[[nodiscard]] std::vector<std::string_view> screen_names();

/// What a button or a key asked for; the station does it after the frame.
enum class Wish {
  none,
  sign_in,
  check,
  check_go_on,
  to_briefing,
  begin,
  end,
  save,
  rescue,
  abandon,
  report,
  next_candidate,
  leave,
  read,
  go_on,
  quit
};

struct StationState {
  Screen screen = Screen::sign_in;
  Wish wish = Wish::none;
  std::array<char, 48> code{};    ///< typed at sign-in
  std::array<char, 512> place{};  ///< typed where a session is to be saved
  bool focus_place = true;
  Message message;            ///< shown with the screen: what went wrong, what was written
  bool code_missing = false;  ///< somebody went on from the sign-in without one
  SceneView view;
  std::optional<CrownSides> sides;  ///< of the tooth in the picture; none: no words stand beside it
  bool left_handed = false;
  bool high_contrast = false;
  double text_scale = 1.0;
  bool muted = false;
  bool confirm_end = false;
  bool confirm_close = false;  ///< the window was asked to close on what is in memory only
  bool confirm_leave = false;  ///< the window was asked to close where it must not without a word
  std::array<char, 48> supervisor_code{};  ///< typed then
  bool focus_supervisor = false;           ///< its field waits for letters again
  Message leave_message;                   ///< shown with that question
  std::optional<office::LinkView>
      office;              ///< what the exam office says; none: the station knows no office
  Message office_outcome;  ///< what became of the recording at the office
  float notice_px =
      0.0F;  ///< how much of the screen's top the office's notice takes: the result begins below it
  bool confirm_go_on = false;  ///< somebody wants to go on although the office has paused the exam
  Message attempt;             ///< the last try to leave the exam
  double attempt_shown_s = 0.0;  ///< so long it is still shown
  int attempts = 0;              ///< in this exam
  bool rescue_failed = false;    ///< no other place took it either
  double replay_at = 0.0;        ///< ticks
  int replay_moment = -1;        ///< chosen of the replay's list; -1 = none
  double replay_speed = 1.0;     ///< times real time
  bool playing = false;          ///< the replay
  double pause_key_s = 0.0;      ///< for so long the pause button stays pressed
  double handpiece_speed = 1.0;  ///< of the dial, 0.1..1
  bool own_arrows = false;   ///< the screen has another use for the arrows than turning the tooth
  Vec3 wanted_mm;            ///< where mouse and keyboard want the tip, tooth frame
  Quat wanted_rotation;      ///< of the handpiece then
  bool coming_back = false;  ///< mouse and keyboard bring the tip back above the tooth
  bool tutorial_wanted = false;      ///< chosen at sign-in
  std::optional<Tutorial> tutorial;  ///< in practice, once it was asked for
  bool mouse_free = false;  ///< in an exam: the mouse points at buttons instead of being the stylus
  bool capture_mouse = false;  ///< the screen wants it as the stylus
  bool focus_code = true;
  bool goes_on = false;  ///< an exam that was begun before is gone on with
};

}  // namespace cavum::station
