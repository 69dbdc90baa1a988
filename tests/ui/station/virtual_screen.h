// A screen that nobody sees, for windows under test: an X server of its own, drawn by the
// processor.
#pragma once

#include <sys/types.h>

#include <string>

namespace cavum::testing_station {

class VirtualScreen {
 public:
  /// Starts Xvfb and sets DISPLAY; `there` tells whether that worked.
  VirtualScreen();
  ~VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;
  [[nodiscard]] bool there() const { return server_ > 0; }

 private:
  pid_t server_ = -1;
};

}  // namespace cavum::testing_station
