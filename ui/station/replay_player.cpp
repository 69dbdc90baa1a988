#include "ui/station/replay_player.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "engine/base/error.h"

namespace cavum::station {
namespace {

const SessionReader& sound(const SessionReader& reader) {
  reader.require_readable();
  const std::int64_t version = reader.number("physics_version", 0);
  if (version != k_physics_version)
    throw Error(reader.path(), fmt::format("was recorded under physics {}, this is {}", version, k_physics_version),
                "use the program that recorded it");
  return reader;
}

}  // namespace

ReplayPlayer::ReplayPlayer(const std::string& path)
    : reader_(path),
      setup_(scenarios::prepare_exam(sound(reader_).setup())),
      simulation_(make_simulation(reader_.setup(), path)),
      runner_(setup_->scenario, setup_->zones, setup_->tooth, setup_->point_names, setup_->session.exam_rules),
      inputs_(reader_.inputs()),
      events_(reader_.events()),
      between_(std::max<std::int64_t>(1000, ticks() / k_most_snapshots + 1)) {
  snapshots_.resize(static_cast<std::size_t>(ticks() / between_ + 1));
  snapshots_[0] = std::make_unique<Moment>();
  snapshots_[0]->servo = simulation_.state;
  snapshots_[0]->input.tip_nm = reader_.setup().first_tip_nm;
  snapshots_[0]->output.proxy_mm = reader_.setup().first_tip_mm();
  now_ = std::make_unique<Moment>(*snapshots_[0]);
}

void ReplayPlayer::seek(std::int64_t tick) {
  goal_ = std::clamp<std::int64_t>(tick, 0, ticks());
  std::size_t nearest = static_cast<std::size_t>(goal_ / between_);
  while (!snapshots_[nearest]) --nearest;
  const Moment& from = *snapshots_[nearest];
  if (goal_ < now_->servo.tick || from.servo.tick > now_->servo.tick) now_ = std::make_unique<Moment>(from);
}

void ReplayPlayer::take_tick() {
  const auto at = static_cast<std::size_t>(now_->servo.tick);
  now_->input = inputs_[at];
  now_->output = step(simulation_.model, now_->servo, now_->input);
  runner_.advance(now_->runner, now_->input, now_->output, now_->servo.removed);
  const std::int64_t tick = now_->servo.tick;
  // what the candidate or the supervisor ended is no input of a tick
  const auto ended = [](const SessionEvent& e) { return e.kind == scenarios::event_name(scenarios::ExamEventKind::finished); };
  if (tick == ticks() && std::any_of(events_.begin(), events_.end(), ended)) runner_.end(now_->runner);
  auto& snapshot = snapshots_[static_cast<std::size_t>(tick / between_)];
  if (tick % between_ == 0 && !snapshot) snapshot = std::make_unique<Moment>(*now_);
}

bool ReplayPlayer::work(double budget_s) {
  using Clock = std::chrono::steady_clock;
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(budget_s));
  constexpr int k_between_looks = 64;
  while (now_->servo.tick < goal_) {
    for (int i = 0; i < k_between_looks && now_->servo.tick < goal_; ++i) take_tick();
    if (Clock::now() > until) break;
  }
  return now_->servo.tick == goal_;
}

}  // namespace cavum::station
