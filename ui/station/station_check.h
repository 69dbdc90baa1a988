// The station's own check of its stylus, before a candidate signs in: when it is due, the thread in
// which it runs, what was found, and who decided to go on with it. Knows no window.
#pragma once

#include <atomic>
#include <future>
#include <mutex>
#include <optional>
#include <string>

#include "ui/parts/self_check.h"
#include "ui/station/sitting.h"

namespace cavum::station {

class StationCheck {
 public:
  /// `hours`: older than this a check counts no more.
  StationCheck(std::string device, double hours) : device_(std::move(device)), hours_(hours) {}
  /// Stops a check that runs.
  ~StationCheck();
  StationCheck(const StationCheck&) = delete;
  StationCheck& operator=(const StationCheck&) = delete;

  /// A real stylus, an exam that begins, and no check of it that is young enough. Throws Error when
  /// the station's history is damaged.
  [[nodiscard]] bool due(const SittingOptions& options) const;
  void begin();
  /// What an earlier candidate's check found is no longer shown.
  void forget() noexcept {
    found_.reset();
    error_ = {};
  }
  /// Takes up what is done. Often; never waits.
  void advance();

  [[nodiscard]] bool running() const noexcept { return check_.valid(); }
  [[nodiscard]] ArmProgress progress() const;
  /// After it ran.
  [[nodiscard]] const std::optional<ui::SelfChecked>& found() const noexcept { return found_; }
  [[nodiscard]] const Message& error() const noexcept { return error_; }  ///< why it could not run
  [[nodiscard]] bool good() const noexcept;
  /// With what was found; `by_code`: the supervisor gave the code. Throws Error when it cannot be
  /// kept.
  void go_on(bool by_code) const;

 private:
  const std::string device_;
  const double hours_;
  std::future<ui::SelfChecked> check_;
  std::optional<ui::SelfChecked> found_;
  Message error_;
  std::atomic<bool> stop_{false};
  mutable std::mutex mutex_;
  ArmProgress progress_;
};

}  // namespace cavum::station
