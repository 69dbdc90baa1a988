// What a locked exam watches: each try to leave it becomes an attempt, which the session records
// and the screen shows. Nothing here ends or hides an exam.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/lock_event.h"
#include "ui/station/input_queue.h"
#include "ui/station/keyboard_watch.h"
#include "ui/station/station_door.h"
#include "ui/station/supervisor_code.h"

namespace cavum::station {

class ExamLock {
 public:
  /// `code_hash`: of the supervisor's code, with which the station can be left; empty: not locked,
  /// what is tried is watched all the same.
  explicit ExamLock(std::string code_hash);
  [[nodiscard]] bool locked() const noexcept { return !hash_.empty(); }
  /// In every picture: what was tried since the one before.
  [[nodiscard]] std::vector<LockAttempt> look(const InputQueue& input);
  /// Whether another window has the keyboard.
  [[nodiscard]] bool away() const noexcept { return away_; }
  [[nodiscard]] bool opens(const std::string& code) const {
    return locked() && is_supervisor_code(hash_, code);
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::string hash_;
  std::optional<StationDoor> door_;
  KeyboardWatch keyboards_;
  Clock::time_point looked_ = Clock::now();
  bool away_ = false;
};

}  // namespace cavum::station
