// A station takes a ticket once.
#include "grading/records/station_ticket.h"

#include <gtest/gtest.h>

#include "grading/records/ledger_error.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;

class StationTicket : public ::testing::Test {
 protected:
  HeldTicket held(const std::string& candidate) {
    const std::string path = school_.file(candidate + ".ticket");
    write_text_file(path, school_.ticket(candidate));
    return read_ticket(path);
  }
  School school_;
};

TEST_F(StationTicket, IsRefusedASecondTimeAndNamesTheFirst) {
  const HeldTicket mine = held("4711"), other = held("4712");
  EXPECT_NO_THROW(require_unused(mine));
  const int answer = begin_with_ticket(&mine, "exams/a b.cavum", [] { return 7; });
  EXPECT_EQ(answer, 7);
  const auto refusal = testing_basics::thrown_by([&] { require_unused(mine); });
  EXPECT_EQ(testing_basics::code_of(refusal), LedgerError::used);
  EXPECT_TRUE(testing_basics::tells(refusal, "exams/a b.cavum"))
      << testing_basics::text_of(refusal);
  bool begun = false;
  EXPECT_THROW(static_cast<void>(begin_with_ticket(&mine, "b.cavum", [&] { return begun = true; })),
               Error);
  EXPECT_FALSE(begun);
  EXPECT_NO_THROW(require_unused(other)) << "another ticket is another exam";
}

TEST_F(StationTicket, StaysGoodWhenTheExamCouldNotBegin) {
  const HeldTicket mine = held("4711");
  const auto fails = []() -> int { throw Error("disk", msg("is full"), msg("make room")); };
  EXPECT_THROW(static_cast<void>(begin_with_ticket(&mine, "a.cavum", fails)), Error);
  EXPECT_NO_THROW(require_unused(mine));
  EXPECT_EQ(begin_with_ticket(&mine, "b.cavum", [] { return 1; }), 1);
  EXPECT_THROW(require_unused(mine), Error);
}

TEST_F(StationTicket, IsRememberedThoughALineBeforeWasCutOff) {
  const HeldTicket mine = held("4711");
  write_text_file(used_tickets_path(), "used 0123\n\nnot a line at all\nused");
  EXPECT_NO_THROW(require_unused(mine));
}

TEST_F(StationTicket, NobodyAsksForOneWhereNoneIsHeld) {
  EXPECT_EQ(begin_with_ticket(nullptr, "a.cavum", [] { return 3; }), 3);
  EXPECT_FALSE(std::filesystem::exists(used_tickets_path()));
}

}  // namespace
}  // namespace cavum::records
