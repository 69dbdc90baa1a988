// The examples that ship in data/measured: they say what their README says of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/base/file.h"
#include "engine/lab/explain/inference/stiffness_table.h"
#include "engine/lab/explain/report/model_file.h"
#include "engine/lab/explain/report/protocol.h"
#include "engine/lab/rig/published.h"
#include "engine/lab/rig/record_rig.h"
#include "engine/physics/bur/bur.h"
#include "tests/engine/support/basics.h"

namespace cavum::explain {
namespace {

const std::string k_data = std::string(CAVUM_SOURCE_DIR) + "/data/";

TableExplanation fig6() {
  const std::string path = k_data + "measured/fig6/fig6.csv", text = read_text_file(path);
  EXPECT_TRUE(is_stiffness_table(text, path));
  return explain_table(parse_stiffness_table(text, path));
}

TEST(Fig6, IsThePublishedLineAndLabelledAsSuch) {
  const TableExplanation e = fig6();
  for (std::size_t i = 0; i < e.table.f_n.size(); ++i)
    EXPECT_NEAR(e.table.f_n[i], paper_force_n(e.table.k_n_per_mm[i]), 5e-4);
  EXPECT_NE(e.table.origin.find("NOT measured values"), std::string::npos);
  EXPECT_TRUE(e.exact);
}

TEST(Fig6, IsAnAliasOfBiasFrictionAndEdgeForceNeverOneOfThem) {
  const TableExplanation e = fig6();
  EXPECT_EQ(e.explanation.verdict, Verdict::alias);
  ASSERT_EQ(e.explanation.causes.size(), 1u);
  const auto& others = e.explanation.causes[0].aliases;
  for (const char* name : {"coulomb_friction", "edge_force"})
    EXPECT_NE(std::find(others.begin(), others.end(), name), others.end()) << name;
  EXPECT_NEAR(e.line.intercept_n, 0.673, 1e-9);
  EXPECT_FALSE(e.explanation.next_experiment.empty());
}

TEST(Fig6, TheRootOfKIsWorkedOut) {
  const TableExplanation e = fig6();
  EXPECT_DOUBLE_EQ(e.predicted_root, 0.5);
  // the line through 0.5 √k at k = 0, 0.2 … 1.2, by sums
  double n = 0, sk = 0, sf = 0, skk = 0, skf = 0;
  for (int i = 0; i <= 6; ++i) {
    const double k = 0.2 * i, f = 0.5 * std::sqrt(k);
    ++n, sk += k, sf += f, skk += k * k, skf += k * f;
  }
  const double slope = (n * skf - sk * sf) / (n * skk - sk * sk);
  EXPECT_NEAR(e.of_root.slope_mm, slope, 1e-12);
  EXPECT_NEAR(e.of_root.intercept_n, (sf - slope * sk) / n, 1e-12);
  EXPECT_NEAR(e.all.root, 0.0, 1e-9);  // the published line is straight
  EXPECT_GT(e.voigt.rms_n, 0.2);       // and no Voigt law fits it
  EXPECT_TRUE(
      std::any_of(e.explanation.notes.begin(), e.explanation.notes.end(), [](const Fact& note) {
        return note.kind() == "root_hides" &&
               std::any_of(note.values().begin(), note.values().end(), [](const auto& value) {
                 const auto* const figure = std::get_if<Number>(&value.second);
                 return value.first == "intercept" && figure != nullptr &&
                        std::fabs(figure->value - 0.097) < 5e-4;
               });
      }));
}

TEST(StiffnessTable, ALineThroughZeroIsNoReasonToName) {
  std::string csv = "k_n_per_mm,f_n,v_mm_s\n";
  for (int i = 0; i < 12; ++i) {
    const double k = 0.1 * i, noise = 0.01 * std::sin(37.0 * i);
    csv +=
        std::to_string(k) + "," + std::to_string(0.5 * k + 0.5 * std::sqrt(k) + noise) + ",0.25\n";
  }
  const TableExplanation e = explain_table(parse_stiffness_table(csv, "t.csv"));
  EXPECT_EQ(e.explanation.verdict, Verdict::not_testable);
  EXPECT_TRUE(e.explanation.causes.empty());
  EXPECT_NEAR(e.voigt.root, 0.5, 0.05);
}

TEST(StiffnessTable, RowsAreLimited) {
  std::string csv = "k_n_per_mm,f_n,v_mm_s\n";
  for (int i = 0; i < 5001; ++i) csv += std::to_string(0.001 * i) + ",1,0.25\n";
  const auto refused =
      testing_basics::thrown_by([&] { static_cast<void>(parse_stiffness_table(csv, "t.csv")); });
  EXPECT_EQ(testing_basics::place_of(refused), "t.csv:5002");
  EXPECT_TRUE(testing_basics::tells(refused, 5000));
}

TEST(StiffnessTable, MistakesAreNamedWithTheirLine) {
  const auto error = [](const std::string& csv) {
    return testing_basics::thrown_by(
        [&] { static_cast<void>(parse_stiffness_table(csv, "t.csv")); });
  };
  EXPECT_EQ(testing_basics::place_of(error("k_n_per_mm,f_n\n0,1\n")), "t.csv:1");
  EXPECT_EQ(testing_basics::place_of(error("k_n_per_mm,f_n,v_mm_s\n0,1,0.25\n-1,1,0.25\n")),
            "t.csv:3");
  EXPECT_TRUE(testing_basics::tells(error("k_n_per_mm,f_n,v_mm_s\n0,x,0.25\n"), "f_n"));
  EXPECT_FALSE(is_stiffness_table("session,t_s,x_mm,f_n,k_n_per_mm\n", "r.csv"));
  EXPECT_EQ(
      explain_table(parse_stiffness_table("k_n_per_mm,f_n,v_mm_s\n0,1,0.25\n1,2,0.25\n", "t.csv"))
          .explanation.verdict,
      Verdict::data_fault);
}

TEST(Hunt, WhatWasHiddenIsFoundAndItsModelLeavesNothing) {
  const Recording r = read_recording(k_data + "measured/hunt/recording.csv");
  const ForceModel answer =
      parse_force_model(read_text_file(k_data + "measured/hunt/answer/model.toml"), "answer");
  ASSERT_EQ(answer.term_values.size(), 1u);
  const Explanation e = explain(r);
  ASSERT_EQ(e.causes.size(), 1u) << english_text(to_text(e));
  EXPECT_EQ(e.verdict, Verdict::named);
  EXPECT_EQ(mechanism_at(e.causes[0].term.mechanism).name, answer.term_values[0].kind);
  const auto& [name, hidden] = answer.term_values[0].parameters.at(0);
  ASSERT_EQ(e.causes[0].parameters.at(0).first, name);
  const Interval& found = e.causes[0].parameters[0].second;
  EXPECT_NEAR(found.value, hidden, 0.05 * hidden);
  EXPECT_LT(found.low, hidden);
  EXPECT_GT(found.high, hidden);

  const std::string materials = k_data + "materials/consistent.toml";
  const ForceModel extended = parse_force_model(
      extended_model_toml(e, parse_force_model(read_text_file(materials), materials)),
      "found.toml");
  const Series added = added_force_n(extended, "dentin", r, "found.toml");
  ExplainOptions on_top;
  on_top.fixed_n = &added;
  EXPECT_EQ(explain(r, on_top).verdict, Verdict::clean);
}

TEST(Hunt, TheCommandOfItsReadmeMakesTheSameFile) {
  const ForceModel answer =
      parse_force_model(read_text_file(k_data + "measured/hunt/answer/model.toml"), "answer");
  const std::string bur = k_data + "burs/round-1.0.toml";
  RecordOptions options;
  options.rate_hz = 25.0;
  const RecordResult made = run_record_rig(parse_motion(protocol_motion_csv(), "protocol.csv"),
                                           answer, parse_bur(read_text_file(bur), bur), options);
  EXPECT_TRUE(record_csv(made) == read_text_file(k_data + "measured/hunt/recording.csv"));
  EXPECT_EQ(record_rig_toml(made), read_text_file(k_data + "measured/hunt/rig.toml"));
}

TEST(RecordRig, WithNothingHiddenItsRecordingIsCleanAndItsKIsThatOfTheModel) {
  const std::string bur = k_data + "burs/round-1.0.toml",
                    model = k_data + "materials/consistent.toml";
  RecordOptions options;
  options.rate_hz = 25.0;
  const RecordResult made = run_record_rig(parse_motion(protocol_motion_csv(), "protocol.csv"),
                                           parse_force_model(read_text_file(model), model),
                                           parse_bur(read_text_file(bur), bur), options);
  Recording r = parse_recording(record_csv(made), "recording.csv");
  r.rig = parse_rig(record_rig_toml(made), "rig.toml");
  const Explanation e = explain(r);
  EXPECT_EQ(e.verdict, Verdict::clean) << english_text(to_text(e));
  EXPECT_NEAR(e.base.k_n_per_mm, 0.8, 0.01);
}

}  // namespace
}  // namespace cavum::explain
