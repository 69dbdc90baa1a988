#include "ui/station/station_check.h"

#include <chrono>

#include "engine/base/error.h"
#include "engine/session/session.h"

namespace cavum::station {

StationCheck::~StationCheck() {
  stop_ = true;
  if (check_.valid()) check_.wait();
}

bool StationCheck::due(const SittingOptions& o) const {
  const StylusKind& kind = station_stylus_kind(device_);
  if (kind.hand != StylusHand::person || o.practice || !o.resume.empty()) return false;
  const CheckedStylus stylus{kind.facts.id,
                             kind.serial ? kind.serial(load_station_stylus(kind)) : std::string()};
  return ui::needs_check(CheckHistory(check_history_path()), stylus, hours_, read_clocks().utc_ns);
}

void StationCheck::begin() {
  forget();
  {
    const std::lock_guard lock(mutex_);
    progress_ = {msg("The stylus is looked for."), 0.0};
  }
  ui::SelfCheckOptions o;
  o.tell = [this](const ArmProgress& p) {
    const std::lock_guard lock(mutex_);
    progress_ = p;
  };
  o.stop = [this] { return stop_.load(); };
  check_ =
      std::async(std::launch::async, [this, o] { return ui::check_station_stylus(device_, o); });
}

void StationCheck::advance() {
  if (!check_.valid() || check_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return;
  try {
    found_ = check_.get();
  } catch (const Error& e) {
    error_ = e.message();
  }
}

ArmProgress StationCheck::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

bool StationCheck::good() const noexcept {
  return found_ && (found_->entry.verdict.outcome == CheckOutcome::learning ||
                    found_->entry.verdict.outcome == CheckOutcome::unchanged);
}

void StationCheck::go_on(bool by_code) const {
  if (found_ && !good())
    ui::decide_on_check(found_->stylus, true, by_code ? "supervisor" : "person", "");
}

}  // namespace cavum::station
