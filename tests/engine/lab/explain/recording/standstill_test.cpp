#include "engine/lab/explain/recording/standstill.h"

#include <gtest/gtest.h>

#include "engine/lab/explain/recording/faults.h"
#include "tests/engine/lab/explain/made_recording.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

/// The rows of the longest stretch of one session, from a quarter to a half of it.
std::pair<Eigen::Index, Eigen::Index> middle_of(const Recording& r, std::size_t session) {
  const auto& s = r.sessions[session];
  return {s.begin + (s.end - s.begin) / 4, s.begin + (s.end - s.begin) / 2};
}

bool says(const std::vector<DataFault>& faults, DataFault::Kind kind) {
  return std::any_of(faults.begin(), faults.end(),
                     [kind](const DataFault& f) { return f.kind == kind; });
}

Recording with_speed() {
  Recording r = made::recording({});
  r.v_mm_s = Series::Zero(r.rows());
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i + 1 < s.end; ++i)
      r.v_mm_s[i] = (r.x_mm[i + 1] - r.x_mm[i - 1]) / (r.t_s[i + 1] - r.t_s[i - 1]);
  return r;
}

TEST(Standstill, ASoundRecordingHasNone) {
  for (const double quantum : {0.0, 0.01, 0.055}) {
    made::Options o;
    o.quantum_mm = quantum;
    const Recording r = made::recording(o);
    EXPECT_TRUE(standstill_faults(r).empty());
    EXPECT_TRUE(jump_faults(r).empty());
    EXPECT_TRUE(swap_faults(r).empty());
  }
  made::Options silent;  // a force of zero in air is no sensor that stands still
  silent.noise_n = 0.0;
  EXPECT_TRUE(standstill_faults(made::recording(silent)).empty());
}

TEST(Standstill, AForceThatKeepsItsValueWhileTheToolMovesIsNamedWithItsSession) {
  Recording r = with_speed();
  const auto [from, to] = middle_of(r, 2);
  for (Eigen::Index i = from; i < to; ++i) r.f_n[i] = 0.123;
  EXPECT_TRUE(says(data_faults(r), DataFault::Kind::stuck_force));
  EXPECT_TRUE(testing_basics::tells(texts_of(data_faults(r)), r.sessions[2].name));
}

TEST(Standstill, APositionThatKeepsItsValueWhileTheSpeedGoesOnIsNamed) {
  Recording r = with_speed();
  const auto [from, to] = middle_of(r, 1);
  for (Eigen::Index i = from; i < to; ++i) r.x_mm[i] = r.x_mm[from];
  EXPECT_TRUE(says(data_faults(r), DataFault::Kind::stuck_position));
}

TEST(Standstill, AClockThatJumpsIsNamedAndMissingRowsAreNot) {
  // at full speed: where the position changes most from row to row
  const Recording sound = made::recording({});
  const auto& s = sound.sessions[1];
  Eigen::Index fast = s.begin + 10;
  for (Eigen::Index i = s.begin + 10; i + 60 < s.end; ++i)
    if (std::fabs(sound.x_mm[i + 4] - sound.x_mm[i - 4]) >
        std::fabs(sound.x_mm[fast + 4] - sound.x_mm[fast - 4]))
      fast = i;
  Recording jumped = sound;
  for (Eigen::Index i = fast; i < s.end; ++i) jumped.t_s[i] += 1.7;
  EXPECT_TRUE(says(data_faults(jumped), DataFault::Kind::clock_jump));
  // the same stretch of time without its rows: each row later by as many
  Recording missing = sound;
  const Eigen::Index lost = 40;
  for (Eigen::Index i = fast; i + lost < s.end; ++i)
    missing.t_s[i] = sound.t_s[i + lost], missing.x_mm[i] = sound.x_mm[i + lost],
    missing.f_n[i] = sound.f_n[i + lost];
  for (Eigen::Index i = s.end - lost; i < s.end; ++i) missing.t_s[i] = missing.t_s[i - 1] + 0.02;
  EXPECT_GT(missing.t_s[fast] - missing.t_s[fast - 1], 0.7);
  EXPECT_TRUE(jump_faults(missing).empty());
}

TEST(Standstill, ColumnsInEachOthersPlaceAreNamed) {
  Recording r = made::recording({});
  std::swap(r.x_mm, r.f_n);
  EXPECT_TRUE(says(data_faults(r), DataFault::Kind::columns_swapped));
}

}  // namespace
}  // namespace cavum::explain
