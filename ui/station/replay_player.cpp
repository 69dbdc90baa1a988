#include "ui/station/replay_player.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "engine/base/error.h"

namespace cavum::station {
namespace {

const SessionReader& sound(const SessionReader& reader) {
  reader.require_readable();
  return reader;
}

}  // namespace

ReplayPlayer::ReplayPlayer(const std::string& path)
    : reader_(path),
      setup_(scenarios::prepare_exam(sound(reader_).setup())),
      simulation_(make_simulation(reader_.setup(), path, &setup_->tooth)),
      runner_(make_runner()),
      inputs_(reader_.inputs()),
      events_(reader_.events()),
      moments_(replay_moments(events_, reader_.result_json(),
                              static_cast<std::int64_t>(inputs_.size()),
                              !setup_->scenario.hold_results)),
      ended_by_hand_(std::any_of(events_.begin(), events_.end(),
                                 [](const TimedEvent& e) { return e.as<Finished>() != nullptr; })),
      between_(std::max<std::int64_t>(1000, ticks() / k_max_snapshots + 1)) {
  Moment first;
  first.servo = simulation_.state;
  first.input.tip_nm = reader_.setup().first_tip_nm;
  first.output.proxy_mm = reader_.setup().first_tip_mm();
  now_ = std::make_unique<Moment>(first);
  show();
  snapshots_.push_back(std::make_shared<const Moment>(std::move(first)));
  filler_ = std::jthread([this](const std::stop_token& stop) { fill(stop); });
}

void ReplayPlayer::fill(const std::stop_token& stop) {
  Moment moment = *snapshots_.front();  // before any other is there
  scenarios::Runner runner = make_runner();
  while (moment.servo.tick < ticks() && !stop.stop_requested()) {
    take_tick(moment, runner);
    if (moment.servo.tick % between_ != 0) continue;
    auto snapshot = std::make_shared<const Moment>(moment);
    const std::scoped_lock lock(mutex_);
    snapshots_.push_back(std::move(snapshot));
  }
}

std::shared_ptr<const ReplayPlayer::Moment> ReplayPlayer::snapshot_before(std::int64_t tick) {
  const std::scoped_lock lock(mutex_);
  return snapshots_[std::min(static_cast<std::size_t>(tick / between_), snapshots_.size() - 1)];
}

std::int64_t ReplayPlayer::reached() {
  const std::scoped_lock lock(mutex_);
  const auto last = static_cast<std::int64_t>(snapshots_.size() - 1) * between_;
  return last + between_ > ticks() ? ticks() : last;
}

void ReplayPlayer::seek(std::int64_t tick) {
  goal_ = std::clamp<std::int64_t>(tick, 0, ticks());
  const auto from = snapshot_before(goal_);
  if (goal_ < now_->servo.tick || from->servo.tick > now_->servo.tick)
    now_ = std::make_unique<Moment>(*from);
}

scenarios::Runner ReplayPlayer::make_runner() const {
  return {setup_->scenario, setup_->zones, setup_->tooth, setup_->bur_names};
}

void ReplayPlayer::take_tick(Moment& moment, scenarios::Runner& runner) const {
  moment.input = inputs_[static_cast<std::size_t>(moment.servo.tick)];
  moment.output = step(simulation_.model, moment.servo, moment.input);
  runner.advance(moment.runner, moment.input, moment.output, moment.servo.removed);
  if (moment.servo.tick == ticks() && ended_by_hand_) runner.end(moment.runner);
}

bool ReplayPlayer::work(double budget_s) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(budget_s));
  constexpr int k_between_looks = 64;
  while (now_->servo.tick < goal_) {
    seek(goal_);  // the snapshots may have come nearer
    for (int i = 0; i < k_between_looks && now_->servo.tick < goal_; ++i) take_tick(*now_, runner_);
    if (Clock::now() > until) break;
  }
  return now_->servo.tick == goal_;
}

}  // namespace cavum::station
