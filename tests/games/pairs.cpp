#include "tests/games/pairs.h"

#include <fmt/core.h>

#include <numbers>
#include <string_view>

namespace cavum::games {
namespace {

double height_of(const Task& t, bool top) {
  const Vec3 out = t.zones.approach();
  double best = top ? -1e9 : 1e9;
  for (const Vec3 p : t.leaves)
    best = top ? std::max(best, dot(p, out)) : std::min(best, dot(p, out));
  return best;
}

/// A place on the target's side wall, from the middle in a drawn direction, at a drawn height.
Vec3 on_side(const Task& t, Random& random) {
  const Frame f(t);
  const double angle = random.uniform(0, 2 * std::numbers::pi);
  const Vec3 side = f.u * std::cos(angle) + f.v * std::sin(angle);
  const double low = height_of(t, false), high = height_of(t, true);
  Vec3 p = t.middle_mm + f.out * (random.uniform(low + 0.3, high) - dot(t.middle_mm, f.out));
  for (int i = 0; i < 400 && t.zones.distance_mm(p) < 0; ++i) p = p + side * 0.02;
  return p;
}
/// A place on its floor.
Vec3 on_floor(const Task& t, Random& random) {
  const Vec3 out = t.zones.approach();
  Vec3 p = t.leaves[random.below(t.leaves.size())];
  for (int i = 0; i < 1000 && t.zones.distance_mm(p) < 0; ++i) p = p - out * 0.02;
  return p;
}
/// Whole tenths of a second, by which idle time is counted.
double tenths(double seconds) { return std::round(10 * seconds) / 10; }
Vec3 inside(const Task& t, Random& random) { return t.leaves[random.below(t.leaves.size())]; }
Body ball(Vec3 at, double radius) {
  return [=](Vec3 p) { return length(p - at) - radius; };
}
/// A body, but nothing of the target that `done` has left nor what lies within two leaves of it: a
/// rib thinner than that loses some by its parts when its other side is cut.
Body beyond_what_is_left(const Task& t, Body body, Body done) {
  const double margin = 2 * t.zones.leaf_mm();
  return without(without(std::move(body), grown_target(t)),
                 [left = without(grown_target(t), std::move(done)), margin](Vec3 p) {
                   return left(p) - margin;
                 });
}
std::string told(Vec3 p) { return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", p.x, p.y, p.z); }

void add(const Task& t, Work& w, const Body& body, const std::string& words) {
  w.body = either(w.body, beyond_what_is_left(t, body, w.core));
  w.words += ", " + words;
}

}  // namespace

void play(const Work& w, Sitting& s) {
  s.cut(w.body, w.seconds - 0.05, w.hand);
  Hand other = w.hand;
  if (w.breaks_a_rule) {
    other.bur = 200;
    other.rpm = 400000;
  }
  s.pass(0.05, other);
  if (w.idle_s > 0) s.pass(w.idle_s, Hand{0.0, 0, false, true, 0, 0.0});
  if (w.walks_out) {
    s.pass(0.3, Hand{0.0, 0, false, true, 0, 0.0});  // as long as lifting off would have taken
    s.walk_out();
  } else {
    s.hand_in();
  }
}

Work drawn_work(const Task& t, Random& random) {
  Work w;
  const double by = random.uniform(-0.15, 0.25);
  const auto all = orders(t);
  const int part = random.below(3) == 0 ? 8 + static_cast<int>(random.below(12)) : 20;
  const Order& order = all[random.below(all.size())];
  w.body = both(grown_target(t, by),
                [key = order.key, end = order.ends[static_cast<std::size_t>(part) - 1]](Vec3 p) {
                  return key(p) - end;
                });
  w.core = w.body;
  w.words = fmt::format("grown by {:.3f}, {} {}/20", by, order.name, part);
  for (auto n = random.below(2); n > 0; --n) {
    const double size = random.uniform(0.2, 0.6);
    const Vec3 at = inside(t, random);
    w.body = w.core = without(w.body, ball(at, size));
    w.words += fmt::format(", lump {:.3f} at {}", size, told(at));
  }
  for (auto n = random.below(3); n > 0; --n) {
    const double size = random.uniform(0.2, 0.6);
    const Vec3 at = random.below(2) == 0 ? on_side(t, random) : on_floor(t, random);
    add(t, w, ball(at, size), fmt::format("gouge {:.3f} at {}", size, told(at)));
  }
  w.seconds = tenths(random.uniform(5, 12));
  w.idle_s = random.below(2) == 0 ? tenths(random.uniform(0, 4)) : 0;
  w.hand.force_n = random.uniform(0.5, 2.0);
  return w;
}

const char* respect_name(Respect r) {
  constexpr const char* k_names[k_respects] = {
      "overcut_wall",       "less_target", "deeper",        "thinner_floor",  "fault_opened",
      "larger_perforation", "rough_wall",  "protected_cut", "cut_elsewhere",  "longer",
      "longer_idle",        "more_force",  "longer_way",    "step_left_open", "rule_broken"};
  return k_names[static_cast<std::size_t>(r)];
}

Work worse(const Task& t, Work& a, Respect respect, Random& random) {
  const Vec3 out = t.zones.approach();
  const auto to_fault = [&](double over, double radius) {
    const WayToFault way = way_to_fault(t);
    const Vec3 along = normalized(way.to_mm - way.from_mm);
    return stroke(way.from_mm, way.to_mm + along * (over - radius), radius);
  };
  const double size = random.uniform(0.2, 0.9);
  Work b = a;
  switch (respect) {
    case Respect::overcut_wall: {
      const Vec3 at = on_side(t, random);
      add(t, b, stroke(at, at + out * random.uniform(0, 1.5), size),
          fmt::format("notch {:.3f} at {}", size, told(at)));
      return b;
    }
    case Respect::less_target: {
      const Vec3 at = inside(t, random);
      // only of the target, two leaves from its surface: leaves on it count to both sides by their
      // parts
      b.body = without(a.body, both(ball(at, size), grown_target(t, -2 * t.zones.leaf_mm())));
      b.words += fmt::format(", less {:.3f} at {}", size, told(at));
      return b;
    }
    case Respect::deeper: {
      const double by = 0.4 * size + t.zones.leaf_mm();
      add(t, b, moved(a.body, out * -by), fmt::format("deeper by {:.3f}", by));
      return b;
    }
    case Respect::thinner_floor: {
      const Vec3 at = on_floor(t, random);
      add(t, b, ball(at, size), fmt::format("floor thinner by {:.3f} at {}", size, told(at)));
      return b;
    }
    case Respect::fault_opened: {
      const double over = random.uniform(0.0, 0.3);
      add(t, b, to_fault(over, 0.3), fmt::format("fault opened, {:.3f}", over));
      return b;
    }
    case Respect::larger_perforation: {
      const double over = random.uniform(0.05, 0.3);
      add(t, a, to_fault(over, 0.3), fmt::format("perforated, {:.3f}", over));
      b = a;
      add(t, b, to_fault(over + 0.5 * size, 0.3 + 0.5 * size),
          fmt::format("perforated wider, {:.3f}", 0.5 * size));
      return b;
    }
    case Respect::rough_wall:
      for (int n = 0; n < 6; ++n) {
        const Vec3 at = on_side(t, random);
        const double radius = random.uniform(0.1, 0.35);
        add(t, b, ball(at, radius), fmt::format("rough {:.3f} at {}", radius, told(at)));
      }
      return b;
    case Respect::protected_cut: {
      // what is protected and nearest to the target: the way to it was cut by both
      double best = 1e9;
      Vec3 at = t.middle_mm;
      t.zones.for_each_leaf([&](IVec3 l, scenarios::Zone z) {
        if (z != scenarios::Zone::protected_ || t.zones.distance_mm(l) >= best) return;
        best = t.zones.distance_mm(l);
        at = t.zones.centre_mm(l);
      });
      add(t, b, ball(at, 0.5 * size),
          fmt::format("protected cut {:.3f} at {}", 0.5 * size, told(at)));
      return b;
    }
    case Respect::cut_elsewhere: {
      const Frame f(t);
      const double angle = random.uniform(0, 2 * std::numbers::pi);
      const Vec3 at = t.middle_mm + (f.u * std::cos(angle) + f.v * std::sin(angle)) * 2.4 +
                      out * (height_of(t, true) - dot(t.middle_mm, out));
      add(t, b, stroke(at, at - out * 1.5, size),
          fmt::format("elsewhere {:.3f} at {}", size, told(at)));
      return b;
    }
    case Respect::longer:
      b.seconds += tenths(10 * size);
      b.words += fmt::format(", {:.3f} s longer", 10 * size);
      return b;
    case Respect::longer_idle:
      b.idle_s += tenths(10 * size);
      b.words += fmt::format(", {:.3f} s idle", 10 * size);
      return b;
    case Respect::more_force:
      b.hand.force_n += 3 * size;
      b.words += fmt::format(", {:.3f} N more", 3 * size);
      return b;
    case Respect::longer_way:
      b.hand.moved_mm *= 1 + size;
      b.words += fmt::format(", way {:.3f} times", 1 + size);
      return b;
    case Respect::step_left_open:
      b.walks_out = true;
      b.words += ", walks out";
      return b;
    case Respect::rule_broken:
      b.breaks_a_rule = true;
      b.words += ", breaks a rule";
      return b;
  }
  return b;
}

namespace {

struct Range {
  const char* metric;
  double full, zero;
};
constexpr Range k_of_any[] = {{"target_removed_percent", 95, 50},
                              {"missed_mm3", 0.2, 4},
                              {"dice", 0.97, 0.5},
                              {"leeway_sides_mm3", 0.2, 5},
                              {"leeway_bottom_mm3", 0.1, 2.5},
                              {"container_sides_mm3", 0.1, 3},
                              {"container_bottom_mm3", 0.1, 3},
                              {"container_mm3", 0.1, 4},
                              {"overcut_mm3", 0.1, 6},
                              {"outside_mm3", 0, 1.5},
                              {"mesial_max_over_mm", 0.2, 1},
                              {"distal_max_over_mm", 0.2, 1},
                              {"buccal_max_over_mm", 0.2, 1},
                              {"lingual_max_over_mm", 0.2, 1},
                              {"floor_max_over_mm", 0.2, 1},
                              {"side_walls_max_over_mm", 0.2, 1},
                              {"walls_max_over_mm", 0.2, 1},
                              {"walls_max_under_mm", 0.1, 1},
                              {"floor_max_under_mm", 0.1, 1},
                              {"outline_length_error_mm", 0.1, 1},
                              {"outline_width_error_mm", 0.1, 1},
                              {"depth_error_mm", 0.1, 1},
                              {"floor_cut_mm3", 0.1, 3},
                              {"perforated", 0, 1},
                              {"perforation_volume_mm3", 0, 0.2},
                              {"time_s", 8, 25},
                              {"handpiece_time_s", 6, 22},
                              {"idle_s", 1, 10},
                              {"force_mean_n", 0.8, 4},
                              {"force_peak_n", 1, 5},
                              {"force_over_limit_s", 0, 10},
                              {"path_mm", 50, 400},
                              {"steps_completed", 2, 0},
                              {"violations", 0, 4}};
constexpr Range k_of_spared_pulp[] = {
    {"dentin_over_pulp_mm", 0.8, 0.1}, {"touched_pulp_mm3", 0, 0.2}, {"protected_mm3", 0, 0.5}};
constexpr Range k_of_access[] = {{"overhang_mm3", 0.1, 2}, {"canals_covered_percent", 10, 60}};

}  // namespace

scenarios::RubricSpec drawn_rubric(const Task& t, Random& random) {
  scenarios::RubricSpec rubric;
  rubric.compensatory = random.below(4) != 0;
  rubric.pass_percent = random.uniform(50, 85);
  rubric.borderline_percent = random.below(2) == 0 ? 0 : random.uniform(0, 6);
  rubric.open_step_passes = random.below(4) == 0;
  const auto put = [&](const Range& r) {
    scenarios::CriterionSpec c;
    c.id = c.title = c.metric = r.metric;
    const double shift = random.uniform(0, 0.3);
    c.full = r.full + shift * (r.zero - r.full) * 0.5;
    c.zero = r.zero - shift * (r.zero - r.full) * 0.5;
    c.points = 1 + static_cast<double>(random.below(30));
    if (random.below(5) == 0) (r.full > r.zero ? c.critical_below : c.critical_above) = c.zero;
    rubric.criteria.push_back(c);
  };
  put(k_of_any[0]);
  // in an access whose floor is the chamber's own, floor_max_under_mm has no value:
  // Findings.ScrapingTheChambersFloorGainsNothing
  const bool access = !t.scenario.perforation.aims.empty();
  for (const auto& r : k_of_any)
    if (&r != k_of_any && !(access && std::string_view(r.metric) == "floor_max_under_mm") &&
        random.below(3) == 0)
      put(r);
  for (const auto& r : k_of_spared_pulp)
    if (!access && random.below(2) == 0) put(r);
  for (const auto& r : k_of_access)
    if (access && random.below(2) == 0) put(r);
  return rubric;
}

}  // namespace cavum::games
