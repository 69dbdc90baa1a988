#include "ui/station/termination.h"

namespace cavum {
namespace {

volatile std::sig_atomic_t g_asked = 0;  // all that a signal handler may touch

extern "C" void note_wish(int) { g_asked = 1; }

}  // namespace

Termination::Termination() {
  g_asked = 0;
  struct sigaction action = {};
  action.sa_handler = note_wish;
  sigemptyset(&action.sa_mask);
  sigaction(SIGTERM, &action, &old_term_);
  sigaction(SIGINT, &action, &old_int_);
}

Termination::~Termination() {
  sigaction(SIGTERM, &old_term_, nullptr);
  sigaction(SIGINT, &old_int_, nullptr);
}

bool Termination::asked() noexcept { return g_asked != 0; }

}  // namespace cavum
