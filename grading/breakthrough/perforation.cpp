#include "grading/breakthrough/perforation.h"

#include <algorithm>
#include <array>

#include "grading/breakthrough/breakthrough.h"

namespace cavum::grading {
namespace {

// Tissue is felt a leaf and a half ahead: at slow feed the fall begins some tenths of a second before the first leaf goes.
constexpr std::int64_t k_confirm_before_ticks = 300, k_confirm_after_ticks = 200;

/// Tip of the diamond point where the tooth lets it be; the device's own tip is pressed in further, by X.
Vec3 place_of(const TickRecord& r) { return {r.proxy_nm[0] * 1e-6, r.proxy_nm[1] * 1e-6, r.proxy_nm[2] * 1e-6}; }

}  // namespace

PerforationMeasures measure_perforation(const GradeInput& input, std::int64_t ticks) {
  PerforationMeasures p;
  const scenarios::PerforationSpec& spec = input.scenario.perforation;
  p.has_aims = !spec.aims.empty();
  std::array<int, 256> role{};  // 1 aim, 2 fault
  for (const auto& t : input.before.tissues) {
    const auto among = [&](const std::vector<std::string>& list) { return std::find(list.begin(), list.end(), t.name) != list.end(); };
    role[t.id] = among(spec.aims) ? 1 : among(spec.faults) ? 2 : 0;
  }
  const double leaf_mm3 = input.zones.leaf_volume_mm3();
  std::array<std::vector<std::int64_t>, 3> touched;  // ticks, by role, in order
  for (const auto& r : input.removed) {
    if (r.tick >= ticks || role[r.leaf.tissue] == 0) continue;
    PerforationTruth& truth = role[r.leaf.tissue] == 1 ? p.aim : p.fault;
    if (!truth.perforated) {
      truth.perforated = true;
      truth.first = {r.tick, input.zones.centre_mm(r.leaf.leaf())};
      truth.tissue = input.before.tissue_name(r.leaf.tissue);
    }
    truth.volume_mm3 += leaf_mm3;
    touched[static_cast<std::size_t>(role[r.leaf.tissue])].push_back(r.tick);
  }
  const auto counted = std::min<std::size_t>(input.inputs.size(), static_cast<std::size_t>(ticks));
  for (const Breakthrough& b : find_breakthroughs(input.inputs.first(counted), input.records.first(counted))) {
    PerforationEvent e;
    e.tick = b.tick;
    e.seen_tick = b.seen_tick;
    e.sureness = b.sureness;
    e.site_mm = place_of(input.records[static_cast<std::size_t>(b.tick)]);
    e.force_before_n = b.force_before_n;
    e.force_after_n = b.force_after_n;
    e.advance_mm = b.advance_mm;
    p.events.push_back(e);
  }
  for (auto& e : p.events) {
    const double beyond = input.zones.distance_mm(e.site_mm);
    const double leeway = std::max(input.scenario.zones.leeway.sides_mm, input.scenario.zones.leeway.bottom_mm);
    e.fault = spec.aims.empty() || beyond > leeway;
    const auto& list = touched[e.fault ? 2 : 1];
    const auto near = std::lower_bound(list.begin(), list.end(), e.tick - k_confirm_before_ticks);
    e.confirmed = near != list.end() && *near <= e.seen_tick + k_confirm_after_ticks;
  }
  return p;
}

}  // namespace cavum::grading
