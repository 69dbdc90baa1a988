// Goes straight in with a steady force, on the pedal all the way, and lets go a reaction time after
// nothing resists any more.
#include <algorithm>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {
namespace {

class Plunger final : public Hand {
 public:
  Plunger(const Task& task, Random random) : task_(task), r_(random) {
    force_n_ = r_.uniform(0.3, 1.1);
    stiffness_ = r_.uniform(0.4, 2.0);
    reaction_s_ = r_.uniform(0.15, 0.4);
  }
  Doing act(const Felt& f) override {
    const Vec3 out = -task_.into;
    Doing d;
    d.stiffness_n_per_mm = stiffness_;
    d.pedal = 1.0;
    d.handle = out;
    const double depth = dot(f.tip_mm - task_.entry_mm, task_.into);
    felt_n_ += (length(f.force_n) - felt_n_) * 0.03;
    if (leaving_) {
      d.pedal = 0.0;
      away_mm_ += 0.02;
      d.wanted_mm = left_mm_ + out * away_mm_;
      d.done = dot(f.hand_mm - task_.entry_mm, task_.into) < -2.0;
      return d;
    }
    most_n_ = std::max(most_n_ * 0.9999, felt_n_);
    gone_s_ = depth > 0.5 && felt_n_ < 0.2 * most_n_ ? gone_s_ + 0.001 : 0.0;
    if (depth > task_.depth_mm || (f.t_s > 1.0 && gone_s_ > reaction_s_) || f.t_s > 50.0)
      leaving_ = true, left_mm_ = f.hand_mm;
    // down to the surface at 4 mm/s; from the first touch on ahead of the tip by as much as the
    // force needs
    const double lead_mm = wanted_mm_ - dot(f.hand_mm - task_.entry_mm, task_.into);
    if (length(f.force_n) > 0.1) touched_ = true;
    wanted_mm_ += touched_ ? 0.005 * (force_n_ / stiffness_ - lead_mm)
                           : 0.004;  // the arm follows within a fifth of a second
    d.wanted_mm = task_.entry_mm + task_.into * wanted_mm_;
    return d;
  }
  [[nodiscard]] std::string style() const override { return "steady"; }

 private:
  Task task_;
  Random r_;
  double force_n_, stiffness_, reaction_s_;
  double felt_n_ = 0, most_n_ = 0, gone_s_ = 0, away_mm_ = 0;
  double wanted_mm_ = -3.0;
  bool leaving_ = false, touched_ = false;
  Vec3 left_mm_;
};

}  // namespace

std::unique_ptr<Hand> make_plunger(const Task& task, Random random) {
  return std::make_unique<Plunger>(task, random);
}

}  // namespace cavum::hands
