// The station's file of checks: what was changed, cut short or taken out of it.
#include "engine/device/selfcheck/check_history.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "engine/base/hash.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

const CheckedStylus k_stylus{"falcon", "A1"};

class CheckHistoryFile : public ::testing::Test {
 protected:
  void SetUp() override { ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1); }
  void TearDown() override { ::unsetenv("CAVUM_HOME"); }
  [[nodiscard]] std::string path() const { return folder_.file("selfcheck.jsonl"); }
  static ArmFigures figures(double friction_n, std::size_t i) {
    ArmFigures f;
    for (ArmAxis& a : f.axes)
      a = {friction_n + 0.002 * static_cast<double>(i % 3), 0.001, 0.1, 0.01, 0.05};
    f.quantum_mm = 0.02;
    f.rate_hz = 1000;
    return f;
  }
  void learn(std::size_t checks) {
    CheckHistory history(path());
    for (std::size_t i = 0; i < checks; ++i)
      history.add_check(k_stylus, figures(0.3, i), 1000 + static_cast<std::int64_t>(i), key_);
  }
  testing_basics::Folder folder_;
  SigningKey key_ = load_signing_key(folder_.file("station.key"), "station");
};

TEST_F(CheckHistoryFile, IsReadAgainAsItWasWritten) {
  learn(9);
  CheckHistory history(path());
  const CheckVerdict v = history.add_check(k_stylus, figures(0.5, 0), 5000, key_);
  EXPECT_EQ(v.outcome, CheckOutcome::changed);
  const CheckHistory again(path());
  ASSERT_EQ(again.entries().size(), 10U);
  EXPECT_EQ(again.entries().back().verdict.changes.at(0).quantity, "friction");
  EXPECT_EQ(again.entries().back().since_utc_ns, 5000);
  EXPECT_EQ(again.earlier(k_stylus).size(), 9U) << "what changed is not learnt";
  EXPECT_EQ(again.earlier({"falcon", "B2"}).size(), 0U) << "another stylus is another history";
  EXPECT_EQ(again.session_note(k_stylus).find("decision"), std::string::npos);
}

TEST_F(CheckHistoryFile, AChangeStaysSinceItsFirstDayUntilANewHistory) {
  learn(9);
  CheckHistory history(path());
  history.add_check(k_stylus, figures(0.5, 0), 5000, key_);
  history.add_decision(k_stylus, true, "supervisor", "no other station is free", 5001, key_);
  history.add_check(k_stylus, figures(0.5, 0), 6000, key_);
  EXPECT_EQ(history.last_check(k_stylus)->since_utc_ns, 5000);
  EXPECT_FALSE(history.last_decision(k_stylus)) << "it was about the check before";
  history.begin_again(k_stylus, "cables replaced", 7000, key_);
  EXPECT_FALSE(history.last_check(k_stylus));
  EXPECT_EQ(history.add_check(k_stylus, figures(0.5, 0), 8000, key_).outcome,
            CheckOutcome::learning);
}

TEST_F(CheckHistoryFile, TruncatedTrailingLineIsLeftOutAndWrittenOver) {
  learn(3);
  std::string text = read_text_file(path());
  write_text_file(path(), text.substr(0, text.size() - 40));
  CheckHistory history(path());
  EXPECT_EQ(history.entries().size(), 2U);
  history.add_check(k_stylus, figures(0.3, 0), 9000, key_);
  EXPECT_EQ(CheckHistory(path()).entries().size(), 3U);
}

TEST_F(CheckHistoryFile, EveryChangedByteIsFound) {
  learn(3);
  const std::string text = read_text_file(path());
  std::mt19937_64 random(testing_basics::drawn_seed("CheckHistoryFile"));
  for (int i = 0; i < 200; ++i) {
    std::string changed = text;
    const std::size_t at = random() % (text.size() - 1);
    changed[at] = changed[at] == '1' ? '2' : '1';
    write_text_file(path(), changed);
    if (changed[at] == '\n' || text[at] == '\n') continue;
    EXPECT_THROW(CheckHistory{path()}, Error) << at;
  }
}

TEST_F(CheckHistoryFile, ALineThatWasTakenOutIsFound) {
  learn(3);
  const std::string text = read_text_file(path());
  const std::size_t first = text.find('\n') + 1, second = text.find('\n', first) + 1;
  write_text_file(path(), text.substr(0, first) + text.substr(second));
  EXPECT_EQ(testing_basics::code_of([&] { CheckHistory history(path()); }), FileError::damaged);
}

TEST_F(CheckHistoryFile, AnotherProgramThatAddedMeanwhileIsNotWrittenOver) {
  learn(2);
  CheckHistory one(path()), two(path());
  one.add_check(k_stylus, figures(0.3, 0), 9000, key_);
  EXPECT_EQ(testing_basics::code_of([&] { two.add_check(k_stylus, figures(0.3, 0), 9001, key_); }),
            FileError::inconsistent);
  EXPECT_EQ(CheckHistory(path()).entries().size(), 3U);
}

TEST_F(CheckHistoryFile, TheStationSaysItsName) {
  EXPECT_EQ(station_name(key_), "station " + to_hex(key_.public_key).substr(0, 8));
  set_station_name("Seat 3");
  EXPECT_EQ(station_name(key_), "Seat 3");
  for (const std::string& bad : {std::string("two\nlines"), std::string(61, 'a')})
    EXPECT_THROW(set_station_name(bad), Error) << bad;
  learn(1);
  EXPECT_EQ(CheckHistory(path()).entries().back().station, "Seat 3");
}

TEST_F(CheckHistoryFile, ANewHistoryNeedsAReason) {
  CheckHistory history(path());
  EXPECT_EQ(testing_basics::code_of([&] { history.begin_again(k_stylus, "", 1, key_); }),
            FileError::missing);
}

}  // namespace
}  // namespace cavum
