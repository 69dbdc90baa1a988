// What the office promised and took back: one live ticket for each candidate and exam, tickets that
// are cancelled, and the ledger's word to begin.
#include <gtest/gtest.h>

#include "grading/records/begin.h"
#include "grading/records/ledger_error.h"
#include "grading/records/station_ticket.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using testing_basics::code_of;
using testing_basics::tells;
using testing_basics::thrown_by;

class Promised : public ::testing::Test {
 protected:
  Filing file(const std::string& path) {
    Ledger ledger = school_.ledger();
    return file_session(ledger, path);
  }
  void expect_refused(const std::string& path, Kind kind) {
    const Filing f = file(path);
    EXPECT_FALSE(f.seq);
    expect_finding(f.findings, kind);
  }
  std::string let_begin(const std::string& ticket, const std::string& again = "") {
    Ledger ledger = school_.ledger();
    return records::let_begin(ledger, parse_ticket(ticket, "", "ticket").nonce, again);
  }
  std::string sit(const std::string& ticket, const std::string& begin) {
    return school_.sit(ticket, "expert", [&](scenarios::ExamOptions& o) {
      if (!begin.empty()) o.notes.emplace_back(k_begin_note, begin);
    });
  }
  School school_;
};

TEST_F(Promised, ACandidateHasOneLiveTicketForAnExamUnlessAPersonSaysOtherwise) {
  Ledger ledger = school_.ledger();
  Identities identities(school_.places().identities());
  const std::int64_t now = read_clocks().utc_ns;
  const Ticket t = promise(*scenarios::prepare_exam(k_scenario, {}), ledger.content(),
                           now - k_hour_ns, now + k_hour_ns);
  const std::string candidate = identities.enrol("4711", "", t.exam, ledger.key());
  static_cast<void>(issue(ledger, t, candidate));
  const auto entries = ledger.content().entries.size();
  EXPECT_THROW(static_cast<void>(issue(ledger, t, candidate)), AnotherTicket);
  EXPECT_EQ(ledger.content().entries.size(), entries) << "nothing is entered";
  EXPECT_NO_THROW(static_cast<void>(issue(ledger, t, candidate, Another::allow)));
  Ticket past = t;
  past.not_before_utc_ns = now - 2 * k_hour_ns;
  past.not_after_utc_ns = now - k_hour_ns;
  const std::string late = identities.enrol("4712", "", t.exam, ledger.key());
  static_cast<void>(issue(ledger, past, late));
  EXPECT_NO_THROW(static_cast<void>(issue(ledger, t, late))) << "one that ran out is not live";
}

TEST_F(Promised, ACancelledTicketIsNotLiveAndItsExamIsAFinding) {
  const std::string ticket = school_.ticket("4711");
  const std::string path = school_.sit(ticket);
  Ledger ledger = school_.ledger();
  const std::uint64_t seq = ledger.content().entries.size() - 1;
  cancel_ticket(ledger, seq, "wrong room");
  EXPECT_EQ(read_registry(ledger.content())
                .live_ticket(parse_ticket(ticket, "", "t").candidate,
                             parse_ticket(ticket, "", "t").exam, 0),
            nullptr);
  EXPECT_THROW(cancel_ticket(ledger, seq, "again"), Error);
  EXPECT_THROW(cancel_ticket(ledger, 0, "no ticket"), Error);
  expect_refused(path, Kind::ticket_cancelled);
  EXPECT_TRUE(check_ledger(school_.places(), false).findings.empty());
}

TEST_F(Promised, AUsedTicketIsNotCancelled) {
  ASSERT_TRUE(file(school_.sit(school_.ticket("4711"))).seq);
  Ledger ledger = school_.ledger();
  EXPECT_EQ(code_of([&] { cancel_ticket(ledger, k_first_entries, "late"); }), LedgerError::used);
}

TEST_F(Promised, WhoHasSatAnExamGetsNoOtherTicketForItUnlessAPersonSaysSo) {
  const std::string ticket = school_.ticket("4711");
  ASSERT_TRUE(file(school_.sit(ticket)).seq);
  Ledger ledger = school_.ledger();
  const std::uint64_t session = read_registry(ledger.content()).sessions.at(0).seq;
  const Ticket t = parse_ticket(ticket, "", "t");
  const auto why = thrown_by([&] { static_cast<void>(issue(ledger, t, t.candidate)); });
  EXPECT_TRUE(tells(why, "block_cavity") && tells(why, Value(static_cast<std::int64_t>(session))))
      << testing_basics::text_of(why);
  EXPECT_NO_THROW(static_cast<void>(issue(ledger, t, t.candidate, Another::allow)));
}

TEST_F(Promised, AnExamThatTheLedgerLetBeginIsFiled) {
  const std::string ticket = school_.ticket("4711", [](Ticket& t) { t.begun_at_ledger = true; });
  const Filing f = file(sit(ticket, let_begin(ticket)));
  for (const auto& finding : f.findings) ADD_FAILURE() << finding.message();
  EXPECT_TRUE(f.seq);
  EXPECT_TRUE(check_ledger(school_.places(), true).findings.empty());
}

TEST_F(Promised, WithoutTheWordThatItsTicketAsksForItIsAFinding) {
  const std::string ticket = school_.ticket("4711", [](Ticket& t) { t.begun_at_ledger = true; });
  expect_refused(sit(ticket, ""), Kind::begin_missing);
}

TEST_F(Promised, AnExamBegunAtTwoStationsCountsWithTheLastWordAlone) {
  const std::string ticket = school_.ticket("4711");
  const std::string first = sit(ticket, let_begin(ticket));
  EXPECT_EQ(code_of([&] { static_cast<void>(let_begin(ticket)); }), LedgerError::twice);
  const std::string second = sit(ticket, let_begin(ticket, "the first station broke"));
  expect_refused(first, Kind::begin_invalid);
  expect_refused(sit(ticket, ""), Kind::begin_missing);
  EXPECT_TRUE(file(second).seq);
}

TEST_F(Promised, AStationsClockThatWasSetBackIsNamedByTheLedgersWord) {
  // sat now, dated two hours back: the ticket allows it, and so does the day within which an exam
  // is handed in
  const std::string ticket =
      school_.ticket("4711", [](Ticket& t) { t.not_before_utc_ns -= 4 * k_hour_ns; });
  const std::string word = let_begin(ticket), path = sit(ticket, word);
  const SessionReader session(path);
  SessionSetup setup = session.setup();
  const std::int64_t back_ns = 2 * k_hour_ns;
  const std::string dated = school_.file("dated.cavum");
  {
    Clocks at = session.created();
    at.utc_ns -= back_ns;
    scenarios::ExamOptions options;
    options.candidate = setup.candidate;
    options.source = setup.source;
    options.position_quantum_mm = OmniModel{}.quantum_mm;
    options.notes = {{k_ticket_note, ticket}, {k_begin_note, word}};
    const auto exam_setup = scenarios::prepare_exam(k_scenario, options);
    auto candidate = scenarios::make_simulated_candidate(*exam_setup, "expert", 7, OmniModel{});
    std::int64_t ticks = 0;
    const auto exam = scenarios::Exam::start(*exam_setup, dated, candidate.start_mm(), [&] {
      const std::int64_t ns = ticks * 1'000'000;
      return Clocks{at.monotonic_ns + ns, at.boot_ns + ns, at.utc_ns + ns};
    });
    for (TickInput input; !exam->over() && candidate.next(exam->last(), exam->last_input(), input);
         ++ticks)
      static_cast<void>(exam->tick(input));
    if (!exam->over()) exam->end();
    exam->recorder().flush();
    grading::ExamContexts grounds;
    const auto graded = grading::load_for_grading(SessionReader(dated), exam->tooth_now(), grounds);
    exam->close(grading::to_json(grading::grade(graded->input(), graded->rubric)).dump());
  }
  expect_refused(dated, Kind::clock);
}

TEST_F(Promised, TheWordOfAnotherTicketOrLedgerIsNone) {
  const std::string mine = school_.ticket("4711"), other = school_.ticket("4712");
  expect_refused(sit(mine, let_begin(other)), Kind::begin_invalid);
  std::string changed = let_begin(mine);
  changed.replace(changed.find("\"utc_ns\":") + 9, 1, "2");
  expect_refused(sit(mine, changed), Kind::begin_invalid);
}

TEST_F(Promised, TheLedgerLetsNothingBeginThatItDidNotPromiseNow) {
  const std::string late = school_.ticket("4711", [](Ticket& t) {
    t.not_before_utc_ns += 2 * k_hour_ns, t.not_after_utc_ns += 2 * k_hour_ns;
  });
  EXPECT_EQ(code_of([&] { static_cast<void>(let_begin(late)); }), LedgerError::not_now);
  const std::string cancelled = school_.ticket("4712");
  {
    Ledger ledger = school_.ledger();
    cancel_ticket(ledger, ledger.content().entries.size() - 1, "x");
  }
  EXPECT_EQ(code_of([&] { static_cast<void>(let_begin(cancelled)); }), LedgerError::ended);
  Ledger ledger = school_.ledger();
  EXPECT_EQ(
      code_of([&] { static_cast<void>(records::let_begin(ledger, std::string(32, '0'), "")); }),
      LedgerError::unknown);
}

TEST_F(Promised, AStationTakesTheWordThatLiesBesideTheTicketAndBeginsNothingWithoutTheOneItNeeds) {
  const std::string ticket = school_.ticket("4711", [](Ticket&t) { t.begun_at_ledger = true; }),
                    path = school_.file("C.ticket");
  write_text_file(path, ticket + "\n");
  scenarios::ExamOptions options;
  const auto setup = [&](const HeldTicket& held) {
    scenarios::ExamOptions o = options;
    use_ticket(held, o);
    return scenarios::prepare_exam(k_scenario, o);
  };
  const HeldTicket without = read_ticket(path);
  EXPECT_EQ(code_of([&] { require_promised(without, setup(without)->session); }),
            LedgerError::unknown);
  write_text_file(begin_path(path), let_begin(ticket) + "\n");
  const HeldTicket held = read_ticket(path);
  EXPECT_NO_THROW(require_promised(held, setup(held)->session));
  write_text_file(begin_path(path), let_begin(school_.ticket("4712")) + "\n");
  EXPECT_THROW(static_cast<void>(read_ticket(path)), Error) << "another ticket's";
}

}  // namespace
}  // namespace cavum::records
