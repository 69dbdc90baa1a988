#include "ui/station/state.h"

namespace cavum::station {

const char* screen_name(Screen screen) noexcept {
  switch (screen) {
    case Screen::sign_in:
      return "sign-in";
    case Screen::self_check:
      return "self-check";
    case Screen::preparing:
      return "preparing";
    case Screen::device_check:
      return "device-check";
    case Screen::briefing:
      return "briefing";
    case Screen::exam:
      return "exam";
    case Screen::grading:
      return "grading";
    case Screen::result:
      return "result";
    case Screen::replay:
      return "replay";
    case Screen::trouble:
      return "trouble";
    case Screen::save:
      return "save";
    case Screen::author:
      return "author";
    case Screen::author_busy:
      return "author-busy";
  }
  return "";
}

}  // namespace cavum::station
