// The disk refuses, or the power goes, at the first, second, third … change that entering anything makes to a file, until it goes through without.
// Afterwards the ledger opens, holds, and has every entry that was acknowledged.
#include <iostream>
#include <random>

#include "tests/engine/support/basics.h"
#include "tests/grading/ledger/faulty_vfs.h"
#include "tests/grading/ledger/school.h"

namespace cavum::ledger {
namespace {

using namespace testing_ledger;
using nlohmann::json;

/// Three entries and the end of the program; those that were acknowledged are noted before the next begins.
void enter_three(const School& school, std::vector<std::string>& acknowledged) {
  Ledger ledger = school.ledger();
  for (int i = 0; i < 3; ++i)
    acknowledged.push_back(
        ledger.append("forget",
                      [&](const LedgerContent&) {
                        return json{{"candidate", "C-" + std::string(300, static_cast<char>('a' + i))}};
                      })
            .text);
}

void expect_nothing_lost(const School& school, const std::vector<std::string>& acknowledged, const std::string& when) {
  const LedgerContent content = read_ledger(school.places());
  EXPECT_TRUE(content.findings.empty()) << when << ": " << content.findings[0];
  for (std::size_t i = 0; i < acknowledged.size(); ++i) {
    ASSERT_GT(content.entries.size(), i + k_first_entries) << when;
    EXPECT_EQ(content.entries[i + k_first_entries].text, acknowledged[i]) << when;
  }
  std::vector<std::string> more;
  enter_three(school, more);
  EXPECT_TRUE(check_ledger(school.places(), false).findings.empty()) << when;
  EXPECT_GE(read_ledger(school.places()).entries.size(), k_first_entries + 3 + acknowledged.size()) << when;
}

void try_all(DiskFault fault, const char* name) {
  const std::uint64_t seed = testing_basics::drawn_seed(name);
  const School fresh;
  int n = 1, changes = 0;
  for (bool happened = true; happened; ++n) {
    ASSERT_LT(n, 1000) << "it never goes through";
    const School school(fresh);
    std::vector<std::string> acknowledged;
    {
      const FaultyDisk disk(fault, n, seed + static_cast<std::uint64_t>(n));
      try {
        enter_three(school, acknowledged);
      } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("; "), std::string::npos) << "says what to do: " << e.what();
      }
      happened = FaultyDisk::happened();
      changes = FaultyDisk::changes();
    }
    if (fault == DiskFault::power_cut) {  // what lies in memory alone is gone
      std::error_code ignored;
      std::filesystem::remove(school.places().database() + "-shm", ignored);
    }
    expect_nothing_lost(school, acknowledged, std::string(name) + " at change " + std::to_string(n));
    if (testing::Test::HasFailure()) return;
  }
  std::cout << name << ": " << n - 2 << " places tried, " << changes << " changes without it\n";
  EXPECT_GE(n, 8) << "entering changes files more often than that";
}

TEST(KilledLedger, LosesNothingThatWasAcknowledgedWhenTheDiskRefuses) { try_all(DiskFault::refused, "refused"); }
TEST(KilledLedger, LosesNothingThatWasAcknowledgedWhenThePowerGoes) { try_all(DiskFault::power_cut, "power cut"); }

/// Three entries in one transaction.
void try_together(DiskFault fault, const char* name) {
  const std::uint64_t seed = testing_basics::drawn_seed(name);
  const School fresh;
  int n = 1;
  std::size_t with = 0, without = 0;
  for (bool happened = true; happened; ++n) {
    ASSERT_LT(n, 1000) << "it never goes through";
    const School school(fresh);
    bool acknowledged = false;
    {
      const FaultyDisk disk(fault, n, seed + static_cast<std::uint64_t>(n));
      try {
        Ledger ledger = school.ledger();
        const auto bodies = [](const LedgerContent&) { return std::vector<json>(3, {{"candidate", "C-" + std::string(300, 'a')}}); };
        acknowledged = ledger.append_all("forget", bodies) == 3;
      } catch (const Error&) {
      }
      happened = FaultyDisk::happened();
    }
    std::error_code ignored;
    if (fault == DiskFault::power_cut) std::filesystem::remove(school.places().database() + "-shm", ignored);
    const LedgerContent content = read_ledger(school.places());
    ASSERT_TRUE(content.findings.empty()) << name << " at change " << n << ": " << content.findings[0];
    const std::size_t added = content.entries.size() - k_first_entries;
    ASSERT_TRUE(added == 3 || (added == 0 && !acknowledged)) << name << " at change " << n << ": " << added << " of 3";
    (added == 3 ? with : without)++;
  }
  EXPECT_GT(with, 0u);
  EXPECT_GT(without, 0u);
}

TEST(KilledLedger, HasAllOfSeveralEntriesOrNoneWhenTheDiskRefuses) { try_together(DiskFault::refused, "together, refused"); }
TEST(KilledLedger, HasAllOfSeveralEntriesOrNoneWhenThePowerGoes) { try_together(DiskFault::power_cut, "together, power cut"); }

TEST(KilledLedger, ADiskThatForgetsWhatItSyncedIsFound) {
  // the test's own test: with a disk that lies, an acknowledged entry is lost, and the witness shows it
  const School school;
  Bytes before = read_file(school.places().database());
  std::vector<std::string> acknowledged;
  enter_three(school, acknowledged);
  write_file(school.places().database(), before);
  EXPECT_FALSE(check_ledger(school.places(), false).findings.empty());
}

}  // namespace
}  // namespace cavum::ledger
