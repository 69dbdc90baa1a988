#include "grading/trial/faulty_preparations.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "engine/base/text.h"
#include "grading/trial/random_preparations.h"
#include "grading/trial/shares_of_target.h"
#include "scenarios/file/bodies.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {
namespace {

double across(Vec3 a, Vec3 b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

/// All faulty preparations, family by family.
class Works {
 public:
  Works(const Task& task, const TargetField& f)
      : task_(task), f_(f), middle_((f.low_mm() + f.high_mm()) * 0.5) {}
  std::vector<FaultyPreparation> all() {
    nothing();
    short_of_it();
    wrong_position();
    wrong_depth();
    too_wide();
    lesion();
    faults();
    holes();
    roof();
    beside();
    return std::move(list_);
  }
  // what is cut, as functions of what is wrong
  [[nodiscard]] Cut deeper(double mm) const;
  [[nodiscard]] Cut wider(double mm) const;
  [[nodiscard]] Cut shifted(Vec3 by) const;
  [[nodiscard]] Cut down_to_share(double share, int tissue = -1) const;
  [[nodiscard]] Cut along_to_share(double share) const;
  /// A ball around the protected place that is nearest to the target; empty where nothing is
  /// protected.
  [[nodiscard]] Cut into_protected(double radius_mm) const;
  /// A ball around the place of a neighbour that is nearest to the target; empty where none is
  /// near.
  [[nodiscard]] Cut into_neighbour(double radius_mm) const;
  /// What is to be taken off lies around what stays: there is nothing beside it but the stump.
  [[nodiscard]] bool around_stump() const {
    const auto& target = task_.scenario.zones.target;
    return !target.empty() && scenarios::body_is(target[0], scenarios::k_around_stump);
  }
  [[nodiscard]] bool longer_in_x() const {
    return f_.high_mm().x - f_.low_mm().x >= f_.high_mm().y - f_.low_mm().y;
  }

 private:
  void add(std::string name, Message what, Mistake mistake, Cut cut) {
    list_.push_back({std::move(name), std::move(what), mistake, std::move(cut)});
  }
  /// The target down to a level, local mm.
  [[nodiscard]] Cut down_to(double level) const {
    return [&f = f_, level](Vec3 p) { return std::max(f.target_mm(p), level - f.local(p).z); };
  }
  /// The target's middle, `share` as wide as it is.
  [[nodiscard]] Cut middle_of(double share) const;
  void nothing();
  void short_of_it();
  void wrong_position();
  void wrong_depth();
  void pit();
  /// The place of the floor nearest to the middle below which all is hard for so far, away from the
  /// target; none where it ends in a canal.
  [[nodiscard]] std::optional<Vec3> hard_floor(double deep_mm) const;
  void too_wide();
  void lesion();
  void faults();
  void holes();
  void roof();
  void beside();
  /// Calls `visit(middle, distance to the target)` for the leaves of some tissues beside the tooth
  /// that are nearer to the target, mm.
  template <class Visit>
  void for_each_near(const TissueSet& tissues, double within_mm, const Visit& visit) const;
  /// Middle of the one that is nearest; none within `within_mm`.
  [[nodiscard]] std::optional<Vec3> nearest_adjacent(const TissueSet& tissues,
                                                     double within_mm) const;

  const Task& task_;
  const TargetField& f_;
  Vec3 middle_;
  std::vector<FaultyPreparation> list_;
};

Cut Works::deeper(double mm) const {
  return [&f = f_, mm](Vec3 p) {
    return std::min(f.target_mm(p), f.open_mm(f.local(p) + Vec3{0, 0, mm}));
  };
}

/// Beside the target down to the level of its floor, and no deeper; of a stump, its walls.
Cut Works::wider(double mm) const {
  if (around_stump())
    return [&f = f_, &zones = task_.zones, mm](Vec3 p) {
      const double d = f.target_mm(p);
      const scenarios::Wall wall = zones.wall(f.tooth().octree.leaf_at(p));
      return wall == scenarios::Wall::floor || wall == scenarios::Wall::opening ? d : d - mm;
    };
  return [&f = f_, mm](Vec3 p) {
    const Vec3 q = f.local(p);
    return std::min(f.target_mm(p), std::max(f.open_mm(q) - mm, f.floor_mm(q) - q.z));
  };
}

Cut Works::shifted(Vec3 by) const {
  return [&f = f_, by](Vec3 p) { return f.open_mm(f.local(p) - by); };
}

Cut Works::into_protected(double radius_mm) const {
  const scenarios::ZoneMap& zones = task_.zones;
  std::optional<IVec3> nearest;
  zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone z) {
    if (z == scenarios::Zone::protected_ &&
        (!nearest || zones.distance_mm(leaf) < zones.distance_mm(*nearest)))
      nearest = leaf;
  });
  if (!nearest) return {};
  return [&f = f_, at = zones.centre_mm(*nearest), radius_mm](Vec3 p) {
    return std::min(f.target_mm(p), length(p - at) - radius_mm);
  };
}

Cut Works::down_to_share(double share, int tissue) const {
  return down_to(beyond_which(
      f_, share, [](Vec3 q) { return q.z; }, tissue));
}

Cut Works::along_to_share(double share) const {
  const bool in_x = longer_in_x();
  const auto along = [in_x](Vec3 q) { return in_x ? q.x : q.y; };
  const double from = beyond_which(f_, share, along);
  return
      [&f = f_, along, from](Vec3 p) { return std::max(f.target_mm(p), from - along(f.local(p))); };
}

Cut Works::middle_of(double share) const {
  return [&f = f_, middle = middle_, share](Vec3 p) {
    const Vec3 q = f.local(p);
    const Vec3 scaled{middle.x + (q.x - middle.x) / share, middle.y + (q.y - middle.y) / share,
                      q.z};
    return std::max(f.target_mm(p), share * f.target_mm(f.in_tooth(scaled)));
  };
}

void Works::nothing() {
  add("hands_in_at_once", msg("nothing; hands in at once"), Mistake::nothing_done, {});
  add("does_nothing", msg("nothing; waits until time is up, at most ten minutes"),
      Mistake::nothing_done, {});
  list_.back().waits = true;
  const double beside = 2.5, level = f_.low_mm().z;
  add("everything_in_reach",
      msg("everything down to the target's floor, {} around it", as_mm(beside, k_as_needed)),
      Mistake::torn_down, [&f = f_, beside, level](Vec3 p) {
        const Vec3 q = f.local(p);
        return std::max(f.open_mm(q) - beside, level - q.z);
      });
}

void Works::short_of_it() {
  for (const int percent : {25, 50, 70, 85}) {
    add(fmt::format("stops_at_{}_percent_by_depth", percent),
        msg("the upper {} of the target", as_percent(percent)), Mistake::not_deep,
        down_to_share(0.01 * percent));
    add(fmt::format("stops_at_{}_percent_by_length", percent),
        msg("{} of the target, from one end", as_percent(percent)), Mistake::too_little,
        along_to_share(0.01 * percent));
  }
}

void Works::wrong_position() {
  // from a side, y of the frame of the way in runs along the crown
  const scenarios::Facing facing = task_.zones.facing();
  const char *up = facing.lateral() ? facing.side > 0 ? "gingival" : "occlusal" : "buccal",
             *down = facing.lateral() ? facing.side > 0 ? "occlusal" : "gingival" : "lingual";
  const std::array<std::pair<const char*, Vec3>, 4> ways{
      {{"mesial", {1, 0, 0}}, {"distal", {-1, 0, 0}}, {up, {0, 1, 0}}, {down, {0, -1, 0}}}};
  for (const auto& [side, way] : ways)
    for (const double mm : {1.0, 2.0})
      add(fmt::format("shifted_{}_mm_{}", plain_number(mm), side),
          msg("the target {} too far to {}", as_mm(mm, k_as_needed), Term{side}),
          Mistake::misplaced, shifted(way * mm));
  const double cosine = std::sqrt(0.75), sine = 0.5;
  add("turned_30_degrees", msg("the target turned by 30° about the way in"), Mistake::misplaced,
      [&f = f_, m = middle_, cosine, sine](Vec3 p) {
        const Vec3 q = f.local(p) - m;
        return f.open_mm(m + Vec3{q.x * cosine + q.y * sine, -q.x * sine + q.y * cosine, q.z});
      });
  list_.back().may_be_right = true;
  add("mirrored_mesial_distal", msg("the target as in a mirror, mesial for distal"),
      Mistake::misplaced, [&f = f_](Vec3 p) {
        return f.open_mm(f.local({-p.x, p.y, p.z}));
      });
  list_.back().may_be_right = true;
  if (facing.lateral())
    add("mirrored_occlusal_gingival", msg("the target as in a mirror, occlusal for gingival"),
        Mistake::misplaced, [&f = f_, m = middle_](Vec3 p) {
          const Vec3 q = f.local(p);
          return f.open_mm({q.x, 2 * m.y - q.y, q.z});
        });
  else
    add("mirrored_buccal_lingual", msg("the target as in a mirror, buccal for lingual"),
        Mistake::misplaced, [&f = f_](Vec3 p) {
          return f.open_mm(f.local({p.x, -p.y, p.z}));
        });
  list_.back().may_be_right = true;
}

void Works::wrong_depth() {
  for (const double mm : {0.8, 1.5})
    add(fmt::format("too_deep_by_{}_mm", plain_number(mm)),
        msg("the target, its floor {} too deep", as_mm(mm, k_as_needed)), Mistake::too_deep,
        deeper(mm));
  pit();
  // in a curved side half the depth is no level: it follows the axial wall
  if (task_.zones.facing().lateral())
    add("half_as_deep", msg("the target, half as deep"), Mistake::not_deep,
        [&f = f_, up = 0.5 * f_.mean_depth_mm()](Vec3 p) {
          const Vec3 q = f.local(p);
          return std::max(f.target_mm(p), f.floor_mm(q) + up - q.z);
        });
  else
    add("half_as_deep", msg("the target, half as deep"), Mistake::not_deep,
        down_to(0.5 * (f_.opening_mm() + f_.low_mm().z)));
}

std::optional<Vec3> Works::hard_floor(double deep_mm) const {
  std::optional<Vec3> nearest;
  const Tooth& tooth = f_.tooth();
  for (const auto& leaf : f_.leaves()) {
    const Vec3 place{leaf.at.x, leaf.at.y, f_.floor_mm(leaf.at)};
    if (nearest && across(place, middle_) >= across(*nearest, middle_)) continue;
    constexpr double k_straight = 0.75;  // beside a slope a hole is a graze
    if (f_.target_mm(f_.in_tooth(place - Vec3{0, 0, deep_mm})) < k_straight * deep_mm) continue;
    bool hard = true;
    for (double down = 0.5 * tooth.octree.leaf_mm(); hard && down <= deep_mm;
         down += tooth.octree.leaf_mm())
      hard = tooth.octree.is_solid(tooth.octree.tissue_at(f_.in_tooth(place - Vec3{0, 0, down})));
    if (hard) nearest = place;
  }
  return nearest;
}

/// One hole of a bur's width through the floor, where what lies below it is nearest: it stops short
/// of that. Means and shares hardly see it.
void Works::pit() {
  constexpr double k_radius_mm = 0.5, k_deep_mm = 1.0, k_spared_mm = 0.3, k_min_mm = 0.4;
  std::optional<Vec3> floor = hard_floor(k_deep_mm);
  double deep = k_deep_mm;
  for (const auto& tissue : task_.scenario.perforation.faults)
    if (const auto below = f_.below(tissue);
        below && below->floor.z - below->tissue.z - k_spared_mm < deep) {
      floor = below->floor;
      deep = below->floor.z - below->tissue.z - k_spared_mm;
    }
  if (!floor || deep < k_min_mm) return;
  add("pit_in_the_floor",
      msg("the target, and a pit 1 mm wide and up to {} deep in its floor, {} short of what lies below",
          as_mm(k_deep_mm, k_as_needed), as_mm(k_spared_mm, k_as_needed)),
      Mistake::too_deep, [&f = f_, floor = *floor, deep](Vec3 p) {
        const Vec3 q = f.local(p);
        const double z = std::clamp(q.z, floor.z - deep + k_radius_mm, floor.z + 0.5);
        return std::min(f.target_mm(p), length(q - Vec3{floor.x, floor.y, z}) - k_radius_mm);
      });
}

void Works::too_wide() {
  add("too_wide_by_1_mm",
      around_stump() ? msg("the target, and 1 mm off the stump's walls")
                     : msg("the target, 1 mm too wide all round"),
      Mistake::too_wide, wider(1.0));
  if (around_stump()) return;  // no shank meets a wall where there is none outside
  const double beside = 1.2, deep = 0.8;
  add("shank_at_the_entrance",
      msg("the target, its entrance {} too wide down to {}", as_mm(beside, k_as_needed),
          as_mm(deep, k_as_needed)),
      Mistake::too_wide, [&f = f_, beside, level = f_.opening_mm() - deep](Vec3 p) {
        const Vec3 q = f.local(p);
        return std::min(f.target_mm(p), std::max(f.open_mm(q) - beside, level - q.z));
      });
}

/// A tissue that the target follows and that is no aim: to be excavated.
void Works::lesion() {
  const auto& aims = task_.scenario.perforation.aims;
  for (const auto& shape : task_.scenario.zones.target) {
    if (shape.kind != scenarios::ShapeSpec::Kind::tissue ||
        shape.combine != scenarios::ShapeSpec::Combine::add)
      continue;
    if (std::find(aims.begin(), aims.end(), shape.tissue) != aims.end()) continue;
    const int id = task_.tooth.tissue_id(shape.tissue);
    for (const int left : {100, 80, 50}) {
      add(fmt::format("leaves_{}_percent_of_{}", left, shape.tissue),
          msg("the way to {}, and {} of it stays", Term{shape.tissue}, as_percent(left)),
          Mistake::lesion_left, down_to_share(std::max(0.001, 1 - 0.01 * left), id));
      list_.back().measure = scenarios::tissue_measure(shape.tissue).name;
    }
  }
}

void Works::faults() {
  for (const auto& tissue : task_.scenario.perforation.faults) {
    const auto below = f_.below(tissue);
    if (!below) continue;
    for (const auto& [name, radius] : {std::pair("opens", 0.5), {"opens_narrowly", 0.25}}) {
      add(fmt::format("{}_{}", name, tissue),
          msg("the target, and a hole of {} through its floor into {}",
              as_mm(2 * radius, k_as_needed), Term{tissue}),
          Mistake::fault_opened, [&f = f_, b = *below, radius = radius](Vec3 p) {
            const Vec3 q = f.local(p);
            const double z = std::clamp(q.z, b.tissue.z - 0.2, b.floor.z + 0.5);
            return std::min(f.target_mm(p), length(q - Vec3{b.floor.x, b.floor.y, z}) - radius);
          });
      list_.back().below_mm =
          std::max(list_.back().below_mm, f_.low_mm().z - below->tissue.z + 1.0);
    }
  }
}

/// Where marks are taken: both ends of length and width, the middle, the deepest place. Holes as
/// wide as a bur, to full depth.
void Works::holes() {
  constexpr double k_radius_mm = 0.5;
  const auto furthest = [&](auto&& along) {
    const TargetLeaf* best = &f_.leaves().front();
    for (const auto& leaf : f_.leaves())
      if (along(leaf.at) > along(best->at)) best = &leaf;
    return best->at;
  };
  const auto inwards = [&](Vec3 at, Vec3 out) {
    return at - out * (k_radius_mm - 0.5 * f_.tooth().octree.leaf_mm());
  };
  std::vector<Vec3> at{middle_, furthest([](Vec3 q) { return -q.z; })};
  for (const Vec3 out : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}})
    at.push_back(inwards(furthest([out](Vec3 q) { return dot(q, out); }), out));
  add("holes_where_marks_are",
      msg("holes of 1 mm at the ends of length and width, in the middle and where it is deepest"),
      Mistake::too_little, [&f = f_, at](Vec3 p) {
        const Vec3 q = f.local(p);
        double nearest = 1e9;
        for (const Vec3 hole : at) nearest = std::min(nearest, across(q, hole) - k_radius_mm);
        return std::max(f.target_mm(p), nearest);
      });
  list_.back().may_be_right = true;  // a target no larger than them
}

void Works::roof() {
  for (const int percent : {45, 65}) {
    if (around_stump()) break;  // its middle stays
    add(fmt::format("opens_the_middle_{}_percent", percent),
        msg("the target's middle, {} as wide and as long, to full depth", as_percent(percent)),
        task_.scenario.perforation.aims.empty() ? Mistake::too_little : Mistake::roof_left,
        middle_of(0.01 * percent));
  }
  double roof = -1e9;
  for (const auto& leaf : f_.leaves())
    for (const auto& aim : task_.scenario.perforation.aims)
      if (leaf.tissue == task_.tooth.tissue_id(aim)) roof = std::max(roof, leaf.at.z);
  if (roof > -1e9)
    add("never_opened", msg("the target down to 0.2 mm above what it is to open"),
        Mistake::roof_left, down_to(roof + 0.2));
}

template <class Visit>
void Works::for_each_near(const TissueSet& tissues, double within_mm, const Visit& visit) const {
  const scenarios::ZoneMap& zones = task_.zones;
  zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone) {
    if (const double d = zones.distance_mm(leaf);
        d < within_mm && tissues[task_.tooth.octree.tissue(leaf)])
      visit(zones.centre_mm(leaf), d);
  });
}

std::optional<Vec3> Works::nearest_adjacent(const TissueSet& tissues, double within_mm) const {
  std::optional<Vec3> nearest;
  double best = within_mm;
  for_each_near(tissues, within_mm, [&](Vec3 place, double d) {
    if (d >= best) return;
    best = d;
    nearest = place;
  });
  return nearest;
}

Cut Works::into_neighbour(double radius_mm) const {
  constexpr double k_near_mm = 0.8;
  const auto at =
      task_.apart ? nearest_adjacent(task_.apart->of_neighbours, k_near_mm) : std::nullopt;
  if (!at) return {};
  return [&f = f_, at = *at, radius_mm](Vec3 p) {
    return std::min(f.target_mm(p), length(p - at) - radius_mm);
  };
}

/// Of a tooth that does not stand alone: its neighbour nicked, the contact not opened, the papilla
/// cut.
void Works::beside() {
  if (!task_.apart) return;
  constexpr double k_near_mm = 0.8, k_papilla_near_mm = 2.0, k_nick_mm = 0.5, k_wide_mm = 1.2,
                   k_deep_mm = 0.4, k_wall_mm = 0.8, k_papilla_mm = 1.2;
  if (const auto at = nearest_adjacent(task_.apart->of_neighbours, k_near_mm)) {
    const double side = at->x >= f_.in_tooth(middle_).x ? 1.0 : -1.0;
    add("nicks_the_neighbour",
        msg("the target, and a hollow of {} radius in the tooth beside it",
            as_mm(k_nick_mm, k_as_needed)),
        Mistake::neighbour_cut, into_neighbour(k_nick_mm));
    add("shaves_the_neighbour",
        msg("the target, and {} off the tooth beside it, {} wide", as_mm(k_deep_mm, k_as_needed),
            as_mm(2 * k_wide_mm, k_as_needed)),
        Mistake::neighbour_cut, [&f = f_, at = *at, side](Vec3 p) {
          const double beyond = side * (p.x - at.x);
          return std::min(f.target_mm(p),
                          std::max({length(p - at) - k_wide_mm, beyond - k_deep_mm, -beyond}));
        });
    // what is nearest to the target may lie far above the contact: the teeth touch where the other
    // one bulges most
    double bulge = 1e9;
    for_each_near(task_.apart->of_neighbours, k_near_mm,
                  [&](Vec3 p, double) { bulge = std::min(bulge, side * p.x); });
    add("leaves_the_contact",
        msg("the target, but for {} before the tooth beside it", as_mm(k_wall_mm, k_as_needed)),
        Mistake::contact_left, [&f = f_, bulge, side](Vec3 p) {
          return std::max(f.target_mm(p), side * p.x - bulge + k_wall_mm);
        });
  }
  if (const auto at = nearest_adjacent(task_.apart->of_gum, k_papilla_near_mm))
    add("cuts_the_papilla",
        msg("the target, and the gum within {} of the papilla's tip",
            as_mm(k_papilla_mm, k_as_needed)),
        Mistake::gum_cut,
        [&f = f_, &tooth = task_.tooth, gum = task_.apart->of_gum, at = *at](Vec3 p) {
          const double ball = length(p - at) - k_papilla_mm;
          return std::min(f.target_mm(p),
                          ball < 0 && !gum[tooth.octree.tissue_at(p)] ? 0.01 : ball);
        });
}

}  // namespace

const std::vector<std::string>& measures_against(Mistake mistake) {
  static const std::map<Mistake, std::vector<std::string>> k_by_mistake{
      {Mistake::nothing_done, {"target_removed_percent", "missed_mm3", "dice", "steps_completed"}},
      {Mistake::too_little,
       {"target_removed_percent", "missed_mm3", "walls_max_under_mm", "side_walls_max_under_mm",
        "dice"}},
      {Mistake::not_deep,
       {"target_removed_percent", "missed_mm3", "depth_error_mm", "floor_max_under_mm", "depth_mm",
        "dice"}},
      {Mistake::roof_left,
       {"target_removed_percent", "overhang_mm3", "canals_covered_percent", "missed_mm3", "dice"}},
      {Mistake::too_deep,
       {"floor_max_over_mm", "floor_p95_mm", "container_bottom_mm3", "floor_cut_mm3",
        "walls_max_over_mm", "depth_error_mm", "container_mm3", "overcut_mm3"}},
      {Mistake::too_wide,
       {"side_walls_max_over_mm", "side_walls_p95_mm", "container_sides_mm3", "walls_max_over_mm",
        "container_mm3", "overcut_mm3"}},
      {Mistake::misplaced,
       {"side_walls_max_over_mm", "side_walls_p95_mm", "walls_max_over_mm", "outside_mm3",
        "container_sides_mm3", "target_removed_percent", "dice"}},
      {Mistake::lesion_left, {"target_removed_percent", "missed_mm3"}},
      {Mistake::fault_opened, {"perforated", "perforation_volume_mm3"}},
      {Mistake::torn_down, {"outside_mm3", "side_walls_max_over_mm", "overcut_mm3", "removed_mm3"}},
      {Mistake::ragged,
       {"target_removed_percent", "dice", "missed_mm3", "side_walls_max_over_mm",
        "walls_max_over_mm", "outside_mm3"}},
      {Mistake::neighbour_cut,
       {"neighbour_nick_depth_mm", "neighbour_removed_mm3", "neighbour_nick_area_mm2"}},
      {Mistake::contact_left, {"proximal_clearance_mm", "target_removed_percent", "missed_mm3"}},
      {Mistake::gum_cut, {"gum_removed_mm3", "gum_touched_s"}},
  };
  return k_by_mistake.at(mistake);
}

Cut honest_cut(const TargetField& field) {
  return [&field](Vec3 p) { return field.target_mm(p); };
}

std::vector<FaultyPreparation> faulty_preparations(const Task& task, const TargetField& field) {
  std::vector<FaultyPreparation> all = Works(task, field).all();
  for (auto& work : random_preparations(task, field)) all.push_back(std::move(work));
  return all;
}

std::vector<Ladder> ladders(const Task& task, const TargetField& field) {
  const Works works(task, field);
  std::vector<Ladder> list;
  const auto grow = [&](const char* name, const Message& what, Unit unit,
                        const std::vector<double>& amounts, const auto& cut) {
    Ladder ladder{name, what, unit, amounts, {}};
    for (const double amount : amounts) ladder.cut.push_back(cut(amount));
    list.push_back(std::move(ladder));
  };
  grow("deeper", msg("the floor too deep"), Unit::mm, {0.1, 0.25, 0.5, 0.9, 1.4},
       [&](double mm) { return works.deeper(mm); });
  grow("wider", msg("all walls too far"), Unit::mm, {0.1, 0.25, 0.5, 0.8, 1.2},
       [&](double mm) { return works.wider(mm); });
  grow("less deep", msg("of the target left, from its floor up"), Unit::percent,
       {3, 10, 25, 50, 80},
       [&](double percent) { return works.down_to_share(1 - 0.01 * percent); });
  grow("less long", msg("of the target left, from one end"), Unit::percent, {3, 10, 25, 50, 80},
       [&](double percent) { return works.along_to_share(1 - 0.01 * percent); });
  grow("shifted", msg("in the wrong place"), Unit::mm, {0.2, 0.5, 0.9, 1.4, 2.0}, [&](double mm) {
    return works.shifted(works.longer_in_x() ? Vec3{0, mm, 0} : Vec3{mm, 0, 0});
  });
  if (works.into_protected(0))
    grow("protected", msg("a ball out of what is protected, its radius"), Unit::mm,
         {0.2, 0.4, 0.7, 1.0, 1.4}, [&](double mm) { return works.into_protected(mm); });
  if (works.into_neighbour(0))
    grow("neighbour", msg("a ball out of the tooth beside it, its radius"), Unit::mm,
         {0.1, 0.2, 0.4, 0.7, 1.0}, [&](double mm) { return works.into_neighbour(mm); });
  return list;
}

CutBox box_of_work(const TargetField& field, double below_mm) {
  constexpr double k_beside_mm = 3.2, k_above_mm = 6.0;
  const Octree& tree = field.tooth().octree;
  Bounds box;
  for (int corner = 0; corner < 8; ++corner) {
    box.add(field.in_tooth(
        {(corner & 1) != 0 ? field.high_mm().x + k_beside_mm : field.low_mm().x - k_beside_mm,
         (corner & 2) != 0 ? field.high_mm().y + k_beside_mm : field.low_mm().y - k_beside_mm,
         (corner & 4) != 0 ? field.high_mm().z + k_above_mm : field.low_mm().z - below_mm}));
  }
  const Vec3 low = tree.origin_mm(), n = to_vec3(tree.size()), high = low + n * tree.leaf_mm();
  return {max(box.low, low), min(box.high, high)};
}

}  // namespace cavum::grading
