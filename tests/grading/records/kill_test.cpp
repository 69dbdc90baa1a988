// The disk refuses, or the power goes, at the first, second, third … change that entering anything
// makes to a file, until it goes through without. Afterwards the ledger opens, holds, and has every
// entry that was acknowledged.
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <random>

#include "tests/engine/support/basics.h"
#include "tests/grading/records/faulty_vfs.h"
#include "tests/grading/records/school.h"

namespace cavum::records {
namespace {

using namespace testing_ledger;
using nlohmann::json;

/// Three entries and the end of the program; those that were acknowledged are noted before the next
/// begins.
void enter_three(const School& school, std::vector<std::string>& acknowledged) {
  Ledger ledger = school.ledger();
  for (int i = 0; i < 3; ++i)
    acknowledged.push_back(
        ledger
            .append([&](const LedgerContent&) {
              return ForgetEntry{"C-" + std::string(300, static_cast<char>('a' + i)), {}};
            })
            .text);
}

void expect_nothing_lost(const School& school, const std::vector<std::string>& acknowledged,
                         const std::string& when) {
  const LedgerContent content = read_ledger(school.places());
  EXPECT_TRUE(content.findings.empty()) << when << ": " << content.findings[0].message();
  for (std::size_t i = 0; i < acknowledged.size(); ++i) {
    ASSERT_GT(content.entries.size(), i + k_first_entries) << when;
    EXPECT_EQ(content.entries[i + k_first_entries].text, acknowledged[i]) << when;
  }
  std::vector<std::string> more;
  enter_three(school, more);
  EXPECT_TRUE(check_ledger(school.places(), false).findings.empty()) << when;
  EXPECT_GE(read_ledger(school.places()).entries.size(), k_first_entries + 3 + acknowledged.size())
      << when;
}

void try_all(InjectedFault fault, const char* name) {
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
        EXPECT_NE(std::string(e.what()).find("; "), std::string::npos)
            << "says what to do: " << e.what();
      }
      happened = FaultyDisk::happened();
      changes = FaultyDisk::changes();
    }
    if (fault == InjectedFault::power_cut) {  // what lies in memory alone is gone
      std::error_code ignored;
      std::filesystem::remove(school.places().database() + "-shm", ignored);
    }
    expect_nothing_lost(school, acknowledged,
                        std::string(name) + " at change " + std::to_string(n));
    if (::testing::Test::HasFailure()) return;
  }
  std::cout << name << ": " << n - 2 << " places tried, " << changes << " changes without it\n";
  EXPECT_GE(n, 8) << "entering changes files more often than that";
}

TEST(KilledLedger, LosesNothingThatWasAcknowledgedWhenTheDiskRefuses) {
  try_all(InjectedFault::refused, "refused");
}
TEST(KilledLedger, LosesNothingThatWasAcknowledgedWhenThePowerGoes) {
  try_all(InjectedFault::power_cut, "power cut");
}

/// Three entries in one transaction.
void try_together(InjectedFault fault, const char* name) {
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
        const auto three = [](const LedgerContent&) {
          return std::vector<Entry>(3, ForgetEntry{"C-" + std::string(300, 'a'), {}});
        };
        acknowledged = ledger.append_all(three) == 3;
      } catch (const Error&) {
      }
      happened = FaultyDisk::happened();
    }
    std::error_code ignored;
    if (fault == InjectedFault::power_cut)
      std::filesystem::remove(school.places().database() + "-shm", ignored);
    const LedgerContent content = read_ledger(school.places());
    ASSERT_TRUE(content.findings.empty())
        << name << " at change " << n << ": " << content.findings[0].message();
    const std::size_t added = content.entries.size() - k_first_entries;
    ASSERT_TRUE(added == 3 || (added == 0 && !acknowledged))
        << name << " at change " << n << ": " << added << " of 3";
    (added == 3 ? with : without)++;
  }
  EXPECT_GT(with, 0u);
  EXPECT_GT(without, 0u);
}

TEST(KilledLedger, HasAllOfSeveralEntriesOrNoneWhenTheDiskRefuses) {
  try_together(InjectedFault::refused, "together, refused");
}
TEST(KilledLedger, HasAllOfSeveralEntriesOrNoneWhenThePowerGoes) {
  try_together(InjectedFault::power_cut, "together, power cut");
}

TEST(KilledLedger, AWitnessThatCannotBeWrittenRefusesTheEntryBeforeItIsMade) {
  const School school;
  std::vector<std::string> acknowledged;
  enter_three(school, acknowledged);
  const std::string witness = witness_path(read_ledger(school.places()).id);
  const Bytes told = read_file(witness);
  std::filesystem::remove(witness);
  std::filesystem::create_symlink("/nowhere/witness", witness);
  const std::size_t before = read_ledger(school.places(), AskWitness::no).entries.size();
  std::vector<std::string> more;
  EXPECT_THROW(enter_three(school, more), DatabaseError);
  EXPECT_EQ(read_ledger(school.places(), AskWitness::no).entries.size(), before);
  std::filesystem::remove(witness);
  write_file(witness, told);
  expect_nothing_lost(school, acknowledged, "the witness is there again");
}

/// What happens in a process whose witness lies on a full disk of its own: 0 when an entry is
/// refused there and made once there is room.
int with_a_full_witness(const School& school, const std::string& witness) {
  const Bytes told = read_file(witness);
  const std::string folder = std::filesystem::path(witness).parent_path().string();
  const std::string nowhere = "none", kind = "tmpfs";
  if (::mount(nowhere.c_str(), "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return 77;
  if (::mount(nowhere.c_str(), folder.c_str(), kind.c_str(), 0, "size=4096") != 0) return 77;
  std::string whole(told.begin(), told.end());
  whole.append(4095 - whole.size() % 4096, '-') +=
      '\n';  // a line that is none; the next one needs a block
  std::ofstream(witness) << whole;
  const std::size_t before = read_ledger(school.places()).entries.size();
  std::vector<std::string> more;
  try {
    enter_three(school, more);
    return 1;
  } catch (const DatabaseError&) {
  }
  if (read_ledger(school.places()).entries.size() != before) return 2;
  if (::mount(nowhere.c_str(), folder.c_str(), kind.c_str(), MS_REMOUNT, "size=65536") != 0)
    return 3;
  enter_three(school, more);
  return check_ledger(school.places(), false).findings.empty() ? 0 : 4;
}

TEST(KilledLedger, AFullDiskOfTheWitnessRefusesTheEntryBeforeItIsMade) {
  const School school;
  std::vector<std::string> acknowledged;
  enter_three(school, acknowledged);
  const std::string witness = witness_path(read_ledger(school.places()).id);
  ASSERT_LT(std::filesystem::file_size(witness), 4096u);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (::unshare(CLONE_NEWNS) != 0) ::_exit(77);
    try {
      ::_exit(with_a_full_witness(school, witness));
    } catch (const std::exception&) {
      ::_exit(5);
    }
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "needs to be root, for a disk of its own";
  EXPECT_EQ(WEXITSTATUS(status), 0)
      << "1: entered, 2: entered and refused, 3: no room was made, 4: it does not hold, 5: an exception";
}

TEST(KilledLedger, ADiskThatForgetsWhatItSyncedIsFound) {
  // the test's own test: with a disk that lies, an acknowledged entry is lost, and the witness
  // shows it
  const School school;
  Bytes before = read_file(school.places().database());
  std::vector<std::string> acknowledged;
  enter_three(school, acknowledged);
  write_file(school.places().database(), before);
  EXPECT_FALSE(check_ledger(school.places(), false).findings.empty());
}

}  // namespace
}  // namespace cavum::records
