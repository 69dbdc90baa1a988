// The screens of a sitting, one function each: it shows what there is and leaves its wish in the
// state. None of them waits for anything.
#pragma once

#include <vector>

#include "ui/station/input_queue.h"
#include "ui/station/replay_player.h"
#include "ui/station/sitting.h"
#include "ui/station/state.h"
#include "ui/station/station_check.h"
#include "ui/station/theme.h"

namespace cavum::station {

struct ScreenContext {
  Theme theme;
  StationState& state;
  const scenarios::Scenario& scenario;  ///< as its file says
  const std::vector<Bur>& shelf;        ///< all burs there are
  Sitting* sitting = nullptr;           ///< null before sign-in
  Scene* scene = nullptr;               ///< null before there is a tooth
  ReplayPlayer* replay = nullptr;       ///< only on the replay's screen
  double frame_s = 0.0;                 ///< since the frame before
  bool practice = false;
  const InputQueue& input;              ///< what this picture plays
  bool mouse_captured = false;          ///< the mouse is the stylus
  const StationCheck* check = nullptr;  ///< of the station's stylus; null at a replay
  bool locked = false;                  ///< only the supervisor's code decides
};

void sign_in_screen(const ScreenContext& c);
void self_check_screen(const ScreenContext& c);
void preparing_screen(const ScreenContext& c);
void device_check_screen(const ScreenContext& c);
void briefing_screen(const ScreenContext& c);
void exam_screen(const ScreenContext& c);
void grading_screen(const ScreenContext& c);
void result_screen(const ScreenContext& c);
void trouble_screen(const ScreenContext& c);
void save_screen(const ScreenContext& c);
void replay_screen(const ScreenContext& c);
/// Over any of them, while `confirm_leave`. `locked`: only the supervisor's code closes the window.
void ask_whether_to_leave(const ScreenContext& c, bool locked);

/// The picture of the tooth, in the rest of the running window; turned with the mouse and by keys:
/// A D W S round the tooth, + and - nearer and farther, 1 to 5 from occlusal, buccal, lingual,
/// mesial, distal, M mirror, T both eyes, H handpiece, R rolls the picture. Returns whether the
/// mouse is over it.
bool tooth_area(const ScreenContext& c, ImVec2 size);
/// Its lower left corner on the screen and its size, of the last tooth_area: for words written into
/// it.
void words_in_picture(const Theme& theme, ImVec2 at, ImVec2 size, const Message& upper,
                      const Message& lower, const ImVec4& colour);

/// Whether a place of the tooth frame lies outside the picture of the tooth; then an arrow at the
/// picture's edge shows where to.
bool arrow_to_what_is_out(const ScreenContext& c, Vec3 place_mm, ImVec2 at, ImVec2 size);

/// All over a picture whose hand is a simulated one, pixels.
void demonstration_in_picture(const Theme& theme, ImVec2 at, ImVec2 size);

/// The silhouette of a bur in a box of the screen, pixels.
void draw_silhouette(const Bur& bur, ImVec2 at, ImVec2 size, ImU32 colour, ImU32 coated);

}  // namespace cavum::station
