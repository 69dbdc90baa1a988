// `cavum devices --self-check` as a user runs it, on the simulated stylus that nobody holds; and
// when a station asks for one.
#include <gtest/gtest.h>

#include <string>

#include "engine/base/file.h"
#include "tests/ui/program.h"
#include "ui/parts/self_check.h"

namespace cavum::ui {
namespace {

using nlohmann::json;
using testing_ui::Ran;

class SelfCheckVerb : public testing_ui::Program {
 protected:
  [[nodiscard]] std::string history() const { return path("home/selfcheck.jsonl"); }
};

TEST_F(SelfCheckVerb, LearnsThenFindsNothingThenBeginsAnewWithAReason) {
  const std::string check = "devices --self-check --stylus simulated";
  json last = run_json(check + " --station-name 'Seat 3'");
  EXPECT_EQ(last["station"], "Seat 3");
  EXPECT_EQ(last["verdict"]["outcome"], "learning");
  EXPECT_NEAR(last["figures"]["friction_n"], 0.26, 0.02)
      << "that of the simulated Omni, and what is viscous";
  EXPECT_NEAR(last["figures"]["axes"]["z"]["mass_kg"], 0.045, 0.003);
  EXPECT_NEAR(last["figures"]["quantum_mm"], 0.055, 1e-9);
  for (int i = 0; i < 8; ++i) last = run_json(check);
  EXPECT_EQ(last["verdict"]["outcome"], "unchanged");
  EXPECT_EQ(last["verdict"]["compared"], 8);
  expect_refused(check + " --new-history ''", {"--new-history"});
  EXPECT_EQ(run_json(check + " --new-history 'another cable'")["verdict"]["outcome"], "learning");
  EXPECT_EQ(run_json("devices --self-check --history")["entries"].size(), 11U);
  EXPECT_NE(run("devices --self-check --history").out.find("another cable"), std::string::npos);
}

TEST_F(SelfCheckVerb, SaysWhatIsMissingOrDamaged) {
  expect_refused("devices --self-check", {"--self-check"});
  expect_refused("devices --self-check --stylus simulated --override-check 'all is well'", {});
  expect_refused("devices --self-check --stylus mouse", {"mouse"});
  static_cast<void>(run_json("devices --self-check --stylus simulated"));
  std::string text = read_text_file(history());
  text[text.find("friction_n") + 13] = '9';
  write_text_file(history(), text);
  expect_refused("devices --self-check --stylus simulated", {"selfcheck.jsonl:1"});
}

TEST_F(SelfCheckVerb, AStationAsksForOneWhenTheLastIsOldOrUndecided) {
  const std::int64_t hour = 3'600'000'000'000;
  const CheckedStylus stylus{"falcon", "A1"};
  const SigningKey key = load_station_key(station_key_path());
  CheckHistory kept(history());
  EXPECT_TRUE(needs_check(kept, stylus, 12, 100 * hour)) << "none was made";
  ArmFigures f;
  for (ArmAxis& a : f.axes) a = {0.3, 0.001, 0.1, 0.01, 0.0};
  kept.add_check(stylus, f, 100 * hour, key);
  EXPECT_FALSE(needs_check(kept, stylus, 12, 111 * hour));
  EXPECT_TRUE(needs_check(kept, stylus, 12, 113 * hour));
  EXPECT_TRUE(needs_check(kept, stylus, 12, 99 * hour))
      << "it comes from the future: the clock was set";
  EXPECT_TRUE(needs_check(kept, {"falcon", "B2"}, 12, 101 * hour)) << "another stylus";
  f.doubt = msg("a hand is on it");
  kept.add_check(stylus, f, 102 * hour, key);
  EXPECT_TRUE(needs_check(kept, stylus, 12, 102 * hour));
  kept.add_decision(stylus, false, "supervisor", "", 102 * hour, key);
  EXPECT_TRUE(needs_check(kept, stylus, 12, 102 * hour));
  kept.add_decision(stylus, true, "supervisor", "", 103 * hour, key);
  EXPECT_FALSE(needs_check(kept, stylus, 12, 103 * hour));
}

}  // namespace
}  // namespace cavum::ui
