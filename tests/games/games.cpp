#include "tests/games/games.h"

#include <fmt/core.h>

#include <set>

#include "engine/base/random.h"
#include "tests/games/bodies.h"

namespace cavum::games {
namespace {

/// Of a task, what several games need.
struct Ground {
  const Task& t;
  Frame f;
  Body target;
  double top = -1e9, floor = 1e9;  // of the target along the approach, where tissue is
  explicit Ground(const Task& task) : t(task), f(task), target(grown_target(task)) {
    for (const Vec3 p : t.leaves) {
      top = std::max(top, dot(p, f.out));
      floor = std::min(floor, dot(p, f.out));
    }
  }
  /// A place above (or below) the target's middle line, moved across it.
  [[nodiscard]] Vec3 at(double u, double v, double height) const {
    const Vec3 m = t.middle_mm;
    return m + f.u * u + f.v * v + f.out * (height - dot(m, f.out));
  }
  /// From the middle towards a side: where the target ends.
  [[nodiscard]] double reach(Vec3 side) const {
    double s = 0;
    while (s < 8 && target(t.middle_mm + side * s) < 0) s += 0.02;
    return s;
  }
  [[nodiscard]] Body hole(double u, double v, double radius, double bottom) const {
    return stroke(at(u, v, top + 3), at(u, v, bottom + radius), radius);
  }
  [[nodiscard]] Body notch(Vec3 side, double depth) const {
    constexpr double k_radius = 0.4;
    const double s = reach(side) + depth - k_radius;
    return both(
        stroke(at(0, 0, top + 3) + side * s, at(0, 0, floor + k_radius) + side * s, k_radius),
        beyond(f.out, floor));  // as deep as the target
  }
};

Game cutting(std::string name, Body body, Fair fair = Fair::any) {
  return {std::move(name),
          [body = std::move(body)](Sitting& s) {
            s.cut(body, 20.0);
            s.hand_in();
          },
          fair};
}

void wrong_position(std::vector<Game>& list, const Ground& g) {
  for (const auto& [by, side, name] :
       {std::tuple{0.3, g.f.u, "mesial"}, std::tuple{0.6, g.f.v * -1.0, "lingual"},
        std::tuple{1.0, g.f.u, "mesial"}, std::tuple{2.0, g.f.v * -1.0, "lingual"}})
    list.push_back(cutting(fmt::format("beside_{:.1f}_{}", by, name), moved(g.target, side * by),
                           by > 1.5 ? Fair::not_pass : Fair::any));
  for (const double deg : {10.0, 20.0, 30.0})
    list.push_back(
        cutting(fmt::format("tilted_{:.0f}", deg), turned(g.target, g.t.middle_mm, g.f.v, deg)));
  list.push_back(cutting("deeper_0.4", either(g.target, moved(g.target, g.f.out * -0.4))));
  list.push_back(cutting("wider_0.4", both(grown_target(g.t, 0.4), beyond(g.f.out, g.floor))));
  list.push_back(cutting("shallower_0.6", both(g.target, moved(g.target, g.f.out * 0.6))));
  list.push_back(cutting("narrower_0.2", grown_target(g.t, -0.2)));
  list.push_back(cutting("notch_0.5_distal", either(g.target, g.notch(g.f.u * -1.0, 0.5))));
  list.push_back(cutting("notch_1.2_buccal", either(g.target, g.notch(g.f.v, 1.2))));
  // the shank rubs the rim of one wall away: 0.8 mm beyond the target in its upper half
  list.push_back(cutting(
      "shank",
      either(g.target, both(both(grown_target(g.t, 0.8), beyond(g.f.out, (g.top + g.floor) / 2)),
                            beyond(g.f.u, dot(g.t.middle_mm, g.f.u))))));
}

void too_much(std::vector<Game>& list, const Ground& g) {
  list.push_back(cutting("everything_around", grown_target(g.t, 1.5), Fair::not_pass));
  const WayToFault way = way_to_fault(g.t);
  const Vec3 along = normalized(way.to_mm - way.from_mm);
  for (const auto& [name, over, radius] :
       {std::tuple{"stops_short_of_fault", -0.25, 0.3}, std::tuple{"grazes_fault", 0.01, 0.3},
        std::tuple{"opens_fault_slightly", 0.15, 0.3}, std::tuple{"opens_fault_widely", 0.6, 0.6}})
    list.push_back(cutting(
        name, either(g.target, stroke(way.from_mm,
                                      way.to_mm + along * (over - radius - g.t.zones.leaf_mm() / 2),
                                      radius))));
}

void too_little(std::vector<Game>& list, const Ground& g) {
  list.push_back({"nothing",
                  [](Sitting& s) {
                    s.pass(20);
                    s.hand_in();
                  },
                  Fair::fail});
  list.push_back(cutting("hold", g.hole(0, 0, 0.5, g.floor), Fair::fail));
  Body pecks = [](Vec3) { return 1e3; };
  for (int i = -6; i <= 6; ++i)
    for (int j = -6; j <= 6; ++j)
      if (g.target(g.at(i, j, (g.top + g.floor) / 2)) < 0)
        pecks = either(pecks, g.hole(i, j, 0.45, g.floor));
  list.push_back(cutting("peck", both(pecks, g.target), Fair::not_pass));
  list.push_back(
      cutting("circle", both(g.target, [t = g.target](Vec3 p) { return -0.35 - t(p); })));
  const Octree& tree = g.t.tooth.octree;
  if (!g.t.scenario.perforation.aims.empty()) {
    const auto roof = [&tree](IVec3 l) {
      for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y)
          for (int x = -2; x <= 2; ++x)
            if (x * x + y * y + z * z <= 5 && tree.tissue(l + IVec3{x, y, z}) == k_pulp)
              return true;
      return false;
    };
    list.push_back(cutting("thin_roof_left", sparing(g.target, tree, roof), Fair::not_pass));
  }
  if (g.t.name == "hidden_lesion") {
    const std::uint8_t lesion = g.t.tooth.tissue_id("lesion");
    list.push_back(cutting(
        "lesion_left",
        sparing(g.target, tree, [&tree, lesion](IVec3 l) { return tree.tissue(l) == lesion; }),
        Fair::fail));
  }
}

void about_time(std::vector<Game>& list, const Ground& g) {
  const double limit = g.t.scenario.time_limit_s;
  list.push_back({"honest_then_idle_to_the_limit",
                  [body = g.target, limit](Sitting& s) {
                    s.cut(body, limit + 1);  // the pedal stays pressed, so the last step stays open
                  },
                  Fair::not_pass});
  list.push_back({"open_then_fill_time",
                  [body = g.hole(0, 0, 0.5, g.floor), limit](Sitting& s) {
                    s.cut(body, 5);
                    s.pass(limit);
                    s.hand_in();
                  },
                  Fair::fail});
  list.push_back({"honest_pedal_never_released",
                  [body = g.target](Sitting& s) {
                    s.cut(body, 20);
                    s.walk_out();
                  },
                  Fair::not_pass});
  const auto pulse = [](Sitting& s, const Task& t, int parts) {
    const Order layers = orders(t).front();
    for (int k = 1; k <= parts; ++k) {
      s.cut(part_of_target(t, layers, k), 0.5);
      s.pass(0.5, Hand{0.5, 0, false, true});
    }
    s.hand_in();
  };
  list.push_back({"pulse", [pulse, &t = g.t](Sitting& s) { pulse(s, t, 20); }});
  list.push_back({"wrong_bur_at_wild_speed", [body = g.target](Sitting& s) {
                    s.cut(body, 20, Hand{6.0, 400000, true, true, 200});
                    s.hand_in();
                  }});
}

}  // namespace

void honest(Sitting& s) {
  s.cut(grown_target(s.task()), 20.0);
  s.hand_in();
}

std::vector<Game> games_of(const Task& task) {
  const Ground g(task);
  std::vector<Game> list;
  too_little(list, g);
  wrong_position(list, g);
  too_much(list, g);
  about_time(list, g);
  return list;
}

std::vector<Game> gross_overcuts_of(const Task& task) {
  const Ground g(task);
  std::vector<Game> list;
  // below the floor of incisor and premolar the canal goes on: there is little to cut
  if (task.name != "incisor_access" && task.name != "premolar_access")
    list.push_back(
        cutting("deeper_1.0", either(g.target, moved(g.target, g.f.out * -1.0)), Fair::not_pass));
  for (const double by : {1.0, 1.5})
    list.push_back(cutting(fmt::format("wider_{:.1f}", by),
                           both(grown_target(task, by), beyond(g.f.out, g.floor)), Fair::not_pass));
  list.push_back(cutting("everything_above_the_floor",
                         both(beyond(g.f.out, g.floor), grown_target(task, 3.5)), Fair::not_pass));
  return list;
}

Game lips_over_the_canals(const Task& task) {
  const Ground g(task);
  const Octree& tree = task.tooth.octree;
  constexpr double k_thick_mm = 0.6;
  std::set<IVec3> lip;
  for (std::size_t i = 0; i < task.leaves.size(); ++i) {
    if (!task.is_hard[i]) continue;
    // straight on into the tooth: the pulp begins near, and is there still where the target ends
    double to_pulp = -1, s = 0;
    Vec3 p = task.leaves[i];
    for (; task.zones.zone(tree.leaf_at(p)) == scenarios::Zone::target;
         s += tree.leaf_mm(), p = p - g.f.out * tree.leaf_mm())
      if (to_pulp < 0 && tree.tissue_at(p) == k_pulp) to_pulp = s;
    if (to_pulp >= 0 && to_pulp <= k_thick_mm && tree.tissue_at(p) == k_pulp)
      lip.insert(tree.leaf_at(task.leaves[i]));
  }
  return cutting("lips_over_the_canals",
                 sparing(g.target, tree, [lip](IVec3 l) { return lip.contains(l); }),
                 Fair::not_pass);
}

std::vector<Game> mixtures_of(const Task& task, std::uint64_t seed, int count) {
  const Ground g(task);
  const auto all = orders(task);
  Random random(seed);
  std::vector<Game> list;
  for (int i = 0; i < count; ++i) {
    const Order& order = all[random.below(all.size())];
    const int part = 4 + static_cast<int>(random.below(17));
    Body body = part_of_target(task, order, part);
    std::string name = fmt::format("mixture_{}: {} {}/20", i, order.name, part);
    for (int n = 1 + static_cast<int>(random.below(3)); n > 0; --n) {
      const double size = random.uniform(0.1, 1.2), angle = random.uniform(0, 2 * std::numbers::pi);
      const Vec3 side = g.f.u * std::cos(angle) + g.f.v * std::sin(angle);
      const auto what = random.below(5);
      if (what == 0) body = either(body, g.notch(side, size));
      if (what == 1) body = moved(body, side * size);
      if (what == 2) body = turned(body, task.middle_mm, side, 25 * size);
      if (what == 3) body = either(body, g.hole(0, 0, 0.5, g.floor - size));
      if (what == 4) body = both(body, moved(body, g.f.out * (size / 2)));
      constexpr const char* k_what[] = {"notch", "beside", "tilted", "hole", "shallow"};
      name += fmt::format(", {} {:.3f} at {:.3f} rad", k_what[what], size, angle);
    }
    list.push_back(cutting(name, body));
  }
  return list;
}

}  // namespace cavum::games
