// Widens as he goes, and cuts with the flank as much as with the end. One of his kind makes a pilot
// hole, then pushes sideways against its walls all round before the next; another works to and fro
// in strokes, a layer at a time, pressing both ways or only on the way there; a third does both in
// turn. Where it gives way he notices by the sinking of the hand, if at all, and mills the edge of
// the opening wider, or leaves, or goes on.
#include <algorithm>
#include <cmath>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {
namespace {

/// Three steady sines for the tremor, and a drift towards ever new places.
class MillerDrift {
 public:
  MillerDrift(Random& r, double tremor_mm, double wander_mm) : wander_mm_(wander_mm) {
    for (int i = 0; i < 3; ++i) {
      turn_[i] = 6.2831853e-3 * r.uniform(8.0, 12.0), phase_[i] = r.uniform(0.0, 6.28);
      mm_[i] = tremor_mm * r.uniform(0.8, 1.9);
    }
  }
  Vec3 next(Random& r) {
    if (--left_ < 0)
      left_ = 100 + static_cast<int>(r.below(700)),
      towards_ = (where_ + Vec3{r.normal(), r.normal(), r.normal()} * wander_mm_) * 0.75;
    along_ += (towards_ - along_) * 0.004;
    where_ += (along_ - where_) * 0.008;
    double s[3];
    for (int i = 0; i < 3; ++i)
      phase_[i] += turn_[i],
          s[i] = mm_[i] * std::sin(phase_[i]) * (1.0 + 0.5 * std::sin(0.11 * phase_[i]));
    return Vec3{s[0], s[1], s[2]} + where_;
  }

 private:
  double wander_mm_, turn_[3], phase_[3], mm_[3];
  int left_ = 0;
  Vec3 towards_, along_, where_;
};

class Miller final : public Hand {
 public:
  Miller(const Task& task, Random random)
      : task_(task),
        r_(random),
        drift_(r_, r_.uniform(0.008, 0.03), r_.uniform(0.03, 0.12)),
        out_(-task.into) {
    u_ = normalized(cross(out_, std::abs(out_.z) < 0.8 ? Vec3{0, 0, 1} : Vec3{0, 1, 0}));
    v_ = cross(out_, u_);
    way_ = static_cast<Way>(r_.below(3));
    down_n_ = r_.uniform(0.4, 1.0);
    side_n_ = r_.uniform(0.35, 1.0);
    under_n_ = r_.uniform(0.05, 0.3);
    stiffness_ = r_.uniform(0.5, 2.2);
    damping_ = r_.uniform(0.04, 0.12);
    gain_ = r_.uniform(2.0, 5.0);
    reaction_s_ = r_.uniform(0.15, 0.35);
    faster_ = r_.uniform(1.7, 2.8);
    numb_ = r_.uniform() < 0.15;
    pushes_on_ = r_.uniform() < 0.4;
    come_mm_s_ = r_.uniform(3.0, 9.0);
    stage_mm_ = r_.uniform(0.35, 1.1);
    walls_ = 2 + static_cast<int>(r_.below(4));
    turn_ = r_.uniform() < 0.6 ? 6.2832 / walls_ : r_.uniform(1.8, 3.6);
    angle_ = r_.uniform(0.0, 6.28);
    side_mm_s_ = r_.uniform(0.6, 2.0);
    wall_s_ = r_.uniform(0.6, 1.8);
    reach_mm_ = std::max(0.15, 0.5 * task_.width_mm - task_.head_radius_mm) + r_.uniform(0.0, 0.25);
    hz_ = r_.uniform(0.8, 2.5);
    swing_mm_ = std::min(r_.uniform(0.25, 1.0), reach_mm_ + 0.2);
    brushes_ = r_.uniform() < 0.4;
    if (brushes_) hz_ = std::min(hz_, 1.6);
    lift_mm_ = r_.uniform(0.15, 0.45);
    layer_mm_ = r_.uniform(0.12, 0.4);
    layer_s_ = r_.uniform(1.5, 4.0);
    near_ = r_.uniform() < 0.5 ? r_.uniform(0.5, 0.85) : 1.0;
    near_mm_ = r_.uniform(0.2, 0.8);
    pedal_ = r_.uniform() < 0.6 ? 1.0 : r_.uniform(0.6, 1.0);
    lifts_foot_ = r_.uniform() < 0.3;
    leans_ = r_.uniform(0.0, 0.25);
    const double about = r_.uniform(0.0, 6.28);
    tilt_ = (u_ * std::cos(about) + v_ * std::sin(about)) * r_.uniform(0.0, 0.3);
    hasty_s_ = r_.uniform(20.0, 32.0);
    more_ = 2 + static_cast<int>(r_.below(5));
    wanted_ = eased_ = task_.entry_mm + out_ * 3.0;
  }

  Doing act(const Felt& f) override {
    const Vec3 rel = f.tip_mm - task_.entry_mm, hand = f.hand_mm - task_.entry_mm;
    depth_mm_ = dot(rel, task_.into), at_mm_ = dot(hand, task_.into);
    tip_side_ = rel - task_.into * depth_mm_, hand_side_ = hand - task_.into * at_mm_;
    resist_n_ += (dot(f.force_n, out_) - resist_n_) * 0.035;
    felt_side_ += (f.force_n - out_ * dot(f.force_n, out_) - felt_side_) * 0.035;
    sinks_mm_s_ += ((at_mm_ - was_mm_) / dt - sinks_mm_s_) * 0.02;
    was_mm_ = at_mm_;
    in_s_ += dt;
    now_s_ = f.t_s;
    if (now_s_ > 43.0 && phase_ != Phase::leave) begin(Phase::leave);
    // in the tooth frame he wants a depth and a place beside the axis
    double deep = dot(wanted_ - task_.entry_mm, task_.into);
    Vec3 side = wanted_ - task_.entry_mm - task_.into * deep;
    double pedal = pedal_;
    lean_ = Vec3{};
    switch (phase_) {
      case Phase::come:
        come(deep, side);
        break;
      case Phase::pilot:
        pilot(deep, side);
        break;
      case Phase::mill:
        mill(deep, side);
        break;
      case Phase::back:
        pedal = back(deep, side);
        break;
      case Phase::stroke:
        stroke(deep, side);
        break;
      case Phase::leave:
        pedal = leave(deep, side);
        break;
    }
    wanted_ = task_.entry_mm + task_.into * deep + side;
    const Vec3 lag = (wanted_ - eased_) * 0.05;
    eased_ += lag * std::min(1.0, 0.022 / std::max(1e-9, length(lag)));
    leaned_ += (lean_ - leaned_) * 0.006;
    Doing d;
    d.wanted_mm = eased_ + drift_.next(r_);
    d.stiffness_n_per_mm = stiffness_;
    d.damping_n_s_per_mm = damping_;
    d.pedal = pedal;
    d.handle = normalized(out_ + tilt_ + leaned_);
    d.done =
        phase_ == Phase::leave && (at_mm_ < -2.7 || (at_mm_ < -2.0 && in_s_ > 1.5) || in_s_ > 5.0);
    return d;
  }
  [[nodiscard]] std::string style() const override {
    return way_ == Way::mills  ? "pilot and walls"
           : way_ == Way::both ? "pilot and strokes"
           : brushes_          ? "brush strokes"
                               : "strokes";
  }

 private:
  enum class Phase { come, pilot, mill, back, stroke, leave };
  enum class Way { mills, strokes, both };
  static constexpr double dt = 0.001;

  void begin(Phase p) {
    phase_ = p, in_s_ = 0.0, gone_s_ = 0.0;
    if (p == Phase::pilot) floor_mm_ = std::max(depth_mm_, 0.0) + stage_mm_ * r_.uniform(0.7, 1.3);
    if (p == Phase::stroke) {
      last_mm_ = depth_mm_ + 0.3, comes_back_ = lifts_ = false,
      floor_mm_ = std::max(depth_mm_, 0.0) + layer_mm_;
      line_ = u_ * std::cos(angle_) + v_ * std::sin(angle_), phase_rad_ = 0.0;
    }
    if (p == Phase::mill)
      wall_n_ = side_n_ * r_.uniform(0.8, 1.2), for_s_ = wall_s_ * r_.uniform(0.7, 1.3);
  }
  [[nodiscard]] bool near() const { return depth_mm_ > task_.depth_mm - near_mm_; }

  /// Downwards with a force, never much further ahead of the hand than that takes.
  void press(double& deep, double n) {
    const double mm_s = std::clamp(gain_ * (n - resist_n_), -4.0, 3.0);
    if (mm_s < 0.0 || deep - at_mm_ < (n + 0.5) / stiffness_) deep += mm_s * dt;
  }
  static void towards(Vec3& side, Vec3 to, double mm_s) {
    const double far = length(to - side);
    side = far <= mm_s * dt ? to : side + (to - side) * (mm_s * dt / far);
  }

  void come(double& deep, Vec3& side) {
    deep += dt * (deep < -0.8 ? come_mm_s_ : std::min(2.0, come_mm_s_));
    towards(side, Vec3{}, 2.0);
    if ((resist_n_ > 0.12 && depth_mm_ > -1.0) || deep > 3.0)
      begin(way_ == Way::strokes ? Phase::stroke : Phase::pilot);
  }

  void pilot(double& deep, Vec3& side) {
    const double n = down_n_ * (near() ? near_ : 1.0) * std::min(1.0, 0.3 + 2.0 * in_s_);
    press(deep, n);
    towards(side, Vec3{}, 1.0);
    harder();
    if (resist_n_ > 0.6 * n) felt_it_s_ += dt;
    if (judged(resist_n_ < 0.3 * n)) return;
    if (depth_mm_ > floor_mm_ && now_s_ < hasty_s_)
      wall_ = 0, begin(way_ == Way::both ? Phase::stroke : Phase::mill);
  }

  void mill(double& deep, Vec3& side) {
    const Vec3 way = u_ * std::cos(angle_) + v_ * std::sin(angle_);
    press(deep, opened_ ? 0.0 : under_n_);
    const double held = -dot(felt_side_, way), ahead = dot(side - hand_side_, way);
    const double mm_s = std::clamp(gain_ * (wall_n_ - held), -side_mm_s_, side_mm_s_);
    if (mm_s < 0.0 || ahead < (wall_n_ + 0.5) / stiffness_) side += way * (mm_s * dt);
    side += (way * dot(side, way) - side) * 0.003;
    lean_ = way * leans_;
    if (!opened_ && judged(false)) return;
    if (dot(tip_side_, way) > reach_mm_ || in_s_ > for_s_) begin(Phase::back);
  }

  double back(double& deep, Vec3& side) {
    if (strayed_) {
      deep = std::max(-1.5, deep - 6.0 * dt);
      towards(side, Vec3{}, deep < -1.2 ? 3.0 : 0.0);
      if (deep < -1.4 && length(side) < 0.05)
        strayed_ = false, deepest_mm_ = -9.0, begin(Phase::come);
      return pedal_;
    }
    towards(side, Vec3{}, 3.0);
    deep += dt * std::clamp((depth_mm_ - 0.1 - deep) * 10.0, -3.0, 0.5);
    if (length(side) < 0.05 && in_s_ > 0.15) {
      angle_ += turn_ * r_.uniform(0.85, 1.15);
      if (opened_)
        begin(--more_ > 0 ? Phase::mill : Phase::leave);
      else
        begin(++wall_ < walls_ ? Phase::mill : Phase::pilot);
    }
    return lifts_foot_ ? 0.0 : pedal_;
  }

  void stroke(double& deep, Vec3& side) {
    phase_rad_ += 6.2831853 * hz_ * dt;
    const double x = std::sin(phase_rad_), v = std::cos(phase_rad_);
    const Vec3 aim = line_ * (swing_mm_ * x);
    const double slack = (side_n_ + 0.3) / stiffness_, far = length(aim - hand_side_);
    // a wall holds the stroke back: first that
    const double yielding =
        now_s_ > hasty_s_ ? 1.0 : 1.0 - 0.6 * std::clamp(1.5 * far / slack - 0.4, 0.0, 1.0);
    const Vec3 held = far > slack ? hand_side_ + (aim - hand_side_) * (slack / far) : aim;
    side += (held - side) * 0.05;
    lean_ = line_ * (x * 0.4 * leans_);
    const bool lifting = brushes_ && v < -0.25;
    if (lifting && !lifts_)
      last_mm_ = depth_mm_, beyond_mm_ = std::max(0.1, deep - depth_mm_), comes_back_ = true;
    lifts_ = lifting;
    const double most = opened_ ? 0.05 : down_n_;
    const double n = most * (near() ? near_ : 1.0) * (depth_mm_ < floor_mm_ ? 1.0 : 0.45) *
                     yielding * std::min(1.0, 0.3 + 2.0 * in_s_);
    if (lifting)
      deep += dt * std::clamp((depth_mm_ - lift_mm_ - deep) * 12.0, -6.0, 0.0);
    else if (comes_back_ && deep < last_mm_ + beyond_mm_)
      deep += dt * 15.0;  // down again to where it pressed
    else
      comes_back_ = false, press(deep, n);
    harder();
    if (!lifting && resist_n_ > 0.6 * n) felt_it_s_ += dt;
    if (brushes_) sinks_mm_s_ = std::min(sinks_mm_s_, 0.0);
    const bool light = brushes_ ? depth_mm_ > last_mm_ + 0.35 : resist_n_ < 0.25 * n;
    if (!opened_ && !lifting && !comes_back_ && judged(light)) return;
    // this layer is off
    if (in_s_ > layer_s_ || (depth_mm_ > floor_mm_ + 0.02 && in_s_ > 1.5 / hz_)) {
      if (opened_ && --more_ <= 0) return begin(Phase::leave);
      angle_ += r_.uniform() < 0.5 ? r_.uniform(0.3, 1.6) : 0.0;
      begin(way_ == Way::both && !opened_ && r_.uniform() < 0.5 ? Phase::pilot : Phase::stroke);
    }
  }

  /// When little happens.
  void harder() {
    idle_s_ += dt;
    if (depth_mm_ > deepest_mm_ + 0.05) deepest_mm_ = depth_mm_, idle_s_ = 0.0;
    if (idle_s_ > 2.5) idle_s_ = 0.0, down_n_ = std::min(1.3, down_n_ * 1.15);
  }

  bool judged(bool light) {
    // or the hand sinks faster than such a force is wont to drive it
    bool soft = false;
    if ((phase_ == Phase::pilot || (phase_ == Phase::stroke && !brushes_)) && in_s_ > 0.4) {
      const double yields = std::clamp(sinks_mm_s_ / std::max(resist_n_, 0.05), 0.0, 4.0);
      soft = depth_mm_ > 0.6 * task_.depth_mm && sinks_mm_s_ > 0.22 &&
             yields > faster_ * std::max(usual_yields_, 0.1);
      usual_yields_ += (yields - usual_yields_) * 0.0007;
    }
    const bool falls = light || soft || sinks_mm_s_ > 1.2;
    gone_s_ =
        falls && felt_it_s_ > 0.25 && in_s_ > 0.4 ? gone_s_ + dt : std::max(0.0, gone_s_ - dt);
    const bool far = length(tip_side_) > std::max(swing_mm_, reach_mm_) + 0.35;
    const bool gave = !numb_ && gone_s_ > reaction_s_ && depth_mm_ > 0.2 && !far;
    const bool deep = depth_mm_ > task_.depth_mm + (task_.into_the_chamber ? 1.0 : 0.0);
    if (gave && task_.into_the_chamber && depth_mm_ > 0.45 * task_.depth_mm) {
      why_ = "gave way", opened_ = true;
      begin(way_ == Way::strokes ? Phase::stroke : Phase::back);
    } else if (gave && !task_.into_the_chamber && !pushes_on_) {
      why_ = "gave way, unmeant";
      begin(Phase::leave);
    } else if (deep && far) {
      begin(Phase::back), felt_it_s_ = 0.0, wall_ = walls_,
                          strayed_ = true;  // slid off: out, and once more
    } else if (deep) {
      why_ = "depth";
      if (task_.into_the_chamber)
        opened_ = true, begin(Phase::back);
      else
        begin(Phase::leave);
    } else {
      if (gave) felt_it_s_ = 0.0, gone_s_ = 0.0;
      return false;
    }
    return true;
  }

  double leave(double& deep, Vec3& side) {
    const double gently = std::clamp(1.0 + resist_n_ / 0.8, 0.0, 1.0) * std::min(1.0, in_s_ / 0.15);
    deep = std::max(-3.3, deep - dt * 10.0 * gently);
    towards(side, Vec3{}, 3.0);
    if (resist_n_ < -0.25) caught_ = true;
    return caught_ && depth_mm_ > -0.3 ? pedal_ : 0.0;
  }

  Task task_;
  Random r_;
  MillerDrift drift_;
  Vec3 out_, u_, v_, tilt_, wanted_, eased_, lean_, leaned_, line_, tip_side_, hand_side_,
      felt_side_;
  Way way_;
  double down_n_, side_n_, under_n_, stiffness_, damping_, gain_, reaction_s_, faster_, come_mm_s_,
      stage_mm_, turn_, angle_, side_mm_s_, wall_s_, reach_mm_, hz_, swing_mm_, lift_mm_, layer_mm_,
      layer_s_, near_, near_mm_, pedal_, leans_, hasty_s_;
  bool numb_, pushes_on_, brushes_, lifts_foot_, opened_ = false, caught_ = false, lifts_ = false,
                                                 comes_back_ = false, strayed_ = false;
  int walls_, more_, wall_ = 0;
  Phase phase_ = Phase::come;
  double depth_mm_ = -3, at_mm_ = -3, was_mm_ = -3, resist_n_ = 0, sinks_mm_s_ = 0, in_s_ = 0,
         now_s_ = 0, gone_s_ = 0, felt_it_s_ = 0, floor_mm_ = 0, for_s_ = 1, wall_n_ = 0.5,
         phase_rad_ = 0, deepest_mm_ = -9, idle_s_ = 0, usual_yields_ = 0.5, last_mm_ = 0,
         beyond_mm_ = 0.1;
  const char* why_ = "";
};

}  // namespace

std::unique_ptr<Hand> make_miller(const Task& task, Random random) {
  return std::make_unique<Miller>(task, random);
}

}  // namespace cavum::hands
