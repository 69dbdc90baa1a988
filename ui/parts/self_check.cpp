#include "ui/parts/self_check.h"

#include <future>

#include "engine/device/hardware/open_stylus.h"
#include "engine/physics/servo/scheduling.h"
#include "engine/session/session.h"

namespace cavum::ui {
namespace {

constexpr double k_ready_within_s = 10.0;

/// A clock that does not wait, for a stylus that is simulated.
ArmClock simulated_clock() {
  constexpr std::int64_t k_tick_ns = 1'000'000;
  return [now = std::int64_t{0}]() mutable { return now += k_tick_ns; };
}

}  // namespace

Vec3 checked_at_mm(const StylusKind& kind) {
  return rotation(kind.placement.rotation).transposed(-kind.placement.offset_mm);
}

SelfChecked check_station_stylus(const std::string& id, const SelfCheckOptions& o) {
  const StylusKind& kind =
      stylus_kinds().at(id, Name{"--stylus " + id}, {StylusHand::candidate, StylusHand::person});
  const SigningKey key = load_station_key(station_key_path());
  CheckHistory history(check_history_path());  // refused before anything moves
  StylusOptions open;
  open.station = load_station_stylus(kind);
  open.station.placement = {};
  const auto stylus = kind.open(open);
  static_cast<void>(first_pose(*stylus, k_ready_within_s));
  ArmCheckOptions check;
  check.home_mm = checked_at_mm(kind);
  check.tell = o.tell;
  check.stop = o.stop;
  if (kind.hand != StylusHand::person) check.clock = simulated_clock();
  // as the servo, in a thread of its own that keeps what the system grants to itself
  const ArmFigures figures = std::async(std::launch::async, [&] {
                               if (!check.clock) {
                                 static_cast<void>(ask_for_fifo(68));
                                 ask_for_sharp_timers();
                               }
                               return check_arm(*stylus, check);
                             }).get();
  SelfChecked done;
  done.stylus = {stylus->facts().id, stylus->facts().serial};
  done.name = stylus->facts().name;
  const std::int64_t now = read_clocks().utc_ns;
  if (!o.new_history.empty()) history.begin_again(done.stylus, o.new_history, now, key);
  history.add_check(done.stylus, figures, now, key);
  done.entry = history.entries().back();
  return done;
}

bool needs_check(const CheckHistory& history, const CheckedStylus& stylus, double hours,
                 std::int64_t now_utc_ns) {
  constexpr double k_ns_in_hour = 3.6e12;
  const auto last = history.last_check(stylus);
  if (!last || last->utc_ns > now_utc_ns ||
      static_cast<double>(now_utc_ns - last->utc_ns) > hours * k_ns_in_hour)
    return true;
  const bool good = last->verdict.outcome == CheckOutcome::learning ||
                    last->verdict.outcome == CheckOutcome::unchanged;
  const auto decision = history.last_decision(stylus);
  return !good && !(decision && decision->go_on);
}

void decide_on_check(const CheckedStylus& stylus, bool go_on, const std::string& by,
                     const std::string& reason) {
  const SigningKey key = load_station_key(station_key_path());
  CheckHistory(check_history_path())
      .add_decision(stylus, go_on, by, reason, read_clocks().utc_ns, key);
}

}  // namespace cavum::ui
