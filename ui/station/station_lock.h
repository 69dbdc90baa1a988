// What a station does about tries to leave an exam: records and shows them, comes back to the
// front, asks before it closes.
#pragma once

#include <chrono>
#include <string>

#include "ui/station/exam_lock.h"
#include "ui/station/sitting.h"
#include "ui/station/state.h"
#include "ui/station/window.h"

namespace cavum::station {

class StationLock {
 public:
  /// As ExamLock.
  explicit StationLock(std::string code_hash) : lock_(std::move(code_hash)) {}
  [[nodiscard]] bool locked() const noexcept { return lock_.locked(); }
  /// The next one begins: what was granted before counts no more.
  void begin_sitting() noexcept { granted_ = false; }

  /// Takes the supervisor's code that was typed. Why it decides nothing; empty: it is right, or
  /// none is asked for.
  [[nodiscard]] Message refusal(StationState& state) const;

  // `sitting` is null before sign-in.
  /// After every picture: what was tried meanwhile.
  void watch(Window& window, StationState& state, Sitting* sitting);
  /// The window was asked to close. True: it may as far as the lock goes; else it stays open, and
  /// the screen asks.
  [[nodiscard]] bool lets_close(Window& window, StationState& state, Sitting* sitting);
  /// Somebody answered that it shall close, with a code where one is asked for.
  void leave(Window& window, StationState& state, Sitting* sitting);

 private:
  ExamLock lock_;
  bool granted_ = false;
  std::chrono::steady_clock::time_point came_back_ = std::chrono::steady_clock::now();
};

}  // namespace cavum::station
