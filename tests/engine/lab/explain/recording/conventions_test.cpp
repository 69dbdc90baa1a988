#include "engine/lab/explain/recording/conventions.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/lab/explain/recording/overview.h"
#include "tests/engine/lab/explain/made_recording.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

std::string proposed(const Recording& r) {
  std::string out;
  for (const Doubt& d : judge_conventions(r).doubts)
    if (d.clear) out += (out.empty() ? "" : " ") + d.options;
  return out;
}

/// With the speed of the positions.
Recording with_speed(Recording r) {
  r.v_mm_s = Series::Zero(r.rows());
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i + 1 < s.end; ++i)
      r.v_mm_s[i] = (r.x_mm[i + 1] - r.x_mm[i - 1]) / (r.t_s[i + 1] - r.t_s[i - 1]);
  return r;
}

TEST(Conventions, ASoundRecordingRaisesNone) {
  for (const bool one_way : {false, true}) {
    made::Options o;
    o.one_way = one_way;
    const Recording r = made::recording(o);
    EXPECT_TRUE(judge_conventions(r).doubts.empty());
    ASSERT_TRUE(judge_conventions(r).contact);
    EXPECT_NEAR(judge_conventions(r).contact->at_mm, 0.0, 0.02);
    EXPECT_EQ(judge_conventions(r).contact->towards, 1);
  }
}

TEST(Conventions, CompressionThatIsNegativeIsToldWithItsOption) {
  Recording r = made::recording({});
  r.f_n = -r.f_n;
  EXPECT_EQ(proposed(r), "--negate f");
  EXPECT_THROW(static_cast<void>(require_conventions(r, "r.csv")), Error);
  const Facts as_it_is = require_conventions(r, "r.csv", true);
  EXPECT_TRUE(as_it_is.size() == 1 && testing_basics::tells(words_of(as_it_is), "--negate f"))
      << "the user's word goes before ours, and is not forgotten";
}

TEST(Conventions, APositionThatGrowsOutOfTheMaterialIsToldWithItsSpeed) {
  Recording r = with_speed(made::recording({}));
  r.x_mm = -r.x_mm;
  EXPECT_EQ(proposed(r), "--negate x") << "the speed is right as it is";
  r.v_mm_s = -r.v_mm_s;
  EXPECT_EQ(proposed(r), "--negate x --negate v");
  r.f_n = -r.f_n;
  EXPECT_EQ(proposed(r), "--negate f --negate x --negate v");
}

TEST(Conventions, ASpeedAgainstThePositionIsTold) {
  Recording r = with_speed(made::recording({}));
  r.v_mm_s = -r.v_mm_s;
  EXPECT_EQ(proposed(r), "--negate v");
}

TEST(Conventions, AMachinesPositionIsToldWithItsSurface) {
  Recording r = made::recording({});
  r.x_mm += 37.4;
  const std::string options = proposed(r);
  ASSERT_TRUE(options.starts_with("--surface-mm 37.")) << options;
  EXPECT_NEAR(std::stod(options.substr(13)), 37.4, 0.1);
  r.x_mm = -r.x_mm;
  EXPECT_TRUE(proposed(r).starts_with("--negate x --surface-mm -37."))
      << proposed(r) << ": in the file's positions, before the sign";
}

TEST(Conventions, AirAloneIsNotRefused) {
  // a joint in air: friction, inertia, and a weight that goes with the place, of either sign
  for (const double weight : {1.0, -1.0}) {
    made::Options o;
    Recording r = made::recording(o);
    Series v = with_speed(r).v_mm_s;
    r.x_mm += 40.0;
    for (Eigen::Index i = 0; i < r.rows(); ++i)
      r.f_n[i] = weight * std::sin(0.5 * r.x_mm[i]) + 0.3 * (v[i] > 0.0 ? 1.0 : -1.0) +
                 0.01 * std::sin(77.0 * static_cast<double>(i));
    EXPECT_EQ(proposed(r), "");
    for (Eigen::Index i = 0; i < r.rows(); ++i)
      r.f_n[i] = 0.02 * std::sin(77.0 * static_cast<double>(i));
    EXPECT_EQ(proposed(r), "");
  }
}

TEST(Conventions, ContactFromTheStartIsNotRefused) {
  Recording r = made::recording({});
  r.x_mm = r.x_mm.max(0.0) + 0.05;
  r.f_n = 0.8 * r.x_mm;
  EXPECT_EQ(proposed(r), "");
}

TEST(Conventions, AForceThatNoHandReachesIsADoubtAndNoRefusal) {
  Recording r = made::recording({});
  r.f_n *= 1000.0;
  r.rig = {};
  const Facts notes = require_conventions(r, "r.csv");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(testing_basics::tells(words_of(notes), "--unit f=mN or --unit f=gf"));
  r.rig.k_n_per_mm = 800.0;
  EXPECT_TRUE(require_conventions(r, "r.csv").empty()) << "a rig that says so";
}

TEST(Conventions, OptionsPutThemRight) {
  const Recording right = made::recording({});
  std::string table = "session,t_s,z_mm,f_n\n";
  for (const auto& s : right.sessions)
    for (Eigen::Index i = s.begin; i < s.end; ++i)
      table += s.name + "," + std::to_string(right.t_s[i]) + "," +
               std::to_string(37.4 - right.x_mm[i]) + "," + std::to_string(-right.f_n[i]) + "\n";
  ReadingOptions options;
  options.negate = {"x", "f"};
  options.surface_mm = 37.4;
  const Recording r = parse_recording_as(table, "r.csv", options);
  EXPECT_LT((r.x_mm - right.x_mm).abs().maxCoeff(), 2e-6);
  EXPECT_LT((r.f_n - right.f_n).abs().maxCoeff(), 2e-6);
  EXPECT_EQ(proposed(r), "");
  options.negate = {"x", "w"};
  EXPECT_THROW(static_cast<void>(parse_recording_as(table, "r.csv", options)), Error);
  options.negate = {"v"};
  EXPECT_THROW(static_cast<void>(parse_recording_as(table, "r.csv", options)), Error)
      << "there is no speed to negate";
}

TEST(Overview, SaysWhatWasUnderstood) {
  std::string table = "Rig 7\nsession;time_ms;Weg [mm];Fz [mN]\n";
  for (int i = 0; i < 400; ++i)
    table += std::string(i < 200 ? "a;" : "b;") + std::to_string(5 * i) + ";" +
             std::to_string(i % 200 - 100) + ",5;" +
             std::to_string(10 * std::max(0, i % 200 - 100)) + "\n";
  const Overview o = overview_of(parse_recording(table, "r.csv"));
  EXPECT_EQ(o.rows, 400);
  ASSERT_EQ(o.sessions.size(), 2U);
  EXPECT_EQ(o.sessions[1].rows, 200);
  EXPECT_NEAR(o.rate_hz, 200.0, 1e-6);
  EXPECT_EQ(o.separator, "semicolon");
  EXPECT_EQ(o.decimal, "comma");
  EXPECT_EQ(o.lines_before, 1U);
  ASSERT_EQ(o.columns.size(), 3U);
  EXPECT_EQ(o.columns[2].header, "Fz [mN]");
  EXPECT_EQ(o.columns[2].factor, 1e-3);
  EXPECT_NEAR(o.columns[2].high, 0.99, 1e-9);
}

}  // namespace
}  // namespace cavum::explain
