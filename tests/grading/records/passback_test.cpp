// Which scores are due for a learning platform's gradebook, by released results and by what was
// answered before.
#include "grading/records/passback.h"

#include "grading/records/erasure.h"
#include "grading/records/regrade.h"
#include "grading/records/release.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;

constexpr char k_column[] = "https://moodle.example/7/lineitems/3",
               k_issuer[] = "https://moodle.example";

/// One exam of 4711 is filed.
class Passbacks : public ::testing::Test {
 protected:
  void SetUp() override {
    Ledger ledger = school_.ledger();
    session_ = file_session(ledger, school_.sit(school_.ticket("4711"))).seq.value_or(0);
  }
  std::vector<ScoreDue> due(const char* column = k_column, bool again = false) {
    Ledger ledger = school_.ledger();
    Identities identities(school_.places().identities());
    return scores_due(ledger.content(), ledger.registry(), identities, "block_cavity", column,
                      english_text, again);
  }
  void release() {
    Ledger ledger = school_.ledger();
    ReleaseCommand wish;
    wish.sessions = {session_};
    ASSERT_EQ(release_results(ledger, wish).results.size(), 1U);
  }
  void answer(const ScoreDue& sent, int status) {
    Ledger ledger = school_.ledger();
    enter_passback(ledger, sent, k_issuer, k_column, status, "said\nin two lines");
  }

  School school_;
  std::uint64_t session_ = 0;
};

TEST_F(Passbacks, AreDueOnceForEachColumnAndReleasedResult) {
  EXPECT_TRUE(due().empty());
  release();
  ASSERT_EQ(due().size(), 1U);
  const ScoreDue first = due()[0];
  EXPECT_EQ(first.id, "4711");
  EXPECT_EQ(first.session, session_);
  EXPECT_EQ(first.result, session_);
  EXPECT_EQ(first.score["gradingProgress"], "FullyGraded");
  answer(first, 200);
  EXPECT_TRUE(due().empty());
  EXPECT_EQ(due("https://moodle.example/8/lineitems/1").size(), 1U) << "another column";
  const auto kept = read_registry(read_ledger(school_.places()));
  EXPECT_TRUE(kept.findings.empty());
  ASSERT_EQ(kept.passbacks.size(), 1U);
  EXPECT_EQ(kept.passbacks[0].answer, "said in two lines");
  EXPECT_EQ(kept.passbacks[0].result, session_);
}

TEST_F(Passbacks, ARefusedOneIsDueAgainOnlyWhenAsked) {
  release();
  answer(due()[0], 404);
  EXPECT_TRUE(due().empty());
  EXPECT_EQ(due(k_column, true).size(), 1U);
  answer(due(k_column, true)[0], 204);
  EXPECT_TRUE(due(k_column, true).empty());
}

TEST_F(Passbacks, WhatIsTakenBackIsClearedByALaterTimeAndOnlyWhereItWasSent) {
  release();
  const ScoreDue first = due()[0];
  answer(first, 200);
  {
    Ledger ledger = school_.ledger();
    retract_results(ledger, {session_}, "wrong tooth");
  }
  ASSERT_EQ(due().size(), 1U);
  const ScoreDue clears = due()[0];
  EXPECT_EQ(clears.result, 0U);
  EXPECT_FALSE(clears.score.contains("scoreGiven"));
  EXPECT_GT(clears.score["timestamp"].get<std::string>(),
            first.score["timestamp"].get<std::string>());
  EXPECT_TRUE(due("https://moodle.example/8/lineitems/1").empty()) << "nothing was sent there";
  answer(clears, 200);
  EXPECT_TRUE(due().empty());
  release();
  EXPECT_EQ(due().size(), 1U) << "released again";
}

TEST_F(Passbacks, WhoeverIsForgottenIsSentNowhere) {
  release();
  ASSERT_EQ(due().size(), 1U);
  {
    Ledger ledger = school_.ledger();
    const std::string pseudonym = ledger.registry().sessions[0].candidate;
    forget(ledger, {pseudonym}, {});
    Identities(school_.places().identities()).forget(pseudonym);
  }
  EXPECT_TRUE(due().empty());
}

TEST_F(Passbacks, AnEntryOfAResultThatIsNotTheSessionsIsFound) {
  release();
  ScoreDue wrong = due()[0];
  wrong.result = session_ + 100;
  answer(wrong, 200);
  wrong = due()[0];
  wrong.session = 1;
  answer(wrong, 200);
  EXPECT_EQ(read_registry(read_ledger(school_.places())).findings.size(), 2U);
}

}  // namespace
}  // namespace cavum::records
