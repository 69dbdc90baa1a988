#include "engine/session/clock_check.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"

namespace cavum {
namespace {

constexpr double k_suspend_s = 0.5, k_set_s = 2.0, k_slow_s = 0.5, k_slow = 1.25, k_fast = 0.9;

std::string seconds(double s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", s);
  return text;
}

/// From one reading to another; whatever a file says, the difference wraps around instead of overflowing.
double seconds_between(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(to_ns) - static_cast<std::uint64_t>(from_ns))) * 1e-9;
}

}  // namespace

std::vector<ClockRemark> check_clocks(const SessionReader& session) {
  std::vector<ClockRemark> out;
  const double tick_s = std::strtod(session.fact("tick_s").c_str(), nullptr);
  if (session.chunks().empty() || !(tick_s > 0.0)) return out;
  std::vector<std::int64_t> gaps;  // first ticks after an acknowledged gap
  for (const auto& e : session.events()) {
    if (e.kind != "gap") continue;
    gaps.push_back(e.tick);
    const auto detail = parse_json_or_null(e.detail_json);
    const auto& gap_s = member_of(detail, "gap_utc_s");
    const bool told = gap_s.is_number();
    const std::string source = told ? text_in(member_of(detail, "source"), "device") : "";
    out.push_back({e.tick, 0,
                   "interrupted" + (told ? " for " + seconds(gap_s.get<double>()) : std::string()) + " and taken up again" +
                       (source.empty() ? "" : " with " + source)});
  }
  Clocks before = session.created();
  double real_s = 0.0, told_s = 0.0;
  for (const auto& c : session.chunks()) {
    const double monotonic_s = seconds_between(before.monotonic_ns, c.clocks.monotonic_ns);
    const double boot_s = seconds_between(before.boot_ns, c.clocks.boot_ns), utc_s = seconds_between(before.utc_ns, c.clocks.utc_ns);
    const double ticks_s = static_cast<double>(c.ticks) * tick_s;
    before = c.clocks;
    bool gap = false;
    for (const auto g : gaps) gap = gap || (g >= c.first_tick && g <= c.first_tick + c.ticks);
    if (gap) continue;  // another boot, or a break that is recorded itself
    real_s += monotonic_s;
    told_s += ticks_s;
    const auto say = [&](const std::string& what) { out.push_back({c.first_tick, c.ticks, what}); };
    if (boot_s - monotonic_s > k_suspend_s) say("the computer slept for " + seconds(boot_s - monotonic_s));
    if (std::fabs(utc_s - boot_s) > k_set_s)
      say("the wall clock was set " + std::string(utc_s > boot_s ? "forward" : "back") + " by " + seconds(std::fabs(utc_s - boot_s)));
    if (monotonic_s > k_slow * ticks_s + k_slow_s)
      say(seconds(ticks_s) + " of the exam took " + seconds(monotonic_s) + ": the candidate had more time than the exam's clock shows");
  }
  if (told_s > 1.0 && real_s < k_fast * told_s)
    out.push_back({0, session.ticks(), seconds(told_s) + " of the exam were recorded in " + seconds(real_s) + ": simulated, no hand moved it"});
  return out;
}

}  // namespace cavum
