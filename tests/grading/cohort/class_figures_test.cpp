#include "grading/cohort/class_figures.h"

#include <gtest/gtest.h>

#include "engine/base/file_error.h"
#include "grading/cohort/simulated_class.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/records/school.h"

namespace cavum::cohort {
namespace {

using namespace testing_basics;
using nlohmann::json;
using testing_ledger::School;

records::FiledSession session(std::uint64_t seq, const std::string& candidate, double first,
                              double second, const std::string& verdict = "pass",
                              const std::string& station = "aa") {
  records::FiledSession s;
  s.seq = s.result_seq = seq;
  s.candidate = candidate;
  s.scenario_id = "exam";
  s.station_key = station;
  s.result = nlohmann::json{
      {"verdict", verdict},
      {"score",
       {{"points", first + second},
        {"max", 100.0},
        {"pass_percent", 60.0},
        {"borderline_percent", 2.0}}},
      {"criteria",
       json::array({{{"id", "a"}, {"metric", "dice"}, {"points", first}, {"max", 60.0}},
                    {{"id", "b"}, {"metric", "time_s"}, {"points", second}, {"max", 40.0}}})}};
  s.filed = s.result;
  return s;
}

records::Registry four() {
  records::Registry r;
  r.sessions = {session(1, "C-1", 60, 40), session(2, "C-2", 30, 20, "fail"),
                session(3, "C-3", 45, 30), session(4, "C-4", 15, 10, "review")};
  return r;
}

TEST(ClassFigures, AreThoseDoneByHand) {
  const ClassFigures f = class_figures(four(), "exam", {}, 3);
  EXPECT_EQ(f.n, 4u);
  EXPECT_EQ(f.pass, 2u);
  EXPECT_EQ(f.review, 1u);
  EXPECT_EQ(f.fail, 1u);
  EXPECT_NEAR(f.mean, 62.5, 1e-12);
  EXPECT_NEAR(f.sd, 32.2749, 1e-4) << "100, 50, 75, 25";
  EXPECT_EQ(f.pass_points, 60.0);
  ASSERT_EQ(f.criteria.size(), 2u);
  EXPECT_NEAR(f.criteria[0].difficulty, 150.0 / 240, 1e-12);
  EXPECT_NEAR(*f.criteria[0].discrimination, 1.0, 1e-12);
  // variances 375 and 166.667, of the sum 1041.667
  EXPECT_NEAR(*f.alpha, 2 * (1 - (375 + 166.6667) / 1041.6667), 1e-5);
  EXPECT_NEAR(*f.sem, 32.2749 * std::sqrt(1 - *f.alpha), 1e-3);
  ASSERT_EQ(f.to_look_at.size(), 1u);
  EXPECT_EQ(f.to_look_at[0].session, 4u);
  EXPECT_FALSE(f.station_effect);
}

TEST(ClassFigures, TheLastAttemptCountsAndWhatDoesNotHoldDoesNot) {
  records::Registry r = four();
  r.sessions.push_back(session(5, "C-4", 60, 40));
  r.sessions.push_back(session(6, "C-5", 0, 0, "fail"));
  r.sessions.back().findings = {records::finding<records::FindingKind::file_changed>("changed")};
  r.sessions.push_back(session(7, "C-6", 60, 40));
  r.sessions.back().scenario_id = "another";
  const ClassFigures f = class_figures(r, "exam", {}, 3);
  EXPECT_EQ(f.n, 4u);
  EXPECT_EQ(f.points, (std::vector<double>{50, 75, 100, 100}));
  EXPECT_THROW(static_cast<void>(class_figures(r, "nobody's", {}, 3)), Error);
}

TEST(ClassFigures, WhoPerforatedWasFiledWithFindingsOrWasSimulatedAmongPeopleIsToBeLookedAt) {
  records::Registry r = four();
  const auto why_of = [](const ClassFigures& f, std::uint64_t seq) {
    std::vector<Message> all;
    for (const auto& l : f.to_look_at)
      if (l.session == seq) all.push_back(l.why);
    return all;
  };
  r.sessions[0].result.change()["perforation"] = {
      {"truth", {{"perforated", true}, {"first_t_s", 12.34}, {"tissue", "pulp"}}},
      {"aim", {{"perforated", false}}}};
  r.sessions[1].result.change()["perforation"] = {
      {"truth", {{"perforated", false}, {"tissue", nullptr}}},
      {"aim", {{"perforated", true}, {"tissue", "pulp"}}}};
  r.sessions.push_back(session(5, "C-5", 60, 40));
  r.sessions.back().findings = {
      records::finding<records::FindingKind::recording_unsound>("the chain breaks at second 7"),
      records::finding<records::FindingKind::recording_unsound>("another")};
  r.sessions[2].simulated = "expert";
  const ClassFigures f = class_figures(r, "exam", {}, 3);
  EXPECT_EQ(f.n, 4u);
  for (const auto& [entry, reasons] : {std::pair(1, 1u), {2, 0u}, {0, 1u}, {4, 1u}, {5, 1u}})
    EXPECT_EQ(why_of(f, static_cast<std::uint64_t>(entry)).size(), reasons)
        << entry << ": what a task aims at is no fault";
  EXPECT_TRUE(tells(why_of(f, 1), "pulp") && tells(why_of(f, 1), 12.34)) << "although it passed";
  EXPECT_EQ(figures_in(why_of(f, 0).at(0)), (std::vector<double>{1, 4}))
      << "simulated among people";
  EXPECT_TRUE(tells(why_of(f, 5), "the chain breaks at second 7") && tells(why_of(f, 5), 1))
      << "and another";
  EXPECT_TRUE(tells(to_text(f), 1));
  for (auto& s : r.sessions) s.simulated = "expert";
  EXPECT_TRUE(why_of(class_figures(r, "exam", {}, 3), 0).empty())
      << "a class of simulated ones alone is not mixed";
}

TEST(ClassFigures, FromFewAreCalledRough) {
  const auto of_n = [](std::size_t n) {
    records::Registry r;
    std::vector<HumanMark> marks;
    for (std::size_t i = 0; i < n; ++i) {
      const auto points = static_cast<double>(i % 10);
      r.sessions.push_back(
          session(i + 1, "C-" + std::to_string(i), 20 + 4 * points, 10 + 2 * points));
      marks.push_back({"C-" + std::to_string(i), "x", 31 + 6 * points, 1 + points / 2});
    }
    return class_figures(r, "exam", marks, 3);
  };
  const auto named = [](const ClassFigures& f) {
    std::vector<std::string> names;
    for (const auto& few : f.few) names.push_back(few.figure);
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(named(of_n(17)), (Names{"alpha", "standard_error", "discrimination", "icc", "limits",
                                    "weighted_kappa", "borderline_cut"}));
  EXPECT_EQ(named(of_n(18)), (Names{"alpha", "standard_error", "discrimination", "icc", "limits",
                                    "borderline_cut"}));
  EXPECT_EQ(named(of_n(30)), (Names{"borderline_cut"}));
  EXPECT_EQ(named(of_n(50)), Names{});
  const ClassFigures f = of_n(17);
  EXPECT_EQ(figures_in(few_words(f, "alpha")), (std::vector<double>{17, 30}));
  EXPECT_TRUE(few_words(of_n(50), "alpha").empty());
  EXPECT_TRUE(tells(to_text(f), few_words(f, "weighted_kappa")));
  EXPECT_EQ(to_json(f)["few"][0], (json{{"figure", "alpha"}, {"n", 17}, {"enough", 30}}));
}

TEST(ClassFigures, ARegradeOutOfAnotherMaximumCountsOnTheScaleOfTheClass) {
  records::Registry r = four();
  r.sessions[0].result.change()["score"] = {
      {"points", 15.0}, {"max", 30.0}, {"pass_percent", 40.0}, {"borderline_percent", 0.0}};
  const ClassFigures f = class_figures(r, "exam", {}, 3);
  EXPECT_EQ(f.max_points, 100.0);
  EXPECT_EQ(f.points, (std::vector<double>{25, 50, 50, 75})) << "15 of 30 are 50 of 100";
}

/// Entered as `seq` with the rubric of hash `rubric`, by another pass mark.
void regrade(records::FiledSession& s, std::uint64_t seq, double pass_percent,
             const std::string& rubric) {
  s.result.change()["score"]["pass_percent"] = pass_percent;
  s.result_seq = seq;
  s.regrades.push_back({seq, 0, "misprinted", "", {{"rubric.toml", rubric}}, s.result});
}

TEST(ClassFigures, ThePassMarkIsTheOneByWhichTheResultsWereMarked) {
  records::Registry r = four();
  std::uint64_t seq = 10;
  for (auto& s : r.sessions) regrade(s, seq++, 70, "aa");
  std::vector<HumanMark> marks;
  for (const auto& s : r.sessions) marks.push_back({s.candidate, "x", 65, {}});
  const ClassFigures all = class_figures(r, "exam", marks, 3);
  EXPECT_EQ(all.pass_points, 70.0);
  EXPECT_TRUE(marked_by_words(all.marked_by).empty()) << "all alike";
  EXPECT_TRUE(tells(to_text(all), 70.0));
  EXPECT_EQ(to_json(all)["points"]["pass"], 70.0);

  records::Registry mixed = four();
  regrade(mixed.sessions[1], 12, 70, "aa");
  // a person decided on top of the regrade: it was marked by the same
  mixed.sessions[1].regrades.push_back(
      {15, 0, "seen", "Dr. Weber", {{"rubric.toml", "aa"}}, mixed.sessions[1].result});
  mixed.sessions[1].result_seq = 15;
  // and on the first mark of another: that is as it was sat
  mixed.sessions[2].regrades.push_back({16, 0, "seen", "Dr. Weber", {}, mixed.sessions[2].result});
  mixed.sessions[2].result_seq = 16;
  const ClassFigures f = class_figures(mixed, "exam", marks, 3);
  EXPECT_FALSE(f.pass_points);
  EXPECT_FALSE(f.agreement.kappa) << "bands around no cut";
  EXPECT_TRUE(f.agreement.limits) << "needs none";
  EXPECT_EQ(figures_in(marked_by_words(f.marked_by)), (std::vector<double>{3, 60, 1, 12, 70}))
      << "three as it was sat, one by that of entry 12";
  EXPECT_TRUE(tells(to_text(f), marked_by_words(f.marked_by)));
  EXPECT_TRUE(to_json(f)["points"]["pass"].is_null());

  records::Registry same_mark = four();
  regrade(same_mark.sessions[1], 12, 60, "aa");
  const ClassFigures told = class_figures(same_mark, "exam", marks, 3);
  EXPECT_EQ(told.pass_points, 60.0);
  EXPECT_EQ(figures_in(marked_by_words(told.marked_by)), (std::vector<double>{3, 60, 1, 12, 60}));
}

TEST(ClassFigures, AStationHasItsNameInTheLedger) {
  records::Registry r = four();
  const std::string first(64, 'a'), second(64, 'b'), third(64, 'c'), unknown(64, 'd');
  r.stations.stations = {{1, "Seat 1", first, 0, 0, {}, {}, {}},
                         {2, "Seat 2", second, 0, 0, {}, {}, {}},
                         {3, "Seat 2", third, 0, 0, {}, {}, {}}};
  EXPECT_EQ(station_label(r, first), "Seat 1");
  EXPECT_EQ(station_label(r, second), "Seat 2 (bbbbbbbb…)") << "two have this name";
  EXPECT_EQ(station_label(r, unknown), "dddddddd…");
  for (std::size_t i = 0; i < r.sessions.size(); ++i)
    r.sessions[i].station_key = i % 2 == 0 ? first : unknown;
  const ClassFigures f = class_figures(r, "exam", {}, 3);
  ASSERT_EQ(f.stations.size(), 2u);
  EXPECT_EQ(f.stations[0].name, "Seat 1");
  EXPECT_EQ(f.stations[1].name, "dddddddd…");
  EXPECT_TRUE(tells(to_text(f), "Seat 1"));
  EXPECT_EQ(english_text(to_text(f)).find(first), std::string::npos);
}

TEST(ClassFigures, AHarderStationIsFound) {
  records::Registry r;
  for (int i = 0; i < 40; ++i)
    r.sessions.push_back(session(static_cast<std::uint64_t>(i), "C-" + std::to_string(i),
                                 30 + i % 7 - (i % 2 ? 12 : 0), 20, "pass", i % 2 ? "bb" : "aa"));
  const ClassFigures f = class_figures(r, "exam", {}, 3);
  ASSERT_EQ(f.stations.size(), 2u);
  EXPECT_LT(f.station_effect->chance, 0.001);
  EXPECT_GT(f.stations[0].mean, f.stations[1].mean + 8);
}

TEST(ClassFigures, PeoplesMarksAreHeldAgainstTheProgram) {
  const School school;
  records::Identities identities(school.places().identities());
  const std::string by_number = identities.enrol("4711", "", "exam", School::key());
  records::Registry r = four();
  r.sessions[0].candidate = by_number;
  const auto marks = parse_marks(
      "candidate,judge,points,rating\n4711,x,98,5\nC-2,x,48,3\nC-3,x,73,4\nC-4,x,23,1\n4711,y,102,\nC-2,y,52,\nC-3,y,77,\nC-4,y,27,\nunknown,x,5,\n",
      identities, "exam", "marks.csv", 200);
  ASSERT_EQ(marks.size(), 9u);
  EXPECT_EQ(marks[0].candidate, by_number);
  const ClassFigures f = class_figures(r, "exam", marks, 3);
  EXPECT_EQ(f.agreement.n, 4u);
  EXPECT_EQ(f.agreement.judges, 2u);
  ASSERT_FALSE(f.to_look_at.empty());
  EXPECT_EQ(f.to_look_at[0].candidate, "unknown") << "marked, and never sat";
  EXPECT_NEAR(f.agreement.limits->bias, 0.0, 1e-12);
  EXPECT_GT(f.agreement.icc->single_random, 0.99);
  EXPECT_NEAR(*f.agreement.kappa, 1.0, 1e-12);
  // ratings 5 3 4 1, points 100 50 75 25: slope 148.75/8.75·... by hand 18.571, through 3.25
  // and 62.5
  EXPECT_NEAR(*f.agreement.cut, 62.5 - 0.25 * 162.5 / 8.75, 1e-9);
  for (const double beyond : {0.9, 5.1, 99.0})
    EXPECT_FALSE(class_figures(r, "exam", marks, beyond).agreement.cut)
        << beyond << ", of ratings 1 to 5";
}

TEST(ClassFigures, MarksThatAreNoneAreNamedWithTheirLine) {
  const School school;
  records::Identities identities(school.places().identities());
  const std::string head = "candidate,judge,points";
  const struct {
    std::string text;
    FileError code;
    Value tells;
  } cases[] = {
      {"name,points\n", FileError::malformed, FileLocation{"m.csv", 1, 0}},
      {head + "\nC-1,x,12,5\n", FileError::inconsistent, Name{"m.csv"}},
      {head + "\nC-1,x,\"12,5\"\n", FileError::wrong_type, Name{"12,5"}},
      {head + "\nC-1,x,12\nC-1,x,13\n", FileError::duplicate, FileLocation{"m.csv", 3, 0}},
      {head + "\nC-1,,12\n", FileError::missing, FileLocation{"m.csv", 2, 0}},
      {head + "\nC-1,x,-1\n", FileError::out_of_range, FileLocation{"m.csv", 2, 0}},
      {head + "\nC-1,x,20\nC-2,x,20.5\n", FileError::out_of_range, FileLocation{"m.csv", 3, 0}},
      {head + ",rating\nC-1,x,20,?\n", FileError::wrong_type, Name{"?"}},
      {head + "\nC-1,x,nan\n", FileError::wrong_type, Name{"nan"}},
      {head + "\n", FileError::missing, Name{"m.csv"}},
  };
  for (const auto& c : cases) {
    const auto error =
        thrown_by([&] { static_cast<void>(parse_marks(c.text, identities, "exam", "m.csv", 20)); });
    EXPECT_EQ(code_of(error), c.code) << c.text;
    EXPECT_TRUE(tells(error, c.tells)) << c.text;
  }
}

TEST(SimulatedClass, SitsIsFiledAndIsTheSameAgain) {
  const auto sit = [](const School& school, int at_once) {
    records::Ledger ledger = school.ledger();
    records::Identities identities(school.places().identities());
    SimulatedClass wanted;
    wanted.scenario = testing_ledger::k_scenario;
    wanted.sessions = school.file("class");
    wanted.n = 4;
    wanted.seed = 11;
    wanted.at_once = at_once;
    const ClassSat sat = simulate_class(wanted, ledger, identities, [](int) {});
    EXPECT_EQ(sat.sat, 4);
    EXPECT_EQ(sat.filed, 4);
    EXPECT_TRUE(records::check_ledger(school.places(), true).findings.empty());
    return class_figures(records::read_registry(ledger.content()), "block_cavity", {}, 3);
  };
  const School one;
  const ClassFigures first = sit(one, 2);
  const School two;
  EXPECT_EQ(sit(two, 1).points, first.points);
  EXPECT_GT(first.points.back(), first.points.front() + 10) << "skills differ";
}

}  // namespace
}  // namespace cavum::cohort
