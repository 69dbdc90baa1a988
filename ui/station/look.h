// Colours and size of text as they were chosen, on a window: Ctrl and + or - change the size.
#pragma once

#include <limits>

#include "ui/station/state.h"
#include "ui/station/theme.h"
#include "ui/station/window.h"

namespace cavum::station {

class Look {
 public:
  /// Between frames. `most`: the largest scale that the screens have room for.
  void follow(Window& window, StationState& state,
              double most = std::numeric_limits<double>::infinity());
  [[nodiscard]] const Theme& theme() const noexcept { return theme_; }

 private:
  Theme theme_;
  double scale_ = 0.0;
  bool contrast_ = false;
};

}  // namespace cavum::station
