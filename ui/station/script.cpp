#include "ui/station/script.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <thread>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/file_name.h"
#include "ui/parts/say.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

constexpr std::array<const char*, 19> k_words{
    "mouse", "wait", "go",      "until", "type", "key",  "hold",   "release", "sleep", "stall",
    "hide",  "show", "picture", "words", "pace", "tell", "memory", "fail",    "close"};

int key_of(const std::string& name) {
  if (name == "enter") return GLFW_KEY_ENTER;
  if (name == "escape") return GLFW_KEY_ESCAPE;
  if (name == "space") return GLFW_KEY_SPACE;
  if (name == "tab") return GLFW_KEY_TAB;
  if (name == "left") return GLFW_KEY_LEFT;
  if (name == "right") return GLFW_KEY_RIGHT;
  if (name == "up") return GLFW_KEY_UP;
  if (name == "down") return GLFW_KEY_DOWN;
  if (name == "pagedown") return GLFW_KEY_PAGE_DOWN;
  if (name == "pageup") return GLFW_KEY_PAGE_UP;
  if (name == "home") return GLFW_KEY_HOME;
  if (name == "end") return GLFW_KEY_END;
  if (name == "ctrl") return GLFW_KEY_LEFT_CONTROL;
  if (name == "shift") return GLFW_KEY_LEFT_SHIFT;
  if (name == "+") return GLFW_KEY_EQUAL;
  if (name.size() == 1) {
    const char c = name[0];
    if (c >= 'a' && c <= 'z') return GLFW_KEY_A + (c - 'a');
    if ((c >= '0' && c <= '9') || c == '[' || c == ']' || c == '-' || c == ',' || c == '.')
      return c;
  }
  if (name.size() >= 2 && name[0] == 'f' &&
      name.find_first_not_of("0123456789", 1) == std::string::npos) {
    const int n = std::stoi(name.substr(1, 2));
    if (n >= 1 && n <= 12) return GLFW_KEY_F1 + n - 1;
  }
  return 0;
}

Number seconds(double s) { return as_s(s, s < 10 && s > 0 ? 1 : 0); }

double memory_mb() {
  std::ifstream statm("/proc/self/statm");
  long all = 0, resident = 0;
  statm >> all >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

constexpr double k_patience_s = 300;
constexpr double k_silence_s = 10;  // longer than that, who watches is told what is awaited

}  // namespace

Script::Script(const std::string& text, const std::string& path, std::string pictures)
    : path_(path), pictures_(std::move(pictures)) {
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    Command c;
    c.line = number;
    if (!(words >> c.word) || c.word[0] == '#') continue;
    const FileLocation where{path, number};
    if (std::find(k_words.begin(), k_words.end(), c.word) == k_words.end())
      throw Error(where, msg("'{}' is no command of a script", c.word),
                  msg("use one of: {}", list_of(k_words)));
    words >> c.text;
    if (c.word == "until" || c.word == "sleep" || c.word == "stall") {
      std::istringstream value(c.text);
      if (!(value >> c.number) || c.number < 0)
        throw Error(where, msg("'{}' needs seconds", c.word), msg("write a number of 0 or more"));
    }
    if (const auto screens = screen_names();
        (c.word == "wait" || c.word == "go") &&
        std::find(screens.begin(), screens.end(), c.text) == screens.end())
      throw Error(where, msg("'{}' is no screen", c.text), msg("use one of: {}", list_of(screens)));
    if (c.word == "pace") {
      std::istringstream value(c.text);
      if (!(value >> c.number) || c.number < 1)
        throw Error(where, msg("'pace' needs pictures a second"),
                    msg("write a number of 1 or more"));
    }
    if (c.word == "mouse") {
      std::istringstream x(c.text);
      std::string button;
      if (!(x >> c.x) || !(words >> c.number))
        throw Error(where, msg("'mouse' needs a place"),
                    msg("write two numbers of pixels, and 'pressed' after them"));
      c.pressed = (words >> button) && button == "pressed";
    }
    if (c.word == "key" || c.word == "hold" || c.word == "release") {
      c.key = key_of(c.text);
      if (c.key == 0)
        throw Error(
            where, msg("'{}' is no key", c.text),
            msg("use enter, escape, space, tab, an arrow's name, pageup, pagedown, home, end, ctrl, shift, f1 to f12, a letter or a digit"));
      words >> c.number;
    }
    commands_.push_back(c);
  }
}

bool Script::run(const Command& c, Window& window, Screen screen, double exam_s, double now_s) {
  const FileLocation where{path_, c.line};
  const double waited_s = now_s - since_s_;
  if (c.word == "wait" || c.word == "go") {
    constexpr double k_again_s = 0.5;
    const bool there = c.text == screen_name(screen);
    if (c.word == "go" && !there && now_s - pressed_s_ > k_again_s) {
      window.press(GLFW_KEY_ENTER);
      pressed_s_ = now_s;
    }
    if (!there && waited_s > k_patience_s)
      throw Error(where,
                  msg("the screen '{}' did not come, '{}' shows", c.text, screen_name(screen)),
                  msg("correct the script"));
    return there;
  }
  if (c.word == "until") {
    if (exam_s < c.number && (screen == Screen::result || screen == Screen::trouble))
      throw Error(where, msg("the exam was over before its clock came to {} s", c.text),
                  msg("correct the script"));
    if (exam_s <= 0 && screen != Screen::exam && waited_s > k_patience_s)
      throw Error(where, msg("no exam began, '{}' shows", screen_name(screen)),
                  msg("correct the script"));
    return exam_s >= c.number;
  }
  if (c.word == "type") {
    if (!window.wants_text()) {
      if (waited_s > k_patience_s)
        throw Error(where, msg("the screen '{}' has no field for letters", screen_name(screen)),
                    msg("correct the script"));
      return false;
    }
    window.type(c.text);
  }
  if (c.word == "key") {
    window.press(c.key, now_s - since_s_ < c.number);
    return now_s - since_s_ >= c.number;
  }
  if (c.word == "mouse")
    window.point_at(static_cast<float>(c.x), static_cast<float>(c.number), c.pressed);
  if (c.word == "hold") window.press(c.key, true);
  if (c.word == "release") window.release(c.key);
  if (c.word == "sleep") return now_s - since_s_ >= c.number;
  if (c.word == "stall") std::this_thread::sleep_for(std::chrono::duration<double>(c.number));
  if (c.word == "hide") window.set_visible(false);
  if (c.word == "show") window.set_visible(true);
  if (c.word == "picture" && !pictures_.empty()) {
    std::filesystem::create_directories(pictures_);
    window.keep_picture(
        (std::filesystem::path(pictures_) / (file_name_of(c.text) + ".png")).string());
  }
  if (c.word == "words" && !pictures_.empty()) {
    std::filesystem::create_directories(pictures_);
    window.keep_words(
        (std::filesystem::path(pictures_) / (file_name_of(c.text) + ".txt")).string());
  }
  if (c.word == "pace") pace_hz_ = c.number;
  if (c.word == "tell" && !pictures_.empty()) {
    std::filesystem::create_directories(pictures_);
    told_to_ = (std::filesystem::path(pictures_) / (file_name_of(c.text) + ".txt")).string();
    std::filesystem::remove(told_to_);
  }
  if (c.word == "memory") std::printf("%s: %.1f MB\n", c.text.c_str(), memory_mb());
  if (c.word == "fail")
    throw Error(where, msg("the script let the window fail"), msg("leave 'fail' out"));
  if (c.word == "close") window.ask_to_close();
  return true;
}

void Script::shown(Screen screen, double exam_s, Vec3 tip_mm) {
  if (told_to_.empty()) return;
  std::ofstream(told_to_, std::ios::app)
      << screen_name(screen) << std::fixed << std::setprecision(4) << ' ' << exam_s << ' '
      << tip_mm.x << ' ' << tip_mm.y << ' ' << tip_mm.z << '\n';
}

void Script::tell(const Command& c, Screen screen, double exam_s) const {
  const FileLocation where{path_, c.line};
  const Name shows{screen_name(screen)};
  if (c.word == "wait" || c.word == "go")
    ui::say_error(msg("notice: {}: waits for the screen '{}'; '{}' shows", where, c.text, shows));
  else if (c.word == "until")
    ui::say_error(msg("notice: {}: waits for the exam's clock to show {} (now {}); '{}' shows",
                      where, seconds(c.number), seconds(exam_s), shows));
  else if (c.word == "type")
    ui::say_error(
        msg("notice: {}: waits for a field to type '{}' into; '{}' shows", where, c.text, shows));
  else
    ui::say_error(
        msg("notice: {}: waits for {} to pass; '{}' shows", where, seconds(c.number), shows));
}

void Script::step(Window& window, Screen screen, double exam_s, double now_s) {
  if (done()) return;
  if (since_s_ < 0) since_s_ = now_s;
  if (std::exchange(let_go_, false))
    return;  // a frame without the key, so that the same one can be pressed again
  if (!run(commands_[next_], window, screen, exam_s, now_s)) {
    if (!told_ && now_s - since_s_ > k_silence_s) {
      tell(commands_[next_], screen, exam_s);
      told_ = true;
    }
    return;
  }
  told_ = false;
  let_go_ = commands_[next_].word == "key";
  ++next_;
  since_s_ = -1.0;
}

}  // namespace cavum::station
