#include "tests/ui/person/means.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "engine/base/file.h"
#include "engine/device/hardware/inverse3_stylus.h"
#include "engine/device/hardware/station_pedal.h"

namespace cavum::testing_person {
namespace {

using Clock = std::chrono::steady_clock;

void rest_s(double s) { std::this_thread::sleep_for(std::chrono::duration<double>(s)); }

constexpr Vec3 k_inverse3_middle_mm{
    0, -120, 150};  // of its space, where the crown's middle lies by the usual placement

}  // namespace

void Means::await(const Eye& eye, const std::string& screen) {
  constexpr double k_patience_s = 600.0;
  const auto began = Clock::now();
  while (eye().screen != screen) {
    if (std::chrono::duration<double>(Clock::now() - began).count() > k_patience_s)
      throw std::runtime_error("the screen '" + screen + "' did not come, '" + eye().screen +
                               "' shows");
    rest_s(0.1);
  }
  see(eye, 2);  // a person looks first
}

void Means::see(const Eye& eye, int pictures) {
  constexpr double k_at_least_s = 0.3, k_patience_s = 60.0;
  const auto began = Clock::now();
  const std::int64_t until = eye().picture + pictures + 1;  // the running one may have begun before
  rest_s(k_at_least_s);
  while (eye().picture < until) {
    if (std::chrono::duration<double>(Clock::now() - began).count() > k_patience_s)
      throw std::runtime_error("no picture came for a minute");
    rest_s(0.02);
  }
}

void Means::try_pedal(const Eye& eye) {
  constexpr double k_stands_s = 1.5, k_pressed_s = 0.8;
  rest_s(k_stands_s);
  pedal(true);
  rest_s(k_pressed_s);
  see(eye, 2);
  pedal(false);
  see(eye, 2);
}

void KeyboardMeans::come_to_exam(const Eye& eye, int bur, int /*shelf*/) {
  await(eye, "sign-in");
  for (const char* letter : {"k", "1"}) hand_.tap(letter, 40);
  see(eye, 2);
  hand_.tap("Return", 60);
  await(eye, "device-check");
  try_pedal(eye);
  for (int i = 0; i < 20 && eye().screen == "device-check"; ++i) {
    hand_.tap("Return", 60);
    see(eye, 3);
  }
  await(eye, "briefing");
  hand_.tap("Return", 60);
  await(eye, "exam");
  hand_.tap("F" + std::to_string(bur + 1), 60);
  see(eye, 2);
}

Vec3 KeyboardMeans::move(Vec3 units) {
  // a tap is 0.05 mm; held for longer than 0.2 s a key goes on at 4 mm a second: docs/station.md
  constexpr double k_step = 0.05, k_wait_s = 0.2, k_mm_s = 4.0, k_tap_s = 0.03;
  const std::array<double, 3> way{units.x, units.y, units.z};
  constexpr std::array<std::array<const char*, 2>, 3> k_keys{
      {{"Right", "Left"}, {"Up", "Down"}, {"Prior", "Next"}}};
  std::array<double, 3> did{};
  struct Let {
    double at_s;
    const char* key;
    std::size_t axis;
    double sign;
  };
  std::vector<Let> lets;
  std::array<Clock::time_point, 3> since{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double far = std::fabs(way[i]);
    if (far < 0.5 * k_step) continue;
    const char* key = k_keys[i][way[i] > 0 ? 0 : 1];
    lets.push_back({far < 1.5 * k_step ? k_tap_s : k_wait_s + (far - k_step) / k_mm_s, key, i,
                    way[i] > 0 ? 1.0 : -1.0});
  }
  std::sort(lets.begin(), lets.end(), [](const Let& a, const Let& b) { return a.at_s < b.at_s; });
  for (const Let& l : lets) {
    hand_.key(l.key, true);
    since[l.axis] = Clock::now();
  }
  const auto began = Clock::now();
  for (const Let& l : lets) {
    std::this_thread::sleep_until(
        began + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(l.at_s)));
    hand_.key(l.key, false);
    const double held_s = std::chrono::duration<double>(Clock::now() - since[l.axis]).count();
    did[l.axis] = l.sign * (k_step + k_mm_s * std::max(0.0, held_s - k_wait_s));
  }
  return {did[0], did[1], did[2]};
}

void KeyboardMeans::hand_in(const Eye& eye) {
  for (int i = 0; i < 5 && eye().screen == "exam"; ++i) {
    hand_.tap("Escape", 60);
    see(eye, 3);
    hand_.tap("Return", 60);
    see(eye, 3);
  }
  await(eye, "result");
  hand_.tap("Return", 60);
}

void MouseMeans::press_main_button(const Eye& eye) const {
  constexpr unsigned long k_accent = 0x56b4e9;  // of the button that goes on
  hand_.point_at(5, 5);
  see(eye, 2);
  const auto place = hand_.see(k_accent);
  if (!place) return;
  hand_.point_at(place->first, place->second);
  see(eye, 2);
  hand_.click(1, 80);
}

void MouseMeans::leave(const Eye& eye, const std::string& screen) const {
  for (int i = 0; i < 20 && eye().screen == screen; ++i) {
    press_main_button(eye);
    see(eye, 3);
  }
}

void MouseMeans::click_at(const Eye& eye, int x, int y) const {
  hand_.point_at(x, y);
  see(eye, 2);
  hand_.click(1, 80);
  see(eye, 3);
}

void MouseMeans::come_to_exam(const Eye& eye, int bur, int shelf) {
  await(eye, "sign-in");
  leave(eye, "sign-in");
  await(eye, "device-check");
  hand_.point_at(5, 5);
  try_pedal(eye);
  leave(eye, "device-check");
  await(eye, "briefing");
  leave(eye, "briefing");
  await(eye, "exam");
  hand_.click(2, 60);  // the pointer
  see(eye, 2);
  // the tray: along the window's lower edge, one field beside the other
  constexpr int k_wide = 800, k_tray_y = 430, k_edge = 14;  // of its 800 x 500 pixels
  click_at(eye, k_edge + (2 * bur + 1) * (k_wide - 2 * k_edge) / (2 * shelf), k_tray_y);
  hand_.click(2, 60);  // the stylus again
  see(eye, 2);
}

Vec3 MouseMeans::move(Vec3 units) {
  constexpr double k_px = 20.0, k_notches = 10.0;
  int x = static_cast<int>(std::lround(units.x * k_px)),
      y = static_cast<int>(std::lround(units.y * k_px)),
      notches = static_cast<int>(std::lround(units.z * k_notches));
  const Vec3 did{x / k_px, y / k_px, notches / k_notches};
  // as a hand does: not all at once
  while (x != 0 || y != 0 || notches != 0) {
    constexpr int k_max_px = 6;
    const int dx = std::clamp(x, -k_max_px, k_max_px), dy = std::clamp(y, -k_max_px, k_max_px);
    if (dx != 0 || dy != 0) hand_.move(dx, -dy);
    x -= dx;
    y -= dy;
    if (notches != 0) hand_.click(notches > 0 ? 4 : 5, 5);
    notches -= notches > 0 ? 1 : notches < 0 ? -1 : 0;
    rest_s(0.015);
  }
  return did;
}

void MouseMeans::hand_in(const Eye& eye) {
  hand_.click(2, 60);
  see(eye, 2);
  constexpr int k_finished_x = 675,
                k_finished_y = 335;  // the last button of the panel on the right
  for (int i = 0; i < 5 && eye().screen == "exam"; ++i) {
    click_at(eye, k_finished_x, k_finished_y);
    press_main_button(eye);
    see(eye, 3);
  }
  await(eye, "result");
  press_main_button(eye);  // the window closes
}

StylusMeans::StylusMeans(testing_station::XHand& hand, const std::string& home, Vec3 start_mm)
    : KeyboardMeans(hand), wanted_mm_(start_mm) {
  StationStylus station = usual_station_stylus(inverse3_kind());
  station.settings["port"] = static_cast<double>(service_.port());
  write_text_file(home + "/stylus-inverse3.toml", to_toml(station));
  // not one that is unknown after 40 ms of silence: this program may wait longer for a core
  write_text_file(
      home + "/pedal.toml",
      to_toml(
          {.vendor = 0x068e,
           .product = 0x00f2,
           .calibration = {.axis = 0, .released = 0, .pressed = 255, .speaks_on_change = true}}));
  // held upright: a grip points along its own y axis, to the tip
  const double half = std::sqrt(0.5);
  service_.change([half](auto&, auto& grips) {
    for (auto& grip : grips) grip.second.orientation = {half, -half, 0, 0};
  });
  service_.move_to((start_mm + k_inverse3_middle_mm) / 1000.0);
  thread_ = std::thread([this] { hold(); });
}

StylusMeans::~StylusMeans() {
  stop_ = true;
  thread_.join();
}

Vec3 StylusMeans::move(Vec3 units) {
  {
    const std::lock_guard lock(mutex_);
    wanted_mm_ += units;
  }
  constexpr double k_mm_s = 2.5;  // of the hand's own way
  rest_s(0.05 + length(units) / k_mm_s);
  return units;
}

void StylusMeans::hold() {
  constexpr double k_mass_kg = 0.15, k_spring_n_mm = 2.0, k_damping_n_s_mm = 0.1, k_mm_s = 2.5,
                   k_step_s = 0.00025, k_longest_s = 0.02;
  Vec3 at = wanted_mm_, speed, aim = wanted_mm_;
  auto before = Clock::now(), last_report = before;
  double owed_s = 0.0;
  while (!stop_) {
    std::this_thread::sleep_for(std::chrono::microseconds(400));
    const auto now = Clock::now();
    owed_s += std::min(k_longest_s, std::chrono::duration<double>(now - before).count());
    before = now;
    const Vec3 push_n = service_.force_n();
    Vec3 wanted;
    {
      const std::lock_guard lock(mutex_);
      wanted = wanted_mm_;
    }
    for (; owed_s >= k_step_s; owed_s -= k_step_s) {
      const Vec3 left = wanted - aim;
      const double far = length(left), most = k_mm_s * k_step_s;
      aim += far > most ? left * (most / far) : left;
      const Vec3 force_n = (aim - at) * k_spring_n_mm - speed * k_damping_n_s_mm + push_n;
      speed += force_n * (1000.0 / k_mass_kg * k_step_s);
      at += speed * k_step_s;
    }
    service_.move_to((at + k_inverse3_middle_mm) / 1000.0);
    if (now - last_report > std::chrono::milliseconds(5)) {
      pedal_.report_axes(pressed_ ? 255 : 0, 0, 0);
      last_report = now;
    }
  }
}

}  // namespace cavum::testing_person
