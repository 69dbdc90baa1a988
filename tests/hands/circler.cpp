// A light hand that goes round: it lets the bur touch and leads it in circles, eights or spirals,
// or to and fro like a brush, a little deeper with every turn or stroke. Some sink step by step
// (how far depends on how the last turn felt), some let the weight of the hand sink. The handle
// leans with the circle. The force is judged over a large part of a turn, so a small hole in the
// floor passes unnoticed by some until most of the turn feels empty. Then they lift, or go round
// the rim a few times, or never notice.
#include <algorithm>
#include <cmath>

#include "tests/hands/hand.h"
#include "tests/hands/kinds.h"

namespace cavum::hands {
namespace {

class Circler final : public Hand {
 public:
  Circler(const Task& task, Random random) : task_(task), r_(random) {
    const Vec3 any = std::abs(task.into.z) < 0.7 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
    const Vec3 u = normalized(cross(task.into, any)), v = cross(task.into, u);
    const double turned = r_.uniform(0.0, full_turn), sense = r_.uniform() < 0.5 ? -1.0 : 1.0;
    e1_ = u * std::cos(turned) + v * std::sin(turned);
    e2_ = (v * std::cos(turned) - u * std::sin(turned)) * sense;
    const double which = r_.uniform();
    figure_ = which < 0.35   ? Figure::circle
              : which < 0.5  ? Figure::eight
              : which < 0.7  ? Figure::spiral
              : which < 0.88 ? Figure::brush
                             : Figure::brush_one_way;
    const bool brushes = figure_ == Figure::brush || figure_ == Figure::brush_one_way;
    radius_mm_ =
        brushes ? r_.uniform(0.25, 0.8)
                : r_.uniform(
                      0.2, std::clamp(0.5 * task.width_mm - 0.2 * task.head_radius_mm, 0.35, 1.0));
    const double speed_mm_s = r_.uniform(2.0, 7.0);
    turns_per_s_ =
        std::clamp(speed_mm_s / (brushes ? 4.0 * radius_mm_ : full_turn * radius_mm_), 0.5, 2.5);
    drive_most_ = r_.uniform(1.2, 2.8);
    squash_ = brushes ? 0.0 : r_.uniform(0.6, 1.0);
    rows_mm_ = brushes ? r_.uniform(0.0, 0.35) : 0.0;
    force_n_ = std::clamp(
        (0.6 + 0.15 * r_.normal()) * std::clamp(0.8 + 0.15 * task.depth_mm, 0.9, 1.4), 0.28, 1.1);
    steps_ = r_.uniform() < 0.5;
    step_mm_ = r_.uniform(0.05, 0.16);
    sink_mm_s_n_ = r_.uniform(1.2, 3.0);
    hurry_ = r_.uniform(0.4, 1.4);
    judge_s_ = r_.uniform(0.2, 0.5) / turns_per_s_;
    rested_ = r_.uniform() < 0.75;
    stiffness_ = rested_ ? r_.uniform(1.0, 2.5) : r_.uniform(0.4, 0.9);
    damping_ = r_.uniform(0.04, 0.12);
    tremor_mm_ = r_.uniform(0.008, 0.03) * (rested_ ? 0.7 : 1.3);
    tremor_hz_ = r_.uniform(8.0, 12.0);
    drift_mm_ = r_.uniform(0.02, 0.1) * (rested_ ? 0.7 : 1.3);
    lean_rad_ = r_.uniform(0.0, 12.0) * full_turn / 360.0;
    lean_to_ = r_.uniform(0.0, full_turn);
    cone_rad_ = r_.uniform() < 0.4 ? 0.0 : r_.uniform(1.0, 8.0) * full_turn / 360.0;
    reaction_s_ = r_.uniform(0.12, 0.35);
    const double attention = r_.uniform();
    empty_share_ = attention < 0.18 ? 2.0 : r_.uniform(0.3, 0.85);
    empty_below_ = r_.uniform(0.2, 0.5);
    catches_at_once_ = attention > 0.6;
    heeds_loss_ = task.into_the_chamber || r_.uniform() < 0.55;
    rim_turns_ = r_.uniform() < 0.5 ? r_.uniform(1.5, 6.0) : 0.0;
    rim_growth_ = r_.uniform(0.0, 0.12);
    slow_mm_ = r_.uniform() < 0.5 ? r_.uniform(0.2, 0.8) : -5.0;
    slow_pedal_ = r_.uniform() < 0.5 ? 0.5 : r_.uniform(0.6, 1.0);
    slow_force_ = r_.uniform(0.55, 0.95);
    pedal_ = r_.uniform() < 0.75 ? 1.0 : r_.uniform(0.7, 1.0);
    breathes_ = r_.uniform() < 0.25;
    look_after_turns_ = std::max(3.0, r_.uniform(3.0, 14.0) * turns_per_s_);
    look_mm_ = r_.uniform(0.5, 4.0);
    look_s_ = r_.uniform(0.4, 1.8);
    approach_mm_s_ = r_.uniform(2.0, 6.0);
    starts_hovering_ = r_.uniform() < 0.3;
    next_look_ = look_after_turns_;
    for (auto& p : phase_) p = r_.uniform(0.0, full_turn);
  }

  Doing act(const Felt& f) override {
    const Vec3 from_entry = f.hand_mm - task_.entry_mm;
    const double hand = dot(from_entry, task_.into),
                 seen = dot(f.tip_mm - task_.entry_mm, task_.into);
    if (f.t_s < 0.0015) level_mm_ = hand, origin_ = from_entry - task_.into * hand;
    const double pressed = -dot(f.force_n, task_.into);
    quick_n_ += (pressed - quick_n_) * dt / 0.04;
    judged_n_ += (pressed - judged_n_) * dt / judge_s_;
    origin_ = origin_ * (1.0 - dt / 0.6);
    since_s_ += dt;
    if (f.t_s > 44.0 && stage_ != Stage::away) go(Stage::away, hand);

    // he sees how wide the bur really swings, and drives it harder or less
    const double swing = dot(f.tip_mm - task_.entry_mm, e1_);
    left_mm_ = std::min(left_mm_, swing), right_mm_ = std::max(right_mm_, swing);
    side_n_ =
        std::max(side_n_ * (1.0 - dt), length(f.force_n - task_.into * dot(f.force_n, task_.into)));
    const double was = turn_;
    if (stage_ != Stage::away && (stage_ != Stage::coming || starts_hovering_))
      turn_ += turns_per_s_ * (1.0 + 0.15 * std::sin(turn_ * 1.7 + phase_[0])) * dt;
    const bool round = std::floor(turn_) > std::floor(was);
    if (round) {
      if (stage_ == Stage::grinding && (figure_ != Figure::spiral || radius_share() > 0.8)) {
        const double short_of = 1.0 - 0.5 * (right_mm_ - left_mm_) / radius_mm_;
        drive_ = std::clamp(drive_ * (1.0 + (side_n_ > 1.3 * force_n_ ? -0.1 : 0.25 * short_of)),
                            0.7, drive_most_);
      }
      left_mm_ = right_mm_ = swing;
    }
    switch (stage_) {
      case Stage::coming:
        level_mm_ += approach_mm_s_ * dt * (level_mm_ > -0.8 ? 0.4 : 1.0);
        if (quick_n_ > 0.07) go(Stage::grinding, level_mm_);
        if (level_mm_ > task_.depth_mm + 1.5) go(Stage::away, level_mm_);
        break;
      case Stage::grinding: {
        const double beside = length(f.tip_mm - task_.entry_mm - task_.into * seen);
        if (beside > 1.4 * radius_mm_ + 0.45 &&
            slips_ < 6) {  // slid off: lifts, and back with a smaller swing and less weight
          ++slips_;
          drive_ *= 0.8, force_n_ *= 0.85;
          back_to_mm_ = std::min(0.0, hand);
          go(Stage::looking, hand);
        } else {
          grind(seen, hand, round);
        }
        break;
      }
      case Stage::rim:
        spread_ += rim_growth_ * turns_per_s_ * dt;
        level_mm_ += std::clamp(0.3 * force_n_ - judged_n_, -1.0, 0.0) * 1.5 * dt;
        if (since_s_ * turns_per_s_ > rim_turns_) go(Stage::away, hand);
        break;
      case Stage::looking: {
        const double s = since_s_ / 0.35, back = (since_s_ - 0.35 - look_s_) / 0.4;
        const double up = std::min(from_mm_ - look_mm_, back_to_mm_ - 0.5);
        if (s < 1.0) level_mm_ = from_mm_ + (up - from_mm_) * ease(s);
        if (back > 0.0) level_mm_ = up + (std::min(from_mm_, back_to_mm_) - 0.1 - up) * ease(back);
        if (back >= 1.0)
          judged_n_ = 0.6 * force_n_, back_to_mm_ = 99.0, go(Stage::grinding, level_mm_);
        break;
      }
      case Stage::away:
        level_mm_ -= dt * std::min(9.0, 2.0 + 10.0 * since_s_) *
                     std::clamp((quick_n_ + 0.9) / 0.6, 0.0, 1.0);
        break;
    }
    return answer(f, hand);
  }
  [[nodiscard]] std::string style() const override {
    switch (figure_) {
      case Figure::circle:
        return steps_ ? "circles, by steps" : "circles";
      case Figure::eight:
        return "eights";
      case Figure::spiral:
        return "spirals";
      case Figure::brush:
        return "brush strokes";
      default:
        return "brush strokes, one way";
    }
  }

 private:
  enum class Figure { circle, eight, spiral, brush, brush_one_way };
  enum class Stage { coming, grinding, rim, looking, away };
  static constexpr double dt = 0.001;
  static constexpr double full_turn = 6.283185307179586;

  static double ease(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return s * s * (3.0 - 2.0 * s);
  }
  /// Of a spiral: grows and shrinks over six turns.
  [[nodiscard]] double radius_share() const {
    return 0.55 - 0.45 * std::cos(full_turn * turn_ / 6.0);
  }
  void go(Stage stage, double from) {
    stage_ = stage;
    since_s_ = 0.0;
    from_mm_ = level_mm_ = from;
  }
  [[nodiscard]] bool close() const { return deepest_mm_ > task_.depth_mm - slow_mm_; }

  void grind(double seen, double hand, bool round) {
    deepest_mm_ = std::max(deepest_mm_, seen);
    if (seen > task_.depth_mm + (task_.into_the_chamber ? 1.0 : 0.0)) return go(Stage::away, hand);
    // little to show for the time spent: a somewhat heavier hand
    const double hurry = 1.0 + std::clamp((since_start_s_ += dt) / 30.0, 0.0, 1.0) * hurry_;
    const double wish = std::min(1.4, force_n_ * hurry * (close() ? slow_force_ : 1.0));
    // the device is soft and its joints stick: far too little or too much is mended at once, a
    // little with patience
    const double lack = wish - judged_n_;
    if (steps_ && usual_n_ > 0.0) {
      if (round)
        owed_mm_ +=
            step_mm_ * std::clamp(0.4 + 2.0 * lack / wish, -1.5, 2.0) * (close() ? 0.6 : 1.0);
      const double now = std::clamp(owed_mm_, -2.0 * dt, 0.8 * dt);
      owed_mm_ -= now;
      level_mm_ += now + std::clamp(0.5 * lack, -0.5, 0.15) * dt;
    } else {
      level_mm_ += std::clamp(sink_mm_s_n_ * lack, -1.5, 0.8) * dt;
    }
    if (quick_n_ < 0.04 && since_s_ < 1.5)
      level_mm_ += 1.2 * dt;  // coming back, not yet on the floor
    if (judged_n_ > 0.7 * wish)
      usual_n_ = usual_n_ == 0.0 ? judged_n_ : usual_n_ + (judged_n_ - usual_n_) * dt / 2.0;
    // what the turn felt like
    const bool empty = quick_n_ < empty_below_ * usual_n_ && usual_n_ > 0.0 && deepest_mm_ > 0.25;
    if (empty) empty_s_ += dt;
    empty_run_s_ = empty ? empty_run_s_ + dt : 0.0;
    bool gone = catches_at_once_ && empty_run_s_ > reaction_s_ + 0.25 / turns_per_s_;
    if (round) {
      gone = gone || empty_s_ * turns_per_s_ > empty_share_;
      empty_s_ = 0.0;
    }
    if (gone && heeds_loss_ && empty_share_ < 1.5 && since_s_ > 1.5 / turns_per_s_) {
      opened_ = true;
      return go(rim_turns_ > 0.0 ? Stage::rim : Stage::away, hand);
    }
    if (turn_ > next_look_ && round) {
      next_look_ = turn_ + look_after_turns_ * r_.uniform(0.6, 1.5) * (close() ? 0.6 : 1.0);
      go(Stage::looking, hand);
    }
  }

  Doing answer(const Felt& f, double hand) {
    // the figure; its size swells from nothing at first touch, and shrinks when he leaves
    const double wished = stage_ == Stage::away     ? 0.0
                          : stage_ == Stage::coming ? (starts_hovering_ ? 0.7 : 0.0)
                                                    : 1.0;
    size_ += (wished - size_) * dt / 0.5;
    const double a = full_turn * turn_;
    double x = 0.0, y = 0.0, unload = 0.0;
    double radius = radius_mm_ * drive_ * size_ + spread_;
    if (figure_ == Figure::spiral) radius *= radius_share();
    switch (figure_) {
      case Figure::circle:
      case Figure::spiral:
        x = std::cos(a), y = squash_ * std::sin(a);
        break;
      case Figure::eight:
        x = std::sin(a), y = squash_ * 0.7 * std::sin(2.0 * a);
        break;
      case Figure::brush:
        x = std::sin(a), y = rows_mm_ / radius_mm_ * std::sin(a / 7.0);
        break;
      case Figure::brush_one_way:
        // pulls slowly under load, swings back quickly and off the floor
        x = std::sin(a + 0.5 * std::sin(a)), y = rows_mm_ / radius_mm_ * std::sin(a / 5.0);
        unload = stage_ == Stage::grinding ? 0.35 * std::clamp(1.5 * std::cos(a), 0.0, 1.0) : 0.0;
        break;
    }
    // trembling: a narrow band of noise (a resonator kicked each millisecond); drifting: a leaky
    // random walk
    const double w = full_turn * tremor_hz_, kick = tremor_mm_ * w * std::sqrt(4.0 * 2.5 * dt);
    for (int i = 0; i < 3; ++i) {
      tremble_v_[i] += (-w * w * tremble_[i] - 2.0 * 2.5 * tremble_v_[i]) * dt + kick * r_.normal();
      tremble_[i] += tremble_v_[i] * dt;
      drift_[i] += -drift_[i] * dt / 0.9 + drift_mm_ * std::sqrt(2.0 * dt / 0.9) * r_.normal();
    }
    Doing d;
    d.stiffness_n_per_mm = stiffness_;
    d.damping_n_s_per_mm = damping_;
    d.wanted_mm = task_.entry_mm + origin_ +
                  task_.into * (level_mm_ - unload + tremble_[0] + 0.4 * drift_[0]) +
                  e1_ * (radius * x + tremble_[1] + drift_[1]) +
                  e2_ * (radius * y + tremble_[2] + drift_[2]);
    const double lean1 = lean_rad_ * std::cos(lean_to_) + cone_rad_ * x * size_,
                 lean2 = lean_rad_ * std::sin(lean_to_) + cone_rad_ * y * size_;
    d.handle = normalized(-task_.into + e1_ * std::tan(lean1) + e2_ * std::tan(lean2));
    double pedal = pedal_ * (close() || opened_ ? slow_pedal_ : 1.0);
    if (breathes_) pedal *= 0.85 + 0.15 * std::sin(0.9 * f.t_s + phase_[1]);
    if (stage_ == Stage::looking) pedal *= since_s_ < 0.2 || since_s_ > look_s_ + 0.3 ? 1.0 : 0.3;
    if (stage_ == Stage::away)
      pedal = quick_n_ < -0.15 ? pedal_
              : since_s_ < 0.4 ? pedal * 0.5
                               : 0.0;  // caught under an edge: lets it turn
    d.pedal = std::clamp(pedal, 0.0, 1.0);
    d.done = stage_ == Stage::away && (hand < -2.9 || since_s_ > 6.0);
    return d;
  }

  Task task_;
  Random r_;
  Vec3 e1_, e2_;
  // the person
  Figure figure_;
  double radius_mm_, turns_per_s_, drive_most_, squash_, rows_mm_, force_n_, step_mm_, sink_mm_s_n_,
      hurry_, judge_s_, stiffness_, damping_, tremor_mm_, tremor_hz_, drift_mm_;
  double lean_rad_, lean_to_, cone_rad_, reaction_s_, empty_share_, empty_below_, rim_turns_,
      rim_growth_, slow_mm_, slow_pedal_, slow_force_, pedal_;
  double look_after_turns_, look_mm_, look_s_, approach_mm_s_;
  bool steps_, rested_, catches_at_once_, heeds_loss_, breathes_, starts_hovering_;
  double phase_[2] = {};
  // the moment
  Stage stage_ = Stage::coming;
  Vec3 origin_;
  double level_mm_ = -3.0, from_mm_ = 0.0, since_s_ = 0.0, back_to_mm_ = 99.0, since_start_s_ = 0.0,
         quick_n_ = 0.0, judged_n_ = 0.0, usual_n_ = 0.0, turn_ = 0.0, next_look_;
  double deepest_mm_ = -3.0, owed_mm_ = 0.0, drive_ = 1.0, left_mm_ = 0.0, right_mm_ = 0.0,
         side_n_ = 0.0, empty_s_ = 0.0, empty_run_s_ = 0.0, size_ = 0.0, spread_ = 0.0;
  double tremble_[3] = {}, tremble_v_[3] = {}, drift_[3] = {};
  int slips_ = 0;
  bool opened_ = false;
};

}  // namespace

std::unique_ptr<Hand> make_circler(const Task& task, Random random) {
  return std::make_unique<Circler>(task, random);
}

}  // namespace cavum::hands
