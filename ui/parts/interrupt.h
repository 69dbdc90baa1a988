// Ctrl-C, SIGTERM and a terminal that closes as a question that a loop may ask, so that an exam
// ends in order: force off, everything recorded, nothing half written.
#pragma once

#include <csignal>

namespace cavum::ui {

/// While one lives, the signals only set it. One at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  [[nodiscard]] static bool asked() noexcept;

 private:
  struct sigaction old_int_ {
  }, old_term_{}, old_hup_{};
};

}  // namespace cavum::ui
