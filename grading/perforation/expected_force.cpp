#include "grading/perforation/expected_force.h"

#include <algorithm>
#include <cmath>

namespace cavum::grading {
namespace {

constexpr double k_min_n = 0.05;       // of a force that shows direction, stiffness or contact
constexpr double k_saturates_n = 2.5;  // beyond it a device may not give what the tissue does (3.3
                                       // N at most, docs/physics.md section 10)
constexpr double k_direction_share = 0.1;  // of each frame's force in the direction of the push
constexpr double k_holds = 0.6;  // of the level: a force that has it still shows the direction
constexpr double k_learns_from = 0.7;  // F / G: below it something else than a spring is at work
constexpr double k_all_there = 0.9;    // F / G: nothing of the force is missing
constexpr double k_held_share = 0.2;   // of each such frame in the force that was held: 50 ms

}  // namespace

void RunningMedian::add(double v) {
  if (count_ >= window_.size())
    sorted_.erase(
        std::lower_bound(sorted_.begin(), sorted_.end(), window_[count_ % window_.size()]));
  sorted_.insert(std::lower_bound(sorted_.begin(), sorted_.end(), v), v);
  window_[count_++ % window_.size()] = v;
}

void RunningMedian::clear() {
  sorted_.clear();
  count_ = 0;
}

ExpectedForce::ExpectedForce(const ExpectedForceSettings& settings)
    : k_(settings), median_(static_cast<std::size_t>(frames_in(settings.level_s))) {}

void ExpectedForce::forget() {
  median_.clear();
  levels_.clear();
  waiting_.clear();
  level_n_ = expected_n_ = pressed_n_ = held_n_ = 0;
  fresh_ = true;
}

void ExpectedForce::take(std::span<const DrillFrame> frames, std::int64_t i) {
  const DrillFrame& f = frames[static_cast<std::size_t>(i)];
  if (!f.cutting_possible) {
    forget();
    return;
  }
  const Vec3 force = mean_force_n(frames, i, k_mean_frames);
  const double before_n = force_n_, size = length(force);
  force_n_ = force_size_n(frames, i, k_mean_frames);
  Vec3 tip;
  const std::int64_t first = std::max<std::int64_t>(0, i - k_mean_frames + 1);
  for (std::int64_t k = first; k <= i; ++k)
    tip += frames[static_cast<std::size_t>(k)].tip_mm / static_cast<double>(i - first + 1);
  const double advance = fresh_ ? 0.0 : -dot(tip - tip_mm_, out_);

  // how stiff: the force against the tip's steps, as long as there is contact and no unexplained
  // loss
  if (!fresh_ && force_n_ > k_min_n && before_n > k_min_n && force_n_ < k_saturates_n &&
      before_n < k_saturates_n && force_n_ > k_learns_from * expected_n_) {
    const double keep = 1.0 - k_frame_s / k_.learns_s;
    along_ = std::max(
        0.0, along_ * keep + advance * (force_n_ - before_n + before_n * k_frame_s / k_.tau_s));
    square_ = square_ * keep + advance * advance;
  }
  const double k = stiffness_n_per_mm();
  // damping adds to the stiffness of quick steps, and is learned with it: a retreat may explain
  // more than k alone, but never less than hard tissue
  const double change_n =
      (advance < 0 ? k_.back_share * std::max(k, k_.stiffness_n_per_mm) : k_.forth_share * k) *
          advance -
      std::max(0.0, expected_n_) * k_frame_s / k_.tau_s;
  expected_n_ += change_n;
  pressed_n_ = force_n_ >= k_all_there * expected_n_
                   ? expected_n_
                   : std::min(pressed_n_ + change_n, k_.pressed_most * level_n_);
  if (size > k_holds * level_n_ && size > k_min_n)
    out_ = normalized(out_ * (1 - k_direction_share) + force * (k_direction_share / size), out_);

  waiting_.push_back(force_n_);
  if (std::ssize(waiting_) > frames_in(k_.level_gap_s)) {
    median_.add(waiting_.front());
    waiting_.pop_front();
  }
  if (median_.ready()) {
    const double now = median_.value();
    while (!levels_.empty() && levels_.back().second <= now) levels_.pop_back();
    levels_.emplace_back(i, now);
    while (levels_.front().first < i - frames_in(k_.level_memory_s)) levels_.pop_front();
    level_n_ = levels_.front().second;
    held_n_ = std::min(held_n_, level_n_);
  }
  expected_n_ = std::min(expected_n_, level_n_);
  // contact moves the surface only by a force that pushes back: a blow against the wall of the hole
  // on the way out is none
  const double pushing_n = std::min({force_n_, dot(force, out_), dot(f.force_n, out_)});
  if (pushing_n > k_min_n) expected_n_ = std::max(expected_n_, std::min(pushing_n, level_n_));
  if (force_n_ >= k_all_there * expected_n_)
    held_n_ += k_held_share * (std::min(std::max(0.0, pushing_n), level_n_) - held_n_);
  tip_mm_ = tip;
  fresh_ = false;
  if (median_.ready() && expected_n_ < -level_n_)
    forget();  // twice its penetration back: it has left the tissue
}

}  // namespace cavum::grading
