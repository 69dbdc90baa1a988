// The service of a Haply Inverse3, as docs/inverse3.md has it: a WebSocket on this computer that
// sends its inventory and then one state for each command. It keeps what it was told, and can fall
// silent, send what is no message, cut lines, and be stopped and begun again.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/base/pose.h"

namespace cavum::testing_device {

class EmulatedInverse3 {
 public:
  using Clock = std::chrono::steady_clock;
  struct Device {
    Vec3 position_m{0, -0.12, 0.15};
    bool calibrated = true, powered = true;
  };
  struct Grip {
    Quat orientation;
    bool a = false, b = false, wired = false;
  };
  /// What a device was told last.
  struct Told {
    Vec3 force_n;
    std::string name;         ///< of the force in the command: `vector` or `values`
    std::int64_t count = 0;   ///< commands
    Clock::time_point since;  ///< of the present force
  };
  /// How it answers.
  enum class Answer {
    state,
    nothing,
    no_json,
    cut_short,
    another_json,
    too_large,
    too_deep,
    bytes,
    half,
    in_two_parts,
    far_away
  };

  /// One device and one wireless grip, on a port of its own; `newer`: as from 3.5 on.
  explicit EmulatedInverse3(bool newer = true);
  ~EmulatedInverse3();
  EmulatedInverse3(const EmulatedInverse3&) = delete;
  EmulatedInverse3& operator=(const EmulatedInverse3&) = delete;

  [[nodiscard]] std::uint16_t port() const noexcept { return port_; }
  /// Lines are cut without a goodbye, and nobody listens.
  void stop();
  /// Listens again, on the same port.
  void start();
  /// Cuts all lines; new ones are taken.
  void cut();
  void answer_with(Answer answer) { answer_ = answer; }
  /// The maps of devices and grips by id, changed under its lock.
  template <class Change>
  void change(const Change& change) {
    const std::lock_guard lock(mutex_);
    change(devices_, grips_);
  }
  void move_to(Vec3 position_m) {
    change([&](auto& devices, auto&) { devices.begin()->second.position_m = position_m; });
  }

  /// Called, without its lock, before a command is heard. Set it, or take it away, while no line is
  /// open.
  void before_each_command(std::function<void()> moves) {
    const std::lock_guard lock(mutex_);
    moves_ = std::move(moves);
  }

  [[nodiscard]] Told told(const std::string& id = "049D") const;
  /// Of a line that is open: the force that its device gives.
  [[nodiscard]] Vec3 force_n(const std::string& id = "049D") const;
  [[nodiscard]] int lines() const noexcept { return lines_; }
  [[nodiscard]] std::int64_t commands_that_were_none() const noexcept { return wrong_; }

 private:
  struct Listener;
  struct Line;
  void listen();
  void serve(Line& line);
  void reply(Line& line, bool first);
  [[nodiscard]] std::string state(bool first) const;
  void hear(Line& line, const std::string& text);

  const bool newer_;
  std::uint16_t port_ = 0;
  std::unique_ptr<Listener> listener_;
  std::atomic<Answer> answer_{Answer::state};
  std::atomic<int> lines_{0};
  std::atomic<std::int64_t> wrong_{0};
  mutable std::mutex mutex_;  // of what follows
  std::map<std::string, Device> devices_{{"049D", {}}};
  std::map<std::string, Grip> grips_{{"61548", {}}};
  std::map<std::string, Told> told_;
  std::function<void()> moves_;
};

}  // namespace cavum::testing_device
