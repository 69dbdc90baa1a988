// A calm, practised person with a finger rest. Bores straight in with a light steady force that he
// keeps by feel, a little lighter near the depth where he expects the chamber, and goes straight at
// it until it gives way. Notices that within 0.12 to 0.25 s and stops. Meant it: he waits a moment,
// then unroofs, hooking the bur under the edge and drawing it outwards and up, stroke by stroke
// round the edge. Did not mean it: lifts at once.
#include <algorithm>
#include <cmath>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {
namespace {

/// Tremor and wander of a braced hand: a resonance shaken by noise, and a slow leaky walk.
class ExpertTremble {
 public:
  ExpertTremble(Random& r, double tremor_mm, double wander_mm) {
    const double turn = 2.0 * 3.14159265358979 * r.uniform(8.0, 12.0) * 1e-3;
    const double keep = std::exp(-r.uniform(4.0, 9.0) * 1e-3);
    cos_ = keep * std::cos(turn), sin_ = keep * std::sin(turn);
    shake_mm_ = tremor_mm * std::sqrt(2.0 * (1.0 - keep * keep));
    stay_ = std::exp(-1e-3 / r.uniform(0.8, 2.5));
    step_mm_ = wander_mm * std::sqrt(1.0 - stay_ * stay_);
  }
  Vec3 next(Random& r) {
    const auto any = [&r] { return Vec3{r.normal(), r.normal(), r.normal()}; };
    const Vec3 re = re_ * cos_ - im_ * sin_ + any() * shake_mm_;
    im_ = re_ * sin_ + im_ * cos_;
    re_ = re;
    walk_ = walk_ * stay_ + any() * step_mm_;
    slow_ += (walk_ - slow_) * 0.01;
    return re_ + slow_;
  }

 private:
  double cos_, sin_, shake_mm_, stay_, step_mm_;
  Vec3 re_, im_, walk_, slow_;
};

class Expert final : public Hand {
 public:
  Expert(const Task& task, Random random)
      : task_(task),
        r_(random),
        tremble_(r_, r_.uniform(0.004, 0.02), r_.uniform(0.015, 0.06)),
        out_(-task.into) {
    u_ = normalized(cross(out_, std::abs(out_.x) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    v_ = cross(out_, u_);
    force_n_ = r_.uniform(0.3, 0.8);
    stiffness_ = r_.uniform(1.2, 3.0);
    damping_ = r_.uniform(0.05, 0.12);
    gain_ = r_.uniform(2.0, 4.5);
    reaction_s_ = r_.uniform(0.12, 0.25);
    faint_ = r_.uniform(0.3, 0.5);
    faster_ = r_.uniform(2.2, 3.2);
    arrive_mm_s_ = r_.uniform(4.0, 8.0);
    settle_mm_s_ = r_.uniform(1.0, 2.0);
    advance_mm_s_ = r_.uniform(1.2, 2.5);
    expects_mm_ = task_.depth_mm * r_.uniform(0.85, 1.1);
    careful_mm_ = r_.uniform(0.3, 1.0);
    careful_ = r_.uniform(0.6, 0.95);
    pedal_ = r_.uniform() < 0.7 ? 1.0 : r_.uniform(0.7, 1.0);
    careful_pedal_ = r_.uniform() < 0.4 ? r_.uniform(0.5, 0.8) * pedal_ : pedal_;
    glance_s_ = r_.uniform() < 0.35 ? r_.uniform(0.3, 0.9) : 0.0;
    const double lean = r_.uniform(0.0, 0.14), about = r_.uniform(0.0, 6.28);
    lean_ = u_ * (lean * std::cos(about)) + v_ * (lean * std::sin(about));
    lean_walk_ = r_.uniform(0.0003, 0.0015);
    // unroofing
    strokes_ = 4 + static_cast<int>(r_.below(6));
    angle_ = r_.uniform(0.0, 6.28);
    turn_ = (r_.uniform() < 0.5 ? 1.0 : -1.0) * r_.uniform(0.7, 1.5);
    side_n_ = r_.uniform(0.3, 0.8);
    draw_mm_s_ = r_.uniform(1.2, 3.0);
    under_mm_ = r_.uniform(0.3, 0.8);
    reach_mm_ = std::max(0.15, 0.5 * task_.width_mm - task_.head_radius_mm) + r_.uniform(0.2, 0.7);
    rise_mm_ = r_.uniform(0.5, 1.2);
    coast_ = r_.uniform() < 0.5;
    leave_mm_s_ = r_.uniform(6.0, 15.0);
    turning_out_ = r_.uniform() < 0.6;
    wanted_ = eased_ = task_.entry_mm + out_ * 3.0;
  }

  Doing act(const Felt& f) override {
    resist_n_ += (dot(f.force_n, out_) - resist_n_) * 0.04;
    depth_mm_ = dot(f.tip_mm - task_.entry_mm, task_.into);
    in_phase_s_ += dt;
    double pedal = pedal_;
    if (f.t_s > 43.0 && phase_ != Phase::leave) begin(Phase::leave);
    switch (phase_) {
      case Phase::arrive:
        arrive(f);
        break;
      case Phase::bore:
        pedal = bore(f);
        break;
      case Phase::stop:
        pedal = stop(f);
        break;
      case Phase::unroof:
        unroof(f);
        break;
      case Phase::leave:
        pedal = 0.0;
        break;
    }
    Doing d;
    if (phase_ == Phase::leave) {
      // caught in the hole: no tugging, the turning bur frees itself
      if (resist_n_ < -0.25) caught_ = true;
      if ((turning_out_ || caught_) && depth_mm_ > -0.3) pedal = pedal_;
      glide(task_.entry_mm + out_ * 3.2, leave_mm_s_ * std::min(1.0, in_phase_s_ / 0.15) *
                                             std::clamp(1.0 + resist_n_ / 0.8, 0.0, 1.0));
      d.done = dot(f.hand_mm - task_.entry_mm, out_) > 2.7 || in_phase_s_ > 5.0;
    }
    lean_ += (u_ * r_.normal() + v_ * r_.normal()) * (lean_walk_ * 0.1);
    // a hand does not jump
    const Vec3 lag = (wanted_ - eased_) * 0.04;
    eased_ += lag * std::min(1.0, 0.016 / std::max(1e-9, length(lag)));
    d.wanted_mm = eased_ + tremble_.next(r_);
    d.stiffness_n_per_mm = stiffness_;
    d.damping_n_s_per_mm = damping_;
    d.pedal = pedal;
    d.handle = normalized(out_ + lean_);
    return d;
  }
  [[nodiscard]] std::string style() const override {
    return task_.into_the_chamber ? "straight, then unroofs" : "straight";
  }

 private:
  enum class Phase { arrive, bore, stop, unroof, leave };
  static constexpr double dt = 0.001;

  void begin(Phase p) { phase_ = p, in_phase_s_ = 0.0; }
  void glide(Vec3 to, double mm_s) {
    const Vec3 way = to - wanted_;
    const double far = length(way);
    wanted_ = far <= mm_s * dt ? to : wanted_ + way * (mm_s * dt / far);
  }

  void arrive(const Felt& f) {
    const double above = dot(wanted_ - task_.entry_mm, out_);
    wanted_ += task_.into * ((above > 0.8 ? arrive_mm_s_ : settle_mm_s_) * dt);
    if (resist_n_ < 0.12 && above > -3.0) return;
    begin(Phase::bore), was_at_mm_ = dot(f.hand_mm - task_.entry_mm, task_.into);
    wanted_ = task_.entry_mm + task_.into * was_at_mm_;
  }

  double bore(const Felt& f) {
    const bool near = depth_mm_ > expects_mm_ - careful_mm_;
    if (near && glance_s_ > 0.0)
      glance_s_ -= dt, glancing_ = true;
    else
      glancing_ = false;
    // little happens: a shade more
    slow_s_ += dt;
    if (depth_mm_ > deepest_mm_ + 0.06) deepest_mm_ = depth_mm_, slow_s_ = 0.0;
    if (slow_s_ > 2.0) slow_s_ = 0.0, force_n_ = std::min(1.1, force_n_ * 1.2);
    const double asked = glancing_ ? 0.1
                                   : (near ? std::max(0.25, force_n_ * careful_) : force_n_) *
                                         std::min(1.0, 0.3 + in_phase_s_ / 0.5);
    const double most = advance_mm_s_ * (near ? careful_ : 1.0);
    const double ahead = dot(wanted_ - f.hand_mm, task_.into);
    double mm_s = std::clamp(gain_ * (asked - resist_n_), -most, most);
    if (ahead > (asked + 0.6) / stiffness_ && mm_s > 0.0) mm_s = 0.0;
    wanted_ += task_.into * (mm_s * dt);
    // what he is used to feel, and whether it is gone
    if (!glancing_) usual_n_ += (std::min(resist_n_, asked) - usual_n_) * 0.002;
    if (resist_n_ > 0.6 * asked) pressed_s_ += dt;
    const bool light = resist_n_ < faint_ * std::min(usual_n_, asked) && depth_mm_ > 0.15;
    // or the hand sinks in faster than such a force is wont to drive it
    const double at_mm = dot(f.hand_mm - task_.entry_mm, task_.into);
    sinks_mm_s_ += ((at_mm - was_at_mm_) / dt - sinks_mm_s_) * 0.015;
    was_at_mm_ = at_mm;
    const double yields = std::max(0.0, sinks_mm_s_) / std::max(resist_n_, 0.05);
    if (!glancing_ && in_phase_s_ > 0.3)
      usual_yields_ += (std::min(yields, 4.0) - usual_yields_) * 0.0008;
    const bool soft = depth_mm_ > 0.65 * expects_mm_ && in_phase_s_ > 1.5 && sinks_mm_s_ > 0.25 &&
                      yields > faster_ * std::max(usual_yields_, 0.1);
    const bool gone = pressed_s_ > 0.3 && !glancing_ && (light || soft);
    gone_s_ = gone ? gone_s_ + dt : std::max(0.0, gone_s_ - 2.0 * dt);
    if (gone_s_ > reaction_s_ - 0.02) {
      if (!task_.into_the_chamber) {
        why_ = "gave way, unmeant";
        wanted_ = f.hand_mm, begin(Phase::leave);
      } else if (depth_mm_ <
                 0.5 * expects_mm_) {  // far too early for the chamber: eases, and goes on
        gone_s_ = pressed_s_ = 0.0, wanted_ = f.hand_mm, in_phase_s_ = 0.0;
      } else {
        why_ = "gave way";
        wanted_ = f.hand_mm + out_ * 0.1, opened_ = true, begin(Phase::stop);
      }
    } else if (depth_mm_ > task_.depth_mm + (task_.into_the_chamber ? 1.0 : 0.0)) {
      why_ = "depth";
      wanted_ = f.hand_mm, begin(task_.into_the_chamber ? Phase::stop : Phase::leave);
    }
    return near ? careful_pedal_ : pedal_;
  }

  double stop(const Felt& f) {
    if (in_phase_s_ < dt * 1.5)
      edge_mm_ = depth_mm_, middle_ = f.tip_mm - task_.into * depth_mm_,
      pause_s_ = r_.uniform(0.3, 0.9);
    if (in_phase_s_ > pause_s_)
      begin(opened_ ? Phase::unroof : Phase::leave), part_ = 0, part_s_ = 0.0;
    return coast_ && in_phase_s_ < pause_s_ - 0.2 ? 0.0 : pedal_;
  }

  /// In under the edge; outwards and up against it; back to the middle.
  void unroof(const Felt& f) {
    const Vec3 side = u_ * std::cos(angle_) + v_ * std::sin(angle_);
    const double sideways = dot(f.tip_mm - middle_, side);
    part_s_ += dt;
    if (part_ == 0) {
      const Vec3 under = middle_ + task_.into * (edge_mm_ + under_mm_);
      if (resist_n_ < 0.4) glide(under, 5.0);
      if (length(under - wanted_) < 0.01 || part_s_ > 0.6)
        part_ = 1, part_s_ = 0.0, hook_n_ = side_n_ * r_.uniform(0.8, 1.2);
    } else if (part_ == 1) {
      // first mostly outwards, then more and more up
      const double up = std::clamp(0.25 + 0.9 * sideways / reach_mm_, 0.25, 1.2);
      const Vec3 way = normalized(side + out_ * up);
      const double held = -dot(f.force_n, way);
      held_n_ += (held - held_n_) * 0.04;
      const double ahead = dot(wanted_ - f.hand_mm, way);
      double mm_s = std::clamp(2.0 * gain_ * (hook_n_ - held_n_), -draw_mm_s_, draw_mm_s_);
      if (ahead > (hook_n_ + 0.6) / stiffness_ && mm_s > 0.0) mm_s = 0.0;
      wanted_ += way * (mm_s * dt);
      if (sideways > reach_mm_ || depth_mm_ < edge_mm_ - rise_mm_ || part_s_ > 1.5)
        part_ = 2, part_s_ = 0.0, rest_s_ = r_.uniform(0.05, 0.35);
    } else {
      glide(middle_ + task_.into * (edge_mm_ - 0.3), 4.0);
      held_n_ = 0.0;
      if (part_s_ > 0.3 + rest_s_) {
        part_ = 0, part_s_ = 0.0;
        angle_ += turn_ * r_.uniform(0.7, 1.3);
        if (--strokes_ <= 0) begin(Phase::leave);
      }
    }
  }

  Task task_;
  Random r_;
  ExpertTremble tremble_;
  Vec3 out_, u_, v_, lean_, wanted_, eased_, middle_;
  double force_n_, stiffness_, damping_, gain_, reaction_s_, faint_, faster_, arrive_mm_s_,
      settle_mm_s_, advance_mm_s_, expects_mm_, careful_mm_, careful_, pedal_, careful_pedal_,
      glance_s_, lean_walk_, angle_, turn_, side_n_, draw_mm_s_, under_mm_, reach_mm_, rise_mm_,
      leave_mm_s_;
  int strokes_, part_ = 0;
  bool coast_, glancing_ = false, opened_ = false, turning_out_, caught_ = false;
  Phase phase_ = Phase::arrive;
  double in_phase_s_ = 0, resist_n_ = 0, depth_mm_ = -3, deepest_mm_ = -9, slow_s_ = 0,
         usual_n_ = 0, pressed_s_ = 0, gone_s_ = 0, edge_mm_ = 0, pause_s_ = 0, part_s_ = 0,
         rest_s_ = 0, held_n_ = 0, hook_n_ = 0, sinks_mm_s_ = 0, was_at_mm_ = 0,
         usual_yields_ = 0.5;
  const char* why_ = "";
};

}  // namespace

std::unique_ptr<Hand> make_expert(const Task& task, Random random) {
  return std::make_unique<Expert>(task, random);
}

}  // namespace cavum::hands
