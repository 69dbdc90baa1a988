// Unsure of himself and without a finger rest. Drills a little and stops: lifts out to look and
// comes back at another speed, often onto another place of the floor; or stays and pumps the pedal;
// or lets the bur turn under the weight of the hand alone and waits; or just stands still. More so
// near the pulp, less when his patience ends. Falls in when it gives way; notices late or not at
// all; then looks again, and dabs at the edge or flees.
#include <algorithm>
#include <array>
#include <cmath>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {
namespace {

/// An unsupported hand: two drifting sines on each axis, and a wander whose velocity walks.
class HesitantSway {
 public:
  HesitantSway(Random& r, double tremor_mm, double wander_mm) : wander_mm_(wander_mm) {
    for (Sine& s : sines_)
      s = {r.uniform(0.0, 6.28), r.uniform(8.0, 12.0), tremor_mm * r.uniform(0.5, 1.2)};
    back_ = r.uniform(1.5, 5.0);
  }
  Vec3 next(Random& r) {
    std::array<double, 3> sum{};
    for (std::size_t i = 0; i < sines_.size(); ++i) {
      Sine& s = sines_[i];
      s.hz = std::clamp(s.hz + 0.03 * r.normal(), 7.5, 12.5);
      s.swell = std::clamp(s.swell + 0.02 * r.normal(), 0.2, 1.8);
      s.phase += 6.2831853 * s.hz * 1e-3;
      sum[i % 3] += s.mm * s.swell * std::sin(s.phase);
    }
    // a spring with little damping, shaken; below 1 Hz
    const double push = 2.0 * wander_mm_ * back_ * std::sqrt(back_) * 0.0316;
    speed_ += (where_ * (-back_ * back_) - speed_ * (2.0 * back_)) * 1e-3 +
              Vec3{r.normal(), r.normal(), r.normal()} * push;
    where_ += speed_ * 1e-3;
    return Vec3{sum[0], sum[1], sum[2]} + where_;
  }

 private:
  struct Sine {
    double phase = 0, hz = 10, mm = 0, swell = 1;
  };
  std::array<Sine, 6> sines_;
  double wander_mm_, back_ = 3;
  Vec3 where_, speed_;
};

class Hesitant final : public Hand {
 public:
  Hesitant(const Task& task, Random random)
      : task_(task),
        r_(random),
        sway_(r_, r_.uniform(0.01, 0.035), r_.uniform(0.04, 0.15)),
        out_(-task.into) {
    u_ = normalized(cross(out_, std::abs(out_.y) < 0.8 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
    v_ = cross(out_, u_);
    force_n_ = r_.uniform(0.3, 0.8);
    grip_ = r_.uniform(0.2, 1.0);
    damping_ = r_.uniform(0.04, 0.1);
    trims_ = r_.uniform(0.6, 1.5);
    bout_s_ = r_.uniform(0.7, 2.6);
    double all = 0.0;
    for (double& w : habits_) w = std::pow(r_.uniform(), 2.0) + 0.03, all += w;
    for (double& w : habits_) w /= all;
    low_mm_ = r_.uniform(0.5, 2.0), high_mm_ = r_.uniform(2.0, 7.0);
    look_s_ = r_.uniform(0.3, 1.2);
    moves_ = r_.uniform(0.3, 0.9);
    spread_mm_ = std::max(0.12, 0.5 * task_.width_mm - task_.head_radius_mm) * r_.uniform(0.5, 1.2);
    brakes_mm_ = r_.uniform() < 0.65 ? r_.uniform(0.4, 1.2) : 0.1;
    slow_mm_s_ = r_.uniform(1.0, 3.0);
    weight_n_ = r_.uniform(0.12, 0.3);
    reaction_s_ = r_.uniform(0.2, 0.5);
    numb_ = r_.uniform() < 0.2;
    pushes_on_ = r_.uniform() < 0.35;
    fearful_ = r_.uniform(0.5, 1.0);
    fears_from_ = r_.uniform(0.5, 0.9);
    half_pedal_ = r_.uniform() < 0.4;
    steep_ = std::pow(r_.uniform(), 2.0) * 0.5;
    patience_s_ = r_.uniform(16.0, 32.0);
    dabs_ = static_cast<int>(r_.below(4));
    leaned_ = lean_ = some_lean();
    come_mm_s_ = r_.uniform(2.0, 8.0);
  }

  Doing act(const Felt& f) override {
    depth_mm_ = dot(f.tip_mm - task_.entry_mm, task_.into);
    hand_mm_now_ = dot(f.hand_mm - task_.entry_mm, task_.into);
    aside_mm_ = length(f.tip_mm - task_.entry_mm - task_.into * depth_mm_ - place_);
    resist_n_ += (dot(f.force_n, out_) - resist_n_) * 0.03;
    now_s_ = f.t_s;
    in_s_ += dt;
    if (f.t_s > 43.0 && phase_ != Phase::leave) begin(Phase::leave);
    grip_now_ +=
        ((phase_ == Phase::weigh ? std::max(0.15, 0.4 * grip_) : grip_) - grip_now_) * 0.01;
    double pedal = 0.0;
    switch (phase_) {
      case Phase::come:
        pedal = come();
        break;
      case Phase::press:
        pedal = press();
        break;
      case Phase::pump:
        pedal = pump();
        break;
      case Phase::weigh:
        pedal = weigh();
        break;
      case Phase::still:
        still();
        break;
      case Phase::look:
        pedal = look();
        break;
      case Phase::leave:
        pedal = leave();
        break;
    }
    const Vec3 way = aim_ - place_;
    const double far = length(way), step = across_mm_s_ * dt;
    place_ = far < step ? aim_ : place_ + way * (step / far);
    leaned_ += (lean_ - leaned_) * 0.004;
    // no hand jumps: it eases off or comes on within a tenth of a second
    eased_mm_ += std::clamp((axial_mm_ - eased_mm_) * 0.03, -0.015, 0.015);
    Doing d;
    d.wanted_mm = task_.entry_mm + place_ + task_.into * eased_mm_ + sway_.next(r_);
    d.stiffness_n_per_mm = grip_now_;
    d.damping_n_s_per_mm = damping_;
    d.pedal = pedal;
    d.handle = normalized(out_ + leaned_);
    d.done = phase_ == Phase::leave &&
             (hand_mm_now_ < -2.7 || (hand_mm_now_ < -2.0 && in_s_ > 1.5) || in_s_ > 5.0);
    return d;
  }
  [[nodiscard]] std::string style() const override { return numb_ ? "hesitant, numb" : "hesitant"; }

 private:
  enum class Phase { come, press, pump, weigh, still, look, leave };
  static constexpr double dt = 0.001;

  void begin(Phase p) {
    const bool pressed = phase_ == Phase::press || phase_ == Phase::pump ||
                         phase_ == Phase::weigh || phase_ == Phase::still;
    const bool presses =
        p == Phase::press || p == Phase::pump || p == Phase::weigh || p == Phase::still;
    if (!presses && pressed) axial_mm_ = std::min(axial_mm_, hand_mm_now_);
    if (presses && !pressed)
      follows_mm_ = hand_mm_now_, ahead_mm_ = std::max(0.0, axial_mm_ - hand_mm_now_);
    phase_ = p, in_s_ = 0.0, gone_s_ = 0.0;
    // how long this will be
    const double hurry = now_s_ > patience_s_ ? 0.4 : 1.0;
    const double any = r_.uniform(0.4, 1.8);
    if (p == Phase::press)
      for_s_ = bout_s_ * any *
               (depth_mm_ > fears_from_ * task_.depth_mm && hurry == 1.0 ? fearful_ : 1.0) / hurry;
    if (p == Phase::pump) for_s_ = hurry * r_.uniform(1.0, 3.5), burst_s_ = 0.0, bursting_ = false;
    if (p == Phase::weigh) for_s_ = hurry * r_.uniform(0.8, 3.0);
    if (p == Phase::still) for_s_ = hurry * r_.uniform(0.3, 1.3);
    if (p == Phase::look) {
      for_s_ = hurry * look_s_ * any, lift_mm_ = r_.uniform(low_mm_, high_mm_);
      lift_mm_s_ = r_.uniform(3.0, 12.0), floor_mm_ = depth_mm_;
    }
    if (p == Phase::come) {
      come_mm_s_ = std::min(15.0, std::exp(r_.uniform(0.7, 2.7)));
      full_ = half_pedal_ && r_.uniform() < 0.5 ? r_.uniform(0.45, 0.7) : 1.0;
    }
  }

  Vec3 some_lean() {
    const double about = r_.uniform(0.0, 6.28), much = steep_ * r_.uniform(0.5, 1.0);
    return (u_ * std::cos(about) + v_ * std::sin(about)) * much;
  }

  /// Ahead of where the hand is by as much as the force needs; what friction eats he adds by feel.
  void push(double n) {
    follows_mm_ += std::clamp((hand_mm_now_ - follows_mm_) * 0.012, -0.008, 0.008);
    ahead_mm_ += std::clamp(trims_ * (n - resist_n_) / grip_now_, -4.0, 4.0) * 2.0 * dt;
    ahead_mm_ = std::clamp(ahead_mm_, -0.1, (n + 0.4) / grip_now_);
    axial_mm_ = follows_mm_ + ahead_mm_;
  }

  double come() {
    const double to_go = floor_mm_ - axial_mm_;
    axial_mm_ += dt * (to_go > brakes_mm_ ? come_mm_s_ : std::min(slow_mm_s_, come_mm_s_));
    if (resist_n_ > 0.1 && depth_mm_ > -1.0)
      begin(Phase::press);
    else if (axial_mm_ > floor_mm_ + (began_ ? 1.5 : 4.0))
      strayed_ = true, begin(Phase::look);
    began_ = began_ || phase_ == Phase::press;
    return full_;
  }

  double press() {
    const double eager = force_n_ * (dabbing_ ? 0.6 : 1.0) * (now_s_ > patience_s_ ? 1.25 : 1.0);
    const double n = eager * std::min(1.0, 0.4 + 3.0 * in_s_);
    push(n);
    idle_s_ += dt;
    if (depth_mm_ > deepest_mm_ + 0.05)
      deepest_mm_ = depth_mm_, deepest_at_ = place_, idle_s_ = 0.0;
    if (idle_s_ > 3.0) {
      idle_s_ = 0.0, force_n_ = std::min(1.1, force_n_ * 1.15);
      // springy, or it does not go: another look, and more upright
      if (hand_mm_now_ > depth_mm_ + 1.5 || r_.uniform() < 0.5) steep_ *= 0.6, begin(Phase::look);
    }
    if (resist_n_ > 0.6 * n) felt_it_s_ += dt;
    if (judged(resist_n_ < 0.4 * n && in_s_ > 0.3)) return full_;
    if (dabbing_ && in_s_ > 0.5 * for_s_)
      --dabs_, begin(dabs_ > 0 ? Phase::look : Phase::leave);
    else if (in_s_ > for_s_)
      pause();
    return full_;
  }

  /// Whether what he feels and sees makes him lift out.
  bool judged(bool light) {
    sinks_mm_s_ += ((hand_mm_now_ - was_mm_) / dt - sinks_mm_s_) * 0.02;
    was_mm_ = hand_mm_now_;
    const bool falls = light || (sinks_mm_s_ > 1.2 && in_s_ > 0.5);
    gone_s_ = falls && felt_it_s_ > 0.25 ? gone_s_ + dt : std::max(0.0, gone_s_ - dt);
    const bool gave =
        (!numb_ || depth_mm_ > task_.depth_mm + 0.8) && gone_s_ > reaction_s_ && depth_mm_ > 0.2;
    const bool deep = depth_mm_ > task_.depth_mm + (task_.into_the_chamber ? 1.0 : 0.0);
    if (!gave && !deep) return false;
    if (aside_mm_ > 0.4) {
      strayed_ = true, grip_ = std::min(1.5, 1.3 * grip_);  // slid off the place
    } else if (gave && !dabbing_ && task_.into_the_chamber && depth_mm_ > 0.45 * task_.depth_mm) {
      why_ = "gave way", dabbing_ = true;
      begin(Phase::look), for_s_ += 0.5;
      return true;
    } else if (gave && !task_.into_the_chamber && !pushes_on_) {
      why_ = "gave way, unmeant", ended_ = true;
    } else if (deep) {
      if (!dabbing_) why_ = "depth";
      ended_ = true;
    } else if (dabbing_) {
      --dabs_;
    }
    felt_it_s_ = 0.0;
    begin(Phase::look);
    return true;
  }

  void pause() {
    double dice = r_.uniform();
    for (std::size_t i = 0; i < habits_.size(); ++i)
      if ((dice -= habits_[i]) < 0.0)
        return begin(std::array{Phase::look, Phase::pump, Phase::weigh, Phase::still}[i]);
    begin(Phase::look);
  }

  double pump() {
    push(std::max(weight_n_, 0.6 * force_n_));
    if (judged(false)) return 0.0;
    burst_s_ -= dt;
    if (burst_s_ < 0.0)
      bursting_ = !bursting_, burst_s_ = bursting_ ? r_.uniform(0.15, 0.7) : r_.uniform(0.2, 0.8);
    if (rested()) return 0.0;
    return bursting_ ? full_ : 0.0;
  }
  double weigh() {
    push(weight_n_);
    if (!judged(false)) rested();
    return full_;
  }
  void still() {
    push(weight_n_);
    rested();
  }
  /// Whether the rest is over; he sees at its end how deep it is.
  bool rested() {
    if (in_s_ < for_s_) return false;
    begin(r_.uniform() < 0.25 * habits_[0] ? Phase::look : Phase::press);
    return true;
  }

  double look() {
    const double to = floor_mm_ - lift_mm_;
    if (axial_mm_ > to) {
      axial_mm_ -= dt * lift_mm_s_ * std::clamp(1.0 + resist_n_ / 0.7, 0.0, 1.0), lifted_s_ = 0.0;
      if (in_s_ < 2.5) return full_;
    }
    lifted_s_ += dt;
    if (lifted_s_ < 1.5 * dt) {
      const bool impatient = now_s_ > patience_s_;
      if (ended_ || (dabbing_ && dabs_ <= 0)) {
        begin(Phase::leave);
        return 0.0;
      }
      lean_ = some_lean();
      across_mm_s_ = r_.uniform(1.0, 6.0);
      if (strayed_) {
        strayed_ = false, aim_ = Vec3{}, spread_mm_ *= 0.6;
      } else if (dabbing_ || (!impatient && r_.uniform() < moves_)) {
        const double about = r_.uniform(0.0, 6.28), mm = spread_mm_ * std::sqrt(r_.uniform());
        aim_ =
            (u_ * std::cos(about) + v_ * std::sin(about)) * mm + (dabbing_ ? deepest_at_ : Vec3{});
      } else if (impatient) {
        aim_ = deepest_at_;
      }
    }
    if (lifted_s_ > for_s_) begin(Phase::come);
    return 0.0;
  }

  double leave() {
    axial_mm_ = std::max(-3.1, axial_mm_ - dt * 8.0 * std::min(1.0, in_s_ / 0.2) *
                                               std::clamp(1.0 + resist_n_ / 0.7, 0.0, 1.0));
    if (resist_n_ < -0.25) caught_ = true;
    return caught_ && depth_mm_ > -0.3 ? 1.0 : 0.0;
  }

  Task task_;
  Random r_;
  HesitantSway sway_;
  Vec3 out_, u_, v_, place_, aim_, lean_, leaned_, deepest_at_;
  std::array<double, 4> habits_;  // look, pump, weigh, still
  double force_n_, grip_, damping_, trims_, bout_s_, low_mm_, high_mm_, look_s_, moves_, spread_mm_,
      brakes_mm_, slow_mm_s_, weight_n_, reaction_s_, fearful_, fears_from_, steep_, patience_s_,
      come_mm_s_;
  bool numb_, pushes_on_, half_pedal_, dabbing_ = false, ended_ = false, bursting_ = false,
                                       caught_ = false, began_ = false, strayed_ = false;
  int dabs_;
  Phase phase_ = Phase::come;
  double grip_now_ = 0.5, full_ = 1.0, axial_mm_ = -3.0, eased_mm_ = -3.0, floor_mm_ = 0.0,
         across_mm_s_ = 3.0, hand_mm_now_ = -3.0, depth_mm_ = -3.0, resist_n_ = 0, now_s_ = 0,
         in_s_ = 0, for_s_ = 1.0, burst_s_ = 0, lift_mm_ = 1, lift_mm_s_ = 5, lifted_s_ = 0,
         follows_mm_ = 0, ahead_mm_ = 0, deepest_mm_ = -9, idle_s_ = 0, sinks_mm_s_ = 0,
         was_mm_ = -3, aside_mm_ = 0, felt_it_s_ = 0, gone_s_ = 0;
  const char* why_ = "";
};

}  // namespace

std::unique_ptr<Hand> make_hesitant(const Task& task, Random random) {
  return std::make_unique<Hesitant>(task, random);
}

}  // namespace cavum::hands
