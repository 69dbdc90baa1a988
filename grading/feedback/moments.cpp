#include "grading/feedback/moments.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "grading/measures/motion.h"
#include "grading/result/loss.h"

namespace cavum::grading {

namespace {

struct Moment {
  std::int64_t from = 0, to = 0;
  std::array<double, scenarios::k_zones> by_zone{};
  std::array<double, scenarios::k_walls + 1> by_wall{};
  double sum = 0.0, bound = 0.0, furthest_mm = -1e9;
  IVec3 at;
};

Facts facts_of(const Moment& m, scenarios::Facing facing) {
  const auto at = static_cast<std::size_t>(std::max_element(m.by_wall.begin(), m.by_wall.end()) -
                                           m.by_wall.begin());
  std::vector<std::size_t> zones;
  for (std::size_t z = 0; z < scenarios::k_zones; ++z)
    if (m.by_zone[z] > 0) zones.push_back(z);
  std::stable_sort(zones.begin(), zones.end(),
                   [&](std::size_t a, std::size_t b) { return m.by_zone[a] > m.by_zone[b]; });
  const Term wall = scenarios::wall_text(at, facing);
  const auto name = [](std::size_t zone) {
    return Term{scenarios::zone_name(static_cast<scenarios::Zone>(zone))};
  };
  const auto outside = [](std::size_t zone) {
    return static_cast<scenarios::Zone>(zone) == scenarios::Zone::none;
  };
  Facts facts;
  if (zones.size() == 1 && outside(zones[0])) {
    facts.emplace_back("removed_outside", std::vector{"wall"},
                       msg("removed outside all zones, the largest part at {}", wall));
  } else if (zones.size() == 1) {
    facts.emplace_back("removed_in_zone", std::vector{"zone", "wall"},
                       msg("removed in {}, the largest part at {}", name(zones[0]), wall));
  } else {
    List parts;
    for (const std::size_t z : zones) {
      const Number volume = as_mm3(m.by_zone[z], 3);
      parts.items.push_back(outside(z) ? msg("{} outside all zones", volume)
                                       : msg("{} in {}", volume, name(z)));
    }
    facts.emplace_back("removed_in_zones", std::vector{"zones", "wall"},
                       msg("removed {}, the largest part at {}", parts, wall));
  }
  if (m.furthest_mm > 0)
    facts.emplace_back("beyond_target", std::vector{"furthest"},
                       msg("the furthest {} beyond the target", as_mm(m.furthest_mm, 2)));
  return facts;
}

}  // namespace

std::vector<WhyItem> removal_moments(const scenarios::ZoneMap& zones,
                                     std::vector<RemovedShare> shares) {
  std::stable_sort(shares.begin(), shares.end(),
                   [](const RemovedShare& a, const RemovedShare& b) { return a.tick < b.tick; });
  std::vector<Moment> moments;
  for (const auto& s : shares) {
    if (moments.empty() || s.tick > moments.back().to + k_moment_gap_ticks)
      moments.push_back({s.tick, s.tick, {}, {}, 0.0, 0.0, -1e9, {}});
    Moment& m = moments.back();
    m.to = s.tick;
    m.sum += s.mm3;
    m.bound += s.bound_mm3;
    m.by_zone[static_cast<std::size_t>(s.zone)] += s.mm3;
    m.by_wall[static_cast<std::size_t>(zones.wall(s.leaf))] += s.mm3;
    if (const double d = zones.distance_mm(s.leaf); d > m.furthest_mm) {
      m.furthest_mm = d;
      m.at = s.leaf;
    }
  }
  std::vector<WhyItem> items;
  for (const auto& m : moments) {
    WhyItem item;
    item.tick = m.from;
    item.end_tick = m.to;
    item.site_mm = zones.centre_mm(m.at);
    item.amount = m.sum;
    item.bound = m.bound;
    item.unit = "mm3";
    item.facts = facts_of(m, zones.facing());
    items.push_back(std::move(item));
  }
  return items;
}

std::vector<WhyItem> removal_moments(const GradeInput& input, std::int64_t end,
                                     const std::function<bool(const RemovedAt&)>& counts) {
  std::vector<RemovedShare> shares;
  const RemovedMap removed(input.all_removed(), end - 1);
  for (const auto& r : input.all_removed())
    if (const IVec3 leaf = r.leaf.leaf(); r.tick < end && counts(r))
      shares.push_back(
          {leaf, r.leaf.tissue, r.tick, input.zones.zone(leaf), input.zones.leaf_volume_mm3(),
           on_border(input.zones, removed, leaf) ? 0.5 * input.zones.leaf_volume_mm3() : 0.0});
  return removal_moments(input.zones, std::move(shares));
}

std::vector<WhyItem> tick_stretches(const GradeInput& input, std::int64_t end,
                                    const std::function<bool(std::int64_t)>& counts,
                                    std::int64_t gap, const Fact& what, Stretch amount) {
  std::vector<WhyItem> items;
  std::int64_t held = 0;
  double peak = 0;
  const auto close = [&] {
    if (items.empty()) return;
    WhyItem& i = items.back();
    const double held_s = static_cast<double>(held) * k_tick_s;
    i.amount = amount == Stretch::peak_force ? peak : held_s;
    i.unit = amount == Stretch::peak_force ? "N" : "s";
    if (amount == Stretch::peak_force)
      i.facts.emplace_back("held", std::vector{"held"},
                           msg("for {} in all; the peak is given", as_s(held_s, 3)));
  };
  const auto n = std::min<std::int64_t>(end, static_cast<std::int64_t>(input.inputs.size()));
  for (std::int64_t i = 0; i < n; ++i) {
    if (!counts(i)) continue;
    if (items.empty() || i > items.back().end_tick + gap + 1) {
      close();
      held = 0;
      peak = 0;
      items.emplace_back();
      items.back().tick = i;
      items.back().facts = {what};
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

std::vector<WhyItem> idle_moments(const GradeInput& input, std::int64_t end,
                                  const std::vector<PauseMeasure>& pauses) {
  std::vector<WhyItem> items;
  for (const TickSpan& span :
       idle_spans(input, std::min(end, static_cast<std::int64_t>(input.inputs.size())), pauses)) {
    WhyItem item;
    item.tick = span.begin;
    item.end_tick = span.end - 1;
    item.facts = {{"idle", msg("neither moved nor cut")}};
    item.amount = static_cast<double>(span.end - span.begin) * k_tick_s;
    item.unit = "s";
    item.site_mm = input.inputs[static_cast<std::size_t>(span.begin)].tip_mm();
    items.push_back(std::move(item));
  }
  return items;
}

Trace last_cut_near(const GradeInput& input, std::int64_t end, Vec3 place_mm) {
  constexpr double k_near_mm = 1.0;
  for (auto r = input.removed.rbegin(); r != input.removed.rend(); ++r)
    if (const Vec3 at = input.zones.centre_mm(r->leaf.leaf());
        r->tick < end && length(at - place_mm) <= k_near_mm)
      return {r->tick, at};
  return {};
}

Fact last_cut(const Trace& last) {
  return last.tick >= 0
             ? Fact("cut_near", msg("cut last within a millimetre of it"))
             : Fact("nothing_cut_near", msg("nothing was cut within a millimetre of it"));
}

std::vector<WhyItem> overhang_moments(const GradeInput& input, std::int64_t end,
                                      const AccessMeasures& access) {
  std::vector<WhyItem> items;
  for (const auto& p : access.overhang_pieces) {
    WhyItem item;
    const Trace last = last_cut_near(input, end, p.middle_mm);
    item.facts = {
        {"roof_left", {"middle"}, msg("roof left over the chamber, its middle at {}", p.middle_mm)},
        last_cut(last)};
    item.tick = item.end_tick = last.tick;
    item.site_mm = last.tick >= 0 ? last.site_mm : p.middle_mm;
    item.amount = p.part;
    item.unit = "mm3";
    items.push_back(std::move(item));
  }
  return items;
}

std::vector<WhyItem> keep_largest(std::vector<WhyItem>& items) {
  if (items.size() <= k_max_moments) return {};
  std::vector<std::size_t> order(items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return *items[a].amount > *items[b].amount;
  });
  std::vector<bool> stays(items.size(), false);
  for (std::size_t i = 0; i < k_max_moments; ++i) stays[order[i]] = true;
  std::vector<WhyItem> kept, dropped;
  for (std::size_t i = 0; i < items.size(); ++i)
    (stays[i] ? kept : dropped).push_back(std::move(items[i]));
  items = std::move(kept);
  return dropped;
}

}  // namespace cavum::grading
