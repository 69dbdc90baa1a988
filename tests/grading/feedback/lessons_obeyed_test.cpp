// Simulated beginners and their lessons. Each mistake is undone in the leaves, and the exam marked
// again: the three that the lessons name first must be those that cost most. Then each sits the
// exam again and does what his three sentences say: his points must rise. A few every day; with
// CAVUM_DEEP two hundred.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <set>

#include "engine/base/file.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_incisor.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/octree_edit.h"
#include "grading/marking/grade.h"
#include "grading/perforation/known_tooth.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/feedback/novice.h"

namespace cavum::grading {
namespace {

using testing::NoviceTask;
using testing::Sat;
using Mistakes = std::set<Topic>;

constexpr Topic k_in_the_tooth[] = {Topic::left_standing, Topic::roof,     Topic::canals,
                                    Topic::beside,        Topic::too_deep, Topic::elsewhere,
                                    Topic::opened};
constexpr double k_alike_points = 1.0;  // mistakes whose gains differ by less cost the same
constexpr double k_mouth_mm = 0.8;      // around a canal's mouth
constexpr double k_near_fault_mm = 0.5;

/// The exam marked again with mistakes undone: filled up to the target where it went too far, or
/// cut on to the target. Nothing of it looks at what lessons say.
class Undone {
 public:
  Undone(const NoviceTask& task, const Sat& sat, const Result& marked)
      : task_(task), sat_(sat), marked_(marked) {
    const auto& scenario = task.setup->scenario;
    for (const auto& t : task.setup->tooth.tissues) {
      const auto named = [&](const std::vector<std::string>& list) {
        return t.id != k_air && std::find(list.begin(), list.end(), t.name) != list.end();
      };
      aim_[t.id] = named(scenario.perforation.aims);
      fault_[t.id] = named(scenario.perforation.faults);
    }
    constexpr double k_around_mm = 0.3;
    const Vec3 around{k_around_mm, k_around_mm, k_around_mm};
    low_mm_ = task.setup->zones.target_low_mm(), high_mm_ = task.setup->zones.target_high_mm();
    for (const auto& r : sat.removed) {
      const Vec3 at = task.setup->zones.centre_mm(r.leaf.leaf());
      low_mm_ = min(low_mm_, at);
      high_mm_ = max(high_mm_, at);
    }
    low_mm_ = low_mm_ - around, high_mm_ = high_mm_ + around;
  }

  /// Without any: the same cavity cut anew by its own surface, which is what gains are counted
  /// from.
  [[nodiscard]] Result without(const Mistakes& mistakes) const {
    const scenarios::ZoneMap& zones = task_.setup->zones;
    const Octree& before = task_.setup->tooth.octree;
    Octree after = before;
    after.reserve_edits(60'000);
    std::vector<RemovedLeaf> leaves;
    leaves.reserve(4'000'000);
    Octree::Cursor cursor;
    const auto cut = [&](Vec3 p) {
      const Octree& was = sat_.after.octree;
      const double open = was.sample(p, cursor).distance_mm;
      double cavity = open > 0 && was.tissue_at(p, cursor) != k_air
                          ? open
                          : -open;  // pulp that is still there is void, and was not cut
      for (const Topic m : mistakes) cavity = without(m, p, cavity);
      return cavity;
    };
    EXPECT_TRUE(after.carve(low_mm_, high_mm_, cut, leaves));
    std::vector<RemovedAt> removed;
    const auto last = static_cast<std::int64_t>(sat_.records.size()) - 1;
    for (const auto& l : leaves) removed.push_back({last, l});
    return grade({task_.setup->scenario, task_.setup->tooth, zones, after, sat_.inputs,
                  sat_.records, removed, sat_.events},
                 task_.setup->scenario.rubric);
  }

 private:
  /// Signed distance to the cavity, mm, negative inside, once this mistake is undone.
  [[nodiscard]] double without(Topic mistake, Vec3 p, double cavity) const {
    const scenarios::ZoneMap& zones = task_.setup->zones;
    const double target = zones.distance_mm(p);
    const IVec3 leaf = task_.setup->tooth.octree.leaf_at(p);
    const bool floor = zones.wall(leaf) == scenarios::Wall::floor;
    const scenarios::Zone zone = zones.zone(leaf);
    switch (mistake) {
      case Topic::beside:
        return floor ? cavity : std::max(cavity, target);
      case Topic::too_deep:
        return floor ? std::max(cavity, target) : cavity;
      case Topic::elsewhere:
        return (zone == scenarios::Zone::none || zone == scenarios::Zone::protected_) && target > 0
                   ? std::max(cavity, target)
                   : cavity;
      case Topic::opened:
        return target > 0 && near_fault(p) ? std::max(cavity, target) : cavity;
      case Topic::left_standing:
        return std::min(cavity, target);
      case Topic::roof:
        return over_aim(p) ? std::min(cavity, target) : cavity;
      case Topic::canals:
        return at_mouth(p) ? std::min(cavity, target) : cavity;
      default:
        return cavity;
    }
  }
  [[nodiscard]] bool near_fault(Vec3 p) const {
    constexpr double d = k_near_fault_mm;
    for (const Vec3 by : {Vec3{0, 0, 0}, Vec3{d, 0, 0}, Vec3{-d, 0, 0}, Vec3{0, d, 0},
                          Vec3{0, -d, 0}, Vec3{0, 0, d}, Vec3{0, 0, -d}})
      if (fault_[task_.setup->tooth.octree.tissue_at(p + by)]) return true;
    return false;
  }
  /// The chamber that is to be opened lies below, as seen along the way in.
  [[nodiscard]] bool over_aim(Vec3 p) const {
    for (double down = 0; down < 4; down += 0.1)
      if (aim_[task_.setup->tooth.octree.tissue_at(p - task_.setup->zones.approach() * down)])
        return true;
    return false;
  }
  /// On the straight way out of a canal's mouth.
  [[nodiscard]] bool at_mouth(Vec3 p) const {
    const Vec3 up = task_.setup->zones.approach();
    return std::any_of(marked_.access.canal_mouths.begin(), marked_.access.canal_mouths.end(),
                       [&](const auto& mouth) {
                         const Vec3 off = p - mouth.middle_mm;
                         return length(off - up * dot(off, up)) < k_mouth_mm;
                       });
  }
  const NoviceTask& task_;
  const Sat& sat_;
  const Result& marked_;
  std::array<bool, 256> aim_{}, fault_{};
  Vec3 low_mm_, high_mm_;  ///< around target and cavity
};

double lost_by(const Result& r, std::initializer_list<const char*> metrics) {
  double lost = 0;
  for (const auto& c : r.criteria)
    for (const char* m : metrics)
      if (c.judged && c.metric == m) lost += c.max - c.points;
  return lost;
}
int failed_limits(const Result& r) {
  return static_cast<int>(std::count_if(r.criteria.begin(), r.criteria.end(), [](const auto& c) {
    return c.judged && c.critical_failed;
  }));
}

/// What mistakes cost, named by a lesson or not: those in the tooth are undone; what time and slope
/// cost stands in their criteria.
class Costs {
 public:
  Costs(const NoviceTask& task, const Sat& sat, const Result& marked)
      : undone_(task, sat, marked), as_it_is_(undone_.without({})) {
    for (const Topic t : k_in_the_tooth) {
      const double wins = gain({t});
      if (wins > 0.05) single_[t] = wins;
    }
    for (const Topic t : {Topic::time, Topic::taper})
      if (const double lost = gain({t}); lost > 0.05) single_[t] = lost;
  }
  /// Points that undoing all of them wins.
  [[nodiscard]] double gain(const Mistakes& mistakes) {
    if (const auto known = known_.find(mistakes); known != known_.end()) return known->second;
    Mistakes in_the_tooth = mistakes;
    in_the_tooth.erase(Topic::time);
    in_the_tooth.erase(Topic::taper);
    const Result r = in_the_tooth.empty() ? as_it_is_ : undone_.without(in_the_tooth);
    double points = r.points - as_it_is_.points;
    if (mistakes.contains(Topic::time)) points += lost_by(r, {"time_s", "idle_s", "handpiece_s"});
    if (mistakes.contains(Topic::taper)) points += lost_by(r, {"taper_deg", "taper_error_deg"});
    frees_[mistakes] = failed_limits(r) < failed_limits(as_it_is_);
    return known_[mistakes] = points;
  }
  /// Whether undoing them takes a failed limit away.
  [[nodiscard]] bool frees(const Mistakes& mistakes) {
    return static_cast<void>(gain(mistakes)), frees_[mistakes];
  }
  /// Of each that costs anything by itself.
  [[nodiscard]] const std::map<Topic, double>& single() const { return single_; }
  /// The mistakes, `most` of them, whose undoing wins the most: one after the other, each with
  /// those before it undone.
  [[nodiscard]] Mistakes dearest(std::size_t most) {
    Mistakes chosen;
    while (chosen.size() < most) {
      Mistakes best = chosen;
      for (const auto& [topic, points] : single_) {
        Mistakes with = chosen;
        with.insert(topic);
        if (gain(with) > (best.empty() ? 0.0 : gain(best)) + 1e-9) best = with;
      }
      if (best == chosen) break;
      chosen = best;
    }
    return chosen;
  }

 private:
  Undone undone_;
  Result as_it_is_;
  std::map<Topic, double> single_;
  std::map<Mistakes, double> known_;
  std::map<Mistakes, bool> frees_;
};

std::string names(const Mistakes& mistakes) {
  std::string all;
  for (const Topic t : mistakes) all += std::string(all.empty() ? "" : "+") + topic_name(t);
  return all;
}

class LessonsOfNovices : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("CAVUM_HOME", folder_.file("home").c_str(), 1);
    MolarShape molar;
    PremolarShape premolar;
    IncisorShape incisor;
    molar.leaf_mm = premolar.leaf_mm = incisor.leaf_mm = 0.1;
    write_file(folder_.file("molar.cvt"), save_tooth(make_molar(molar)));
    write_file(folder_.file("premolar.cvt"), save_tooth(make_premolar(premolar)));
    write_file(folder_.file("incisor.cvt"), save_tooth(make_incisor(incisor)));
    write_file(
        folder_.file("block.cvt"),
        save_tooth(make_block(
            {10, 10, 6}, {{"enamel", 1.2}, {"dentin", 2.0}, {"pulp", 1.5}, {"dentin", 1.3}}, 0.1)));
  }
  testing_basics::Folder folder_;
};

TEST_F(LessonsOfNovices, HearWhatCostMostAndWinPointsByIt) {
  const bool deep = std::getenv("CAVUM_DEEP") != nullptr;
  Random random(testing_basics::drawn_seed("LessonsOfNovices.HearWhatCostMostAndWinPointsByIt"));
  const std::pair<const char*, const char*> sat_on[] = {
      {"slot", "block.cvt"},        {"premolar_access", "premolar.cvt"},
      {"class_1", "molar.cvt"},     {"cross", "block.cvt"},
      {"class_2", "molar.cvt"},     {"incisor_access", "incisor.cvt"},
      {"molar_access", "molar.cvt"}};
  const char* many = std::getenv("CAVUM_NOVICES");
  const int novices = many != nullptr ? std::atoi(many) : deep ? 200 : 3;
  std::map<std::string, NoviceTask> tasks;
  int lost_something = 0, named = 0, first_is_dearest = 0, won = 0;
  const auto& kinds = testing::beginner_kinds();
  for (int i = 0; i < novices; ++i) {
    const auto& [task_name, tooth] = sat_on[static_cast<std::size_t>(i) % std::size(sat_on)];
    if (!tasks.contains(task_name))
      tasks[task_name] = testing::novice_task(task_name, folder_.file(tooth));
    const NoviceTask& task = tasks[task_name];
    const testing::Beginner who =
        testing::beginner(kinds[random.below(kinds.size())], random.next());
    const Sat first = testing::sit(task, who, {}, folder_.file("first.cavum"));
    const Result r = grade(first.input(task), task.setup->scenario.rubric);
    auto said = lessons(first.input(task), r);
    if (said.size() > 3) said.resize(3);
    if (said.empty()) continue;
    ++lost_something;

    Costs costs(task, first, r);
    Mistakes said_topics;
    std::string line;
    for (const auto& l : said) {
      said_topics.insert(l.topic);
      line += fmt::format(" {}{} {:.1f}", topic_name(l.topic), l.fails_exam ? "!" : "", l.points);
    }
    const Mistakes dearest = costs.dearest(3);
    const bool right =
        costs.gain(said_topics) > (dearest.empty() ? 0.0 : costs.gain(dearest)) - k_alike_points;
    double most = 0;
    for (const auto& [topic, points] : costs.single()) most = std::max(most, points);
    const bool first_right = costs.gain({said[0].topic}) > most - k_alike_points ||
                             (said[0].fails_exam && costs.frees({said[0].topic}));
    named += right;
    first_is_dearest += first_right;
    const Sat again = testing::sit(task, who, said, folder_.file("again.cavum"));
    const Result better = grade(again.input(task), task.setup->scenario.rubric);
    const bool rose = better.points > r.points;
    won += rose;
    std::cout << fmt::format(
        "{} {} {}: {:.1f} to {:.1f}{} | said{}: {:.1f}{}{} | dearest {}: {:.1f} |", i, task_name,
        who.kind, r.points, better.points, rose ? "" : " NOT BETTER", line, costs.gain(said_topics),
        right ? "" : " NOT THE DEAREST", first_right ? "" : " NOT THE FIRST", names(dearest),
        dearest.empty() ? 0.0 : costs.gain(dearest));
    for (const auto& [topic, points] : costs.single())
      std::cout << fmt::format(" {} {:.1f}", topic_name(topic), points);
    std::cout << std::endl;
  }
  std::cout << fmt::format(
      "{} lost points; the three sentences name the three dearest mistakes of {}, the first the dearest of {}; who obeys wins points: {}\n",
      lost_something, named, first_is_dearest, won);
  EXPECT_GT(lost_something, 0);
  if (deep) {
    EXPECT_GE(named, (9 * lost_something) / 10);
    EXPECT_GE(won, (9 * lost_something) / 10);
  }
}

}  // namespace
}  // namespace cavum::grading
