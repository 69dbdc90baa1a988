#include "ui/station/station_lock.h"

namespace cavum::station {
namespace {

/// An exam runs that counts: leaving it is recorded.
bool examined(const Sitting* sitting) {
  return sitting != nullptr && sitting->stage() == Stage::running && !sitting->practice();
}

void keep(const LockAttempt& a, StationState& state, Sitting* sitting) {
  constexpr int k_most = 1000;  // in one exam: who goes on and on fills no disk
  if (!examined(sitting) || state.attempts >= k_most) return;
  sitting->note(a);
  if (a.what == LockTry::focus_back || a.what == LockTry::screen_back) return;
  ++state.attempts;
  state.attempt = lock_words(a);
  constexpr double k_shown_s = 10.0;
  state.attempt_shown_s = k_shown_s;
}

}  // namespace

void StationLock::watch(Window& window, StationState& state, Sitting* sitting) {
  for (const LockAttempt& a : lock_.look(window.input())) {
    keep(a, state, sitting);
    if (locked() && (a.what == LockTry::screen_lost || a.what == LockTry::screen_back))
      window.come_back();
  }
  constexpr auto k_again = std::chrono::milliseconds(500);
  const auto now = std::chrono::steady_clock::now();
  if (!locked() || !lock_.away() || now - came_back_ < k_again) return;
  came_back_ = now;
  window.come_back();
}

bool StationLock::lets_close(Window& window, StationState& state, Sitting* sitting) {
  if (granted_ || (!locked() && !examined(sitting))) return true;
  window.stay_open();
  keep({LockTry::close_asked}, state, sitting);
  state.confirm_end = false;
  state.confirm_leave = true;
  return false;
}

Message StationLock::refusal(StationState& state) const {
  const std::string code = state.supervisor_code.data();
  state.supervisor_code = {};
  if (!locked() || lock_.opens(code)) return {};
  state.focus_supervisor = true;
  return msg("This is not the supervisor's code.");
}

void StationLock::leave(Window& window, StationState& state, Sitting* sitting) {
  state.leave_message = refusal(state);
  if (!state.leave_message.empty()) return keep({LockTry::close_refused}, state, sitting);
  keep({LockTry::close_granted, locked()}, state, sitting);
  granted_ = true;
  state.confirm_leave = false;
  window.ask_to_close();
}

}  // namespace cavum::station
