#include "ui/station/tutorial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ui/station/theme.h"

namespace cavum::station {
namespace {

enum Step : int { move, turn, above, tilt, touch, drill, lift };

struct Words {
  const char* pointer;
  const char* stylus;
};
constexpr std::array<Words, Tutorial::k_steps> k_words{{
    {"Move the mouse, or press the arrow keys: the tip follows.", "Move the stylus: the tip follows."},
    {"Turn the tooth: press A, D, W or S, or hold the right mouse button and move.", "Turn the tooth: press A, D, W or S."},
    {"Press 1: you look from above.", "Press 1: you look from above."},
    {"Tilt the handpiece: hold Ctrl, and move the mouse or press arrows. Then press 0: it is upright again. Without a keyboard go on down.",
     "Tilt the handpiece, and hold it upright again."},
    {"Bring the tip over the blue target. Turn the wheel towards you, or hold PgDn, until it touches the tooth.",
     "Bring the tip over the blue target, and down until it touches the tooth."},
    {"Now drill: hold the space bar or the left button (the pedal), and go on down.", "Now drill: press the pedal, and go on down gently."},
    {"Lift the tip off: turn the wheel away from you, or hold PgUp. Then let go of the pedal.", "Lift the tip off, then let go of the pedal."},
}};

double degrees_between(Vec3 a, Vec3 b) { return std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * 180.0 / 3.14159265358979323846; }

}  // namespace

bool Tutorial::did(const TutorialSight& s) {
  constexpr double k_way_mm = 2.0, k_tilt_deg = 10.0, k_upright_deg = 7.0, k_off_mm = 0.3, k_standing_rpm = 1000.0;
  constexpr float k_turn_deg = 20.0F, k_from_above_deg = 80.0F;
  switch (step_) {
    case Step::move:
      return length(s.tip_mm - first_.tip_mm) > k_way_mm;
    case Step::turn:
      return std::fabs(s.turn_deg - first_.turn_deg) + std::fabs(s.rise_deg - first_.rise_deg) > k_turn_deg;
    case Step::above:
      return s.rise_deg > k_from_above_deg;
    case Step::tilt:
      tilted_ = tilted_ || degrees_between(s.handle, first_.handle) > k_tilt_deg;
      return (tilted_ && degrees_between(s.handle, first_.handle) < k_upright_deg) || (!tilted_ && s.contact);
    case Step::touch:
      if (s.contact) touched_mm_ = s.tip_mm;
      return s.contact;
    case Step::drill:
      if (s.cutting) hole_mm_ = std::max(hole_mm_, dot(touched_mm_ - s.tip_mm, s.out));
      return hole_mm_ >= k_hole_mm;
    default:
      if (s.cutting) hole_mm_ = std::max(hole_mm_, dot(touched_mm_ - s.tip_mm, s.out));
      return !s.contact && dot(s.tip_mm - touched_mm_, s.out) > k_off_mm && s.rpm < k_standing_rpm;
  }
}

void Tutorial::see(const TutorialSight& sight) {
  if (done()) return;
  if (!begun_) first_ = sight;
  begun_ = true;
  if (!did(sight)) return;
  ++step_;
  begun_ = false;
}

std::string Tutorial::text() const {
  if (done()) return number_text("Your first hole, %.1f mm deep. Go on as you like; Esc and Enter hand it in.", hole_mm_);
  const Words& words = k_words[static_cast<std::size_t>(step_)];
  std::string text = pointer_ ? words.pointer : words.stylus;
  if (step_ == Step::drill) text += number_text(" %.1f", hole_mm_) + number_text(" of %.1f mm", k_hole_mm);
  return text;
}

}  // namespace cavum::station
