// Results whose every text was written by somebody who wants rows, formulas or commands in what the
// school exports of them.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/base/csv.h"
#include "grading/records/exports.h"
#include "grading/result/finding.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;

const char* const k_hostile[] = {"=cmd|' /C calc'!A0",
                                 "+1+1",
                                 "-2+3+cmd",
                                 "@SUM(1)",
                                 "\t=1",
                                 "\r=1",
                                 "pass\n9,forged,x,y,,0,0,0,0,pass,1,a,b,1,,100,100",
                                 "pass\",\"=1+1",
                                 "a;=1+1",
                                 "\x1b]0;owned\x07",
                                 "\xc2\x9b"
                                 "31m",
                                 "\xe2\x80\xae"
                                 "ssap"};

/// A result with `text` wherever a result holds text.
json result_of(const std::string& text) {
  return {{"verdict", "pass"},
          {"score",
           {{"points", 80.0}, {"max", 100.0}, {"pass_percent", 60.0}, {"borderline_percent", 5.0}}},
          {"criteria",
           {{{"id", text},
             {"metric", text},
             {"unit", text},
             {"value", 1.5},
             {"points", 80.0},
             {"max", 100.0},
             {"critical_failed", true},
             {"facts", {to_json(grading::finding<grading::FindingKind::tissue_touched>(text))}}}}}};
}

Registry registry_of(const std::string& text, const std::string& candidate) {
  Registry registry;
  FiledSession s{};
  s.seq = s.result_seq = s.shown_seq = 3;
  s.candidate = candidate;
  s.scenario_id = s.station_key = text;
  s.filed = s.sealed = s.result = s.shown = result_of(text);
  s.released = true;
  registry.sessions.push_back(s);
  s.simulated = text;
  s.seq = s.result_seq = s.shown_seq = 4;
  registry.sessions.push_back(s);
  return registry;
}

void expect_harmless(const std::string& csv, std::size_t rows, const std::string& text) {
  for (const auto& line : {csv})
    EXPECT_EQ(static_cast<std::size_t>(std::count(line.begin(), line.end(), '\n')), rows)
        << text << "\n"
        << csv;
  EXPECT_EQ(csv.find_first_of("\r\x1b\x07\t"), std::string::npos) << csv;
  const auto table =
      parse_csv(csv, "export.csv");  // refuses rows of another length, and control characters
  ASSERT_EQ(table.size(), rows) << csv;
  for (const auto& row : table)
    for (const auto& field : row.fields) {
      std::size_t end = 0;
      try {
        static_cast<void>(std::stod(field, &end));
      } catch (const std::exception&) {
      }
      if (!field.empty() && end == field.size()) continue;  // a number
      EXPECT_EQ(field.find_first_of("=+-@"), field.find_first_of("=+-@", 1))
          << "a formula: " << field;
    }
}

TEST(HostileText, MakesNoRowsAndNoFormulasInAnyExport) {
  const School school;
  Identities identities(school.places().identities());
  const std::string known = identities.enrol("=HYPERLINK(1)", "", "exam", School::key());
  for (const std::string text : k_hostile) {
    const Registry registry = registry_of(text, known);
    int left_out = 0;
    expect_harmless(moodle_csv(registry, identities, left_out, english_text, true), 3, text);
    EXPECT_EQ(left_out, 0);
    expect_harmless(tidy_csv(registry), 3, text);
    expect_harmless(tidy_csv(registry_of("x", text)), 3, text);
    EXPECT_TRUE(json::accept(lti_scores(registry, identities, english_text, true).dump())) << text;
  }
}

}  // namespace
}  // namespace cavum::records
