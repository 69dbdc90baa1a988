// Every game in every task that ships, on its tooth in leaves of 0.1 mm (with CAVUM_DEEP as it
// ships): none is marked better than honest work, none passes that a fair examiner would not let
// pass, and more honest work is never marked lower.
#include "tests/games/games.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "tests/engine/support/basics.h"
#include "tests/games/bodies.h"

namespace cavum::games {
namespace {

constexpr double k_rounding = 1e-9;

class Games : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static const Task& ground() {
    return std::getenv("CAVUM_DEEP") != nullptr ? task(GetParam()) : coarse_task(GetParam());
  }
  [[nodiscard]] static const grading::Result& honest_mark() {
    static std::map<std::string, grading::Result> kept;
    const auto found = kept.find(GetParam());
    if (found != kept.end()) return found->second;
    Sitting s(ground());
    honest(s);
    return kept[GetParam()] = s.marked();
  }
};

/// Below the line under which a rubric fails an exam for what of the target was left, by more than
/// the mark's own bound.
bool below_critical(const Task& t, const Seen& seen, const grading::Result& r) {
  for (std::size_t i = 0; i < t.scenario.rubric.criteria.size(); ++i) {
    const auto& c = t.scenario.rubric.criteria[i];
    if (c.metric == "target_removed_percent" && c.critical_below &&
        seen.most_percent < *c.critical_below - r.criteria[i].bound)
      return true;
  }
  return false;
}

/// Plays it and holds its mark against honest work's and the examiner's.
void judge(const Task& t, const grading::Result& honest, const Game& game) {
  Sitting s(t);
  game.play(s);
  const grading::Result r = s.marked();
  const Seen saw = seen(s);
  const std::string all = t.name + " " + game.name + ": " + told(r);
  EXPECT_LE(r.points, honest.points + k_rounding) << "better than honest work: " << all;
  EXPECT_LE(rank(r.verdict), rank(honest.verdict)) << "better than honest work: " << all;
  const bool unfinished = below_critical(t, saw, r);
  const int most = game.fair == Fair::fail || unfinished || saw.fault_opened ? 0
                   : game.fair == Fair::not_pass                             ? 1
                                                                             : 2;
  EXPECT_LE(rank(r.verdict), most) << (saw.fault_opened ? "a fault was opened"
                                       : unfinished     ? "unfinished"
                                                        : "no fair examiner")
                                   << ": " << all;
  std::printf(
      "%-16s %-32s %6.2f %% of the target, %6.2f mm3 beyond, fault %d: %s\n", t.name.c_str(),
      game.name.c_str(), saw.target_percent, saw.beyond_leeway_mm3, saw.fault_opened ? 1 : 0,
      std::getenv("CAVUM_GAMES_TELL") != nullptr ? told(r).c_str() : told(r).substr(0, 30).c_str());
}

TEST_P(Games, HonestWorkPasses) {
  EXPECT_EQ(honest_mark().verdict, grading::Verdict::pass) << told(honest_mark());
  EXPECT_GE(honest_mark().points, 99) << told(honest_mark());
}

TEST_P(Games, NoneIsMarkedBetterThanHonestWorkAndNonePassesThatShouldNot) {
  for (const auto& game : games_of(ground())) judge(ground(), honest_mark(), game);
}

TEST_P(Games, NonePassesWhoseWallsOrFloorAreAMillimetreOff) {
  for (const auto& game : gross_overcuts_of(ground())) judge(ground(), honest_mark(), game);
}

TEST_P(Games, NonePassesWithEveryCanalCovered) {
  if (ground().scenario.perforation.aims.empty()) return;  // no canals to find
  judge(ground(), honest_mark(), lips_over_the_canals(ground()));
}

TEST_P(Games, NoMixtureIsMarkedBetterThanHonestWork) {
  const std::uint64_t seed =
      testing_basics::drawn_seed("Games.NoMixtureIsMarkedBetterThanHonestWork");
  for (const auto& game : mixtures_of(ground(), seed, 4)) judge(ground(), honest_mark(), game);
}

TEST_P(Games, AnUntouchedToothHasNoPoints) {
  Sitting s(ground());
  s.hand_in();
  EXPECT_EQ(s.marked().points, 0) << told(s.marked());
}

/// After each twentieth of honest work.
std::vector<std::pair<Seen, grading::Result>> stopping_early(const Task& t, const Order& order,
                                                             int every) {
  std::vector<std::pair<Seen, grading::Result>> list;
  Sitting s(t);
  for (int k = 1; k <= 20; ++k) {
    s.cut(part_of_target(t, order, k));
    if (k % every != 0) continue;
    Sitting stops(s);
    stops.hand_in();
    list.emplace_back(seen(stops), stops.marked());
  }
  return list;
}

TEST_P(Games, MoreHonestWorkIsNeverMarkedLower) {
  const auto all = orders(ground());
  for (std::size_t o = 0; o < (std::getenv("CAVUM_DEEP") != nullptr ? 3 : 2); ++o) {
    // wall by wall in the four largest every tenth, for time's sake
    const int every =
        std::getenv("CAVUM_DEEP") == nullptr && o == 1 && ground().leaves.size() > 25000 ? 2 : 1;
    const auto list = stopping_early(ground(), all[o], every);
    for (std::size_t k = 0; k < list.size(); ++k) {
      const auto& [saw, r] = list[k];
      const std::string all_of_it = GetParam() + " " + all[o].name + " " +
                                    std::to_string(5 * static_cast<std::size_t>(every) * (k + 1)) +
                                    " %: " + told(r);
      if (std::getenv("CAVUM_GAMES_TELL") != nullptr) std::printf("%s\n", all_of_it.c_str());
      EXPECT_LE(r.points, honest_mark().points + k_rounding) << all_of_it;
      const int most = below_critical(ground(), saw, r)         ? 0
                       : r.progress.finish != Finish::completed ? 1
                                                                : 2;
      EXPECT_LE(rank(r.verdict), most) << saw.target_percent << " % of the target: " << all_of_it;
      if (k == 0) continue;
      const grading::Result& last = list[k - 1].second;
      EXPECT_GE(r.points, last.points - k_rounding)
          << "less than before: " << all_of_it << "\n  before: " << told(last);
      EXPECT_GE(rank(r.verdict), rank(last.verdict))
          << "less than before: " << all_of_it << "\n  before: " << told(last);
      // past a critical line, which the rubric itself draws, an exam may go from fail to pass at
      // once
      bool critical = false;
      for (const auto& c : last.criteria) critical = critical || c.critical_failed;
      EXPECT_LE(rank(r.verdict), rank(last.verdict) + (critical ? 2 : 1))
          << "a cliff: " << all_of_it << "\n  before: " << told(last);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tasks, Games, ::testing::ValuesIn(task_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace cavum::games
