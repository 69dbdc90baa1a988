#include "engine/session/session_writer.h"

#include <chrono>
#include <cmath>

#include "engine/base/message_from.h"

namespace cavum {

SessionWriter::SessionWriter(TickStream& stream, Recorder& recorder, double tick_s, Watch watch)
    : stream_(stream),
      recorder_(recorder),
      period_ns_(std::llround(tick_s * 1e9)),
      watch_(std::move(watch)) {}

SessionWriter::~SessionWriter() {
  if (thread_.joinable()) thread_.join();
}

void SessionWriter::start() {
  thread_ = std::thread([this] { run(); });
}

const WriterReport& SessionWriter::finish() {
  if (thread_.joinable()) thread_.join();
  return report_;
}

template <class Action>
void SessionWriter::guarded(const Action& action) noexcept {
  try {
    action();
  } catch (const DatabaseError& e) {
    if (report_.error.empty()) report_.error = e.message(), report_.refusal = e.refusal();
  } catch (const std::exception& e) {
    if (report_.error.empty()) report_.error = message_from(e);
  } catch (...) {
    if (report_.error.empty()) report_.error = msg("something that is no std::exception");
  }
}

void SessionWriter::run() noexcept {
  ServoTick tick;
  for (;;) {
    const bool last_round =
        stream_.closed();  // asked before emptying: what was put in before closing is seen
    report_.most_waiting =
        std::max(report_.most_waiting, static_cast<std::int64_t>(stream_.waiting()));
    while (stream_.pop(tick, removed_)) take(tick);
    if (last_round) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  guarded([&] {
    note_counts(recorder_.ticks());
    recorder_.add_event(recorder_.ticks(), ServoStopped{stream_.stop()});
  });
  guarded([&] { recorder_.flush(); });
}

void SessionWriter::take(const ServoTick& tick) {
  ++report_.ticks;
  guarded([&] { note_changes(tick); });
  bool recorded = false;
  if (watch_) {
    const auto error_before = report_.error.empty();
    guarded([&] { recorded = !watch_(tick, removed_); });
    if (error_before && !report_.error.empty())
      watch_ = {};  // what it counts is wrong from here on
  }
  if (recorded) return;
  // on error the recorder has kept the tick, and tries again with the next second
  guarded([&] {
    recorder_.append(tick.input, make_tick_record(tick.output), removed_, tick.state_hash);
  });
}

void SessionWriter::note_changes(const ServoTick& tick) {
  if (tick.skipped_periods > 0) {
    if (gaps_++ == 0) first_gap_tick_ = tick.tick;
    gap_periods_ += tick.skipped_periods;
  }
  const bool silent = (tick.output.notices & k_notice_stale_stylus) != 0;
  if (silent && !was_silent_)
    recorder_.add_event(tick.tick, StylusSilent{(tick.input.flags & k_stylus_fault) != 0});
  if (!silent && was_silent_) recorder_.add_event(tick.tick, StylusBack{});
  was_silent_ = silent;
  const int gone = last_flags_ & ~tick.input.flags, come = tick.input.flags & ~last_flags_;
  if ((gone & k_pedal_fresh) != 0) recorder_.add_event(tick.tick, PedalLost{});
  if ((come & k_pedal_fresh) != 0) recorder_.add_event(tick.tick, PedalBack{});
  last_flags_ = tick.input.flags;
  if (tick.late_ns > period_ns_) {
    ++overruns_;
    worst_late_ns_ = std::max(worst_late_ns_, tick.late_ns);
  }
  if ((tick.tick - counted_since_) * period_ns_ >= 1'000'000'000) note_counts(tick.tick);
}

void SessionWriter::note_counts(std::int64_t tick) {
  counted_since_ = tick;
  if (gaps_ > 0) recorder_.add_event(tick, ServoGap{gap_periods_, gaps_, first_gap_tick_});
  if (overruns_ > 0)
    recorder_.add_event(tick, Overruns{overruns_, static_cast<double>(worst_late_ns_) * 1e-6});
  gap_periods_ = gaps_ = overruns_ = worst_late_ns_ = 0;
}

}  // namespace cavum
