// The first two minutes at a station: one thing to do at a time, which counts when the person has
// done it, up to a first hole. Knows no window.
#pragma once

#include "engine/base/message.h"
#include "engine/base/vec.h"

namespace cavum::station {

/// What is seen of the person's work in a picture.
struct TutorialSight {
  Vec3 tip_mm;            ///< as the tooth allows it, tooth frame
  Vec3 handle{0, 0, 1};   ///< from the tip to the hand, unit
  Vec3 out{0, 0, 1};      ///< out of the cavity, unit
  float turn_deg = 0.0F;  ///< of the view
  float rise_deg = 0.0F;
  bool contact = false, cutting = false;
  double rpm = 0.0;
};

class Tutorial {
 public:
  static constexpr int k_steps = 7;
  static constexpr double k_hole_mm = 0.5;  ///< deep, that is drilled

  /// `pointer`: mouse and keyboard are the stylus.
  explicit Tutorial(bool pointer) : pointer_(pointer) {}
  /// In every picture; goes on by one step at most.
  void see(const TutorialSight& sight);
  [[nodiscard]] bool done() const noexcept { return step_ >= k_steps; }
  [[nodiscard]] int step() const noexcept { return step_; }  ///< from 0
  /// What to press now, and how far it has come; when done what was drilled.
  [[nodiscard]] Message text() const;
  [[nodiscard]] double hole_mm() const noexcept { return hole_mm_; }

 private:
  [[nodiscard]] bool did(const TutorialSight& sight);

  bool pointer_;
  int step_ = 0;
  bool begun_ = false;   // the running step has its first sight
  bool tilted_ = false;  // the handpiece was, in that step
  TutorialSight first_;  // of the running step
  Vec3 touched_mm_;      // where the tip touched the tooth first
  double hole_mm_ = 0.0;
};

}  // namespace cavum::station
