// A student with the clock behind him. He changes his mind every second or two: presses (unevenly,
// too much or too little), holds still with the bur turning, scrapes about, takes his foot off
// while he presses, pulls back, takes fright for nothing, gives it a shove. He leans along the
// handle, which wanders, rather than along the axis; he trembles more the harder he presses; he
// sees depth wrongly. When the resistance goes he notices late or never: pushes on, freezes in the
// hole, or snatches the tool out.
#include <algorithm>
#include <cmath>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {
namespace {

class Novice final : public Hand {
 public:
  Novice(const Task& task, Random random) : task_(task), r_(random) {
    p_ = normalized(cross(task.into, std::abs(task.into.y) < 0.7 ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
    q_ = cross(task.into, p_);
    base_n_ = std::clamp(0.65 * std::exp(0.42 * r_.normal()), 0.25, 1.35);
    uneven_ = r_.uniform(0.15, 0.6);
    uneven_s_ = r_.uniform(0.3, 1.5);
    clock_ = r_.uniform(0.0, 1.0);
    grip_ = r_.uniform(0.35, 1.6);
    squeeze_ = r_.uniform(0.0, 0.8);
    damping_ = r_.uniform(0.03, 0.15);
    eagerness_ = r_.uniform(1.5, 4.5);
    advance_most_mm_s_ = r_.uniform(1.0, 3.0);
    numb_s_ = r_.uniform(0.05, 0.12);
    shake_mm_ = r_.uniform(0.015, 0.05);
    shake_hz_ = r_.uniform(8.0, 12.0);
    sway_mm_ = r_.uniform(0.04, 0.15);
    sway_s_ = r_.uniform(0.3, 1.2);
    tilt_to_ = r_.uniform(0.0, turn);
    tilt_ = r_.uniform(3.0, 30.0) * degree;
    tilt_wander_ = r_.uniform(2.0, 7.0) * degree;
    tilt_s_ = r_.uniform(0.8, 3.0);
    along_handle_ = r_.uniform(0.0, 0.8);
    misjudges_mm_ = std::clamp(0.12 * r_.normal(), -0.25, 0.25);
    reaction_s_ = r_.uniform() < 0.35 ? 1e9 : r_.uniform(0.22, 0.8);
    const double then = r_.uniform();
    at_loss_ = then < 0.35 ? AtLoss::pushes_on : then < 0.65 ? AtLoss::freezes : AtLoss::snatches;
    push_on_mm_ = r_.uniform(0.4, 2.0);
    freeze_s_ = r_.uniform(0.4, 1.8);
    heeds_loss_ = task.into_the_chamber || r_.uniform() < 0.4;
    for (auto& w : weight_) w = r_.uniform() < 0.3 ? 0.0 : r_.uniform(0.1, 1.0);
    weight_[static_cast<int>(Mind::press)] = r_.uniform(2.0, 5.0);
    weight_[static_cast<int>(Mind::fright)] *= 0.5;
    foot_ = r_.uniform() < 0.5 ? 1.0 : r_.uniform(0.5, 1.0);
    foot_wobble_ = r_.uniform() < 0.5 ? 0.0 : r_.uniform(0.05, 0.35);
    late_foot_s_ = r_.uniform() < 0.25 ? r_.uniform(0.5, 2.0) : 0.0;
    timid_near_mm_ = r_.uniform() < 0.25 ? r_.uniform(0.2, 0.8) : -5.0;
    timid_ = r_.uniform(0.4, 0.8);
    gives_up_early_s_ = r_.uniform() < 0.06 ? r_.uniform(10.0, 25.0) : 1e9;
    stray_mm_ = r_.uniform(0.05, 0.4);
    for (auto& p : phase_) p = r_.uniform(0.0, turn);
  }

  Doing act(const Felt& f) override {
    const double hand = along(f.hand_mm), seen = along(f.tip_mm),
                 pressed = -dot(f.force_n, task_.into);
    if (f.t_s < 0.0015) want_mm_ = hand, place_ = f.hand_mm - task_.entry_mm - task_.into * hand;
    felt_n_ += (pressed - felt_n_) * ms / numb_s_;
    in_mind_s_ += ms;
    if (mind_ != Mind::leave && f.t_s > std::min(44.0, gives_up_early_s_))
      think(Mind::leave, 9.0, hand);
    moody_ += -moody_ * ms / uneven_s_ + std::sqrt(2.0 * ms / uneven_s_) * r_.normal();
    const double step = decide(f, hand, seen);
    want_mm_ = std::min(want_mm_ + step * ms, hand + 2.4 / stiffness());
    const double beside = length(f.tip_mm - task_.entry_mm - task_.into * seen);
    slid_s_ = beside > 0.5 * task_.width_mm + 0.4 ? slid_s_ + ms : 0.0;
    if (touched_ && slid_s_ > 0.2 && slips_ < 5 && mind_ < Mind::push_on &&
        mind_ != Mind::fright) {  // slid off the tooth: back, and not so hard
      ++slips_;
      soft_ *= 0.75;
      back_mm_ = std::max(0.5, hand + 0.4);
      place_ = {};
      think(Mind::fright, 0.3 + 0.1 * back_mm_, hand);
    }
    if (touched_ && mind_ != Mind::leave && slid_s_ == 0.0) mind_the_end(hand, seen);
    if (slid_s_ > 3.0 && mind_ != Mind::leave) think(Mind::leave, 9.0, hand);
    return answer(f, hand);
  }
  [[nodiscard]] std::string style() const override {
    return base_n_ > 0.85 ? "novice, heavy" : base_n_ < 0.45 ? "novice, timid" : "novice";
  }

 private:
  enum class Mind { press, hold, rest, fright, shove, scrape, foot_off, push_on, frozen, leave };
  enum class AtLoss { pushes_on, freezes, snatches };
  static constexpr double ms = 0.001;
  static constexpr double turn = 6.283185307179586;
  static constexpr double degree = turn / 360.0;

  [[nodiscard]] double along(Vec3 p) const { return dot(p - task_.entry_mm, task_.into); }
  /// He grips harder as he presses harder.
  [[nodiscard]] double stiffness() const {
    return std::clamp(grip_ * (1.0 + squeeze_ * std::max(0.0, felt_n_ - 0.4)), 0.3, 3.0);
  }
  void think(Mind mind, double for_s, double hand) {
    // the fingers' aim goes back to where the hand is, unless he just keeps pressing
    if (mind == Mind::rest || mind == Mind::fright || mind == Mind::leave) want_mm_ = hand;
    mind_ = mind;
    mind_for_s_ = for_s;
    in_mind_s_ = 0.0;
    mind_from_mm_ = hand;
  }
  void change_mind(double hand) {
    double sum = 0.0;
    for (const double w : weight_) sum += w;
    double pick = r_.uniform(0.0, sum);
    int i = 0;
    while (i < 6 && pick >= weight_[i]) pick -= weight_[i++];
    if (mind_ != Mind::press) i = 0;  // whatever he did, then he presses again
    switch (static_cast<Mind>(i)) {
      case Mind::hold:
        return think(Mind::hold, r_.uniform(0.5, 2.5), hand);
      case Mind::rest:
        back_mm_ = r_.uniform(0.2, 1.0);
        return think(Mind::rest, r_.uniform(0.3, 1.0), hand);
      case Mind::fright:
        back_mm_ = r_.uniform(1.5, 5.0);
        return think(Mind::fright, r_.uniform(0.8, 2.2), hand);
      case Mind::shove:
        return think(Mind::shove, r_.uniform(0.3, 0.9), hand);
      case Mind::scrape:
        scrape_mm_ = r_.uniform(0.15, 0.6), scrape_hz_ = r_.uniform(0.8, 2.2);
        return think(Mind::scrape, r_.uniform(0.6, 1.8), hand);
      case Mind::foot_off:
        return think(Mind::foot_off, r_.uniform(0.3, 1.2), hand);
      default:
        level_ = std::exp(0.3 * r_.normal());  // this time harder, or less hard
        return think(Mind::press, r_.uniform(0.7, 3.5), hand);
    }
  }
  /// How fast he moves the aim of his fingers, mm/s into the tooth.
  double decide(const Felt& f, double hand, double seen) {
    if (!touched_) {
      if (felt_n_ > 0.06) touched_ = true, change_mind(hand);
      if (want_mm_ > task_.depth_mm + 1.5) think(Mind::leave, 9.0, hand);
      return want_mm_ < -0.7 ? 4.0 : 1.3;
    }
    const double late = 1.0 + clock_ * std::clamp((f.t_s - 8.0) / 20.0, 0.0, 1.0);
    double wish = base_n_ * soft_ * level_ * late * std::clamp(1.0 + uneven_ * moody_, 0.25, 2.2);
    if (seen > task_.depth_mm - timid_near_mm_) wish *= timid_;
    wish = std::clamp(wish, 0.12, 1.7);
    const bool over = in_mind_s_ > mind_for_s_;
    const auto toward = [&](double force) {
      return std::clamp(eagerness_ * (force - felt_n_), -3.0, advance_most_mm_s_);
    };
    switch (mind_) {
      case Mind::press:
      case Mind::foot_off:
        if (over) change_mind(hand);
        return toward(wish);
      case Mind::scrape:
        if (over) change_mind(hand);
        return toward(0.5 * wish);
      case Mind::shove:
        if (over) change_mind(hand);
        return std::clamp(8.0 * (std::min(2.1, 1.7 * wish + 0.3) - felt_n_), -3.0, 4.0);
      case Mind::hold:
        if (over) change_mind(hand);
        return felt_n_ > 0.3 ? -0.4 : 0.0;  // the weight alone
      case Mind::rest:
      case Mind::fright: {
        const double out_mm_s = mind_ == Mind::fright ? 14.0 : 5.0;
        if (over) {
          // comes back, as a rule somewhere else
          if (mind_ == Mind::fright && slips_ == 0)
            place_ = p_ * (stray_mm_ * r_.normal()) + q_ * (stray_mm_ * r_.normal());
          change_mind(hand);
          back_s_ = back_mm_ / 5.0;
        }
        return want_mm_ > mind_from_mm_ - back_mm_ ? -out_mm_s : 0.0;
      }
      case Mind::push_on:
        if (hand > mind_from_mm_ + push_on_mm_ || in_mind_s_ > 2.0) think(Mind::leave, 9.0, hand);
        return toward(wish);
      case Mind::frozen:
        if (over) think(Mind::leave, 9.0, hand);
        return 0.0;
      case Mind::leave:
        break;
    }
    // caught under an edge on the way out, he stops pulling at some 1.5 N, and finds the pedal
    return (at_loss_ == AtLoss::snatches ? -15.0 : -std::min(6.0, 1.0 + 6.0 * in_mind_s_)) *
           std::clamp((felt_n_ + 1.5) / 0.7, 0.0, 1.0);
  }
  void mind_the_end(double hand, double seen) {
    if (seen > (task_.into_the_chamber ? task_.depth_mm + 1.0 : task_.depth_mm + misjudges_mm_) &&
        mind_ != Mind::push_on)
      return think(Mind::leave, 9.0, hand);
    back_s_ = std::max(0.0, back_s_ - ms);
    const bool pressing = (mind_ == Mind::press || mind_ == Mind::shove) && back_s_ == 0.0;
    if (pressing && felt_n_ > 0.15)
      usual_n_ = usual_n_ == 0.0 ? felt_n_ : usual_n_ + (felt_n_ - usual_n_) * ms / 1.5;
    if (felt_n_ > 0.4 * usual_n_)
      gone_s_ = 0.0, floor_mm_ = std::max(floor_mm_, seen);
    else if (pressing && hand > floor_mm_ + 0.15 && floor_mm_ > 0.3)
      gone_s_ += ms;
    if (gone_s_ < reaction_s_ || !heeds_loss_ || mind_ >= Mind::push_on) return;
    switch (at_loss_) {
      case AtLoss::pushes_on:
        return think(Mind::push_on, 9.0, hand);
      case AtLoss::freezes:
        return think(Mind::frozen, freeze_s_, hand);
      case AtLoss::snatches:
        return think(Mind::leave, 9.0, hand);
    }
  }

  Doing answer(const Felt& f, double hand) {
    const double effort = 0.6 + 0.8 * std::max(0.0, felt_n_);
    const double tone =
        turn * (shake_hz_ * f.t_s) + 1.5 * shake_phase_;  // a tone whose phase strays
    shake_phase_ += std::sqrt(ms) * 2.0 * r_.normal();
    for (int i = 0; i < 3; ++i)
      sway_[i] += -sway_[i] * ms / sway_s_ + sway_mm_ * std::sqrt(2.0 * ms / sway_s_) * r_.normal();
    for (auto& t : tilts_)
      t += -t * ms / tilt_s_ + tilt_wander_ * std::sqrt(2.0 * ms / tilt_s_) * r_.normal();
    const double a = tilt_ * std::cos(tilt_to_) + tilts_[0],
                 b = tilt_ * std::sin(tilt_to_) + tilts_[1];
    Doing d;
    d.handle = normalized(-task_.into + p_ * std::tan(std::clamp(a, -0.65, 0.65)) +
                          q_ * std::tan(std::clamp(b, -0.65, 0.65)));
    // leaning along the handle: what he presses with also pushes sideways
    const double ahead = std::max(0.0, want_mm_ - hand);
    const Vec3 side =
        (d.handle - task_.into * dot(d.handle, task_.into)) * (-along_handle_ * ahead);
    Vec3 scraping;
    if (mind_ == Mind::scrape)
      scraping = p_ * (scrape_mm_ * std::sin(turn * scrape_hz_ * in_mind_s_)) +
                 q_ * (0.4 * scrape_mm_ * std::sin(turn * 0.7 * scrape_hz_ * in_mind_s_));
    drawn_to_ += (place_ - drawn_to_) * (ms / 0.25);
    const auto shake = [&](int i) {
      return shake_mm_ * effort * std::sin(tone + phase_[i]) + sway_[i];
    };
    d.stiffness_n_per_mm = stiffness();
    d.damping_n_s_per_mm = damping_;
    d.wanted_mm = task_.entry_mm + task_.into * (want_mm_ + shake(0)) + drawn_to_ + side +
                  scraping + p_ * shake(1) + q_ * shake(2);
    double foot = foot_ * (1.0 - foot_wobble_ * (0.5 + 0.5 * std::sin(1.3 * f.t_s + phase_[3]) *
                                                           std::sin(0.41 * f.t_s + phase_[4])));
    if (f.t_s < 0.5 + late_foot_s_ && late_foot_s_ > 0.0 &&
        !(touched_ && f.t_s > late_foot_s_ + 1.0))
      foot = 0.0;
    if (mind_ == Mind::foot_off || (mind_ == Mind::fright && in_mind_s_ > 0.3)) foot = 0.0;
    if (mind_ == Mind::leave && in_mind_s_ > 0.25) foot = felt_n_ < -0.5 ? 0.8 : 0.0;
    d.pedal = std::clamp(foot, 0.0, 1.0);
    d.done = mind_ == Mind::leave && (hand < -2.9 || in_mind_s_ > 6.0);
    return d;
  }

  Task task_;
  Random r_;
  Vec3 p_, q_;
  // the person
  double base_n_, uneven_, uneven_s_, clock_, grip_, squeeze_, damping_, eagerness_,
      advance_most_mm_s_, numb_s_, shake_mm_, shake_hz_, sway_mm_, sway_s_;
  double tilt_to_, tilt_, tilt_wander_, tilt_s_, along_handle_, misjudges_mm_, reaction_s_,
      push_on_mm_, freeze_s_;
  double foot_, foot_wobble_, late_foot_s_, timid_near_mm_, timid_, gives_up_early_s_, stray_mm_;
  AtLoss at_loss_;
  bool heeds_loss_;
  double weight_[7] = {};  ///< of press to foot_off
  double phase_[5] = {};
  // the moment
  Mind mind_ = Mind::press;
  Vec3 place_, drawn_to_;
  double want_mm_ = -3.0, felt_n_ = 0.0, usual_n_ = 0.0, in_mind_s_ = 0.0, mind_for_s_ = 0.0,
         mind_from_mm_ = 0.0, moody_ = 0.0, level_ = 1.0, back_mm_ = 0.0, slid_s_ = 0.0,
         soft_ = 1.0;
  double back_s_ = 0.0, scrape_mm_ = 0.0, scrape_hz_ = 1.0, gone_s_ = 0.0, floor_mm_ = -3.0,
         shake_phase_ = 0.0;
  double sway_[3] = {}, tilts_[2] = {};
  int slips_ = 0;
  bool touched_ = false;
};

}  // namespace

std::unique_ptr<Hand> make_novice(const Task& task, Random random) {
  return std::make_unique<Novice>(task, random);
}

}  // namespace cavum::hands
