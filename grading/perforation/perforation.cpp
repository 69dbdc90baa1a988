#include "grading/perforation/perforation.h"

#include <algorithm>
#include <array>
#include <optional>

#include "engine/tooth/adjacent.h"
#include "grading/perforation/breakthrough.h"
#include "grading/perforation/drill_frames.h"
#include "grading/perforation/drop.h"
#include "grading/perforation/exposure.h"
#include "grading/perforation/known_tooth.h"

namespace cavum::grading {
namespace {

// Tissue is felt a leaf and a half ahead: at slow feed the fall begins some tenths of a second
// before the first leaf goes.
constexpr std::int64_t k_confirm_before_ticks = 300, k_confirm_after_ticks = 200;

/// Tip of the bur where the tooth lets it be; the device's own tip is pressed in further, by X.
Vec3 place_of(const TickRecord& r) {
  return {r.proxy_nm[0] * 1e-6, r.proxy_nm[1] * 1e-6, r.proxy_nm[2] * 1e-6};
}

using OpenedTicks = std::array<std::vector<std::int64_t>, 2>;  // of aims and of faults

/// What the tissue shows: fills the truth of aims and faults. Returns the ticks at which either
/// were opened, in order.
OpenedTicks measure_truth(const GradeInput& input, const std::array<ExposedTissue, 256>& exposed,
                          const TissueSet& either, const TissueSet& faults,
                          PerforationMeasures& p) {
  OpenedTicks opened;
  for (const auto& t : input.before.tissues) {
    if (!either[t.id]) continue;
    const ExposedTissue& e = exposed[t.id];
    PerforationTruth& truth = faults[t.id] ? p.fault : p.aim;
    const auto earlier = [](const Trace& a, const Trace& b) {
      return a.tick >= 0 && (b.tick < 0 || a.tick < b.tick);
    };
    if (earlier(e.first, truth.first)) truth.first = e.first, truth.tissue = t.name;
    if (earlier(e.first_outside, truth.first_outside)) truth.first_outside = e.first_outside;
    truth.perforated = truth.perforated || e.opened();
    truth.area_mm2 += e.area_mm2;
    truth.area_bound_mm2 += e.area_bound_mm2;
    truth.volume_mm3 += e.inside_mm3;
    truth.outside_mm3 += e.outside_mm3;
    auto& list = opened[faults[t.id] ? 1 : 0];
    list.insert(list.end(), e.ticks.begin(), e.ticks.end());
  }
  for (auto& list : opened) std::sort(list.begin(), list.end());
  return opened;
}

/// A breakthrough that the force shows, and whether the tissue confirms it.
PerforationEvent event_of(const GradeInput& input, const Breakthrough& b,
                          const OpenedTicks& opened) {
  PerforationEvent e;
  e.tick = b.tick;
  e.seen_tick = b.seen_tick;
  e.probability = b.probability;
  e.site_mm = place_of(input.records[static_cast<std::size_t>(b.tick)]);
  e.force_before_n = b.force_before_n;
  e.force_after_n = b.force_after_n;
  e.advance_mm = b.advance_mm;
  const double beyond = input.zones.distance_mm(e.site_mm);
  const double leeway =
      std::max(input.scenario.zones.leeway.sides_mm, input.scenario.zones.leeway.bottom_mm);
  e.fault = input.scenario.perforation.aims.empty() || beyond > leeway;
  const auto& list = opened[e.fault ? 1 : 0];
  const auto near = std::lower_bound(list.begin(), list.end(), e.tick - k_confirm_before_ticks);
  e.confirmed = near != list.end() && *near <= e.seen_tick + k_confirm_after_ticks;
  return e;
}

}  // namespace

PerforationMeasures measure_perforation(const GradeInput& input, const RemovedMap& removed,
                                        std::int64_t last_tick) {
  PerforationMeasures p;
  const scenarios::PerforationSpec& spec = input.scenario.perforation;
  p.has_aims = !spec.aims.empty();
  const auto ids_of = [&](const std::vector<std::string>& names) {
    TissueSet ids{};
    for (const auto& t : input.before.tissues)
      ids[t.id] = std::find(names.begin(), names.end(), t.name) != names.end();
    return ids;
  };
  const TissueSet aims = ids_of(spec.aims), faults = ids_of(spec.faults);
  TissueSet either = aims;
  for (std::size_t i = 0; i < either.size(); ++i) either[i] = either[i] || faults[i];
  std::optional<KnownTooth> of_this;
  KnownTooth& tooth =
      input.known != nullptr ? *input.known : of_this.emplace(input.seen_before(), input.before);
  const TissueSet& around = input.around != nullptr ? *input.around : tooth.around(either);
  const std::array<ExposedTissue, 256> exposed =
      measure_exposure(input.before, input.removed, removed, last_tick, either, &around);
  const OpenedTicks opened = measure_truth(input, exposed, either, faults, p);
  const auto counted =
      std::min<std::size_t>(input.inputs.size(), static_cast<std::size_t>(last_tick) + 1);
  const auto inputs = input.inputs.first(counted);
  const auto records = input.records.first(counted);
  if (input.again != nullptr) {
    const auto drop = [&](const TissueSet& tissues, const std::vector<std::int64_t>& ticks) {
      const auto asked = inputs.first(std::min<std::size_t>(
          inputs.size(), static_cast<std::size_t>(last_asked_tick(ticks) + k_frame_ticks)));
      ForceDrop d = find_drop(
          {felt_force_n(records), tooth.filled_force_n(*input.again, tissues, asked)}, ticks);
      if (d.from_tick >= 0) d.site_mm = place_of(records[static_cast<std::size_t>(d.from_tick)]);
      return d;
    };
    if (p.aim.perforated) p.aim.drop = drop(aims, opened[0]);
    if (p.fault.perforated) p.fault.drop = drop(faults, opened[1]);
  }
  for (const Breakthrough& b : find_breakthroughs(inputs, records))
    p.events.push_back(event_of(input, b, opened));
  return p;
}

}  // namespace cavum::grading
