#include "grading/volumes.h"

#include <algorithm>

namespace cavum {

VolumeMeasures measure_volumes(const GradeInput& input, const RemovedMap& removed, std::int64_t last_tick) {
  const ZoneMap& zones = input.zones;
  const double leaf_mm3 = zones.leaf_volume_mm3();
  VolumeMeasures v;
  std::array<std::uint64_t, k_zones> count{}, border{};
  std::array<std::uint64_t, 256> tissue{}, tissue_border{};
  std::uint64_t removed_border = 0;
  std::size_t kept = 0;
  for (const auto& r : input.removed) {
    const IVec3 leaf = r.leaf.leaf();
    if (r.tick > last_tick || removed.tick(leaf) != r.tick) continue;
    ++kept;
    const Zone zone = zones.zone(leaf);
    const auto z = static_cast<std::size_t>(zone);
    // a border leaf is one beside which something else begins: tissue that stayed, or another zone
    bool edge = false, zone_edge = false;
    for (const IVec3 step : k_six_neighbours) {
      const IVec3 n = leaf + step;
      const bool stays = !removed.has(n);
      edge = edge || stays;
      zone_edge = zone_edge || stays || zones.zone(n) != zone;
    }
    removed_border += edge ? 1 : 0;
    ++count[z];
    border[z] += zone_edge ? 1 : 0;
    ++tissue[r.leaf.tissue];
    tissue_border[r.leaf.tissue] += zone_edge ? 1 : 0;
    v.zone[z].by_wall_mm3[static_cast<std::size_t>(zones.wall(leaf))] += leaf_mm3;
    if (v.zone[z].first.tick < 0) v.zone[z].first = {r.tick, zones.centre_mm(leaf)};
  }
  const auto volume = [&](std::uint64_t leaves, std::uint64_t at_border) {
    return Volume{static_cast<double>(leaves) * leaf_mm3, 0.5 * static_cast<double>(at_border) * leaf_mm3};
  };
  for (std::size_t z = 0; z < k_zones; ++z) v.zone[z].removed = volume(count[z], border[z]);
  for (std::size_t t = 0; t < 256; ++t) v.tissue[t] = volume(tissue[t], tissue_border[t]);
  std::uint64_t missed = 0, missed_border = 0;
  zones.for_each_target_leaf([&](IVec3 leaf) {
    if (removed.has(leaf)) return;
    ++missed;
    v.missed_by_wall_mm3[static_cast<std::size_t>(zones.wall(leaf))] += leaf_mm3;
    for (const IVec3 step : k_six_neighbours)
      if (removed.has(leaf + step) || zones.zone(leaf + step) != Zone::target) {
        ++missed_border;
        break;
      }
  });
  const std::uint64_t target = zones.count(Zone::target), hit = count[static_cast<std::size_t>(Zone::target)];
  v.target = volume(target, zones.target_border_leaves());
  v.removed = volume(kept, removed_border);
  v.missed = volume(missed, missed_border);
  v.target_removed_percent = 100.0 * static_cast<double>(hit) / static_cast<double>(target);
  v.target_removed_bound_percent = 100.0 * v.missed.bound_mm3 / v.target.mm3;
  v.dice = 2.0 * static_cast<double>(hit) / static_cast<double>(kept + target);
  return v;
}

}  // namespace cavum
