// A practised hand that never leans on the tooth: it goes in and out, a short press and a short
// lift, each press a ballistic movement to where the floor was the last time plus what the force
// needs, corrected by touch. It knows from peck to peck how much lead gives the force it likes.
// Some move their pecks about the floor, some pulse the pedal (with the pecks or in a rhythm of
// their own), some go lighter and slower near the pulp, most lift away once a peck meets nothing,
// some probe on with lighter pecks round the opening, some notice nothing.
#include <algorithm>
#include <cmath>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {
namespace {

class Pecker final : public Hand {
 public:
  Pecker(const Task& task, Random random) : task_(task), r_(random) {
    across_ =
        normalized(cross(task.into, std::abs(task.into.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    along_ = cross(task.into, across_);
    rested_ = r_.uniform() < 0.65;
    stiffness_ = rested_ ? r_.uniform(1.0, 2.6) : r_.uniform(0.5, 1.0);
    damping_ = r_.uniform(0.03, 0.1);
    force_n_ =
        std::clamp((0.8 + 0.22 * r_.normal()) * std::clamp(0.8 + 0.12 * task.depth_mm, 0.9, 1.3),
                   0.35, 1.5);  // much to do: a firmer hand
    spread_ = r_.uniform(0.05, 0.25);
    press_s_ = r_.uniform() < 0.25 ? r_.uniform(0.5, 1.6) : r_.uniform(0.2, 0.42);
    up_s_ = r_.uniform(0.05, 0.3);
    move_s_ = r_.uniform(0.07, 0.14);
    lift_mm_ = r_.uniform(0.2, 1.0);
    correct_mm_s_n_ = r_.uniform(2.5, 6.0);
    reaction_s_ = r_.uniform() < 0.15 ? 1e9 : r_.uniform(0.12, 0.35);
    felt_rate_ = tick_s / r_.uniform(0.02, 0.06);
    tremor_mm_ = (rested_ ? 0.6 : 1.0) * r_.uniform(0.010, 0.045);
    tremor_hz_ = r_.uniform(8.0, 12.0);
    wander_mm_ = (rested_ ? 0.5 : 1.0) * r_.uniform(0.03, 0.14);
    wander_s_ = r_.uniform(0.2, 0.8);
    tilt_ = r_.uniform(0.0, 18.0) / 360.0 * two_pi;
    tilt_way_ = r_.uniform(0.0, two_pi);
    tilt_wander_ = r_.uniform(0.5, 3.0) / 360.0 * two_pi;
    hop_mm_ =
        r_.uniform() < 0.4
            ? 0.0
            : r_.uniform(0.1, std::max(0.15, 0.5 * task.width_mm - 0.4 * task.head_radius_mm));
    hop_each_ = 2 + static_cast<int>(r_.below(6));
    look_each_ = 5 + static_cast<int>(r_.below(25));
    look_s_ = r_.uniform(0.4, 2.0);
    look_mm_ = r_.uniform(0.8, 5.0);
    const double habit = r_.uniform();
    pedal_habit_ = habit < 0.45   ? Pedal::held
                   : habit < 0.75 ? Pedal::with_the_peck
                                  : Pedal::own_rhythm;
    pedal_on_s_ = r_.uniform(0.4, 2.0);
    pedal_off_s_ = r_.uniform(0.2, 0.6);
    pedal_full_ = r_.uniform() < 0.7 ? 1.0 : r_.uniform(0.6, 1.0);
    careful_mm_ = r_.uniform() < 0.6 ? r_.uniform(0.2, 0.9) : -5.0;
    careful_force_ = r_.uniform(0.5, 0.9);
    careful_pedal_ = r_.uniform() < 0.5 ? 1.0 : r_.uniform(0.45, 0.7);
    impatience_ = r_.uniform(0.0, 0.08);
    give_mm_ = r_.uniform(0.15, 0.5);
    approach_mm_s_ = r_.uniform(2.5, 8.0);
    heeds_loss_ = task.into_the_chamber || r_.uniform() < 0.6;
    probes_ = r_.uniform() < 0.4 ? 1 + static_cast<int>(r_.below(5)) : 0;
    lead_mm_ = 0.35 * force_n_ / stiffness_;
    for (auto& p : phase_) p = r_.uniform(0.0, two_pi);
  }

  Doing act(const Felt& f) override {
    if (f.t_s < 0.0015) at_mm_ = depth(f.hand_mm), side_ = lateral(f.hand_mm), side_goal_ = side_;
    felt_n_ += (-dot(f.force_n, task_.into) - felt_n_) * felt_rate_;
    const double seen = depth(f.tip_mm), hand = depth(f.hand_mm);
    in_phase_s_ += tick_s;
    if (f.t_s > 44.0 && doing_ != Phase::leave) begin(Phase::leave, hand);
    switch (doing_) {
      case Phase::approach:
        approach(seen);
        break;
      case Phase::down:
        down();
        break;
      case Phase::press:
        press(seen, lateral(f.tip_mm));
        break;
      case Phase::up:
        up();
        break;
      case Phase::wait:
        wait();
        break;
      case Phase::leave:
        at_mm_ -= tick_s * std::min(12.0, 4.0 + 20.0 * in_phase_s_) * freely();
        break;
    }
    if (doing_ == Phase::down || doing_ == Phase::press) feel_for_loss(hand, seen);
    return answer(f, hand);
  }
  [[nodiscard]] std::string style() const override {
    if (press_s_ > 0.45) return "pecking, long";
    return pedal_habit_ == Pedal::held            ? "pecking"
           : pedal_habit_ == Pedal::with_the_peck ? "pecking, pedal with it"
                                                  : "pecking, pedal pulsed";
  }

 private:
  enum class Phase { approach, down, press, up, wait, leave };
  enum class Pedal { held, with_the_peck, own_rhythm };
  static constexpr double tick_s = 0.001;
  static constexpr double two_pi = 6.283185307179586;
  struct Side {
    double a = 0.0, b = 0.0;
  };

  /// 0 to 1 with rest at both ends, as people move between two places.
  [[nodiscard]] static double minimum_jerk(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
  }
  [[nodiscard]] double depth(Vec3 p) const { return dot(p - task_.entry_mm, task_.into); }
  [[nodiscard]] Side lateral(Vec3 p) const {
    return {dot(p - task_.entry_mm, across_), dot(p - task_.entry_mm, along_)};
  }
  void begin(Phase phase, double from) {
    doing_ = phase;
    in_phase_s_ = 0.0;
    from_mm_ = from;
  }
  [[nodiscard]] bool near_pulp() const { return floor_mm_ > task_.depth_mm - careful_mm_; }

  /// Caught under an edge on the way out, he pulls no harder but lets it turn: 1 free, 0 caught.
  [[nodiscard]] double freely() const { return std::clamp(1.5 + felt_n_ / 0.6, 0.0, 1.0); }

  void approach(double seen) {
    at_mm_ += approach_mm_s_ * tick_s * (at_mm_ > -1.0 ? 0.5 : 1.0);
    if (felt_n_ > 0.08) {
      floor_mm_ = seen;
      new_peck();
      begin(Phase::press, at_mm_);
    } else if (at_mm_ > task_.depth_mm + 1.5) {
      begin(Phase::leave, at_mm_);  // there is no tooth here
    }
  }
  void new_peck() {
    wish_n_ = force_n_ * eager_ * std::clamp(1.0 + spread_ * r_.normal(), 0.5, 1.6);
    this_press_s_ = press_s_ * std::clamp(1.0 + 0.2 * r_.normal(), 0.5, 1.7);
    if (near_pulp()) wish_n_ *= careful_force_;
    if (opened_) wish_n_ *= 0.6, this_press_s_ *= 0.8;
    wish_n_ = std::clamp(wish_n_, 0.2, 1.8);
    most_this_n_ = 0.0;
    const bool hops = hop_mm_ > 0.0 && (pecks_ % hop_each_ == 0 || opened_);
    if (hops) {
      const double way = r_.uniform(0.0, two_pi), far = hop_mm_ * std::sqrt(r_.uniform());
      side_goal_ = {far * std::cos(way), far * std::sin(way)};
    } else if (hop_mm_ == 0.0) {
      side_goal_ = {side_goal_.a * 0.7, side_goal_.b * 0.7};
    }
    ++pecks_;
  }
  void down() {
    at_mm_ =
        from_mm_ + (floor_mm_ + lead_mm_ - from_mm_) * minimum_jerk(in_phase_s_ / this_move_s_);
    if (in_phase_s_ >= this_move_s_ || felt_n_ > 1.1 * wish_n_) begin(Phase::press, at_mm_);
  }
  void press(double seen, Side beside) {
    if (std::hypot(beside.a, beside.b) > 0.5 * task_.width_mm + 0.35 &&
        slips_ < 6) {  // slid off: back to the place, lighter
      ++slips_;
      eager_ *= 0.8;
      lead_mm_ *= 0.7;
      side_goal_ = {};
      floor_mm_ = std::min(floor_mm_, 0.1);
      this_lift_mm_ = 0.8, this_up_s_ = 0.4, this_move_s_ = 0.15;
      return begin(Phase::up, at_mm_);
    }
    at_mm_ += std::clamp(correct_mm_s_n_ * (wish_n_ - felt_n_), -4.0, 2.5) * tick_s;
    most_this_n_ = std::max(most_this_n_, felt_n_);
    if (seen > (task_.into_the_chamber ? task_.depth_mm + 1.0 : task_.depth_mm))
      return begin(Phase::leave, at_mm_);
    if (in_phase_s_ < this_press_s_) return;
    if (felt_n_ > 0.25 * wish_n_) {
      usual_n_ = usual_n_ == 0.0 ? felt_n_ : usual_n_ + 0.25 * (felt_n_ - usual_n_);
      lead_mm_ = std::clamp(
          0.5 * (lead_mm_ + at_mm_ - seen) + 0.4 * (wish_n_ - felt_n_) / stiffness_, 0.05, 3.0);
      eager_ = seen < floor_mm_ + 0.015 ? std::min(1.7, eager_ + impatience_)
                                        : std::max(1.0, eager_ - 0.5 * impatience_);
      floor_mm_ = seen;
    } else {
      floor_mm_ = std::max(floor_mm_, std::min(seen, floor_mm_ + 0.3));
    }
    const bool looks = pecks_ % (near_pulp() ? std::max(3, look_each_ / 2) : look_each_) == 0;
    this_lift_mm_ = looks ? look_mm_ : lift_mm_ * r_.uniform(0.7, 1.4);
    this_up_s_ = looks ? look_s_ * r_.uniform(0.6, 1.5) : up_s_ * r_.uniform(0.6, 1.6);
    this_move_s_ = move_s_ + this_lift_mm_ / 14.0;
    begin(Phase::up, at_mm_);
  }
  void up() {
    at_mm_ = from_mm_ +
             (floor_mm_ - this_lift_mm_ - from_mm_) * minimum_jerk(in_phase_s_ / this_move_s_);
    if (in_phase_s_ >= this_move_s_) begin(Phase::wait, at_mm_);
  }
  void wait() {
    if (in_phase_s_ < this_up_s_) return;
    if (opened_ && probes_-- <= 0) return begin(Phase::leave, at_mm_);
    new_peck();
    begin(Phase::down, at_mm_);
  }
  /// The hand is where the floor was, and further, and meets nothing: after a reaction time he
  /// knows.
  void feel_for_loss(double hand, double seen) {
    const double usual = usual_n_ > 0.0 ? usual_n_ : force_n_;
    if (felt_n_ > 0.45 * std::min(usual, wish_n_)) gone_s_ = 0.0;
    if (hand > floor_mm_ + 0.12 && floor_mm_ > 0.25 && felt_n_ < 0.3 * std::min(usual, wish_n_))
      gone_s_ += tick_s;
    // or it gave way under him, by more than cutting explains
    if (doing_ != Phase::press || felt_n_ < 0.2 * wish_n_) follow_mm_ = seen;
    follow_mm_ += (seen - follow_mm_) * tick_s / 0.12;
    gave_s_ = gave_s_ > 0.0 || (seen - follow_mm_ > give_mm_ && seen > floor_mm_ + give_mm_ &&
                                floor_mm_ > 0.25)
                  ? gave_s_ + tick_s
                  : 0.0;
    if (std::max(gone_s_, gave_s_) < reaction_s_ || !heeds_loss_ || opened_) return;
    opened_ = true;
    floor_mm_ = std::max(floor_mm_, std::min(seen, floor_mm_ + 0.2));
    if (probes_ == 0) return begin(Phase::leave, at_mm_ = hand);
    this_lift_mm_ = look_mm_;
    this_up_s_ = look_s_;
    this_move_s_ = move_s_ + look_mm_ / 14.0;
    at_mm_ = hand;
    begin(Phase::up, hand);
  }

  Doing answer(const Felt& f, double hand) {
    // trembling: two neighbouring tones that beat, a pair for each direction; wandering: a random
    // walk that is drawn back
    const auto tremble = [&](int i) {
      return tremor_mm_ *
             (0.6 * std::sin(two_pi * tremor_hz_ * f.t_s + phase_[i]) +
              0.4 * std::sin(two_pi * (tremor_hz_ + 0.7 + 0.2 * i) * f.t_s + phase_[i + 3]));
    };
    const double kick = wander_mm_ * std::sqrt(2.0 * tick_s / wander_s_);
    for (auto& w : wander_) w += -w * tick_s / wander_s_ + kick * r_.normal();
    lean_ += -lean_ * tick_s / 1.5 + tilt_wander_ * std::sqrt(2.0 * tick_s / 1.5) * r_.normal();
    const double pull = tick_s / 0.12;
    side_.a += (side_goal_.a - side_.a) * pull;
    side_.b += (side_goal_.b - side_.b) * pull;

    Doing d;
    d.stiffness_n_per_mm = stiffness_;
    d.damping_n_s_per_mm = damping_;
    d.wanted_mm = task_.entry_mm + task_.into * (at_mm_ + tremble(0) + 0.5 * wander_[0]) +
                  across_ * (side_.a + tremble(1) + wander_[1]) +
                  along_ * (side_.b + tremble(2) + wander_[2]);
    const double tilt = tilt_ + lean_;
    d.handle =
        normalized(-task_.into * std::cos(tilt) +
                   (across_ * std::cos(tilt_way_) + along_ * std::sin(tilt_way_)) * std::sin(tilt));
    d.pedal = pedal(f.t_s);
    d.done = doing_ == Phase::leave && (hand < -2.9 || in_phase_s_ > 6.0);
    return d;
  }
  [[nodiscard]] double pedal(double t_s) const {
    const double full = pedal_full_ * (near_pulp() || opened_ ? careful_pedal_ : 1.0);
    if (doing_ == Phase::leave && felt_n_ < -0.2) return 1.0;
    if (doing_ == Phase::leave) return in_phase_s_ < 0.15 && !opened_ ? full : 0.0;
    if (doing_ == Phase::approach) return full;
    if (this_up_s_ > 0.35 && (doing_ == Phase::up || doing_ == Phase::wait))
      return opened_ ? 0.0 : 0.5 * full;
    if (pedal_habit_ == Pedal::with_the_peck)
      return doing_ == Phase::up || (doing_ == Phase::wait && this_up_s_ - in_phase_s_ > 0.1)
                 ? 0.0
                 : full;
    if (pedal_habit_ == Pedal::own_rhythm)
      return std::fmod(t_s, pedal_on_s_ + pedal_off_s_) < pedal_on_s_ ? full : 0.0;
    return full;
  }

  Task task_;
  Random r_;
  Vec3 across_, along_;
  // the person
  bool rested_, heeds_loss_;
  double stiffness_, damping_, force_n_, spread_, press_s_, up_s_, move_s_, lift_mm_,
      correct_mm_s_n_, reaction_s_, felt_rate_;
  double tremor_mm_, tremor_hz_, wander_mm_, wander_s_, tilt_, tilt_way_, tilt_wander_, hop_mm_,
      look_s_, look_mm_;
  double pedal_on_s_, pedal_off_s_, pedal_full_, careful_mm_, careful_force_, careful_pedal_,
      impatience_, give_mm_, approach_mm_s_;
  int hop_each_, look_each_, probes_;
  Pedal pedal_habit_;
  double phase_[6] = {};
  // the moment
  Phase doing_ = Phase::approach;
  double in_phase_s_ = 0.0, from_mm_ = 0.0, at_mm_ = 0.0, floor_mm_ = 0.0, lead_mm_, felt_n_ = 0.0,
         usual_n_ = 0.0, most_this_n_ = 0.0, wish_n_ = 0.5;
  double this_press_s_ = 0.3, this_up_s_ = 0.1, this_lift_mm_ = 0.5, this_move_s_ = 0.1,
         gone_s_ = 0.0, gave_s_ = 0.0, follow_mm_ = 0.0, eager_ = 1.0, lean_ = 0.0;
  double wander_[3] = {};
  Side side_, side_goal_;
  int pecks_ = 0, slips_ = 0;
  bool opened_ = false;
};

}  // namespace

std::unique_ptr<Hand> make_pecker(const Task& task, Random random) {
  return std::make_unique<Pecker>(task, random);
}

}  // namespace cavum::hands
