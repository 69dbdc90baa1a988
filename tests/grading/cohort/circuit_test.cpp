// The figures of a circuit where there is little or nothing to study: no estimate outside its
// range, no figure that is none.
#include "grading/cohort/circuit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "tests/engine/support/basics.h"
#include "tests/grading/cohort/drawn_class.h"
#include "tests/grading/records/school.h"

namespace cavum::cohort {
namespace {

using namespace testing_basics;

/// Rows of candidates, a column for each exam.
std::vector<StudyMark> table(const std::vector<std::vector<double>>& rows) {
  std::vector<StudyMark> marks;
  for (std::uint32_t p = 0; p < rows.size(); ++p)
    for (std::uint32_t t = 0; t < rows[p].size(); ++t) marks.push_back({{p, t}, rows[p][t]});
  return marks;
}
CircuitStudy study_of(const std::vector<std::vector<double>>& rows, double cut = 60) {
  return study_circuit(crossed_design({"candidate", "exam"}), table(rows), cut);
}
std::optional<ErrorCode> refusal_of(const std::vector<std::vector<double>>& rows) {
  return code_of([&] { static_cast<void>(study_of(rows)); });
}

void expect_sound(const CircuitStudy& s, const std::string& what) {
  EXPECT_LE(s.range.g_low, s.as_sat.g) << what;
  EXPECT_GE(s.range.g_high, s.as_sat.g) << what;
  EXPECT_LE(s.range.phi_low, s.as_sat.phi) << what;
  EXPECT_GE(s.range.phi_high, s.as_sat.phi) << what;
  ASSERT_TRUE(s.at_cut) << what;
  EXPECT_GE(s.at_cut->phi_at_cut, s.as_sat.phi) << what;
  CircuitFigures f;
  f.exams = {"a", "b"};
  f.candidates = 3;
  f.program = s;
  f.why_no_people = msg("no marks of people");
  for (const Message& cell : cells_of(to_text(f)))
    for (const double figure : figures_in(cell))
      EXPECT_TRUE(std::isfinite(figure)) << what << ": " << cell;
  const std::string json = to_json(f).dump();
  for (const char* none : {"nan", "inf"})
    EXPECT_EQ(json.find(none), std::string::npos) << what << ": " << json;
  EXPECT_FALSE(to_json(f)["program"]["at_cut"]["phi"].is_null()) << what;
}

TEST(Circuit, WhereNoCandidateDiffersThereIsNoStudy) {
  const double third = 100.0 / 3;  // rounding leaves something of it
  for (const double v : {0.0, third, 70.0, 100.0})
    EXPECT_EQ(refusal_of({{v, v, v}, {v, v, v}, {v, v, v}}), StudyError::all_alike) << v;
  EXPECT_EQ(refusal_of({{third, 70, 55}, {third, 70, 55}, {third, 70, 55}, {third, 70, 55}}),
            StudyError::conditions_alone);
  EXPECT_EQ(refusal_of({{60}, {70}}), StudyError::effects_not_apart) << "one exam";
  EXPECT_EQ(refusal_of({{60, 70}}), StudyError::effects_not_apart) << "one candidate";
  CircuitFigures f;
  f.why_no_program = Name{"all alike"};
  const auto j = to_json(f)["program"];
  EXPECT_EQ(j["why_not"], "all alike");
  for (const char* name :
       {"mean_percent", "components", "as_sat", "at_cut", "by_exams", "exams_for_phi_080"})
    EXPECT_TRUE(j.at(name).is_null()) << name;
  EXPECT_TRUE(tells(to_text(f), "all alike"));
}

TEST(Circuit, AnEstimateLiesWithinItsRange) {
  const CircuitStudy sure = study_of({{100.0 / 3, 100.0 / 3}, {50, 50}, {71.7, 71.7}});
  expect_sound(sure, "candidates differ, and no error at all");
  EXPECT_EQ(sure.as_sat.phi, 1);
  EXPECT_EQ(sure.range.phi_low, 1);
  EXPECT_EQ(sure.for_enough.estimate, 1);
  const CircuitStudy added = study_of({{40.1, 60.2}, {50.1, 70.2}, {70.1, 90.2}, {20.1, 40.2}});
  expect_sound(added, "candidates and exams add up");
  EXPECT_EQ(added.as_sat.g, 1);
  EXPECT_LT(added.as_sat.phi, 1);
  expect_sound(study_of({{40, 60}, {60, 40}}), "candidates alike in the mean");
  expect_sound(study_of({{0, 0}, {0, 0}, {0, 0}, {0, 100}}), "one mark differs");
  Random random(3);
  for (int i = 0; i < 40; ++i) {  // small tables of few values
    std::vector<std::vector<double>> rows(static_cast<std::size_t>(2 + i % 5),
                                          std::vector<double>(static_cast<std::size_t>(2 + i % 3)));
    for (auto& row : rows)
      for (double& v : row) v = 25.0 * static_cast<double>(random.next() % (i % 2 == 0 ? 2 : 5));
    std::string what = "table " + std::to_string(i) + ":";
    for (const auto& row : rows) {
      for (const double v : row) what += " " + std::to_string(static_cast<int>(v));
      what += ";";
    }
    if (!refusal_of(rows)) expect_sound(study_of(rows, 50), what);
  }
}

TEST(Circuit, TheCutIsThePassMarkOfTheResultsAndNoneWhereTheyHaveSeveral) {
  const testing_ledger::School school;
  records::Identities identities(school.places().identities());
  records::Registry r;
  std::uint64_t seq = 1;
  for (int c = 0; c < 6; ++c)
    for (const std::string exam : {"a", "b"}) {
      records::FiledSession s;
      s.seq = s.result_seq = seq++;
      s.candidate =
          identities.enrol("c" + std::to_string(c), "", exam, testing_ledger::School::key());
      s.scenario_id = exam;
      s.result = nlohmann::json{{"verdict", "pass"},
                                {"score",
                                 {{"points", 40.0 + 9 * c + (exam == "a" ? c % 3 : 0)},
                                  {"max", 100.0},
                                  {"pass_percent", 65.0}}},
                                {"criteria", nlohmann::json::array()}};
      s.filed = s.result;
      r.sessions.push_back(s);
    }
  const auto regrade = [&](records::FiledSession& s) {
    s.result.change()["score"]["pass_percent"] = 75.0;
    s.result_seq = seq++;
    s.regrades.push_back({s.result_seq, 0, "misprinted", "", {{"rubric.toml", "aa"}}, s.result});
  };
  EXPECT_EQ(circuit_figures(r, identities, {"a", "b"}, {}).cut_percent, 65.0);
  for (auto& s : r.sessions)
    if (s.scenario_id == "a") regrade(s);
  const CircuitFigures all = circuit_figures(r, identities, {"a", "b"}, {});
  EXPECT_EQ(all.cut_percent, 70.0) << "one passes with 75, the other with 65";
  EXPECT_TRUE(all.marked_differently.empty());
  ASSERT_TRUE(all.program) << all.why_no_program;
  EXPECT_TRUE(tells(to_text(all), 70.0));

  regrade(r.sessions[1]);  // one of exam b
  const CircuitFigures f = circuit_figures(r, identities, {"a", "b"}, {});
  EXPECT_FALSE(f.cut_percent);
  ASSERT_TRUE(f.program) << f.why_no_program;
  EXPECT_FALSE(f.program->at_cut);
  EXPECT_EQ(f.program->as_sat.phi, all.program->as_sat.phi) << "the rest needs no cut";
  EXPECT_FALSE(tells(to_text(f), 70.0));
  ASSERT_EQ(f.marked_differently.size(), 1u);
  EXPECT_TRUE(tells(f.marked_differently[0], "b") && tells(f.marked_differently[0], 5) &&
              tells(f.marked_differently[0], 65.0));
  EXPECT_TRUE(to_json(f)["cut_percent"].is_null());
  EXPECT_TRUE(to_json(f)["program"]["at_cut"].is_null());
}

TEST(Circuit, MarksThatAreLeftOutAreNamedAndCounted) {
  CircuitFigures f;
  f.why_no_program = f.why_no_people = msg("none");
  EXPECT_FALSE(tells(to_text(f), 7));
  for (int i = 1; i <= 7; ++i)
    f.marks_left_out.push_back({"class_1", "c" + std::to_string(i), "A"});
  const Lines text = to_text(f);
  EXPECT_TRUE(tells(text, 7) && tells(text, "c1") && tells(text, "c5") && tells(text, 2))
      << "and two more";
  EXPECT_FALSE(tells(text, "c6"));
  EXPECT_EQ(to_json(f)["marks_left_out"].size(), 7u);
  EXPECT_EQ(to_json(f)["marks_left_out"][6]["candidate"], "c7");
}

/// Six judges, of whom two mark each work; in no exam does one see a candidate again.
std::vector<StudyMark> rotated_pairs(std::uint64_t seed) {
  Random random(seed);
  std::vector<drawn::Levels> places;
  for (std::uint32_t p = 0; p < 30; ++p)
    for (std::uint32_t t = 0; t < 3; ++t)
      for (std::uint32_t i = 0; i < 2; ++i) places.push_back({p, t, (p + p / 6 + 2 * t + i) % 6});
  return drawn::draw(places, {.judge = 9, .candidate_exam = 16, .candidate_judge = 1, .rest = 64},
                     random)
      .marks;
}

TEST(Circuit, WhatPartsTheMarksAlikeIsOneEffectAndNamed) {
  const CircuitStudy s = study_of_judges(rotated_pairs(7), 60);
  ASSERT_EQ(s.merged.size(), 1u);
  EXPECT_EQ(s.merged[0],
            (std::pair<std::string, std::string>("candidate x judge", "candidate x exam x judge")));
  EXPECT_EQ(s.design.names,
            (std::vector<std::string>{"candidate", "exam", "judge", "candidate x exam",
                                      "exam x judge", "candidate x exam x judge"}));
  expect_sound(s, "pairs in rotation");
  CircuitFigures f;
  f.why_no_program = msg("none");
  f.people = s;
  const auto cells = cells_of(to_text(f));
  EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [](const Message& m) {
    return tells(m, "candidate x judge") && tells(m, "candidate x exam x judge");
  }));
  EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [](const Message& m) {
    return figures_in(m) == std::vector<double>{6, 3, 6};
  })) << "the mean of 6 marks: 3 exams, 6 judges";
  // Of each candidate two marks an exam: exam x judge stands in six cells, the judges in six, what
  // is left in six marks.
  EXPECT_NEAR(s.marking.as_given().own[2], 1.0 / 6, 1e-12);
  EXPECT_NEAR(s.marking.as_given().own[3], 1.0 / 3, 1e-12);
  EXPECT_NEAR(s.marking.with_tasks(3).own[2], 1.0 / 6, 1e-12) << "three exams as they were";
  EXPECT_NEAR(s.marking.with_tasks(6).own[2], 1.0 / 12, 1e-12)
      << "other judges in each further exam";
  EXPECT_NEAR(s.marking.with_tasks(6).common[1], 1.0 / 6, 1e-12) << "everybody at the same exams";
}

TEST(Circuit, EffectsThatCannotBeToldApartAreNamed) {
  std::vector<StudyMark> marks;  // one exam alone
  for (std::uint32_t p = 0; p < 6; ++p)
    for (std::uint32_t j = 0; j < 2; ++j)
      marks.push_back({{p, 0, j}, static_cast<double>(50 + p * 3 + j * (p % 2))});
  const auto refused = thrown_by([&] { static_cast<void>(study_of_judges(marks, 60)); });
  EXPECT_EQ(code_of(refused), StudyError::effects_not_apart);
  const std::string why = refused->what();
  EXPECT_NE(why.find("exam"), std::string::npos) << why;
  EXPECT_EQ(why.find("candidate x exam x judge"), std::string::npos)
      << "the residual is told: " << why;
}

TEST(Circuit, TheNumberOfExamsThatIsEnoughHasARange) {
  Random random(4);
  const auto marks = drawn::draw(
      drawn::crossed(30, 3, 2),
      {.exam = 16, .judge = 0, .candidate_exam = 36, .candidate_judge = 0, .rest = 16}, random);
  const CircuitStudy s = study_of_judges(marks.marks, 60);
  ASSERT_TRUE(s.for_enough.estimate && s.for_enough.low);
  EXPECT_LE(*s.for_enough.low, *s.for_enough.estimate);
  EXPECT_GE(s.for_enough.high.value_or(k_max_tasks + 1), *s.for_enough.estimate);
  EXPECT_LT(*s.for_enough.low, s.for_enough.high.value_or(k_max_tasks + 1))
      << "thirty candidates at three exams do not know it";
  CircuitFigures f;
  f.why_no_program = msg("none");
  f.people = s;
  const auto cells = cells_of(to_text(f));
  EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [&](const Message& m) {
    const auto figures = figures_in(m);
    return figures.size() > 2 && figures[0] == 0.8 && figures[1] == *s.for_enough.estimate &&
           figures[2] == *s.for_enough.low;
  }));
  EXPECT_EQ(to_json(f)["people"]["exams_for_phi_080_range"][0], *s.for_enough.low);
}

}  // namespace
}  // namespace cavum::cohort
