#include "engine/lab/explain/recording/holds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>

#include "engine/lab/explain/inference/explain.h"
#include "tests/engine/lab/explain/made_recording.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

constexpr double k_quantum_mm = 0.055;

/// Another one at each call, all from the same draw.
std::uint64_t new_seed(const char* what) {
  static Random random(testing_basics::drawn_seed("Holds"));
  const std::uint64_t seed = random.next();
  std::cout << what << ": seed " << seed << "\n";
  return seed;
}

made::Options coarse(std::uint64_t seed, bool one_programme) {
  made::Options o;
  o.quantum_mm = k_quantum_mm;
  o.one_programme = one_programme;
  o.seed = seed;
  return o;
}

/// Places stepped through by hand: 1 s at each of `cells`, 0.02 s in every cell between.
Recording stairs(const std::vector<std::vector<int>>& sessions) {
  Recording r;
  std::vector<double> t, x;
  for (const auto& cells : sessions) {
    const auto begin = static_cast<Eigen::Index>(t.size());
    int at = cells.front();
    const auto row = [&] {
      x.push_back(k_quantum_mm * at);
      t.push_back(0.01 * static_cast<double>(static_cast<Eigen::Index>(t.size()) - begin));
    };
    for (const int cell : cells) {
      for (; at != cell; at += cell > at ? 1 : -1)
        for (int i = 0; i < 2; ++i) row();
      for (int i = 0; i < 100; ++i) row();
    }
    r.sessions.push_back({"s", begin, static_cast<Eigen::Index>(t.size())});
  }
  r.t_s = Eigen::Map<const Series>(t.data(), static_cast<Eigen::Index>(t.size()));
  r.x_mm = Eigen::Map<const Series>(x.data(), static_cast<Eigen::Index>(x.size()));
  return r;
}

TEST(Holds, AreFoundWhereTheToolStands) {
  const Holds h = find_holds(stairs({{-10, 5, 9, 5}, {-10, 5, 9, 5}}), k_quantum_mm);
  ASSERT_EQ(h.holds.size(), 8u);
  ASSERT_EQ(h.positions_mm.size(), 3u);
  EXPECT_NEAR(h.positions_mm[1], 5 * k_quantum_mm, 1e-12);
  for (const auto& hold : h.holds)
    EXPECT_NEAR(static_cast<double>(hold.end - hold.begin), 101.0, 2.0) << hold.begin;
  EXPECT_EQ(h.holds[1].place, 1u);
  EXPECT_EQ(h.holds[2].place, 2u);
  EXPECT_NEAR(h.repeated, 1.0, 1e-12);
}

TEST(Holds, ASlowMotionIsNone) {
  std::vector<int> every;
  for (int i = -10; i < 10; ++i) every.push_back(i);
  EXPECT_LE(find_holds(stairs({every, every}), k_quantum_mm).holds.size(), 4u);  // its ends
}

TEST(Holds, OfDifferentDepthsDoNotRepeat) {
  EXPECT_FALSE(
      find_holds(stairs({{-20, 2, 8}, {-13, 5, 11}, {-17, 3, 14}}), k_quantum_mm).repeat());
  EXPECT_FALSE(
      find_holds(made::recording(coarse(new_seed("depths drawn by session"), false)), k_quantum_mm)
          .repeat());
  EXPECT_TRUE(
      find_holds(made::recording(coarse(new_seed("one programme"), true)), k_quantum_mm).repeat());
}

TEST(Holds, APathOfTheSameProgrammeStandsStillWithinHalfACell) {
  const Recording r = made::recording(coarse(new_seed("programme"), true));
  const Holds h = find_holds(r, k_quantum_mm);
  Random random(new_seed("places"));
  const Series path = replaced_holds(r, r.x_mm, h, k_quantum_mm, random);
  std::vector<double> at(h.positions_mm.size(), std::nan(""));
  for (const auto& hold : h.holds) {
    for (Eigen::Index i = hold.begin; i < hold.end; ++i) ASSERT_EQ(path[i], path[hold.begin]);
    if (std::isnan(at[hold.place])) at[hold.place] = path[hold.begin];
    EXPECT_EQ(path[hold.begin], at[hold.place]) << "a place is the same in all sessions";
    EXPECT_LE(std::fabs(path[hold.begin] - h.positions_mm[hold.place]), 0.5 * k_quantum_mm + 1e-12);
  }
  // elsewhere the way is the old one, shifted by no more than places are, and without jumps of its
  // own
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      EXPECT_LT(std::fabs(path[i] - r.x_mm[i]), 1.01 * k_quantum_mm) << i;
      const double moved =
          i > s.begin ? std::fabs(path[i] - path[i - 1]) - std::fabs(r.x_mm[i] - r.x_mm[i - 1])
                      : 0.0;
      EXPECT_LT(moved, 2.01 * k_quantum_mm) << i;
    }
}

TEST(Holds, ThatRepeatAreNoCause) {
  // the error of rounding is the same in all six sessions; before twins repeated it, too, something
  // was named in every such recording
  int named = 0;
  for (int draw = 0; draw < 3; ++draw) {
    const Explanation e = explain(made::recording(coarse(new_seed("one programme"), true)));
    if (e.verdict == Verdict::clean) continue;
    ++named;
    std::cout << english_text(to_text(e));
  }
  EXPECT_LE(named, 1);
}

TEST(Holds, ThatRepeatDoNotHideFriction) {
  // one recording in a dozen or so is missed (docs/explain.md)
  int found = 0;
  for (int draw = 0; draw < 3; ++draw) {
    const Recording r =
        made::recording(coarse(new_seed("one programme"), true),
                        [](const made::Row& q) { return 0.04 * std::tanh(q.v_mm_s / 0.02); });
    const Explanation e = explain(r);
    const auto is_friction = [](const std::string& name) { return name == "coulomb_friction"; };
    const bool told =
        !e.causes.empty() && (is_friction(mechanism_at(e.causes.front().term.mechanism).name) ||
                              std::any_of(e.causes.front().aliases.begin(),
                                          e.causes.front().aliases.end(), is_friction));
    found += told ? 1 : 0;
    if (!told) std::cout << english_text(to_text(e));
  }
  EXPECT_GE(found, 2);
}

}  // namespace
}  // namespace cavum::explain
