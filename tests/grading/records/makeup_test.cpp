// Makeup sittings: who gets one, what becomes of the first sitting, and that of two results of one
// candidate one counts.
#include "grading/records/makeup.h"

#include "grading/records/begin.h"
#include "grading/records/decision.h"
#include "grading/records/exports.h"
#include "grading/records/ledger_error.h"
#include "grading/records/regrade.h"
#include "grading/records/release.h"
#include "tests/grading/records/school.h"
#include "tests/grading/records/short_exam.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;
using testing_basics::code_of;
using testing_basics::tells;
using testing_basics::thrown_by;

class MakeupSitting : public ::testing::Test {
 protected:
  /// Entry of the ticket that was issued last.
  [[nodiscard]] std::uint64_t last_entry() const {
    return read_ledger(school_.places()).entries.size() - 1;
  }
  [[nodiscard]] Registry registry() const { return read_registry(read_ledger(school_.places())); }
  [[nodiscard]] IssuedTicket ticket_of(std::uint64_t entry) const {
    for (const auto& t : registry().tickets)
      if (t.seq == entry) return t;
    return {};
  }
  std::string past_ticket(const std::string& candidate) const {
    return school_.ticket(candidate, [](Ticket& t) {
      t.not_before_utc_ns -= 3 * k_hour_ns, t.not_after_utc_ns -= 2 * k_hour_ns;
    });
  }
  std::string make_up(std::uint64_t first, FirstSitting became,
                      const std::string& reason = "the lift stood still") const {
    Ledger ledger = school_.ledger();
    const std::int64_t now = read_clocks().utc_ns;
    return issue_makeup(ledger,
                        promise(*scenarios::prepare_exam(k_scenario, {}), ledger.content(),
                                now - k_hour_ns, now + k_hour_ns),
                        {first, became, reason});
  }
  /// Why none is given; nothing is entered.
  std::optional<Error> why_not(std::uint64_t first, FirstSitting became,
                               const std::string& reason = "x") const {
    const std::size_t before = last_entry();
    auto refused = thrown_by([&] { static_cast<void>(make_up(first, became, reason)); });
    EXPECT_TRUE(refused) << "was given";
    EXPECT_EQ(last_entry(), before) << "nothing is entered";
    return refused;
  }
  /// The short exam: nothing is cut, so its points are those of an untouched tooth.
  Filing file_short(const std::string& ticket) const {
    static int n = 0;
    const std::string path = school_.file("short-" + std::to_string(++n) + ".cavum");
    sit_shortly(k_scenario, path, ticket);
    Ledger ledger = school_.ledger();
    return file_session(ledger, path);
  }
  Filing file(const std::string& path) const {
    Ledger ledger = school_.ledger();
    return file_session(ledger, path);
  }
  std::size_t release_all() const {
    Ledger ledger = school_.ledger();
    return release_results(ledger, {.all = true}).results.size();
  }
  std::string gradebook() const {
    Identities identities(school_.places().identities());
    int left_out = 0;
    return moodle_csv(registry(), identities, left_out, english_text);
  }
  School school_;
};

TEST_F(MakeupSitting, TakesThePlaceOfAMissedOneAndTheGradebookSaysSo) {
  const std::string first = past_ticket("4711");
  const std::uint64_t entry = last_entry();
  const std::string makeup = make_up(entry, FirstSitting::missed);
  EXPECT_EQ(parse_ticket(makeup, "", "t").candidate, parse_ticket(first, "", "t").candidate);
  EXPECT_NE(parse_ticket(makeup, "", "t").nonce, parse_ticket(first, "", "t").nonce);
  EXPECT_EQ(ticket_of(entry).made_up_by, last_entry());
  EXPECT_EQ(ticket_of(last_entry()).makes_up->became, FirstSitting::missed);
  EXPECT_EQ(read_ledger(school_.places()).entries.back().by.reason, "the lift stood still");
  const Filing filed = file(school_.sit(makeup));
  ASSERT_TRUE(filed.seq) << filed.findings.front().message();
  EXPECT_EQ(release_all(), 1u);
  EXPECT_NE(gradebook().find(" " + std::to_string(entry)), std::string::npos) << gradebook();
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
}

TEST_F(MakeupSitting, OfAnInterruptedOneCountsAloneWhateverTheFirstWasWorth) {
  const std::string first = school_.ticket("4711");
  const std::uint64_t entry = last_entry();
  const auto good = file(school_.sit(first));  // the better of the two
  ASSERT_TRUE(good.seq);
  const std::string makeup = make_up(entry, FirstSitting::interrupted);
  EXPECT_EQ(registry().sessions[0].made_up_by, last_entry());
  EXPECT_EQ(release_all(), 0u) << "the first does not count";
  {
    Ledger ledger = school_.ledger();
    json review = *registry().sessions[0].result;
    review["verdict"] = "review";
    enter_regrade(ledger, *good.seq, review, {}, "as if the program had left it to a person");
    const std::size_t before = last_entry();
    EXPECT_EQ(code_of([&] {
                enter_decision(ledger, *good.seq, {grading::Verdict::pass, "Dr. Examiner", "x"});
              }),
              LedgerError::contested);
    EXPECT_EQ(last_entry(), before);
  }
  const auto worse = file_short(makeup);
  ASSERT_TRUE(worse.seq) << worse.findings.front().message();
  Ledger ledger = school_.ledger();
  EXPECT_THROW(release_results(ledger, {.with_findings = true, .sessions = {*good.seq}}), Error);
  EXPECT_EQ(release_results(ledger, {.all = true, .undecided = true}).results,
            std::vector<std::uint64_t>{*worse.seq});
  const auto shown = registry();
  EXPECT_EQ(shown.sessions[0].shown_seq, 0u);
  EXPECT_NE(shown.sessions[0].result->at("score")["points"],
            shown.sessions[1].result->at("score")["points"])
      << "the test can tell them apart";
  const std::string csv = gradebook();
  EXPECT_NE(csv.find("\n4711," + shown.sessions[1].result->at("score")["points"].dump() + ","),
            std::string::npos)
      << csv;
  EXPECT_NE(csv.find(" " + std::to_string(entry)), std::string::npos) << csv;
  Identities identities(school_.places().identities());
  EXPECT_EQ(lti_scores(registry(), identities, english_text).size(), 1u);
  const json signed_ones = json::parse(signed_results(registry(), ledger))["results"];
  EXPECT_EQ(signed_ones[0]["made_up_by"], *ticket_of(entry).made_up_by);
  EXPECT_EQ(signed_ones[1]["makes_up"], entry);
}

TEST_F(MakeupSitting, LetsNothingBeBegunOrFiledWithTheFirstTicketAnyMore) {
  const std::string first = school_.ticket("4711", [](Ticket& t) { t.begun_at_ledger = false; });
  const std::uint64_t entry = last_entry();
  const std::string path = school_.sit(first);  // the candidate kept it back
  const std::string makeup = make_up(entry, FirstSitting::interrupted);
  Ledger ledger = school_.ledger();
  EXPECT_THROW(static_cast<void>(let_begin(ledger, parse_ticket(first, "", "t").nonce, "")), Error);
  const Filing refused = file(path);
  EXPECT_FALSE(refused.seq);
  expect_kinds(refused.findings, {Kind::ticket_made_up});
  ASSERT_TRUE(file_short(makeup).seq);
  FilingOptions all_the_same;
  all_the_same.with_findings = true;
  Ledger again = school_.ledger();
  const auto questioned = file_session(again, path, all_the_same);
  ASSERT_TRUE(questioned.seq);
  EXPECT_THROW(release_results(again, {.with_findings = true, .sessions = {*questioned.seq}}),
               Error)
      << "not even by name";
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
}

TEST_F(MakeupSitting, IsNotGivenBesideAReleasedResult) {
  const std::string first = school_.ticket("4711");
  const std::uint64_t entry = last_entry();
  const auto filed = file(school_.sit(first));
  ASSERT_EQ(release_all(), 1u);
  EXPECT_TRUE(tells(why_not(entry, FirstSitting::interrupted),
                    Value(static_cast<std::int64_t>(*filed.seq))))
      << "which is to be taken back first";
  Ledger ledger = school_.ledger();
  retract_results(ledger, {*filed.seq}, "the power failed");
  EXPECT_FALSE(make_up(entry, FirstSitting::interrupted).empty());
}

TEST_F(MakeupSitting, IsGivenOnceWithAReasonAndToWhomItIsDue) {
  static_cast<void>(school_.ticket("4711", [](Ticket& t) {
    t.not_before_utc_ns += 2 * k_hour_ns, t.not_after_utc_ns += 2 * k_hour_ns;
  }));
  EXPECT_EQ(code_of(why_not(last_entry(), FirstSitting::missed)), LedgerError::not_now)
      << "it is still to come";
  static_cast<void>(school_.ticket("4712"));
  const std::uint64_t running = last_entry();
  EXPECT_EQ(code_of(why_not(running, FirstSitting::missed)), LedgerError::not_now)
      << "its time is not over";
  EXPECT_EQ(code_of(why_not(running, FirstSitting::interrupted, "")), General::error)
      << "without a reason";
  EXPECT_EQ(code_of(why_not(0, FirstSitting::missed)), LedgerError::unknown);
  static_cast<void>(past_ticket("4713"));
  const std::uint64_t past = last_entry();
  static_cast<void>(make_up(past, FirstSitting::missed));
  EXPECT_TRUE(
      tells(why_not(past, FirstSitting::missed), Value(static_cast<std::int64_t>(last_entry()))))
      << "the makeup that there is";
  static_cast<void>(past_ticket("4714"));
  const std::uint64_t cancelled = last_entry();
  Ledger ledger = school_.ledger();
  cancel_ticket(ledger, cancelled, "ill");
  EXPECT_EQ(code_of(why_not(cancelled, FirstSitting::missed)), LedgerError::not_now);
  static_cast<void>(past_ticket("4715"));
  const std::uint64_t beside = last_entry();
  static_cast<void>(school_.ticket("4715"));
  EXPECT_TRUE(
      tells(why_not(beside, FirstSitting::missed), Value(static_cast<std::int64_t>(last_entry()))))
      << "the other ticket";
}

TEST_F(MakeupSitting, ThatWasCancelledBeforeItBeganGivesTheFirstBackAndOneThatWasBegunDoesNot) {
  static_cast<void>(school_.ticket("4711"));
  const std::uint64_t a = last_entry();
  static_cast<void>(make_up(a, FirstSitting::interrupted));
  {
    Ledger ledger = school_.ledger();
    EXPECT_THROW(cancel_ticket(ledger, a, "x"), Error) << "it is made up";
    cancel_ticket(ledger, last_entry(), "given to the wrong one");
  }
  EXPECT_FALSE(ticket_of(a).made_up_by);
  const std::string b = make_up(a, FirstSitting::interrupted);
  const std::uint64_t begun = last_entry();
  Ledger ledger = school_.ledger();
  static_cast<void>(let_begin(ledger, parse_ticket(b, "", "t").nonce, ""));
  cancel_ticket(ledger, begun, "the station died");
  EXPECT_EQ(ticket_of(a).made_up_by, begun)
      << "who has begun a makeup does not go back to the first";
  static_cast<void>(make_up(begun, FirstSitting::interrupted));
  EXPECT_EQ(ticket_of(last_entry()).first_sitting, a);
  EXPECT_TRUE(registry().findings.empty());
}

TEST_F(MakeupSitting, OfTwoSittingsOneIsShownAlsoWhereAnEntryNamesBoth) {
  const std::string first = school_.ticket("4711");
  const std::uint64_t entry = last_entry();
  const auto a = file(school_.sit(first));
  const std::string makeup = make_up(entry, FirstSitting::interrupted);
  const auto b = file_short(makeup);
  ASSERT_TRUE(a.seq && b.seq);
  Ledger ledger = school_.ledger();
  ledger.append([&](const LedgerContent&) {
    return ReleaseEntry{{*a.seq, *b.seq}};
  });  // as another program might write it
  const Registry r = registry();
  EXPECT_EQ(r.sessions[0].shown_seq, 0u);
  EXPECT_EQ(r.sessions[1].shown_seq, *b.seq);
  expect_kinds(r.remarks, {Kind::release_void});
  EXPECT_TRUE(tells(words_of(r.remarks), Value(static_cast<std::int64_t>(*a.seq))))
      << r.remarks[0].message();
}

}  // namespace
}  // namespace cavum::records
