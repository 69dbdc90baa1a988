// What a person may have in hand at the station: keyboard, mouse or stylus. Each moves the tip by
// its own units and learns from the picture what they come to; screens are gone through by the same
// means.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "engine/base/vec.h"
#include "tests/device/emulated_inverse3.h"
#include "tests/device/emulated_pedal.h"
#include "tests/ui/station/x_hand.h"

namespace cavum::testing_person {

/// What is seen: the screen's name, the exam's clock, the tip.
struct Seen {
  std::string screen;
  double exam_s = 0.0;
  Vec3 tip_mm;
  std::int64_t picture = 0;  ///< number of the last one, from 1; 0 = none yet
};
using Eye = std::function<Seen()>;

class Means {
 public:
  explicit Means(testing_station::XHand& hand) : hand_(hand) {}
  virtual ~Means() = default;
  Means(const Means&) = delete;
  Means& operator=(const Means&) = delete;

  /// Options of `cavum station`.
  [[nodiscard]] virtual std::string options() const = 0;
  /// From sign-in to the exam; `bur` lies at this place of the shelf's `shelf`.
  virtual void come_to_exam(const Eye& eye, int bur, int shelf) = 0;
  /// Moves by so many of its units to the right, up in the picture, and towards the person; returns
  /// what it could.
  virtual Vec3 move(Vec3 units) = 0;
  virtual void pedal(bool down) = 0;
  /// Hands the work in, and closes the window.
  virtual void hand_in(const Eye& eye) = 0;

 protected:
  static void await(const Eye& eye, const std::string& screen);
  /// Until so many pictures were shown that began after the call.
  static void see(const Eye& eye, int pictures);
  /// As the check before an exam asks for.
  void try_pedal(const Eye& eye);
  testing_station::XHand& hand_;
};

/// Arrows, PgUp, PgDn, space bar; units are mm of the key's way.
class KeyboardMeans : public Means {
 public:
  using Means::Means;
  [[nodiscard]] std::string options() const override { return "--device mouse"; }
  void come_to_exam(const Eye& eye, int bur, int shelf) override;
  Vec3 move(Vec3 units) override;
  void pedal(bool down) override { hand_.key("space", down); }
  void hand_in(const Eye& eye) override;
};

/// The mouse alone, no key at all; units are 20 pixels, and notches of the wheel by ten.
class MouseMeans final : public Means {
 public:
  using Means::Means;
  [[nodiscard]] std::string options() const override { return "--device mouse --candidate M1"; }
  void come_to_exam(const Eye& eye, int bur, int shelf) override;
  Vec3 move(Vec3 units) override;
  void pedal(bool down) override { hand_.button(1, down); }
  void hand_in(const Eye& eye) override;

 private:
  void press_main_button(const Eye& eye) const;
  /// Presses it until another screen shows.
  void leave(const Eye& eye, const std::string& screen) const;
  void click_at(const Eye& eye, int x, int y) const;
};

/// An Inverse3 and a foot pedal, both emulated, in a hand with mass, spring and damping that the
/// station's forces push; units are mm. The keyboard is there for the screens.
class StylusMeans final : public KeyboardMeans {
 public:
  /// `home`: CAVUM_HOME of the station, where its stylus and pedal are noted.
  StylusMeans(testing_station::XHand& hand, const std::string& home, Vec3 start_mm);
  ~StylusMeans() override;
  [[nodiscard]] std::string options() const override { return "--device inverse3 --no-self-check"; }
  Vec3 move(Vec3 units) override;
  void pedal(bool down) override { pressed_ = down; }

 private:
  void hold();
  testing_device::EmulatedInverse3 service_;
  testing_device::EmulatedPedal pedal_;
  std::atomic<bool> stop_{false}, pressed_{false};
  std::mutex mutex_;
  Vec3 wanted_mm_;
  std::thread thread_;
};

}  // namespace cavum::testing_person
