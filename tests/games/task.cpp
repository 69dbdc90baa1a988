#include "tests/games/task.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include "engine/base/file.h"
#include "scenarios/file/parse.h"
#include "tests/engine/support/basics.h"

namespace cavum::games {
namespace {

/// What no game reaches is left out: leaves below this many of the fine tooth's, from its top: 12
/// mm.
constexpr int k_kept_leaves = 240;

/// A leaf of 2x2x2 others: the tissue that most of them have (of equals the first), the mean
/// distance.
Tooth halved(const Tooth& fine) {
  const TissueGrid from = fine.octree.to_grid();
  const int dropped = std::max(0, from.size.z - k_kept_leaves) / 2 * 2;
  TissueGrid to;
  to.allocate({(from.size.x + 1) / 2, (from.size.y + 1) / 2, (from.size.z - dropped + 1) / 2},
              2 * from.leaf_mm, from.origin_mm + Vec3{0, 0, dropped * from.leaf_mm});
  for (int z = 0; z < to.size.z; ++z)
    for (int y = 0; y < to.size.y; ++y)
      for (int x = 0; x < to.size.x; ++x) {
        int most = 0, codes = 0, seen = 0;
        std::uint8_t best = k_air, label[8];
        for (int k = 0; k < 8; ++k) {
          const IVec3 at{2 * x + (k & 1), 2 * y + (k >> 1 & 1), dropped + 2 * z + (k >> 2)};
          if (!from.inside(at)) continue;
          label[seen++] = from.tissue[from.index(at)];
          codes += from.distance[from.index(at)];
        }
        for (int k = 0; k < seen; ++k) {
          const int same = static_cast<int>(std::count(label, label + seen, label[k]));
          if (same <= most) continue;
          most = same;
          best = label[k];
        }
        to.tissue[to.index({x, y, z})] = best;
        // half as many leaves to the surface; what was beyond the band may be beyond it no more,
        // which no measure looks at
        const int mean = codes / std::max(1, seen);
        to.distance[to.index({x, y, z})] =
            static_cast<std::int8_t>(std::abs(mean) >= k_distance_far ? mean : mean / 2);
      }
  Tooth tooth;
  tooth.name = fine.name + ", coarse";
  tooth.tissues = fine.tissues;
  to.make_consistent(tooth.tissues);
  tooth.octree = Octree(to, tooth.tissues);
  return tooth;
}

Task laid(const std::string& name, scenarios::Scenario scenario, Tooth tooth) {
  Task t;
  t.name = name;
  t.scenario = std::move(scenario);
  t.tooth = std::move(tooth);
  t.tooth.octree.reserve_edits(80000);
  t.apart = grading::take_apart(t.tooth);
  t.zones = scenarios::build_zones(t.scenario, t.tooth);
  t.low_mm = t.zones.target_low_mm();
  t.high_mm = t.zones.target_high_mm();
  t.zones.for_each_target_leaf([&](IVec3 leaf) {
    t.leaves.push_back(t.zones.centre_mm(leaf));
    t.is_hard.push_back(t.tooth.octree.is_solid(t.tooth.octree.tissue(leaf)));
    t.middle_mm = t.middle_mm + t.leaves.back();
  });
  t.middle_mm = t.middle_mm / static_cast<double>(t.leaves.size());
  return t;
}

std::string scenario_path(const std::string& name) {
  return testing_basics::data_path("scenarios/" + name + ".toml");
}

/// As it ships or in leaves of twice the edge; read once.
const Tooth& shipped_tooth(const std::string& file, bool coarse) {
  static std::map<std::string, Tooth> all[2];
  const auto found = all[coarse].find(file);
  if (found != all[coarse].end()) return found->second;
  if (coarse) return all[1][file] = halved(shipped_tooth(file, false));
  return all[0][file] = load_tooth_file(testing_basics::data_path("teeth/" + file));
}

const Task& kept(std::map<std::string, std::unique_ptr<Task>>& all, const std::string& name,
                 bool coarse) {
  auto& t = all[name];
  if (!t) {
    scenarios::Scenario s = scenarios::load_scenario(scenario_path(name));
    const Tooth& tooth = shipped_tooth(s.tooth_file, coarse);
    t = std::make_unique<Task>(laid(name, std::move(s), tooth));
  }
  return *t;
}

}  // namespace

const std::vector<std::string>& task_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const auto& f :
         std::filesystem::directory_iterator(testing_basics::data_path("scenarios")))
      if (f.path().extension() == ".toml") list.push_back(f.path().stem().string());
    std::sort(list.begin(), list.end());
    return list;
  }();
  return names;
}

const Task& task(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Task>> all;
  return kept(all, name, false);
}

const Task& coarse_task(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Task>> all;
  return kept(all, name, true);
}

Task task_on(const std::string& toml, const std::string& name, Tooth tooth) {
  return laid(name, scenarios::parse_scenario(toml, name + ".toml"), std::move(tooth));
}

Body grown_target(const Task& t, double by_mm) {
  return [&t, by_mm](Vec3 p) {
    if (p.x != t.asked_mm.x || p.y != t.asked_mm.y || p.z != t.asked_mm.z) {
      t.asked_mm = p;
      t.answer_mm = t.zones.distance_mm(p);
    }
    return t.answer_mm - by_mm;
  };
}

}  // namespace cavum::games
