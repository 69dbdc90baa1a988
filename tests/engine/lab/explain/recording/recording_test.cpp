#include "engine/lab/explain/recording/recording.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/lab/explain/recording/faults.h"
#include "tests/engine/lab/explain/made_recording.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

using testing_basics::code_of, testing_basics::place_of, testing_basics::tells,
    testing_basics::thrown_by;

bool has_fault(const Recording& r, DataFault::Kind kind) {
  const auto faults = data_faults(r);
  return std::any_of(faults.begin(), faults.end(),
                     [kind](const DataFault& f) { return f.kind == kind; });
}

TEST(Recording, KeepsSessionsKnownAndUnknownColumnsAndNumbersWords) {
  const Recording r = parse_recording(
      "# note\nsession,t_s,x_mm,f_n,bur_id,humidity\na,0,1,2,old,40\na,0.1,1.5,2.5,old,41\nb,0,1,2,new,\n",
      "r.csv");
  ASSERT_EQ(r.sessions.size(), 2u);
  EXPECT_EQ(r.sessions[1].begin, 2);
  EXPECT_EQ((*r.column("bur_id"))[2], 1.0);
  EXPECT_EQ((*r.column("humidity"))[2], 41.0);  // missing: the last one
  EXPECT_EQ(r.notes.size(), 1u);
  EXPECT_EQ(r.column("wet"), nullptr);
}

TEST(Recording, ColumnsOfOtherNamesAreMapped) {
  const Recording r = parse_recording("time;way;load\n0;1;2\n1;2;3\n", "r.csv",
                                      {{"t_s", "time"}, {"x_mm", "way"}, {"f_n", "load"}});
  EXPECT_EQ(r.x_mm[1], 2.0);
  EXPECT_EQ(r.sessions.size(), 1u);
}

TEST(Recording, ErrorsNameLineAndColumn) {
  const struct {
    const char* csv;
    FileError code;
    std::vector<const char*> tells;
    ColumnNames names = {};
  } cases[] = {
      {"session,t_s,x_mm\n", FileError::missing, {"f_n"}},
      {"t_s,x_mm,f_n\n0,1,2\n1,nan,2\n", FileError::malformed, {"r.csv:3", "nan", "x_mm"}},
      {"t_s,x_mm,f_n\n0,1\n", FileError::inconsistent, {"r.csv:2"}},
      {"session,t_s,x_mm,f_n\na,0,1,2\nb,0,1,2\na,1,1,2\n", FileError::inconsistent, {"a"}},
      {"", FileError::missing, {"r.csv"}},
      {"t_s,x_mm,f_n\n0,1,2\n", FileError::missing, {"speed"}, {{"v_mm_s", "speed"}}},
  };
  for (const auto& c : cases) {
    const auto error =
        thrown_by([&] { static_cast<void>(parse_recording(c.csv, "r.csv", c.names)); });
    EXPECT_EQ(code_of(error), c.code) << c.csv;
    for (const char* name : c.tells)
      EXPECT_TRUE(tells(error, name) || place_of(error) == name) << c.csv << ": " << name;
  }
}

TEST(Recording, RigFileIsStrict) {
  const Rig rig = parse_rig("k_n_per_mm = 0.8\nposition_quantum_mm = 0.055\n", "rig.toml");
  EXPECT_EQ(*rig.k_n_per_mm, 0.8);
  EXPECT_FALSE(rig.c_n_s_per_mm);
  EXPECT_THROW(static_cast<void>(parse_rig("k = 0.8\n", "rig.toml")), Error);
  EXPECT_THROW(static_cast<void>(parse_rig("k_n_per_mm = -1\n", "rig.toml")), Error);
}

TEST(Faults, ASoundRecordingHasNone) { EXPECT_TRUE(data_faults(made::recording({})).empty()); }

TEST(Faults, ShuffledAndRepeatedTimeStamps) {
  Recording r = made::recording({});
  std::swap(r.t_s[100], r.t_s[101]);
  EXPECT_TRUE(has_fault(r, DataFault::Kind::time_stamps));
  r = made::recording({});
  r.t_s[100] = r.t_s[99];
  EXPECT_TRUE(has_fault(r, DataFault::Kind::time_stamps));
}

TEST(Faults, TheUnitOfTimeIsJudgedByTheRowsThatTellIt) {
  Recording r = made::recording({});
  r.t_s *= 1e3;
  EXPECT_TRUE(has_fault(r, DataFault::Kind::time_base));
  r.t_s /= 1e9;
  EXPECT_TRUE(has_fault(r, DataFault::Kind::time_base));
  // a hold written in wide steps after a quick ramp, on average more than a second apart
  Recording uneven;
  for (const double t :
       {0.0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0})
    uneven.t_s.conservativeResize(uneven.t_s.size() + 1), uneven.t_s[uneven.t_s.size() - 1] = t;
  uneven.x_mm = (1.0 - (-uneven.t_s).exp()).eval();
  uneven.f_n = uneven.x_mm;
  uneven.sessions = {{"1", 0, uneven.t_s.size()}};
  EXPECT_FALSE(has_fault(uneven, DataFault::Kind::time_base));
  // packets: of two rows one comes a microsecond after the other
  Recording packets = made::recording({});
  for (const auto& s : packets.sessions)
    for (Eigen::Index i = s.begin; i + 1 < s.end; i += 2)
      packets.t_s[i + 1] = packets.t_s[i] + 1e-6;
  EXPECT_FALSE(has_fault(packets, DataFault::Kind::time_base));
}

TEST(Faults, SpeedThatDoesNotIntegrateToThePosition) {
  Recording r = made::recording({});
  r.v_mm_s = Series::Zero(r.rows());
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i + 1 < s.end; ++i)
      r.v_mm_s[i] = (r.x_mm[i + 1] - r.x_mm[i - 1]) / (r.t_s[i + 1] - r.t_s[i - 1]);
  EXPECT_TRUE(data_faults(r).empty());
  Recording slow = r;
  slow.t_s *= 1.05;
  EXPECT_TRUE(has_fault(slow, DataFault::Kind::time_base));
  Recording metres = r;
  metres.x_mm *= 1e-3;
  EXPECT_TRUE(has_fault(metres, DataFault::Kind::units));
  metres.v_mm_s *= 1e-3;  // both: the rig's stiffness tells
  EXPECT_TRUE(has_fault(metres, DataFault::Kind::units));
}

TEST(Faults, ClippedForce) {
  Recording r = made::recording({});
  r.f_n = r.f_n.min(0.4);
  EXPECT_TRUE(has_fault(r, DataFault::Kind::clipped));  // the plateau is exact
  r = made::recording({});
  r.rig.force_limit_n = 0.4;
  r.f_n = r.f_n.min(0.4);
  EXPECT_TRUE(has_fault(r, DataFault::Kind::clipped));
}

}  // namespace
}  // namespace cavum::explain
