#include "engine/session/clock_check.h"

#include <algorithm>
#include <cstdlib>

namespace cavum {
namespace {

constexpr double k_suspend_s = 0.5, k_set_s = 2.0, k_slow_s = 0.5, k_slow = 1.25;
constexpr double k_ahead_s = 1.0,
                 k_ahead = 0.02;  // a writer that waits for its disk makes ticks late, never early
constexpr double k_lost_s = 2.0;

Number seconds(double s) { return as_s(s, 1); }

/// From one reading to another; whatever a file says, the difference wraps around instead of
/// overflowing.
double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(to_ns) -
                                                       static_cast<std::uint64_t>(from_ns))) *
         1e-9;
}

/// What the clocks say of a chunk: how far each went, and how long its ticks are.
void remark_chunk(const ChunkRow& c, double monotonic_s, double boot_s, double utc_s,
                  double ticks_s, std::vector<ClockRemark>& out) {
  const auto say = [&](Damage what, bool doubtful) {
    out.push_back({std::move(what), c.first_tick, c.ticks, doubtful});
  };
  const std::int64_t tick = c.first_tick;
  if (monotonic_s < 0 || boot_s < 0) say(damage<DamageKind::clock>(tick), true);
  if (boot_s - monotonic_s > k_suspend_s)
    say(damage<DamageKind::clock_slept>(tick, seconds(boot_s - monotonic_s)), true);
  if (utc_s - boot_s > k_set_s)
    say(damage<DamageKind::clock_set_forward>(tick, seconds(utc_s - boot_s)), true);
  if (boot_s - utc_s > k_set_s)
    say(damage<DamageKind::clock_put_back>(tick, seconds(boot_s - utc_s)), true);
  if (monotonic_s > k_slow * ticks_s + k_slow_s)
    say(damage<DamageKind::clock_slow>(tick, seconds(ticks_s), seconds(monotonic_s)), false);
}

}  // namespace

std::vector<ClockRemark> check_clocks(const SessionReader& session) {
  std::vector<ClockRemark> out;
  const double tick_s = std::strtod(session.fact("tick_s").c_str(), nullptr);
  if (session.chunks().empty() || !(tick_s > 0.0)) return out;
  std::vector<std::int64_t> gaps;  // first ticks after an acknowledged gap
  for (const auto& e : session.event_rows()) {
    const auto* gap = e.as<RecordingGap>();
    if (gap == nullptr) continue;
    gaps.push_back(e.tick);
    out.push_back({!gap->by.source ? damage<DamageKind::interrupted>(e.tick, seconds(gap->utc_s()))
                                   : damage<DamageKind::interrupted_source>(
                                         e.tick, seconds(gap->utc_s()), in_words(*gap->by.source)),
                   e.tick});
  }
  Clocks before = session.created();
  double real_s = 0.0, reported_s = 0.0, ahead_s = 0.0;  // since the beginning or the last gap
  double lost_s = 0.0;
  std::int64_t first_ahead = -1;
  const auto end_stretch = [&] {
    lost_s += std::max(0.0, real_s - reported_s);
    real_s = reported_s = 0.0;
  };
  for (const auto& c : session.chunks()) {
    const double monotonic_s = seconds_between(before.monotonic_ns, c.clocks.monotonic_ns);
    const double boot_s = seconds_between(before.boot_ns, c.clocks.boot_ns),
                 utc_s = seconds_between(before.utc_ns, c.clocks.utc_ns);
    const double ticks_s = static_cast<double>(c.ticks) * tick_s;
    before = c.clocks;
    bool gap = false;
    for (const auto g : gaps) gap = gap || (g >= c.first_tick && g <= c.first_tick + c.ticks);
    if (gap) {  // another boot, or a break that is recorded itself
      end_stretch();
      continue;
    }
    real_s += monotonic_s;
    reported_s += ticks_s;
    if (const double early_s = reported_s - real_s;
        early_s > k_ahead_s + k_ahead * reported_s && early_s > ahead_s) {
      if (first_ahead < 0) first_ahead = c.first_tick;
      ahead_s = early_s;
    }
    remark_chunk(c, monotonic_s, boot_s, utc_s, ticks_s, out);
  }
  end_stretch();
  if (first_ahead >= 0)
    out.push_back(
        {damage<DamageKind::clock_fast>(first_ahead, seconds(ahead_s)), first_ahead, 0, true});
  if (lost_s - admitted_lost_s(session) > k_lost_s)
    out.push_back({damage<DamageKind::clock_lost>(0, seconds(lost_s)), 0, 0, true});
  return out;
}

double admitted_lost_s(const SessionReader& session) {
  double s = 0.0;
  const double tick_s = std::strtod(session.fact("tick_s").c_str(), nullptr);
  for (const auto& e : session.event_rows())
    if (const auto* gap = e.as<ServoGap>()) s += static_cast<double>(gap->periods) * tick_s;
  return s;
}

}  // namespace cavum
