#include "grading/trial/random_preparations.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/base/random.h"

namespace cavum::grading {
namespace {

constexpr int k_works = 6;
constexpr std::uint64_t k_seed = 20261125;
constexpr std::size_t k_max_pillars = 200,
                      k_max_bites = 60;  // where a target or what lies around it holds less

/// A ball drawn out along the way in: downwards where it is left standing, upwards where it was
/// removed.
struct Rod {
  Vec3 at;  // local
  double radius_mm;
};

double down_mm(Vec3 q, Rod rod) {
  return length(q - Vec3{rod.at.x, rod.at.y, std::min(q.z, rod.at.z)}) - rod.radius_mm;
}
double up_mm(Vec3 q, Rod rod) {
  return length(q - Vec3{rod.at.x, rod.at.y, std::max(q.z, rod.at.z)}) - rod.radius_mm;
}

/// Pillars until at least `share` of the target is in them.
std::vector<Rod> pillars(const TargetField& f, double share, Random& random) {
  std::vector<Rod> rods;
  std::vector<std::uint8_t> left(f.leaves().size(), 0);
  for (std::size_t count = 0;
       static_cast<double>(count) < share * static_cast<double>(left.size()) &&
       rods.size() < k_max_pillars;) {
    rods.push_back({f.leaves()[random.below(f.leaves().size())].at, random.uniform(0.3, 0.9)});
    for (std::size_t i = 0; i < left.size(); ++i)
      if (left[i] == 0 && down_mm(f.leaves()[i].at, rods.back()) < 0) {
        left[i] = 1;
        ++count;
      }
  }
  return rods;
}

/// Bites beside the target's surface until at least `share` of its volume is removed beyond it;
/// fewer where there is not enough tissue.
std::vector<Rod> bites(const TargetField& f, double share, Random& random) {
  const Octree& tree = f.tooth().octree;
  const double leaf = tree.leaf_mm(), wanted = share * static_cast<double>(f.leaves().size());
  std::vector<Rod> rods;
  double count = 0;
  while (count < wanted && rods.size() < k_max_bites) {
    const double angle_x = random.normal(), angle_y = random.normal();
    const Vec3 way = normalized({angle_x, angle_y, 0}, {1, 0, 0});
    Rod rod{f.leaves()[random.below(f.leaves().size())].at, random.uniform(0.4, 1.0)};
    for (int i = 0; i < 400 && f.target_mm(f.in_tooth(rod.at)) < 0.3 * rod.radius_mm; ++i)
      rod.at = rod.at + way * leaf;
    // every second leaf each way stands for eight
    const double step = 2 * leaf;
    for (double z = rod.at.z - rod.radius_mm; z < f.high_mm().z + 3; z += step)
      for (double y = rod.at.y - rod.radius_mm; y < rod.at.y + rod.radius_mm; y += step)
        for (double x = rod.at.x - rod.radius_mm; x < rod.at.x + rod.radius_mm; x += step) {
          const Vec3 q{x, y, z}, p = f.in_tooth(q);
          if (up_mm(q, rod) >= 0 || f.target_mm(p) < 0 || tree.tissue_at(p) == k_air) continue;
          if (std::any_of(rods.begin(), rods.end(),
                          [&](const Rod& other) { return up_mm(q, other) < 0; }))
            continue;
          count += 8;
        }
    rods.push_back(rod);
  }
  return rods;
}

}  // namespace

std::vector<FaultyPreparation> random_preparations(const Task&, const TargetField& field) {
  struct Kind {
    const char* name;
    Message what;
    double left, beyond;
  };
  const Kind kinds[] = {
      {"pillars", msg("the target with pillars left in it, a quarter of its volume"), 0.27, 0},
      {"bites", msg("the target and bites around it, a third of its volume"), 0, 0.36},
      {"ragged", msg("pillars left, a quarter of the target, and bites around it, a third"), 0.27,
       0.36}};
  std::vector<FaultyPreparation> list;
  for (int i = 0; i < k_works; ++i) {
    const Kind& kind = kinds[i % 3];
    Random random(k_seed + static_cast<std::uint64_t>(i));
    const auto left = pillars(field, kind.left, random);
    const auto beyond = bites(field, kind.beyond, random);
    list.push_back({fmt::format("{}_{}", kind.name, i / 3 + 1), kind.what, Mistake::ragged,
                    [&field, left, beyond](Vec3 p) {
                      const Vec3 q = field.local(p);
                      double d = field.target_mm(p);
                      for (const Rod& rod : left) d = std::max(d, -down_mm(q, rod));
                      for (const Rod& rod : beyond) d = std::min(d, up_mm(q, rod));
                      return d;
                    }});
    list.back().may_be_right = true;
    if (kind.beyond > 0 && !(kind.left > 0)) list.back().mistake = Mistake::too_wide;
    if (kind.left > 0 && !(kind.beyond > 0)) list.back().mistake = Mistake::too_little;
  }
  return list;
}

}  // namespace cavum::grading
