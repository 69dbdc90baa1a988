#include "ui/station/exam_lock.h"

namespace cavum::station {

ExamLock::ExamLock(std::string code_hash) : hash_(std::move(code_hash)) {
  if (locked()) door_.emplace();
}

std::vector<LockAttempt> ExamLock::look(const InputQueue& input) {
  std::vector<LockAttempt> attempts;
  for (const InputEvent& e : input.played()) {
    if (e.kind == InputEvent::Kind::focus && away_ == e.down) {
      away_ = !e.down;
      attempts.push_back({away_ ? LockTry::focus_lost : LockTry::focus_back});
    }
    if (e.kind == InputEvent::Kind::screens)
      attempts.push_back(
          {.what = e.down ? LockTry::screen_back : LockTry::screen_lost, .screens_left = e.code});
  }
  if (door_)
    for (int n = door_->knocks(); n > 0; --n) attempts.push_back({LockTry::second_station});
  if (const auto now = Clock::now(); now - looked_ > std::chrono::seconds(1)) {
    looked_ = now;
    for (const std::string& keyboard : keyboards_.added())
      attempts.push_back({.what = LockTry::keyboard_added, .keyboard = keyboard});
  }
  return attempts;
}

}  // namespace cavum::station
