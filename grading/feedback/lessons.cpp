#include "grading/feedback/lessons.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>

#include "grading/feedback/lesson_words.h"
#include "grading/result/mark.h"
#include "scenarios/file/measures.h"

namespace cavum::grading {
namespace {

using scenarios::Zone;

constexpr double k_min_points = 0.005, k_middle_mm = 0.4;

/// Points of one criterion, by what they were lost for.
using Shares = std::map<Topic, double>;

double removed_mm3(const Result& r, Zone z) { return r.volumes.zone[row_of(z)].removed.mm3; }
/// Of what was removed there, straight on through the floor: too deep, however far it went.
double below_mm3(const Result& r, Zone z) {
  return r.volumes.zone[row_of(z)].by_wall_mm3[row_of(scenarios::Wall::floor)];
}
double elsewhere_mm3(const Result& r, Zone z) {
  return std::max(0.0, removed_mm3(r, z) - below_mm3(r, z));
}

/// What a measure charges where it counts several things: each by its own volume.
Shares by_volume(const Result& r, unsigned counts) {
  const auto removed = [&r](Zone z) { return removed_mm3(r, z); };
  Shares s;
  const auto add = [&](unsigned bit, Topic topic, double amount) {
    if ((counts & bit) != 0) s[topic] += amount;
  };
  const double roof = r.access.overhang ? r.access.overhang->mm3 : 0;
  add(scenarios::k_counts_target, Topic::left_standing, std::max(0.0, r.volumes.missed.mm3 - roof));
  if (roof > 0) add(scenarios::k_counts_target, Topic::roof, roof);
  add(scenarios::k_counts_sides, Topic::beside, removed(Zone::container_sides));
  add(scenarios::k_counts_leeway, Topic::beside, removed(Zone::leeway_sides));
  add(scenarios::k_counts_bottom, Topic::too_deep, removed(Zone::container_bottom));
  for (const auto& [bit, zone] : {std::pair{scenarios::k_counts_outside, Zone::none},
                                  std::pair{scenarios::k_counts_protected, Zone::protected_}}) {
    add(bit, Topic::too_deep, below_mm3(r, zone));
    add(bit, Topic::elsewhere, elsewhere_mm3(r, zone));
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
    s[r.shape.end_error[i].beyond_mm < 0 ? Topic::left_standing : Topic::beside] +=
        r.shape.end_error[i].part_mm;
  return s;
}

/// Whether the furthest overcut of the walls that a measure looks at is no wall of the cavity, but
/// a cut elsewhere.
bool is_cut_elsewhere(const Result& r, const scenarios::Measure& m) {
  const WallMeasures* worst = nullptr;
  for (std::size_t w = m.first_wall; w < std::min(m.first_wall + m.walls, scenarios::k_walls); ++w)
    if (worst == nullptr || r.shape.wall[w].max_over_mm > worst->max_over_mm)
      worst = &r.shape.wall[w];
  if (worst == nullptr || worst->worst_over.tick < 0 ||
      worst == &r.shape.wall[row_of(scenarios::Wall::floor)])
    return false;
  return worst->over_outside &&
         elsewhere_mm3(r, Zone::none) + elsewhere_mm3(r, Zone::protected_) >
             removed_mm3(r, Zone::container_sides) + removed_mm3(r, Zone::container_bottom);
}

/// One mistake that several measures see is named once: tissue over the chamber stands over the
/// canals' mouths as well.
void join(std::map<Topic, Lesson>& by_topic, Topic from, Topic to) {
  const auto found = by_topic.find(from);
  if (found == by_topic.end()) return;
  by_topic[to].points += found->second.points;
  by_topic[to].fails_exam = by_topic[to].fails_exam || found->second.fails_exam;
  by_topic.erase(found);
}

/// In a slip through what must not be opened: the bur went through there, and what it cut from then
/// on is the same mistake. What was cut before is one of its own: a hole that was begun beside the
/// outline was wrong before it reached the pulp.
bool in_that_slip(const Trace& opened, const Trace& cut) {
  constexpr double k_slip_s = 5, k_before_s = 0.5;
  const double after_s = cut.t_s() - opened.t_s();
  return opened.timed() && cut.timed() && after_s >= -k_before_s && after_s <= k_slip_s;
}

/// Nearly all that was cut in these zones, but for the floor, was cut in that slip.
bool cut_in_that_slip(const GradeInput& in, const Trace& opened,
                      std::initializer_list<Zone> zones) {
  constexpr double k_nearly_all = 0.9;
  double all = 0, then = 0;
  for (const RemovedAt& r : in.removed) {
    const IVec3 leaf = r.leaf.leaf();
    if (std::find(zones.begin(), zones.end(), in.zones.zone(leaf)) == zones.end() ||
        in.zones.wall(leaf) == scenarios::Wall::floor)
      continue;
    all += 1;
    then += in_that_slip(opened, {r.tick, {}}) ? 1 : 0;
  }
  return then >= k_nearly_all * all;
}

/// What a criterion's value is charged for.
Shares charged_for(const Result& r, const scenarios::Measure& m) {
  if (m.name == "overhang_mm3") return {{Topic::roof, 1}};
  if (m.name == "canals_covered_percent") return {{Topic::canals, 1}};
  if (m.name == "taper_deg" || m.name == "taper_error_deg") return {{Topic::taper, 1}};
  if (m.name == "proximal_clearance_mm") return {{Topic::contact, 1}};
  if (m.name == "dentin_over_pulp_mm") return {{Topic::too_deep, 1}};
  if (m.name == "soft_tissue_outside_mm3") return {{Topic::elsewhere, 1}};
  if (m.name.starts_with("steps_") || m.name == "violations") return {{Topic::steps, 1}};
  if (m.name.starts_with("outline_length")) return by_ends(r, 0);
  if (m.name.starts_with("outline_width")) return by_ends(r, 2);
  if (m.name.starts_with("depth_"))
    return {{r.shape.depth_mm.value_or(0) > r.shape.target_depth_mm ? Topic::too_deep
                                                                    : Topic::left_standing,
             1}};
  if (m.family != nullptr && m.key() == scenarios::k_wall_family &&
      m.figure != scenarios::WallFigure::max_under && is_cut_elsewhere(r, m))
    return {{Topic::elsewhere, 1}};
  if (m.name.starts_with("force_")) return {{Topic::force, 1}};
  return by_volume(r, m.counts);
}

Shares shares_of(const Result& r, const CriterionResult& c) {
  const double lost = c.max - c.points;
  // care that counts in part only: what is missing of it is missing work
  const double by_value = c.value && c.work_share > 0 ? c.max - c.points / c.work_share : 0;
  Shares charged = charged_for(r, scenarios::known_measure(c.metric)), out;
  double sum = 0;
  for (const auto& [topic, part] : charged) sum += part;
  if (charged.empty()) charged[Topic::other] = 0;
  for (const auto& [topic, part] : charged)
    out[topic] += by_value * (sum > 0 ? part / sum : 1.0 / static_cast<double>(charged.size()));
  out[Topic::left_standing] += lost - by_value;
  return out;
}

}  // namespace

const char* topic_name(Topic topic) noexcept {
  constexpr const char* k_names[] = {"left_standing", "roof",   "canals", "beside",    "too_deep",
                                     "elsewhere",     "opened", "taper",  "neighbour", "contact",
                                     "gum",           "force",  "time",   "steps",     "other"};
  return k_names[static_cast<std::size_t>(topic)];
}

Message side_words(Vec3 place_mm, const scenarios::ZoneMap& zones) {
  const scenarios::Facing facing = zones.facing();
  const Vec3 off = facing.local(place_mm - (zones.target_low_mm() + zones.target_high_mm()) * 0.5);
  const double x = std::fabs(off.x), y = std::fabs(off.y);
  if (x * x + y * y < k_middle_mm * k_middle_mm) return msg("in the middle");
  constexpr double k_eighth = 0.41421356;  // tan 22.5°
  const bool along_x = x >= k_eighth * y, along_y = y >= k_eighth * x, mesial = off.x > 0,
             buccal = off.y > 0;
  const Term first{mesial ? "mesial" : "distal"},
      second{scenarios::wall_name(buccal ? scenarios::Wall::buccal : scenarios::Wall::lingual,
                                  facing)};
  if (!along_y) return msg("towards {}", first);
  if (!along_x) return msg("towards {}", second);
  if (facing.lateral()) return msg("towards {} and {}", first, second);
  if (!buccal) return mesial ? msg("mesiolingually") : msg("distolingually");
  if (facing.anterior) return mesial ? msg("mesiolabially") : msg("distolabially");
  return mesial ? msg("mesiobuccally") : msg("distobuccally");
}

std::vector<Lesson> lessons(const GradeInput& input, const Result& result) {
  std::map<Topic, Lesson> by_topic;
  for (const auto& c : result.criteria) {
    if (!c.judged || (!(c.max - c.points > 0) && !c.critical_failed)) continue;
    const Shares shares = shares_of(result, c);
    const auto main =
        std::max_element(shares.begin(), shares.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    for (const auto& [topic, points] : shares) {
      by_topic[topic].points += points;
      if (topic == main->first && c.critical_failed) by_topic[topic].fails_exam = true;
    }
  }
  if (by_topic.contains(Topic::roof)) join(by_topic, Topic::canals, Topic::roof);
  if (opened_through_floor(input, result)) join(by_topic, Topic::opened, Topic::too_deep);
  if (const PerforationTruth& fault = result.perforation.fault; fault.perforated) {
    const Topic slip = by_topic.contains(Topic::too_deep) ? Topic::too_deep : Topic::opened;
    const auto is_that_slip = [&](std::initializer_list<Zone> zones) {
      return cut_in_that_slip(input, fault.first, zones);
    };
    if (by_topic.contains(slip) && is_that_slip({Zone::none, Zone::protected_}))
      join(by_topic, Topic::elsewhere, slip);
    if (by_topic.contains(slip) && is_that_slip({Zone::container_sides, Zone::leeway_sides}))
      join(by_topic, Topic::beside, slip);
  }
  std::vector<Lesson> all;
  for (auto& [topic, lesson] : by_topic) {
    if (lesson.points <= k_min_points && !lesson.fails_exam) continue;
    lesson.topic = topic;
    tell_lesson(lesson, input, result);
    all.push_back(std::move(lesson));
  }
  std::stable_sort(all.begin(), all.end(), [](const Lesson& a, const Lesson& b) {
    return a.fails_exam != b.fails_exam ? a.fails_exam : a.points > b.points;
  });
  return all;
}

}  // namespace cavum::grading
