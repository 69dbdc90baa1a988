#include "grading/feedback/lesson_words.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/pose.h"
#include "grading/feedback/moments.h"
#include "grading/result/loss.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {
namespace {

using scenarios::Zone;

constexpr double k_shown_points = 0.005, k_min_lean_deg = 6.0, k_degrees_of = 57.29577951308232,
                 k_min_covered_percent = 5.0;

Number percent_of(double part, double all) { return as_percent(all > 0 ? 100 * part / all : 0); }
/// Two sentences, the second where there is one.
Message both(const Message& first, const Message& second) {
  return second.empty() ? first : msg("{} {}", first, second);
}

template <class Row>
std::size_t largest(const Row& row, std::size_t count) {
  return static_cast<std::size_t>(
      std::max_element(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(count)) -
      row.begin());
}

std::size_t worst_side(const Result& r) {
  std::size_t worst = 0;
  for (std::size_t w = 0; w < scenarios::k_side_walls; ++w)
    if (r.shape.wall[w].max_over_mm > r.shape.wall[worst].max_over_mm) worst = w;
  return worst;
}

/// Says a topic's sentences.
class Teller {
 public:
  Teller(const GradeInput& input, const Result& result) : in_(input), r_(result) {}

  void tell(Lesson& l) const {
    switch (l.topic) {
      case Topic::left_standing:
        return left_standing(l);
      case Topic::roof:
        return roof(l);
      case Topic::canals:
        return canals(l);
      case Topic::beside:
        return beside(l);
      case Topic::too_deep:
        return too_deep(l);
      case Topic::elsewhere:
        return elsewhere(l);
      case Topic::opened:
        return opened(l);
      case Topic::taper:
        return taper(l);
      case Topic::neighbour:
        return neighbour(l);
      case Topic::contact:
        return contact(l);
      case Topic::gum:
        return gum(l);
      case Topic::force:
        return force(l);
      case Topic::time:
        return time(l);
      case Topic::steps:
        return steps(l);
      case Topic::other:
        return other(l);
    }
  }

 private:
  [[nodiscard]] Message there(Vec3 p) const { return side_words(p, in_.zones); }
  [[nodiscard]] Term wall(std::size_t w) const { return scenarios::wall_text(w, r_.shape.facing); }
  /// When it began, and when it was: a sentence; none where nobody knows when.
  static Message from(const Trace& t) {
    if (!t.timed()) return {};
    return t.t_s() < 1 ? msg("It was so from the beginning.")
                       : msg("It began at {}.", ClockTime{t.t_s()});
  }
  static Message when_at(const Trace& t) {
    return t.timed() ? msg("That was at {}.", ClockTime{t.t_s()}) : Message();
  }

  void left_standing(Lesson& l) const {
    if (!(r_.volumes.target_removed_percent > 0)) {
      l.what = msg("Nothing of the cavity was cut.");
      l.instead = msg("Open the outline first, then take the cavity away layer by layer.");
      return;
    }
    constexpr double k_hardly_begun_percent =
        50.0;  // of a cavity that was never made, no wall has to be taken back
    const double roof_mm3 = r_.access.overhang ? r_.access.overhang->mm3 : 0;
    const Left left = what_is_left();
    const std::size_t w = largest(left.hard_by_wall, scenarios::k_walls);
    const Number amount = as_mm3(std::max(0.0, r_.volumes.missed.mm3 - roof_mm3));
    l.where = r_.volumes.target_last[w];
    if (left.aim > left.hard_by_wall[w]) {
      l.look_mm = left.aim_middle_mm;
      l.what = msg("{} of the cavity was left, {} of it {} that was not cleared out.", amount,
                   percent_of(left.aim, left.all), Term{left.aim_tissue});
      l.instead = msg(
          "Clear it out from wall to wall with light strokes, and do not press on the floor below.");
      return;
    }
    if (r_.volumes.target_removed_percent < k_hardly_begun_percent) {
      l.what = msg("Only {} of the cavity was cut: {} of it were left standing.",
                   as_percent(r_.volumes.target_removed_percent), amount);
      l.instead = msg("Open the outline first, then take the cavity away layer by layer.");
      return;
    }
    const double thick = r_.shape.wall[w].max_under_mm;
    if (thick > 0) l.look_mm = r_.shape.wall[w].worst_under.site_mm;
    const Number share = percent_of(left.hard_by_wall[w], left.all);
    l.what =
        thick > 0
            ? msg("{} of the cavity was left standing, the largest part ({}) at {}, up to {} thick.",
                  amount, share, wall(w), as_mm(thick))
            : msg("{} of the cavity was left standing, the largest part ({}) at {}.", amount, share,
                  wall(w));
    if (static_cast<scenarios::Wall>(w) != scenarios::Wall::floor)
      l.instead = msg(
          "Go round the outline once more before you hand in, and take {} back until the outline is reached.",
          wall(w));
    else if (!r_.perforation.has_aims)
      l.instead = msg(
          "Go on down to the depth that is asked, and feel for an even floor before you hand in.");
    else if (r_.perforation.aim.perforated)
      l.instead = msg(
          "Cut on the way out only, from below what still stands; do not press on the floor of the chamber.");
    else
      l.instead = msg(
          "Go on down in the middle of the outline until the resistance gives way, then stop pressing.");
  }
  void roof(Lesson& l) const {
    const double all = r_.access.overhang ? r_.access.overhang->mm3 : 0;
    const Piece whole{r_.access.overhang_middle_mm, all, all};
    const Piece& piece = r_.access.overhang_pieces.empty() ? whole : r_.access.overhang_pieces[0];
    const Vec3 p = piece.middle_mm;
    show_hard_tissue(l, p);
    constexpr double k_nearly_all = 0.95;
    l.what = piece.part < k_nearly_all * all
                 ? msg("{} of roof was left over the pulp chamber, the largest part ({}) {}.",
                       as_mm3(all), percent_of(piece.part, all), there(p))
                 : msg("{} of roof was left over the pulp chamber, {}.", as_mm3(all), there(p));
    if (const double covered = r_.access.canals_covered_percent.value_or(0);
        covered >= k_min_covered_percent)
      l.what =
          both(l.what,
               one_canal()
                   ? msg("Hard tissue stands over {} of the canal's mouth.", as_percent(covered))
                   : msg("Hard tissue stands over {} of the canals' mouths.", as_percent(covered)));
    l.instead = msg(
        "Reach under the roof {} and cut it on the way out, until nothing catches between the wall and the opening.",
        there(p));
  }
  void canals(Lesson& l) const {
    const Vec3 p = r_.access.canals_covered_mm;
    show_hard_tissue(l, p);
    const Number covered = as_percent(r_.access.canals_covered_percent.value_or(0));
    l.what = one_canal()
                 ? msg("Hard tissue stands over {} of the canal's mouth, {}.", covered, there(p))
                 : msg("Hard tissue stands over {} of the canals' mouths, {}.", covered, there(p));
    l.instead = msg(
        "Take the shelf of dentin away {}, until an instrument goes straight in without bending at the entrance.",
        there(p));
  }
  void beside(Lesson& l) const {
    const ZoneVolume &out = r_.volumes.zone[row_of(Zone::container_sides)],
                     &near = r_.volumes.zone[row_of(Zone::leeway_sides)];
    std::size_t w =
        largest(out.removed.mm3 > 0 ? out.by_wall_mm3 : near.by_wall_mm3, scenarios::k_walls);
    if (w == row_of(scenarios::Wall::floor)) w = worst_side(r_);
    const bool all_round = walls_as_wide() >= 3;
    if (all_round) w = worst_side(r_);
    const WallMeasures& m = r_.shape.wall[w];
    l.where = m.worst_over;
    if (m.worst_over.tick >= 0) l.look_mm = m.worst_over.site_mm;
    const Trace& first = out.removed.mm3 > 0 ? out.first : near.first;
    const Number far = as_mm(std::max(0.0, m.max_over_mm));
    l.what = both(
        all_round ? msg("The cavity became too wide all round, by up to {} at {}.", far, wall(w))
                  : msg("The cavity became too wide: {} was cut by up to {} beyond its outline.",
                        wall(w), far),
        from(first));
    l.instead = msg("Stop at the outline, with the side of the bur on the wall and not its tip.");
    l.instead = both(l.instead, lean_at(w));
  }
  void too_deep(Lesson& l) const {
    const WallMeasures& m = r_.shape.wall[row_of(scenarios::Wall::floor)];
    if (opened_through_floor(in_, r_)) {
      opened(l);
      const PerforationTruth& p = r_.perforation.fault;
      const Message where = there(p.first.site_mm);
      const Number depth = as_mm(std::max(0.0, m.max_over_mm));
      const Term tissue{p.tissue};
      l.what = both(
          is_outside(p)
              ? msg("The tooth was perforated into the {} {}: the floor is up to {} too deep.",
                    tissue, where, depth)
              : msg("The {} was opened {}: the floor is up to {} too deep.", tissue, where, depth),
          when_at(p.first));
      return;
    }
    l.where = m.worst_over;
    if (m.worst_over.tick >= 0) l.look_mm = m.worst_over.site_mm;
    const Number far = as_mm(std::max(0.0, m.max_over_mm));
    l.what = both(m.worst_over.tick >= 0 ? msg("The floor is up to {} too deep, deepest {}.", far,
                                               there(m.worst_over.site_mm))
                                         : msg("The floor is up to {} too deep.", far),
                  when_at(m.worst_over));
    l.instead = msg(
        "Slow down for the last half millimetre, press lightly, and measure the depth before each further layer.");
  }
  void elsewhere(Lesson& l) const {
    const ZoneVolume &none = r_.volumes.zone[row_of(Zone::none)],
                     &guarded = r_.volumes.zone[row_of(Zone::protected_)];
    const bool is_guarded = guarded.removed.mm3 > none.removed.mm3;
    l.where = is_guarded ? guarded.first : none.first;
    if (l.where.tick >= 0 &&
        in_.zones.wall(in_.before.octree.leaf_at(l.where.site_mm)) == scenarios::Wall::floor)
      l.where = {};
    if (l.where.tick >= 0) l.look_mm = l.where.site_mm;
    const double below = none.by_wall_mm3[row_of(scenarios::Wall::floor)] +
                         guarded.by_wall_mm3[row_of(scenarios::Wall::floor)];
    const Number volume = as_mm3(std::max(0.0, r_.volumes.outside().mm3 - below));
    l.what = both(is_guarded ? msg("{} was cut of what must stay.", volume)
                             : msg("{} was cut far from the cavity.", volume),
                  from(l.where));
    l.instead = msg(
        "Take the foot off the pedal before the bur leaves the cavity, and lift it clear before you move on.");
  }
  void opened(Lesson& l) const {
    const PerforationTruth& p = r_.perforation.fault;
    l.where = p.first;
    if (p.perforated) l.look_mm = p.first.site_mm;
    const Message where = there(p.first.site_mm);
    const Term tissue{p.tissue};
    l.what = both(is_outside(p) ? msg("The tooth was perforated into the {} {}.", tissue, where)
                                : msg("The {} was opened {}.", tissue, where),
                  when_at(p.first));
    l.instead = msg(
        "Near it press lightly and look after each stroke; when the resistance gives way, stop at once.");
  }
  void taper(Lesson& l) const {
    const double is = r_.shape.taper_deg.value_or(0),
                 wanted = r_.access.target_taper_deg.value_or(is);
    l.what = msg("The walls open by {}, and {} are asked.", as_deg(is), as_deg(wanted));
    l.instead =
        is > wanted
            ? msg("Keep the handpiece along the way in while you cut the walls; do not let it swing.")
            : msg("Lean the bur outwards a little along the walls, or take a tapered one.");
  }
  void neighbour(Lesson& l) const {
    l.where = r_.beside.first_nick;
    if (r_.beside.nick_depth_mm > 0) l.look_mm = r_.beside.deepest.site_mm;
    l.what = both(msg("The neighbouring tooth was cut, {} deep.", as_mm(r_.beside.nick_depth_mm)),
                  when_at(l.where));
    l.instead = msg(
        "Leave a thin shell of enamel in front of the neighbour until the box is finished, and break it out last.");
  }
  void contact(Lesson& l) const {
    l.where.site_mm = r_.beside.clearance_from_mm;
    l.look_mm = r_.beside.clearance_from_mm;
    l.what = msg("The box comes clear of the neighbour by {} only.",
                 as_mm(r_.beside.clearance_mm.value_or(0)));
    l.instead = msg(
        "Carry the margins of the box on until the neighbour can be passed all round, at its floor as well.");
  }
  void gum(Lesson& l) const {
    l.where = r_.beside.first_gum;
    l.what = both(msg("{} of gum was cut.", as_mm3(r_.beside.gum_removed.mm3)), from(l.where));
    l.instead =
        msg("Keep the bur above the margin of the gum, and come from above and not along it.");
  }
  void force(Lesson& l) const {
    l.where = r_.motion.force_peak;
    l.what = both(msg("You pressed with {} on average and up to {}.",
                      as_n(r_.motion.force_mean_n, 1), as_n(r_.motion.force_peak_n, 1)),
                  when_at(l.where));
    l.instead = msg("Let the diamond do the cutting: press less, and keep the bur moving.");
  }
  void time(Lesson& l) const {
    l.what = msg("The work took {}; for {} the bur neither moved nor cut.",
                 ClockTime{r_.motion.time_s}, ClockTime{r_.motion.idle_s});
    l.instead =
        r_.motion.idle_s > 0.2 * r_.motion.time_s
            ? msg("Plan the order of your cuts before you begin, so that the bur seldom rests.")
            : msg("Take the bulk away in broad, even layers, and keep the fine strokes for the end.");
  }
  void steps(Lesson& l) const {
    l.where = r_.progress.first_violation;
    const int times = r_.progress.violations;
    l.what = times > 0 ? msgn("A rule of the task was broken {} time.",
                              "A rule of the task was broken {} times.", times, times)
                       : msg("Steps completed: {} of {}.", r_.progress.steps_completed,
                             r_.progress.steps);
    l.instead = times > 0 ? msg("Use the burs and the speed that the task allows.")
                          : msg("Follow the steps on the screen to the last one.");
  }
  void other(Lesson& l) const {
    for (const auto& c : r_.criteria)
      if (c.judged && c.max - c.points > k_shown_points &&
          scenarios::known_measure(c.metric).counts == scenarios::k_counts_nothing) {
        l.where = c.first;
        l.what = msg("{}: not as asked.", Authored{c.title});
        l.instead = msg("Look at its row in the table of criteria.");
        return;
      }
  }

  /// What of the target still stands at the end, mm³ of whole leaves: hard tissue by wall, and
  /// tissue that the task opens.
  struct Left {
    std::array<double, scenarios::k_walls + 1> hard_by_wall{};
    double aim = 0, all = 0;
    Vec3 aim_middle_mm;
    std::string aim_tissue;
  };
  [[nodiscard]] Left what_is_left() const {
    std::array<bool, 256> aim{};
    Left left;
    for (const auto& t : in_.before.tissues)
      for (const auto& name : in_.scenario.perforation.aims)
        if (t.name == name) aim[t.id] = true, left.aim_tissue = name;
    Vec3 sum;
    Octree::Cursor cursor;
    in_.zones.for_each_target_leaf([&](IVec3 leaf) {
      const std::uint8_t tissue = in_.after.tissue(leaf, cursor);
      if (tissue == k_air) return;
      const double mm3 = in_.zones.leaf_volume_mm3();
      left.all += mm3;
      if (aim[tissue]) {
        left.aim += mm3;
        sum += in_.zones.centre_mm(leaf) * mm3;
      } else {
        left.hard_by_wall[row_of(in_.zones.wall(leaf))] += mm3;
      }
    });
    if (left.aim > 0) left.aim_middle_mm = sum / left.aim;
    return left;
  }

  /// What stands at the end, and the moment in which something was cut beside it last; where
  /// nothing was, the end.
  void show_hard_tissue(Lesson& l, Vec3 at_mm) const {
    const std::int64_t end =
        counted_ticks(static_cast<std::int64_t>(in_.inputs.size()), in_.events);
    l.where = last_cut_near(in_, end, at_mm);
    if (l.where.tick < 0) l.where = {r_.end.tick, at_mm};
    l.look_mm = at_mm;
  }

  /// What surrounds the root was opened: nobody says of that that it was opened.
  static bool is_outside(const PerforationTruth& p) { return p.tissue == "periodontium"; }
  [[nodiscard]] bool one_canal() const { return r_.access.canal_mouths.size() == 1; }

  /// Side walls that were cut nearly as far beyond the outline as the furthest.
  [[nodiscard]] int walls_as_wide() const {
    constexpr double k_as_far = 0.6;
    const double most = r_.shape.wall[worst_side(r_)].max_over_mm;
    int walls = 0;
    for (std::size_t w = 0; w < scenarios::k_side_walls; ++w)
      walls += most > 0 && r_.shape.wall[w].max_over_mm >= k_as_far * most ? 1 : 0;
    return walls;
  }

  /// How the handpiece leaned while a wall was cut beyond its outline; empty when it stood along
  /// the way in, or nobody knows.
  [[nodiscard]] Message lean_at(std::size_t w) const {
    Vec3 sum;
    std::int64_t last = -1;
    for (const auto& cut : in_.removed) {
      if (cut.tick == last || cut.tick < 0 ||
          cut.tick >= static_cast<std::int64_t>(in_.inputs.size()))
        continue;
      const IVec3 leaf = cut.leaf.leaf();
      if (in_.zones.zone(leaf) != Zone::container_sides || row_of(in_.zones.wall(leaf)) != w)
        continue;
      last = cut.tick;
      sum +=
          rotation(in_.inputs[static_cast<std::size_t>(cut.tick)].pose().rotation) * Vec3{0, 0, 1};
    }
    if (last < 0) return {};
    const scenarios::Facing facing = in_.zones.facing();
    const Vec3 is = facing.local(normalized(sum)), way = facing.local(in_.zones.approach());
    const double x = is.x - way.x, y = is.y - way.y, deg = k_degrees_of * std::sqrt(x * x + y * y);
    if (deg < k_min_lean_deg) return {};
    const scenarios::Wall to = std::fabs(x) > std::fabs(y)
                                   ? (x > 0 ? scenarios::Wall::mesial : scenarios::Wall::distal)
                                   : (y > 0 ? scenarios::Wall::buccal : scenarios::Wall::lingual);
    return msg("The handpiece leaned {} towards {} there: hold it along the way in.", as_deg(deg),
               Term{scenarios::wall_name(to, facing)});
  }

  const GradeInput& in_;
  const Result& r_;
};

}  // namespace

/// What must not be opened was reached through the floor: the same mistake as a floor that is too
/// deep.
bool opened_through_floor(const GradeInput& in, const Result& r) {
  const PerforationTruth& p = r.perforation.fault;
  return p.perforated && p.first.tick >= 0 &&
         in.zones.wall(in.before.octree.leaf_at(p.first.site_mm)) == scenarios::Wall::floor &&
         r.shape.wall[row_of(scenarios::Wall::floor)].max_over_mm > 0;
}

void tell_lesson(Lesson& lesson, const GradeInput& input, const Result& result) {
  Teller(input, result).tell(lesson);
}

}  // namespace cavum::grading
