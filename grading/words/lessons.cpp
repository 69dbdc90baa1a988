#include "grading/words/lessons.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/pose.h"
#include "engine/base/text.h"
#include "grading/result/loss.h"
#include "grading/result/mark.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {
namespace {

using scenarios::Zone;

constexpr double k_least_points = 0.005, k_least_lean_deg = 6.0, k_middle_mm = 0.4, k_degrees_of = 57.29577951308232, k_least_covered_percent = 5.0;

std::size_t at(Zone z) { return static_cast<std::size_t>(z); }
std::size_t at(scenarios::Wall w) { return static_cast<std::size_t>(w); }
std::string mm(double v) { return fixed(v, v < 1 ? 2 : 1) + " mm"; }
std::string mm3(double v) { return fixed(v, v < 1 ? 2 : 1) + " mm³"; }
std::string clock_text(double s) {
  const auto whole = static_cast<std::int64_t>(s);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

template <class Row>
std::size_t largest(const Row& row, std::size_t count) {
  return static_cast<std::size_t>(std::max_element(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(count)) - row.begin());
}

/// Points of one criterion, by what they were lost for.
using Shares = std::map<Topic, double>;

/// What a measure charges where it counts several things: each by its own volume.
Shares by_volume(const Result& r, unsigned counts) {
  const auto removed = [&r](Zone z) { return r.volumes.zone[at(z)].removed.mm3; };
  Shares s;
  const auto add = [&](unsigned bit, Topic topic, double amount) {
    if ((counts & bit) != 0) s[topic] += amount;
  };
  add(scenarios::k_counts_target, Topic::left_standing, r.volumes.missed.mm3);
  add(scenarios::k_counts_sides, Topic::beside, removed(Zone::container_sides));
  add(scenarios::k_counts_leeway, Topic::beside, removed(Zone::leeway_sides));
  add(scenarios::k_counts_bottom, Topic::too_deep, removed(Zone::container_bottom));
  // straight on through the floor is too deep, however far it went
  const auto below = [&r](Zone z) { return r.volumes.zone[at(z)].by_wall_mm3[at(scenarios::Wall::floor)]; };
  for (const auto& [bit, zone] : {std::pair{scenarios::k_counts_outside, Zone::none}, std::pair{scenarios::k_counts_protected, Zone::protected_}}) {
    add(bit, Topic::too_deep, below(zone));
    add(bit, Topic::elsewhere, std::max(0.0, removed(zone) - below(zone)));
  }
  add(scenarios::k_counts_faults, Topic::opened, r.perforation.fault.volume_mm3);
  add(scenarios::k_counts_time, Topic::time, 0);
  add(scenarios::k_counts_force, Topic::force, 0);
  add(scenarios::k_counts_neighbour, Topic::neighbour, 0);
  add(scenarios::k_counts_gum, Topic::gum, 0);
  return s;
}

/// Of an outline's error: its ends that lie short of the target's, and those beyond it.
Shares by_ends(const Result& r, std::size_t first) {
  Shares s{{Topic::left_standing, 0.0}, {Topic::beside, 0.0}};
  for (std::size_t i = first; i < first + 2; ++i)
    s[r.shape.end_error[i].beyond_mm < 0 ? Topic::left_standing : Topic::beside] += r.shape.end_error[i].part_mm;
  return s;
}

/// Whether the furthest overcut of the walls that a measure looks at is no wall of the cavity, but a cut elsewhere.
bool is_cut_elsewhere(const GradeInput& in, const Result& r, const scenarios::Measure& m) {
  const WallMeasures* worst = nullptr;
  for (std::size_t w = m.first_wall; w < std::min(m.first_wall + m.walls, scenarios::k_walls); ++w)
    if (worst == nullptr || r.shape.wall[w].max_over_mm > worst->max_over_mm) worst = &r.shape.wall[w];
  if (worst == nullptr || worst->worst_over.tick < 0 || worst == &r.shape.wall[at(scenarios::Wall::floor)]) return false;
  const Zone zone = in.zones.zone(in.before.octree.leaf_at(worst->worst_over.site_mm));
  const auto removed = [&r](Zone z) { return r.volumes.zone[at(z)].removed.mm3; };
  return (zone == Zone::none || zone == Zone::protected_) &&
         r.volumes.outside().mm3 > removed(Zone::container_sides) + removed(Zone::container_bottom);
}

/// What must not be opened was reached through the floor: the same mistake as a floor that is too deep.
bool opened_through_floor(const GradeInput& in, const Result& r) {
  const PerforationTruth& p = r.perforation.fault;
  return p.perforated && p.first.tick >= 0 && in.zones.wall(in.before.octree.leaf_at(p.first.site_mm)) == scenarios::Wall::floor &&
         r.shape.wall[at(scenarios::Wall::floor)].max_over_mm > 0;
}

/// One mistake that several measures see is named once: tissue over the chamber stands over the canals' mouths as well.
void join(std::map<Topic, Lesson>& by_topic, Topic from, Topic to) {
  const auto found = by_topic.find(from);
  if (found == by_topic.end()) return;
  by_topic[to].points += found->second.points;
  by_topic[to].fails_exam = by_topic[to].fails_exam || found->second.fails_exam;
  by_topic.erase(found);
}

/// What a criterion's value is charged for.
Shares charged_for(const GradeInput& in, const Result& r, const scenarios::Measure& m) {
  if (m.name == "overhang_mm3") return {{Topic::roof, 1}};
  if (m.name == "canals_covered_percent") return {{Topic::canals, 1}};
  if (m.name == "taper_deg" || m.name == "taper_error_deg") return {{Topic::taper, 1}};
  if (m.name == "proximal_clearance_mm") return {{Topic::contact, 1}};
  if (m.name == "dentin_over_pulp_mm") return {{Topic::too_deep, 1}};
  if (m.name == "soft_tissue_outside_mm3") return {{Topic::elsewhere, 1}};
  if (m.name.starts_with("steps_") || m.name == "violations") return {{Topic::steps, 1}};
  if (m.name.starts_with("outline_length")) return by_ends(r, 0);
  if (m.name.starts_with("outline_width")) return by_ends(r, 2);
  if (m.name.starts_with("depth_")) return {{r.shape.depth_mm.value_or(0) > r.shape.target_depth_mm ? Topic::too_deep : Topic::left_standing, 1}};
  if (m.family != nullptr && m.key() == scenarios::k_wall_family && m.figure != scenarios::WallFigure::max_under && is_cut_elsewhere(in, r, m))
    return {{Topic::elsewhere, 1}};
  if (m.name.starts_with("force_")) return {{Topic::force, 1}};
  return by_volume(r, m.counts);
}

Shares shares_of(const GradeInput& in, const Result& r, const CriterionResult& c) {
  const double lost = c.max - c.points;
  // care that counts in part only: what is missing of it is missing work
  const double by_value = c.value && c.work_share > 0 ? c.max - c.points / c.work_share : 0;
  Shares charged = charged_for(in, r, scenarios::known_measure(c.metric)), out;
  double sum = 0;
  for (const auto& [topic, part] : charged) sum += part;
  if (charged.empty()) charged[Topic::other] = 0;
  for (const auto& [topic, part] : charged) out[topic] += by_value * (sum > 0 ? part / sum : 1.0 / static_cast<double>(charged.size()));
  out[Topic::left_standing] += lost - by_value;
  return out;
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
  [[nodiscard]] std::string there(Vec3 p) const { return side_words(p, in_.zones); }
  [[nodiscard]] std::string wall(std::size_t w) const { return wall_text(w, r_.shape.facing); }
  /// "from 0:49 on"; nothing where nobody knows when.
  static std::string from(const Trace& t) { return t.timed() ? fmt::format(", from {} on", clock_text(t.t_s())) : ""; }
  static std::string when_at(const Trace& t) { return t.timed() ? fmt::format(" at {}", clock_text(t.t_s())) : ""; }

  void left_standing(Lesson& l) const {
    if (!(r_.volumes.target_removed_percent > 0)) {
      l.what = "Nothing of the cavity was cut.";
      l.instead = "Open the outline first, then take the cavity away layer by layer.";
      return;
    }
    const std::size_t w = largest(r_.volumes.missed_by_wall_mm3, scenarios::k_walls);
    const scenarios::Wall of = static_cast<scenarios::Wall>(w);
    const double thick = r_.shape.wall[w].max_under_mm;
    l.where = r_.volumes.target_last[w];
    if (thick > 0) l.look_mm = r_.shape.wall[w].worst_under.site_mm;
    l.what = fmt::format("{} of the cavity was left standing, most of it at {}{}.", mm3(r_.volumes.missed.mm3), wall(w),
                         thick > 0 ? fmt::format(", up to {} thick", mm(thick)) : "");
    if (of == scenarios::Wall::floor)
      l.instead = "Go on down to the depth that is asked, and feel for an even floor before you hand in.";
    else
      l.instead = fmt::format("Go round the outline once more before you hand in, and take {} back until the outline is reached.", wall(w));
  }
  void roof(Lesson& l) const {
    const Vec3 p = r_.access.overhang_pieces.empty() ? r_.access.overhang_middle_mm : r_.access.overhang_pieces[0].middle_mm;
    l.where.site_mm = p;
    l.look_mm = p;
    l.what =
        fmt::format("{} of roof was left over the pulp chamber, most of it {}.", mm3(r_.access.overhang ? r_.access.overhang->mm3 : 0), there(p));
    if (const double covered = r_.access.canals_covered_percent.value_or(0); covered >= k_least_covered_percent)
      l.what += fmt::format(" It stands over {} % of the canals' mouths.", fixed(covered, 0));
    l.instead = fmt::format("Reach under the roof {} and cut it on the way out, until nothing catches between the wall and the opening.", there(p));
  }
  void canals(Lesson& l) const {
    const Vec3 p = r_.access.canals_covered_mm;
    l.where.site_mm = p;
    l.look_mm = p;
    l.what = fmt::format("Hard tissue stands over {} % of the canals' mouths, most of it {}.", fixed(r_.access.canals_covered_percent.value_or(0), 0),
                         there(p));
    l.instead = fmt::format("Take the shelf of dentin away {}, until an instrument goes straight in without bending at the entrance.", there(p));
  }
  void beside(Lesson& l) const {
    const ZoneVolume &out = r_.volumes.zone[at(Zone::container_sides)], &near = r_.volumes.zone[at(Zone::leeway_sides)];
    std::size_t w = largest(out.removed.mm3 > 0 ? out.by_wall_mm3 : near.by_wall_mm3, scenarios::k_walls);
    if (w == at(scenarios::Wall::floor)) w = worst_side();
    const WallMeasures& m = r_.shape.wall[w];
    l.where = m.worst_over;
    if (m.worst_over.tick >= 0) l.look_mm = m.worst_over.site_mm;
    const Trace& first = out.removed.mm3 > 0 ? out.first : near.first;
    l.what = fmt::format("The cavity became too wide: {} was cut by up to {} beyond its outline{}.", wall(w), mm(std::max(0.0, m.max_over_mm)),
                         from(first));
    l.instead = "Stop at the outline, with the side of the point on the wall and not its tip.";
    if (const std::string lean = lean_at(w); !lean.empty()) l.instead += " " + lean;
  }
  void too_deep(Lesson& l) const {
    const WallMeasures& m = r_.shape.wall[at(scenarios::Wall::floor)];
    if (opened_through_floor(in_, r_)) {
      opened(l);
      l.what = fmt::format("The {} was opened {}{}: the floor is up to {} too deep.", r_.perforation.fault.tissue,
                           there(r_.perforation.fault.first.site_mm), when_at(r_.perforation.fault.first), mm(std::max(0.0, m.max_over_mm)));
      return;
    }
    l.where = m.worst_over;
    if (m.worst_over.tick >= 0) l.look_mm = m.worst_over.site_mm;
    l.what = fmt::format("The floor is up to {} too deep{}{}.", mm(std::max(0.0, m.max_over_mm)),
                         m.worst_over.tick >= 0 ? ", deepest " + there(m.worst_over.site_mm) : "", when_at(m.worst_over));
    l.instead = "Slow down for the last half millimetre, press lightly, and measure the depth before each further layer.";
  }
  void elsewhere(Lesson& l) const {
    const ZoneVolume &none = r_.volumes.zone[at(Zone::none)], &guarded = r_.volumes.zone[at(Zone::protected_)];
    const bool is_guarded = guarded.removed.mm3 > none.removed.mm3;
    l.where = is_guarded ? guarded.first : none.first;
    if (l.where.tick >= 0 && in_.zones.wall(in_.before.octree.leaf_at(l.where.site_mm)) == scenarios::Wall::floor) l.where = {};
    if (l.where.tick >= 0) l.look_mm = l.where.site_mm;
    const double below = none.by_wall_mm3[at(scenarios::Wall::floor)] + guarded.by_wall_mm3[at(scenarios::Wall::floor)];
    l.what = fmt::format("{} was cut {}{}.", mm3(std::max(0.0, r_.volumes.outside().mm3 - below)),
                         is_guarded ? "of what must stay" : "far from the cavity", from(l.where));
    l.instead = "Take the foot off the pedal before the point leaves the cavity, and lift it clear before you move on.";
  }
  void opened(Lesson& l) const {
    const PerforationTruth& p = r_.perforation.fault;
    l.where = p.first;
    if (p.perforated) l.look_mm = p.first.site_mm;
    l.what = fmt::format("The {} was opened {}{}.", p.tissue, there(p.first.site_mm), when_at(p.first));
    l.instead = "Near it press lightly and look after each stroke; when the resistance gives way, stop at once.";
  }
  void taper(Lesson& l) const {
    const double is = r_.shape.taper_deg.value_or(0), wanted = r_.access.target_taper_deg.value_or(is);
    l.what = fmt::format("The walls open by {}°, and {}° are asked.", fixed(is, 0), fixed(wanted, 0));
    l.instead = is > wanted ? "Keep the handpiece along the way in while you cut the walls; do not let it swing."
                            : "Lean the point outwards a little along the walls, or take a tapered one.";
  }
  void neighbour(Lesson& l) const {
    l.where = r_.beside.first_nick;
    if (r_.beside.nick_depth_mm > 0) l.look_mm = r_.beside.deepest.site_mm;
    l.what = fmt::format("The neighbouring tooth was cut, {} deep{}.", mm(r_.beside.nick_depth_mm), when_at(l.where));
    l.instead = "Leave a thin shell of enamel in front of the neighbour until the box is finished, and break it out last.";
  }
  void contact(Lesson& l) const {
    l.where.site_mm = r_.beside.clearance_from_mm;
    l.look_mm = r_.beside.clearance_from_mm;
    l.what = fmt::format("The box comes clear of the neighbour by {} only.", mm(r_.beside.clearance_mm.value_or(0)));
    l.instead = "Carry the margins of the box on until the neighbour can be passed all round, at its floor as well.";
  }
  void gum(Lesson& l) const {
    l.where = r_.beside.first_gum;
    l.what = fmt::format("{} of gum was cut{}.", mm3(r_.beside.gum_removed.mm3), from(l.where));
    l.instead = "Keep the point above the margin of the gum, and come from above and not along it.";
  }
  void force(Lesson& l) const {
    l.where = r_.motion.force_peak;
    l.what = fmt::format("You pressed with {} N on average and up to {} N{}.", fixed(r_.motion.force_mean_n, 1), fixed(r_.motion.force_peak_n, 1),
                         when_at(l.where));
    l.instead = "Let the diamond do the cutting: press less, and keep the point moving.";
  }
  void time(Lesson& l) const {
    l.what = fmt::format("The work took {}; for {} the point neither moved nor cut.", clock_text(r_.motion.time_s), clock_text(r_.motion.idle_s));
    l.instead = r_.motion.idle_s > 0.2 * r_.motion.time_s ? "Plan the order of your cuts before you begin, so that the point seldom rests."
                                                          : "Take the bulk away in broad, even layers, and keep the fine strokes for the end.";
  }
  void steps(Lesson& l) const {
    l.where = r_.progress.first_violation;
    l.what = r_.progress.violations > 0 ? fmt::format("A rule of the task was broken {} times.", r_.progress.violations)
                                        : fmt::format("{} of {} steps were completed.", r_.progress.steps_completed, r_.progress.steps);
    l.instead = r_.progress.violations > 0 ? "Use the points and the speed that the task allows." : "Follow the steps on the screen to the last one.";
  }
  void other(Lesson& l) const {
    for (const auto& c : r_.criteria)
      if (c.judged && c.max - c.points > k_least_points && scenarios::known_measure(c.metric).counts == scenarios::k_counts_nothing) {
        l.where = c.first;
        l.what = fmt::format("{}: not as asked.", c.title);
        l.instead = "Look at its row in the table of criteria.";
        return;
      }
  }

  [[nodiscard]] std::size_t worst_side() const {
    std::size_t worst = 0;
    for (std::size_t w = 0; w < 4; ++w)
      if (r_.shape.wall[w].max_over_mm > r_.shape.wall[worst].max_over_mm) worst = w;
    return worst;
  }

  /// How the handpiece leaned while a wall was cut beyond its outline; empty when it stood along the way in, or nobody knows.
  [[nodiscard]] std::string lean_at(std::size_t w) const {
    Vec3 sum;
    std::int64_t last = -1;
    for (const auto& cut : in_.removed) {
      if (cut.tick == last || cut.tick < 0 || cut.tick >= static_cast<std::int64_t>(in_.inputs.size())) continue;
      const IVec3 leaf = cut.leaf.leaf();
      if (in_.zones.zone(leaf) != Zone::container_sides || at(in_.zones.wall(leaf)) != w) continue;
      last = cut.tick;
      sum += rotation(in_.inputs[static_cast<std::size_t>(cut.tick)].pose().rotation) * Vec3{0, 0, 1};
    }
    if (last < 0) return "";
    const scenarios::Facing facing = in_.zones.facing();
    const Vec3 is = facing.local(normalized(sum)), way = facing.local(in_.zones.approach());
    const double x = is.x - way.x, y = is.y - way.y, deg = k_degrees_of * std::sqrt(x * x + y * y);
    if (deg < k_least_lean_deg) return "";
    const scenarios::Wall to = std::fabs(x) > std::fabs(y) ? (x > 0 ? scenarios::Wall::mesial : scenarios::Wall::distal)
                                                           : (y > 0 ? scenarios::Wall::buccal : scenarios::Wall::lingual);
    return fmt::format("The handpiece leaned {}° towards {} there: hold it along the way in.", fixed(deg, 0), scenarios::wall_name(to, facing));
  }

  const GradeInput& in_;
  const Result& r_;
};

}  // namespace

const char* topic_name(Topic topic) noexcept {
  constexpr const char* k_names[] = {"left_standing", "roof",    "canals", "beside", "too_deep", "elsewhere", "opened", "taper",
                                     "neighbour",     "contact", "gum",    "force",  "time",     "steps",     "other"};
  return k_names[static_cast<std::size_t>(topic)];
}

std::string side_words(Vec3 place_mm, const scenarios::ZoneMap& zones) {
  const scenarios::Facing facing = zones.facing();
  const Vec3 off = facing.local(place_mm - (zones.target_low_mm() + zones.target_high_mm()) * 0.5);
  const double x = std::fabs(off.x), y = std::fabs(off.y);
  if (x * x + y * y < k_middle_mm * k_middle_mm) return "in the middle";
  constexpr double k_eighth = 0.41421356;  // tan 22.5°
  const bool along_x = x >= k_eighth * y, along_y = y >= k_eighth * x;
  const std::string first = off.x > 0 ? "mesial" : "distal",
                    second = scenarios::wall_name(off.y > 0 ? scenarios::Wall::buccal : scenarios::Wall::lingual, facing);
  if (!along_y) return "towards " + first;
  if (!along_x) return "towards " + second;
  return facing.lateral() ? fmt::format("towards {} and {}", first, second) : fmt::format("{}o{}ly", first.substr(0, first.size() - 2), second);
}

std::vector<Lesson> lessons(const GradeInput& input, const Result& result) {
  std::map<Topic, Lesson> by_topic;
  for (const auto& c : result.criteria) {
    if (!c.judged || (!(c.max - c.points > 0) && !c.critical_failed)) continue;
    const Shares shares = shares_of(input, result, c);
    const auto main = std::max_element(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    for (const auto& [topic, points] : shares) {
      by_topic[topic].points += points;
      if (topic == main->first && c.critical_failed) by_topic[topic].fails_exam = true;
    }
  }
  if (by_topic.contains(Topic::roof)) join(by_topic, Topic::canals, Topic::roof);
  if (opened_through_floor(input, result)) join(by_topic, Topic::opened, Topic::too_deep);
  std::vector<Lesson> all;
  const Teller teller(input, result);
  for (auto& [topic, lesson] : by_topic) {
    if (lesson.points <= k_least_points && !lesson.fails_exam) continue;
    lesson.topic = topic;
    teller.tell(lesson);
    all.push_back(std::move(lesson));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Lesson& a, const Lesson& b) { return a.fails_exam != b.fails_exam ? a.fails_exam : a.points > b.points; });
  return all;
}

}  // namespace cavum::grading
