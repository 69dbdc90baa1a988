#include "tests/hands/examine.h"

#include <algorithm>

#include "grading/perforation/exposure.h"

namespace cavum::hands {
namespace {

constexpr std::int64_t k_early_ticks = 500, k_late_ticks = 1000;

}  // namespace

Examined examine(const Drilled& d, const grading::BreakthroughSettings& settings) {
  Examined out;
  out.hand = d.hand, out.style = d.style, out.tooth = d.tooth, out.bur = d.bur,
  out.meant_to_open = d.meant_to_open;
  out.tilt_deg = d.tilt_deg, out.friction_n = d.friction_n, out.noise_n = d.noise_n,
  out.quantum_mm = d.quantum_mm;
  const auto ticks = static_cast<std::int64_t>(d.inputs.size());
  out.seconds = static_cast<double>(ticks) * k_tick_s;
  const grading::RemovedMap removed(d.removed, ticks);
  const auto exposed = grading::measure_exposure(*d.before, d.removed, removed, ticks, d.voids);
  std::vector<std::int64_t> opened;
  for (const auto& e : exposed) {
    opened.insert(opened.end(), e.ticks.begin(), e.ticks.end());
    out.area_mm2 += e.area_mm2;
  }
  std::sort(opened.begin(), opened.end());
  if (!opened.empty()) {
    out.opened_tick = opened.front();
    // the force without its noise: the noise is the detector's trouble, not the truth's
    const grading::MissingForce missing = grading::missing_force(
        d.filled_model, make_servo_state(d.filled_model, d.filled, d.first_tip_mm), d.inputs,
        d.true_records);
    out.drop = grading::find_drop(missing, opened);
  }
  out.events = grading::find_breakthroughs(d.inputs, d.records, settings);
  for (const auto& e : out.events) {
    bool at_opening = false;
    if (!opened.empty()) {
      const auto near = std::lower_bound(opened.begin(), opened.end(), e.tick - k_late_ticks);
      at_opening = near != opened.end() && *near <= e.seen_tick + k_early_ticks;
    }
    if (!at_opening) out.false_alarm = true;
    const std::int64_t felt = out.drop.felt() ? out.drop.felt_tick : out.drop.to_tick;
    const auto within = [&](std::int64_t from, std::int64_t to) {
      return e.seen_tick >= from && e.tick <= to + k_late_ticks;
    };
    // the steepest stretch may come long after the drop could be felt first
    const bool at_drop = !opened.empty() && out.drop.from_tick >= 0 &&
                         (within(out.drop.from_tick - k_early_ticks, out.drop.to_tick) ||
                          within(felt - grading::k_felt_drop_ticks, felt));
    if (at_drop && !out.seen)
      out.seen = true, out.delay_ms = static_cast<double>(e.seen_tick - felt);
    if (at_drop || opened.empty()) out.probability = std::max(out.probability, e.probability);
  }
  return out;
}

}  // namespace cavum::hands
