#include "tests/games/bodies.h"

#include <map>

#include "engine/base/error.h"

namespace cavum::games {

std::vector<Order> orders(const Task& t) {
  const Frame f(t);
  const Vec3 middle = t.middle_mm;
  std::vector<Order> list{{"layers", [=](Vec3 p) { return -dot(p, f.out); }, {}},
                          {"walls", [=](Vec3 p) { return -dot(p, f.u); }, {}},
                          {"middle_out",
                           [=](Vec3 p) {
                             const Vec3 q = p - middle;
                             return length(q - f.out * dot(q, f.out));
                           },
                           {}}};
  for (auto& o : list) {
    std::vector<double> keys;
    for (const Vec3 p : t.leaves) keys.push_back(o.key(p));
    std::sort(keys.begin(), keys.end());
    for (std::size_t k = 1; k <= 20; ++k)
      o.ends.push_back(k == 20 ? 1e6 : keys[keys.size() * k / 20]);
  }
  return list;
}

Body part_of_target(const Task& t, const Order& o, int part) {
  const double end = o.ends[static_cast<std::size_t>(part) - 1];
  return both(grown_target(t), [key = o.key, end](Vec3 p) { return key(p) - end; });
}

WayToFault way_to_fault(const Task& t) {
  static std::map<const Task*, WayToFault> found;
  if (const auto known = found.find(&t); known != found.end()) return known->second;
  const Octree& tree = t.tooth.octree;
  const IVec3 size = tree.size();
  double best = 1e9;
  WayToFault way;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const std::uint8_t id = tree.tissue({x, y, z});
        if (id == k_air || tree.is_solid(id)) continue;
        const auto& faults = t.scenario.perforation.faults;
        if (std::count(faults.begin(), faults.end(), t.tooth.tissue_name(id)) == 0) continue;
        const double d = t.zones.distance_mm(tree.centre_mm({x, y, z}));
        if (d >= best) continue;
        best = d;
        way.to_mm = tree.centre_mm({x, y, z});
      }
  if (best > 1e8) throw Error(t.name, msg("no tissue under faults"), msg("name one"));
  best = 1e9;
  for (const Vec3 p : t.leaves) {
    if (length(p - way.to_mm) >= best) continue;
    best = length(p - way.to_mm);
    way.from_mm = p;
  }
  return found[&t] = way;
}

}  // namespace cavum::games
