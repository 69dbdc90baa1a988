#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "grading/ledger/csv.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::error_of;

TEST(CsvLimits, RowsAndFieldsBeyondAreRefusedWithTheLimitNamed) {
  std::string rows = "id,name\n", fields = "id";
  for (int i = 0; i < 20'000; ++i) rows += "1,a\n";
  EXPECT_EQ(parse_csv(rows, "class.csv").size(), 20'001U);
  EXPECT_EQ(error_of([&] { static_cast<void>(parse_csv(rows + "1,a\n", "class.csv")); }),
            "class.csv:20002: is beyond the limit of 20000 rows; split the table");
  for (int i = 1; i < 100; ++i) fields += ",x";
  EXPECT_EQ(parse_csv(fields, "class.csv")[0].fields.size(), 100U);
  EXPECT_EQ(error_of([&] { static_cast<void>(parse_csv(fields + ",x", "class.csv")); }),
            "class.csv:1: has more than 100 fields; leave out what is not asked for");
}

}  // namespace
}  // namespace cavum
