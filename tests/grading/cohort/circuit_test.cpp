// The figures of a circuit where there is little or nothing to study: no estimate outside its range, no figure that is none.
#include "grading/cohort/circuit.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "tests/engine/support/basics.h"

namespace cavum::cohort {
namespace {

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
std::string refusal_of(const std::vector<std::vector<double>>& rows) {
  return testing_basics::error_of([&] { static_cast<void>(study_of(rows)); });
}

void expect_sound(const CircuitStudy& s, const std::string& what) {
  EXPECT_LE(s.range.g_low, s.as_sat.g) << what;
  EXPECT_GE(s.range.g_high, s.as_sat.g) << what;
  EXPECT_LE(s.range.phi_low, s.as_sat.phi) << what;
  EXPECT_GE(s.range.phi_high, s.as_sat.phi) << what;
  EXPECT_GE(s.at_cut.phi_at_cut, s.as_sat.phi) << what;
  CircuitFigures f;
  f.exams = {"a", "b"};
  f.candidates = 3;
  f.program = s;
  f.why_no_people = "no marks of people";
  for (const std::string& text : {to_text(f), to_json(f).dump()})
    for (const char* none : {"nan", "inf"}) EXPECT_EQ(text.find(none), std::string::npos) << what << ": " << text;
  EXPECT_FALSE(to_json(f)["program"]["at_cut"]["phi"].is_null()) << what;
}

TEST(Circuit, WhereNoCandidateDiffersThereIsNoStudy) {
  const double third = 100.0 / 3;  // rounding leaves something of it
  for (const double v : {0.0, third, 70.0, 100.0})
    EXPECT_NE(refusal_of({{v, v, v}, {v, v, v}, {v, v, v}}).find("are all alike"), std::string::npos) << v;
  EXPECT_NE(refusal_of({{third, 70, 55}, {third, 70, 55}, {third, 70, 55}, {third, 70, 55}}).find("differ by their conditions alone"),
            std::string::npos);
  EXPECT_NE(refusal_of({{60}, {70}}).find("cannot tell these effects apart"), std::string::npos) << "one exam";
  EXPECT_NE(refusal_of({{60, 70}}).find("cannot tell these effects apart"), std::string::npos) << "one candidate";
  CircuitFigures f;
  f.why_no_program = "these marks: are all alike";
  const auto j = to_json(f)["program"];
  EXPECT_EQ(j["why_not"], "these marks: are all alike");
  for (const char* name : {"mean_percent", "components", "as_sat", "at_cut", "by_exams", "exams_for_phi_080"})
    EXPECT_TRUE(j.at(name).is_null()) << name;
  EXPECT_NE(to_text(f).find("no study: these marks: are all alike"), std::string::npos);
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
    std::vector<std::vector<double>> rows(static_cast<std::size_t>(2 + i % 5), std::vector<double>(static_cast<std::size_t>(2 + i % 3)));
    for (auto& row : rows)
      for (double& v : row) v = 25.0 * static_cast<double>(random.next() % (i % 2 == 0 ? 2 : 5));
    std::string what = "table " + std::to_string(i) + ":";
    for (const auto& row : rows) {
      for (const double v : row) what += " " + std::to_string(static_cast<int>(v));
      what += ";";
    }
    if (refusal_of(rows).empty()) expect_sound(study_of(rows, 50), what);
  }
}

TEST(Circuit, MarksThatAreLeftOutAreNamedAndCounted) {
  CircuitFigures f;
  f.why_no_program = f.why_no_people = "none";
  EXPECT_EQ(to_text(f).find("left out"), std::string::npos);
  for (int i = 1; i <= 7; ++i) f.marks_left_out.push_back({"class_1", "c" + std::to_string(i), "A"});
  EXPECT_NE(to_text(f).find("marks left out: 7, of candidates without a session of that exam that counts: c1 (class_1), c2 (class_1)"),
            std::string::npos)
      << to_text(f);
  EXPECT_NE(to_text(f).find("c5 (class_1) and 2 more"), std::string::npos) << to_text(f);
  EXPECT_EQ(to_json(f)["marks_left_out"].size(), 7u);
  EXPECT_EQ(to_json(f)["marks_left_out"][6]["candidate"], "c7");
}

}  // namespace
}  // namespace cavum::cohort
