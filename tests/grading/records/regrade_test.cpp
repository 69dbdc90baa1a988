// What a filed exam was marked anew by stays in the ledger, bound by the tree.
#include "grading/records/regrade.h"

#include "grading/records/reason.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;

const std::string k_rubric =
    "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = \"target_removed_percent\"\nfull = 50\n"
    "zero = 0\npoints = 10\n";

/// A school with one filed exam; each test works on a copy.
class KeptRegrade : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new School();
    Ledger ledger = shared_->ledger();
    ASSERT_TRUE(file_session(ledger, shared_->sit(shared_->ticket("4711"))).seq);
  }
  static void TearDownTestSuite() { delete shared_; }
  void SetUp() override {
    const FiledSession s = read_registry(read_ledger(school_.places())).sessions.at(0);
    session_ = s.seq;
    sealed_ = *s.result;
    basis_.rubric_toml = k_rubric;
  }
  json better() const {
    json r = sealed_;
    r["score"]["points"] = 12.5;
    return r;
  }
  void tamper(const std::string& sql) {
    test::tamper(
        school_.places().database(),
        "DROP TRIGGER document_stays; DROP TRIGGER document_is_kept; " + sql +
            "; CREATE TRIGGER document_stays BEFORE UPDATE ON document BEGIN SELECT RAISE(ABORT, 'the ledger is "
            "append only'); END; CREATE TRIGGER document_is_kept BEFORE DELETE ON document BEGIN SELECT "
            "RAISE(ABORT, 'the ledger is append only'); END");
  }
  School school_{*shared_};
  std::uint64_t session_ = 0;
  json sealed_;
  RegradeBasis basis_;

 private:
  static inline School* shared_ = nullptr;
};

TEST_F(KeptRegrade, IsFoundAgainByteForByteAndKeptOnce) {
  Ledger ledger = school_.ledger();
  enter_regrade(ledger, session_, better(), basis_, "the limit was misprinted");
  enter_regrade(ledger, session_, sealed_, basis_, "and again");
  const LedgerContent content = read_ledger(school_.places());
  EXPECT_TRUE(content.findings.empty()) << content.findings[0].message();
  EXPECT_EQ(content.documents.size(), 1u);
  EXPECT_EQ(ledger.content().documents, content.documents);
  const FiledSession s = read_registry(content).sessions.at(0);
  ASSERT_EQ(s.regrades.size(), 2u);
  EXPECT_EQ(s.regrade(s.result_seq)->reason, "and again");
  EXPECT_EQ(s.regrade(s.seq), nullptr) << "the sealed result is no regrade";
  const auto kept = kept_basis(content, s.regrades[0]);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->rubric_toml, k_rubric);
  EXPECT_EQ(rubric_of(*kept, "kept")->criteria.at(0).id, "removed");
  EXPECT_FALSE(scenario_of(*kept, "kept"));
  // its hash is in the text that the tree's leaf is of
  EXPECT_NE(content.entries.at(s.regrades[0].seq).text.find(to_hex(sha256(k_rubric))),
            std::string::npos);
}

TEST_F(KeptRegrade, AScenarioIsKeptWithItsSurfaces) {
  Ledger ledger = school_.ledger();
  RegradeBasis basis = read_basis("", k_scenario);
  EXPECT_EQ(basis.scenario_toml, read_text_file(k_scenario));
  basis.surfaces.emplace_back("a b.stl", Bytes{0, 255, 7});
  enter_regrade(ledger, session_, better(), basis, "corrected");
  const LedgerContent content = read_ledger(school_.places());
  const auto kept = kept_basis(content, read_registry(content).sessions.at(0).regrades.at(0));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->scenario_toml, basis.scenario_toml);
  EXPECT_EQ(kept->surfaces, basis.surfaces);
}

TEST_F(KeptRegrade, WhatIsDoneToItIsFound) {
  {
    Ledger ledger = school_.ledger();
    enter_regrade(ledger, session_, better(), basis_, "appeal");
  }
  const Bytes sound = read_file(school_.places().database());
  tamper(
      "UPDATE document SET bytes = CAST(replace(CAST(bytes AS TEXT), 'full = 50', 'full = 90') AS BLOB)");
  expect_kinds(check_ledger(school_.places(), false).findings, {Kind::part_changed});
  EXPECT_THROW(school_.ledger(), Error);
  write_file(school_.places().database(), sound);
  tamper("DELETE FROM document");
  expect_finding(check_ledger(school_.places(), false).findings, Kind::part_missing,
                 {"rubric.toml"});
  write_file(school_.places().database(), sound);
  tamper("INSERT INTO document VALUES (x'" + to_hex(sha256(std::string("x"))) + "', x'78')");
  expect_kinds(check_ledger(school_.places(), false).findings, {Kind::foreign});
}

TEST_F(KeptRegrade, AReasonIsALineOfText) {
  Ledger ledger = school_.ledger();
  for (const std::string& reason : {std::string(), std::string("two\nlines"), std::string("\xff"),
                                    std::string(k_longest_reason + 1, 'a')})
    EXPECT_THROW(enter_regrade(ledger, session_, sealed_, basis_, reason), Error) << reason;
  EXPECT_EQ(ledger.content().documents.size(), 0u);
}

}  // namespace
}  // namespace cavum::records
