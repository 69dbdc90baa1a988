#include "tests/hands/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <map>

namespace cavum::hands {

void Counts::add(const Examined& e) {
  ++sessions;
  if (e.opened_tick < 0) {
    ++untouched;
  } else {
    ++opened;
    seen += e.seen ? 1 : 0;
    if (e.drop.felt()) {
      ++felt;
      felt_seen += e.seen ? 1 : 0;
      if (e.seen) delays_ms.push_back(e.delay_ms);
    }
  }
  alarmed += e.false_alarm ? 1 : 0;
}

std::string table(std::span<const Examined> all) {
  std::string out = fmt::format(
      "{:32} sessions  opened  seen   felt  seen        false alarms  median delay\n", "");
  const auto rows = [&](const char* by, const std::function<std::string(const Examined&)>& key) {
    std::map<std::string, Counts> counts;
    for (const auto& e : all) counts[key(e)].add(e);
    out += fmt::format("by {}\n", by);
    for (auto& [name, c] : counts) {
      std::sort(c.delays_ms.begin(), c.delays_ms.end());
      out +=
          fmt::format("  {:30} {:8} {:7} {:5} {:6} {:5} ({:5.1f} %) {:6} ({:4.1f} %) {:8.0f} ms\n",
                      name, c.sessions, c.opened, c.seen, c.felt, c.felt_seen,
                      c.felt > 0 ? 100.0 * c.felt_seen / c.felt : 0.0, c.alarmed,
                      100.0 * c.alarmed / std::max(1, c.sessions),
                      c.delays_ms.empty() ? 0.0 : c.delays_ms[c.delays_ms.size() / 2]);
    }
  };
  rows("hand", [](const Examined& e) { return e.hand; });
  rows("style", [](const Examined& e) { return e.hand + ": " + e.style; });
  rows("bur", [](const Examined& e) { return e.bur; });
  rows("tooth", [](const Examined& e) { return e.tooth; });
  rows("severity", [](const Examined& e) {
    return std::string(
        e.opened_tick < 0
            ? "nothing opened"
            : grading::k_drop_severities[static_cast<std::size_t>(e.drop.severity())]);
  });
  rows("all", [](const Examined&) { return std::string("all"); });
  return out;
}

std::string log_head() {
  return "seed,hand,style,tooth,bur,meant_to_open,tilt_deg,friction_n,noise_n,quantum_mm,seconds,opened_tick,area_mm2,missing_n,share,from_tick,to_"
         "tick,"
         "felt_tick,seen,delay_ms,probability,false_alarm,events";
}

std::string log_line(const Examined& e) {
  std::string events;
  for (const auto& b : e.events)
    events += fmt::format("{}{}:{}:{:.2f}", events.empty() ? "" : ";", b.tick, b.seen_tick,
                          b.probability);
  std::string style = e.style;
  std::replace(style.begin(), style.end(), ',', ';');
  return fmt::format(
      "{},{},{},{},{:d},{:.0f},{},{},{},{:.1f},{},{:.4f},{:.3f},{:.2f},{},{},{},{:d},{:.0f},{:.2f},{:d},{}",
      e.hand, style, e.tooth, e.bur, e.meant_to_open, e.tilt_deg, e.friction_n, e.noise_n,
      e.quantum_mm, e.seconds, e.opened_tick, e.area_mm2, e.drop.missing_n, e.drop.share,
      e.drop.from_tick, e.drop.to_tick, e.drop.felt_tick, e.seen, e.delay_ms, e.probability,
      e.false_alarm, events);
}

}  // namespace cavum::hands
