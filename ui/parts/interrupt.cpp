#include "ui/parts/interrupt.h"

#include <atomic>

namespace cavum::ui {
namespace {

std::atomic<bool> signalled{false};  // a handler reaches nothing else
static_assert(std::atomic<bool>::is_always_lock_free);

void note(int) { signalled.store(true, std::memory_order_relaxed); }

}  // namespace

Interrupt::Interrupt() {
  signalled.store(false, std::memory_order_relaxed);
  struct sigaction action {};
  action.sa_handler = note;
  sigaction(SIGINT, &action, &old_int_);
  sigaction(SIGTERM, &action, &old_term_);
  sigaction(SIGHUP, &action, &old_hup_);
}

Interrupt::~Interrupt() {
  sigaction(SIGINT, &old_int_, nullptr);
  sigaction(SIGTERM, &old_term_, nullptr);
  sigaction(SIGHUP, &old_hup_, nullptr);
}

bool Interrupt::asked() noexcept { return signalled.load(std::memory_order_relaxed); }

}  // namespace cavum::ui
