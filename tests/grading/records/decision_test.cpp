// A result that the program leaves to a person waits until one has decided; what he decided is an
// entry, a result of its own, and what goes out.
#include "grading/records/decision.h"

#include "grading/records/appeal.h"
#include "grading/records/erasure.h"
#include "grading/records/exports.h"
#include "grading/records/ledger_error.h"
#include "grading/records/regrade.h"
#include "grading/records/release.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;
using testing_basics::code_of;
using testing_basics::tells;
using testing_basics::thrown_by;

/// A school with one filed exam whose verdict is `review`; each test works on a copy.
class LeftToAPerson : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new School();
    Ledger ledger = shared_->ledger();
    ASSERT_TRUE(file_session(ledger, shared_->sit(shared_->ticket("4711"))).seq);
  }
  static void TearDownTestSuite() { delete shared_; }
  void SetUp() override {
    Ledger ledger = school_.ledger();
    json review = *session().result;
    entry_ = session().seq;
    review["verdict"] = "review";
    review["verdict_reasons"] =
        json::array({to_json(grading::finding<grading::FindingKind::force_without_tissue>())});
    enter_regrade(ledger, entry_, review, {}, "as if the program had left it to a person");
  }
  FiledSession session() const {
    return read_registry(read_ledger(school_.places())).sessions.at(0);
  }
  std::string moodle() const {
    Identities identities(school_.places().identities());
    int left_out = 0;
    return moodle_csv(read_registry(read_ledger(school_.places())), identities, left_out,
                      english_text);
  }
  json lti() const {
    Identities identities(school_.places().identities());
    return lti_scores(read_registry(read_ledger(school_.places())), identities, english_text)
        .at(0)
        .at("score");
  }
  School school_{*shared_};
  std::uint64_t entry_ = 0;

 private:
  static inline School* shared_ = nullptr;
};

TEST_F(LeftToAPerson, WaitsAndGoesOutAsHeDecides) {
  Ledger ledger = school_.ledger();
  const auto queue = review_queue(read_registry(ledger.content()));
  ASSERT_EQ(queue.size(), 1u);
  EXPECT_EQ(queue[0].session, entry_);
  EXPECT_EQ(queue[0].reasons.size(), 1u);
  const Release waits = release_results(ledger, {.all = true});
  EXPECT_EQ(waits.results.size(), 0u);
  EXPECT_EQ(waits.to_decide, 1u);

  enter_decision(
      ledger, entry_,
      {grading::Verdict::fail, "Dr. Examiner", "the floor is cut through at the distal canal"});
  const FiledSession s = session();
  EXPECT_EQ(s.result->at("verdict"), "fail");
  EXPECT_EQ(s.result->at("decision"),
            (json{{"verdict_before", "review"}, {"person", "Dr. Examiner"}}));
  EXPECT_EQ(s.result->at("score"), s.filed->at("score")) << "a decision changes no points";
  EXPECT_EQ(s.regrade(s.result_seq)->person, "Dr. Examiner");
  EXPECT_TRUE(review_queue(read_registry(ledger.content())).empty());
  EXPECT_FALSE(s.released);
  EXPECT_EQ(release_results(ledger, {.all = true}).results.size(), 1u);
  const std::string csv = moodle();
  EXPECT_NE(csv.find("the floor is cut through at the distal canal"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\n4711,0,fail"), std::string::npos)
      << "points that would pass do not count: " << csv;
  EXPECT_TRUE(read_ledger(school_.places()).findings.empty());
}

TEST_F(LeftToAPerson, IsDecidedOnceAndOnlyWhereThereIsSomethingToDecide) {
  Ledger ledger = school_.ledger();
  const auto refused = [&](const Decision& d) {
    return thrown_by([&] { enter_decision(ledger, entry_, d); });
  };
  EXPECT_TRUE(refused({grading::Verdict::review, "Dr. Examiner", "x"}));
  EXPECT_TRUE(tells(refused({grading::Verdict::pass, "", "x"}), "--person"));
  EXPECT_TRUE(refused({grading::Verdict::pass, "Dr. Examiner", "two\nlines"}));
  EXPECT_TRUE(tells(refused({grading::Verdict::pass, std::string(k_longest_person + 1, 'x'), "x"}),
                    Value(static_cast<std::int64_t>(k_longest_person))));
  enter_decision(ledger, entry_, {grading::Verdict::pass, "Dr. Examiner", "looked at the tooth"});
  const auto twice = refused({grading::Verdict::fail, "Dr. Other", "x"});
  EXPECT_EQ(code_of(twice), LedgerError::twice);
  EXPECT_TRUE(tells(twice, "Dr. Examiner"));
  json again = *session().filed;
  again["verdict"] = "pass";
  enter_regrade(ledger, entry_, again, {}, "marked anew");
  EXPECT_EQ(code_of(refused({grading::Verdict::fail, "Dr. Other", "x"})), LedgerError::not_now)
      << "the program leaves nothing to a person";
  EXPECT_THROW(enter_decision(ledger, 999, {grading::Verdict::pass, "x", "x"}), Error);
}

TEST_F(LeftToAPerson, GoesOutUndecidedWhereThatIsAskedFor) {
  Ledger ledger = school_.ledger();
  EXPECT_EQ(release_results(ledger, {.sessions = {entry_}}).to_decide, 1u);
  EXPECT_EQ(release_results(ledger, {.all = true, .undecided = true}).results.size(), 1u);
  EXPECT_NE(moodle().find(",,review,"), std::string::npos)
      << "no grade: a gradebook would count it as the final one";
  EXPECT_EQ(lti()["gradingProgress"], "PendingManual");
  EXPECT_FALSE(lti().contains("scoreGiven"));
  enter_decision(ledger, entry_, {grading::Verdict::pass, "Dr. Examiner", "looked at the tooth"});
  EXPECT_NE(moodle().find(",review,"), std::string::npos)
      << "the old one stands until the new one is released";
  release_results(ledger, {.all = true});
  EXPECT_NE(moodle().find(",pass,"), std::string::npos);
  EXPECT_EQ(lti()["gradingProgress"], "FullyGraded");
  EXPECT_EQ(lti()["scoreGiven"], session().shown->at("score")["points"]);
}

TEST_F(LeftToAPerson, ItsDecisionIsErasedWithItsResults) {
  Ledger ledger = school_.ledger();
  enter_decision(ledger, entry_, {grading::Verdict::pass, "Dr. Examiner", "looked at the tooth"});
  EXPECT_EQ(erase(ledger, {.sessions = {entry_}, .results = true}, "asked for").size(), 3u)
      << "mark, regrade, decision";
  EXPECT_TRUE(session().result->is_null());
  EXPECT_TRUE(review_queue(read_registry(ledger.content())).empty());
}

TEST_F(LeftToAPerson, AnAppealIsAnsweredOnceAndLetsAPersonDecide) {
  Ledger ledger = school_.ledger();
  enter_decision(ledger, entry_, {grading::Verdict::fail, "Dr. One", "the floor"});
  const auto again = [&] {
    enter_decision(ledger, entry_, {grading::Verdict::pass, "Dr. Two", "the probe slipped"});
  };
  EXPECT_TRUE(tells(thrown_by(again), "Dr. One"));
  EXPECT_EQ(code_of([&] { answer_appeal(ledger, entry_, Outcome::stands, "no"); }),
            LedgerError::unknown);
  open_appeal(ledger, entry_, "the floor was probed twice");
  EXPECT_EQ(code_of([&] { open_appeal(ledger, entry_, "again"); }), LedgerError::twice);
  EXPECT_EQ(code_of([&] { answer_appeal(ledger, entry_, Outcome::changed, "yes"); }),
            LedgerError::not_now);
  enter_regrade(ledger, entry_, *session().result, {}, "measured once more, and the same came out");
  EXPECT_EQ(code_of([&] { answer_appeal(ledger, entry_, Outcome::changed, "yes"); }),
            LedgerError::not_now);
  EXPECT_FALSE(thrown_by(again));
  EXPECT_EQ(code_of([&] { answer_appeal(ledger, entry_, Outcome::stands, "no"); }),
            LedgerError::another_state)
      << "its trail would say that it stands, and the next release would give out another verdict";
  answer_appeal(ledger, entry_, Outcome::changed, "a second examiner measured");
  EXPECT_TRUE(tells(thrown_by(again), "Dr. Two")) << "the appeal is answered";
  const FiledSession s = session();
  ASSERT_EQ(s.appeals.size(), 1u);
  EXPECT_EQ(s.appeals[0].reason, "the floor was probed twice");
  EXPECT_EQ(s.appeals[0].outcome, Outcome::changed);
  EXPECT_EQ(s.appeals[0].answer, "a second examiner measured");
  EXPECT_EQ(s.open_appeal(), nullptr);
  EXPECT_EQ(s.result->at("verdict"), "pass");
  EXPECT_TRUE(read_registry(read_ledger(school_.places())).findings.empty());
}

TEST_F(LeftToAPerson, WhatIsTakenBackStandsInNoExportUntilItIsReleasedAgain) {
  Ledger ledger = school_.ledger();
  EXPECT_EQ(code_of([&] { retract_results(ledger, {entry_}, "too early"); }), LedgerError::not_now);
  enter_decision(ledger, entry_, {grading::Verdict::pass, "Dr. One", "good"});
  ASSERT_EQ(release_results(ledger, {.all = true}).results.size(), 1u);
  ASSERT_NE(moodle().find("4711,"), std::string::npos) << moodle();
  EXPECT_THROW(retract_results(ledger, {entry_}, ""), Error);
  EXPECT_TRUE(tells(thrown_by([&] { retract_results(ledger, {}, "x"); }), "--session"));
  retract_results(ledger, {entry_}, "the wrong tooth was mounted");
  EXPECT_EQ(moodle().find("4711,"), std::string::npos) << moodle();
  EXPECT_TRUE(session().retracted_by);
  EXPECT_EQ(code_of([&] { retract_results(ledger, {entry_}, "again"); }), LedgerError::not_now);
  EXPECT_TRUE(session().taken_back());
  EXPECT_EQ(session().retracted_why, "the wrong tooth was mounted");
  const Release all = release_results(ledger, {.all = true});
  EXPECT_TRUE(all.results.empty()) << "nobody releases it without knowing";
  EXPECT_EQ(all.withheld, 1u);
  EXPECT_EQ(moodle().find("4711,"), std::string::npos);
  EXPECT_EQ(release_results(ledger, {.sessions = {entry_}}).results.size(), 1u) << "by name";
  EXPECT_NE(moodle().find("4711,"), std::string::npos);
  EXPECT_FALSE(session().retracted_by);
  EXPECT_TRUE(read_registry(read_ledger(school_.places())).findings.empty());
}

}  // namespace
}  // namespace cavum::records
