#include "grading/moments.h"

#include <algorithm>
#include <numeric>

#include "engine/base/text.h"
#include "grading/loss.h"
#include "grading/motion.h"

namespace cavum {

std::vector<WhyItem> removal_moments(const GradeInput& input, std::int64_t end, const std::function<bool(const RemovedAt&)>& counts) {
  struct Moment {
    std::int64_t from, to;
    std::size_t leaves = 0;
    double furthest_mm = -1e9;
    IVec3 at;
  };
  std::vector<Moment> moments;
  for (const auto& r : input.removed) {
    if (r.tick >= end || !counts(r)) continue;
    if (moments.empty() || r.tick > moments.back().to + k_moment_gap_ticks) moments.push_back({r.tick, r.tick, 0, -1e9, {}});
    Moment& m = moments.back();
    m.to = r.tick;
    ++m.leaves;
    if (const double d = input.zones.distance_mm(r.leaf.leaf()); d > m.furthest_mm) {
      m.furthest_mm = d;
      m.at = r.leaf.leaf();
    }
  }
  std::vector<WhyItem> items;
  for (const auto& m : moments) {
    WhyItem item;
    item.tick = m.from;
    item.end_tick = m.to;
    item.site_mm = input.zones.centre_mm(m.at);
    item.amount = static_cast<double>(m.leaves) * input.zones.leaf_volume_mm3();
    item.unit = "mm3";
    const auto wall = static_cast<std::size_t>(input.zones.wall(m.at));
    item.what = "removed, at the furthest " + fixed(std::max(0.0, m.furthest_mm), 2) + " mm beyond the target at " + wall_text(wall) + " (" +
                zone_name(input.zones.zone(m.at)) + ")";
    items.push_back(std::move(item));
  }
  return items;
}

std::vector<WhyItem> tick_stretches(const GradeInput& input, std::int64_t end, const std::function<bool(std::int64_t)>& counts, std::int64_t gap,
                                    const std::string& what, Stretch amount) {
  std::vector<WhyItem> items;
  std::int64_t held = 0;
  double peak = 0;
  const auto close = [&] {
    if (items.empty()) return;
    WhyItem& i = items.back();
    const double held_s = static_cast<double>(held) * k_tick_s;
    i.amount = amount == Stretch::peak_force ? peak : held_s;
    i.unit = amount == Stretch::peak_force ? "N" : "s";
    if (amount == Stretch::peak_force) i.what += ", " + fixed(held_s, 3) + " s of it; the peak is given";
  };
  const auto n = std::min<std::int64_t>(end, static_cast<std::int64_t>(input.inputs.size()));
  for (std::int64_t i = 0; i < n; ++i) {
    if (!counts(i)) continue;
    if (items.empty() || i > items.back().end_tick + gap) {
      close();
      held = 0;
      peak = 0;
      items.emplace_back();
      items.back().tick = i;
      items.back().what = what;
    }
    items.back().end_tick = i;
    ++held;
    const auto at = static_cast<std::size_t>(i);
    const double f = force_n(input.records[at]);
    if (f > peak || held == 1) {
      peak = std::max(peak, f);
      items.back().site_mm = input.inputs[at].tip_mm();
    }
  }
  close();
  return items;
}

std::size_t keep_largest(std::vector<WhyItem>& items) {
  if (items.size() <= k_most_moments) return 0;
  std::vector<std::size_t> order(items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return *items[a].amount > *items[b].amount; });
  order.resize(k_most_moments);
  std::sort(order.begin(), order.end());
  std::vector<WhyItem> kept;
  for (const std::size_t i : order) kept.push_back(std::move(items[i]));
  const std::size_t dropped = items.size() - kept.size();
  items = std::move(kept);
  return dropped;
}

}  // namespace cavum
