// SIGTERM and SIGINT as a wish that the window's thread finds in its next frame: the servo then stops with zero force, and the recording stays whole.
#pragma once

#include <csignal>

namespace cavum {

/// While one lives, the two signals end nothing by themselves.
class Termination {
 public:
  Termination();
  ~Termination();
  Termination(const Termination&) = delete;
  Termination& operator=(const Termination&) = delete;
  [[nodiscard]] static bool asked() noexcept;

 private:
  struct sigaction old_term_ = {}, old_int_ = {};
};

}  // namespace cavum
