#include "engine/physics/servo/real_time.h"

#include <cmath>
#include <exception>
#include <system_error>
#include <thread>

#include "engine/base/error.h"
#include "engine/base/message_from.h"
#include "engine/base/system_error.h"

namespace cavum {

struct RealTimeServo::Loop {
  const ServoModel& model;
  ServoState& state;
  ServoDevice& device;
  TickStream& stream;
  const RealTimeOptions options;
  const std::int64_t period_ns;

  TickInput input;
  double silent_s = 0.0;     // since the last reading
  std::int64_t skipped = 0;  // periods without a tick since the last one
  ServoFault doing = ServoFault::reading;
  RealTimeReport report;  // the servo thread's; the guard keeps its own count
  std::atomic<bool> stop{false}, finished{false};
  std::atomic<std::int64_t> alive_ns{0}, guard_cuts{0};
  std::thread thread, guard;

  Loop(const ServoModel& m, ServoState& s, ServoDevice& d, TickStream& t, const TickInput& first,
       const RealTimeOptions& o)
      : model(m),
        state(s),
        device(d),
        stream(t),
        options(o),
        period_ns(std::llround(m.config.tick_s * 1e9)),
        input(first) {}

  /// One step, if it can be handed over. Returns false without room.
  bool take_step(std::int64_t due_ns, TickOutput& output) noexcept {
    if (!stream.has_room(state.removed.capacity())) {
      ++report.skipped_full;
      ++skipped;
      return false;
    }
    ServoTick row;
    row.late_ns = std::max<std::int64_t>(0, monotonic_ns() - due_ns);
    row.tick = state.tick;
    row.input = input;
    row.output = step(model, state, input);
    row.state_hash = state_hash(state);
    row.skipped_periods = skipped;
    stream.push(row, state.removed);
    skipped = 0;
    output = row.output;
    ++report.ticks;
    report.lateness.add(row.late_ns);
    if (row.late_ns > period_ns) ++report.overruns;
    return true;
  }

  /// A tick whose time has passed: nobody was asked where the stylus was.
  void make_up_for(std::int64_t due_ns) noexcept {
    silent_s += model.config.tick_s;
    input.flags = static_cast<std::uint16_t>(input.flags & ~(k_stylus_fresh | k_stylus_fault));
    if (silent_s > model.config.limits.watchdog_s)
      input.flags = static_cast<std::uint16_t>(input.flags & ~k_pedal_fresh);
    TickOutput unsent;
    if (take_step(due_ns, unsent)) ++report.made_up;
  }

  void read_and_step(std::int64_t due_ns, std::int64_t periods) {
    doing = ServoFault::reading;
    const DeviceReading r = device.read(static_cast<double>(periods) * model.config.tick_s);
    constexpr auto k_of_device = static_cast<std::uint16_t>(k_stylus_fresh | k_pedal_fresh |
                                                            k_button_1 | k_button_2 | k_hold);
    input = make_tick_input(r.pose, r.pedal, r.flags & k_of_device, r.bur, input);
    silent_s = 0.0;
    TickOutput output;
    if (take_step(due_ns, output)) device.show(output);
    doing = ServoFault::sending;
    device.send_force(output.rendered_force_n);
  }

  void run_periods() {
    // Steps may become slower than the period. Then making up only adds to the delay: half of the
    // watchdog's time goes to it at most, so that the device is read, and its force renewed, before
    // the watchdog fades it.
    const auto budget_ns = static_cast<std::int64_t>(0.5e9 * model.config.limits.watchdog_s);
    std::int64_t due = monotonic_ns() + period_ns;
    std::int64_t unread = 0;  // periods since the last reading
    while (!stop.load(std::memory_order_relaxed)) {
      sleep_until(due);
      const std::int64_t start = monotonic_ns();
      std::int64_t behind = std::max<std::int64_t>(0, (start - due) / period_ns);
      const auto pass = [&](std::int64_t periods) {
        behind -= periods;
        due += periods * period_ns;
        unread += periods;
      };
      const auto give_up = [&](std::int64_t periods) {
        report.skipped_late += periods;
        skipped += periods;
        pass(periods);
      };
      if (behind > options.most_made_up) give_up(behind - options.most_made_up);
      while (behind > 0 && !enough()) {
        if (monotonic_ns() - start > budget_ns) {
          give_up(behind);
          break;
        }
        make_up_for(due);
        pass(1);
      }
      if (enough()) break;
      read_and_step(due, unread + 1);
      unread = 0;
      due += period_ns;
      const std::int64_t end = monotonic_ns();
      report.work.add(end - start);
      alive_ns.store(end, std::memory_order_release);
      if (enough()) break;
    }
    report.ended.why = enough() ? ServoEnd::ticks : ServoEnd::asked;
  }
  [[nodiscard]] bool enough() const noexcept {
    return options.max_ticks > 0 && report.ticks >= options.max_ticks;
  }

  void run() noexcept {
    ask_for_sharp_timers();
    if (options.ask_for_memory) report.memory = ask_for_memory();  // with this thread's stack
    if (options.ask_for_fifo) report.fifo = ask_for_fifo(options.priority);
    alive_ns.store(monotonic_ns(), std::memory_order_release);
    try {
      run_periods();
    } catch (const std::exception& e) {
      fail(doing, message_from(e));
    } catch (...) {
      fail(doing, msg("something that is no std::exception"));
    }
    device.cut_force();
    try {
      device.send_force({});
    } catch (...) {  // it was cut already
      if (report.ended.why != ServoEnd::device_failed)
        fail(ServoFault::zero_force, msg("zero force could not be sent"));
    }
    stream.close(report.ended);
    finished.store(true, std::memory_order_release);
  }
  void fail(ServoFault fault, const Message& what) {
    device.cut_force();  // before anything else
    report.ended = {ServoEnd::device_failed, fault};
    report.failure = what;
  }

  /// Takes the force away when the loop has been silent for nearly twice the watchdog's time.
  void watch() noexcept {
    ask_for_sharp_timers();
    if (options.ask_for_fifo) static_cast<void>(ask_for_fifo(options.priority + 1));
    const auto watchdog_ns = static_cast<std::int64_t>(model.config.limits.watchdog_s * 1e9);
    const std::int64_t look_ns = watchdog_ns / 4, hung_ns = 2 * watchdog_ns - 2 * look_ns;
    bool hung = false;
    for (std::int64_t next = monotonic_ns(); !finished.load(std::memory_order_acquire);
         sleep_until(next)) {
      const std::int64_t now = monotonic_ns(), last = alive_ns.load(std::memory_order_acquire);
      const bool silent = last != 0 && now - last > hung_ns;
      if (silent && !hung) {
        device.cut_force();
        guard_cuts.fetch_add(1, std::memory_order_relaxed);
      }
      hung = silent;
      next = now + look_ns;
    }
  }
};

Message in_words(const ServoStop& stop) {
  switch (stop.fault) {
    case ServoFault::none:
      break;
    case ServoFault::reading:
      return msg("the device failed when it was read");
    case ServoFault::sending:
      return msg("the device failed when a force was sent");
    case ServoFault::zero_force:
      return msg("zero force could not be sent");
    case ServoFault::threads:
      return msg("the system gave no threads ({})", system_words(stop.error));
  }
  return stop.why == ServoEnd::ticks ? msg("all ticks that were wanted were taken")
                                     : msg("it was asked to stop");
}

RealTimeServo::RealTimeServo(const ServoModel& model, ServoState& state, ServoDevice& device,
                             TickStream& stream, const TickInput& before_first,
                             const RealTimeOptions& options)
    : loop_(std::make_unique<Loop>(model, state, device, stream, before_first, options)) {}

RealTimeServo::~RealTimeServo() {
  ask_to_stop();
  if (loop_->thread.joinable()) join();
}

void RealTimeServo::start() {
  if (loop_->thread.joinable() || loop_->finished)
    throw Error(msg("servo"), msg("was started already"), msg("make a new one"));
  Loop* loop = loop_.get();
  try {
    loop->guard = std::thread([loop] { loop->watch(); });
    loop->thread = std::thread([loop] { loop->run(); });
  } catch (const std::system_error& e) {
    loop->finished.store(true, std::memory_order_release);
    if (loop->guard.joinable()) loop->guard.join();
    loop->device.cut_force();
    loop->stream.close({ServoEnd::device_failed, ServoFault::threads,
                        e.code().value()});  // who empties it must not wait
    throw Error(msg("servo"), msg("cannot have its two threads ({})", e.what()),
                msg("close other programs, or raise the limits of memory and processes"));
  }
}

void RealTimeServo::ask_to_stop() noexcept { loop_->stop.store(true, std::memory_order_relaxed); }

bool RealTimeServo::running() const noexcept {
  return loop_->thread.joinable() && !loop_->finished.load(std::memory_order_acquire);
}

const RealTimeReport& RealTimeServo::join() {
  if (loop_->thread.joinable()) {
    loop_->thread.join();
    loop_->guard.join();
    if (loop_->report.memory.granted()) give_memory_back();
    loop_->report.guard_cuts = loop_->guard_cuts.load(std::memory_order_relaxed);
  }
  return loop_->report;
}

}  // namespace cavum
