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

std::vector<std::string_view> screen_names() {
  std::vector<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(Screen::author_busy); ++i)
    names.emplace_back(screen_name(static_cast<Screen>(i)));
  return names;
}

}  // namespace cavum::station
