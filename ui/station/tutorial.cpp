#include "ui/station/tutorial.h"

#include <algorithm>
#include <cmath>

namespace cavum::station {
namespace {

enum Step : int { move, turn, above, tilt, touch, drill, lift };

double degrees_between(Vec3 a, Vec3 b) {
  return std::acos(std::clamp(dot(a, b), -1.0, 1.0)) * 180.0 / 3.14159265358979323846;
}

}  // namespace

bool Tutorial::did(const TutorialSight& s) {
  constexpr double k_path_mm = 2.0, k_tilt_deg = 10.0, k_upright_deg = 7.0, k_off_mm = 0.3,
                   k_standing_rpm = 1000.0;
  constexpr float k_turn_deg = 20.0F, k_from_above_deg = 80.0F;
  switch (step_) {
    case Step::move:
      return length(s.tip_mm - first_.tip_mm) > k_path_mm;
    case Step::turn:
      return std::fabs(s.turn_deg - first_.turn_deg) + std::fabs(s.rise_deg - first_.rise_deg) >
             k_turn_deg;
    case Step::above:
      return s.rise_deg > k_from_above_deg;
    case Step::tilt:
      tilted_ = tilted_ || degrees_between(s.handle, first_.handle) > k_tilt_deg;
      return (tilted_ && degrees_between(s.handle, first_.handle) < k_upright_deg) ||
             (!tilted_ && s.contact);
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

Message Tutorial::text() const {
  switch (step_) {
    case Step::move:
      return pointer_ ? msg("Move the mouse, or press the arrow keys: the tip follows.")
                      : msg("Move the stylus: the tip follows.");
    case Step::turn:
      return pointer_
                 ? msg("Turn the tooth: press A, D, W or S, or hold the right mouse button and move.")
                 : msg("Turn the tooth: press A, D, W or S.");
    case Step::above:
      return msg("Press 1: you look from above.");
    case Step::tilt:
      return pointer_
                 ? msg("Tilt the handpiece: hold Ctrl, and move the mouse or press arrows. Then press 0: it is upright again. Without a keyboard go "
                       "on down.")
                 : msg("Tilt the handpiece, and hold it upright again.");
    case Step::touch:
      return pointer_
                 ? msg("Bring the tip over the blue target. Turn the wheel towards you, or hold PgDn, until it touches the tooth.")
                 : msg("Bring the tip over the blue target, and down until it touches the tooth.");
    case Step::drill: {
      const Number is = as_number(hole_mm_, 1), wanted = as_mm(k_hole_mm, 1);
      return pointer_
                 ? msg("Now drill: hold the space bar or the left button (the pedal), and go on down. {} of {}",
                       is, wanted)
                 : msg("Now drill: press the pedal, and go on down gently. {} of {}", is, wanted);
    }
    case Step::lift:
      return pointer_
                 ? msg("Lift the tip off: turn the wheel away from you, or hold PgUp. Then let go of the pedal.")
                 : msg("Lift the tip off, then let go of the pedal.");
    default:
      return msg("Your first hole, {} deep. Go on as you like; Esc and Enter hand it in.",
                 as_mm(hole_mm_, 1));
  }
}

}  // namespace cavum::station
