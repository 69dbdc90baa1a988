// Days at a school that seeds draw (school_day.h): nothing that was acknowledged is lost, every
// wrong clock is named. CAVUM_SIMULATION_SEEDS says how many (10,000 take a quarter of an hour),
// CAVUM_TEST_SEED repeats a run, CAVUM_SIMULATION_DAY one day.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>

#include "tests/engine/support/basics.h"
#include "tests/simulation/school_day.h"

namespace cavum::simulation {
namespace {

const Morning& morning() {
  static const Morning made = make_morning();
  return made;
}

std::uint64_t number_in(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

/// Days on which something was wrong once, each kept: a disk that is full while the key is
/// replaced, twice, or while a backup is restored; a recording erased during a backup, twice, or
/// while somebody verifies; a second backup cut off before it says what it holds.
constexpr std::uint64_t k_kept[] = {
    2070568136836150368U, 3746302825775987233U, 15782216399703653366U, 17575763446533936184U,
    8878052474977038694U, 145598872595458111U,  14357867830483894556U};

struct Campaign {
  std::map<std::string, std::uint64_t> counts;
  std::vector<std::string> wrong;
};

void live_through(const std::vector<std::uint64_t>& seeds, Campaign& out) {
  {  // what all days share is made before they part
    SchoolDay warm(morning(), 1);
    warm.give("office 1", {Task::file});
    static_cast<void>(warm.run());
  }
  const testing_basics::Folder folder;
  // Processes that were killed leave their memory behind, SQLite's list of open files among it:
  // each day has a real process of its own, so that it is the same whatever came before it, and a
  // crash ends no more than this one.
  for (const std::uint64_t seed : seeds) {
    const std::string told = folder.file("day");
    std::cout.flush();
    std::fflush(stdout);
    const pid_t child = ::fork();
    if (child == 0) {
      std::ofstream file(told);
      SchoolDay day(morning(), seed);
      day.draw();
      for (const auto& w : day.run()) file << "wrong " << w << std::endl;
      for (const auto& [what, n] : day.counts()) file << "count " << n << " " << what << "\n";
      file << "end" << std::endl;
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    std::ifstream file(told);
    std::string line;
    const std::string day = std::to_string(seed);
    bool whole = false;
    while (std::getline(file, line)) {
      if (line.starts_with("wrong ")) {
        out.wrong.push_back("CAVUM_SIMULATION_DAY=" + day + ": " + line.substr(6));
        std::cout << out.wrong.back() << std::endl;
      }
      if (line.starts_with("count ")) {
        std::size_t used = 0;
        const auto n = std::stoull(line.substr(6), &used);
        out.counts[line.substr(7 + used)] += n;
      }
      whole = whole || line == "end";
    }
    if (!whole || status != 0)
      out.wrong.push_back("CAVUM_SIMULATION_DAY=" + day + ": ended the program, status " +
                          std::to_string(status));
  }
}

TEST(LedgerSimulation, NothingAcknowledgedIsLostAndEveryWrongClockIsNamed) {
  std::vector<std::uint64_t> seeds;
  if (const auto day = number_in("CAVUM_SIMULATION_DAY", 0); day != 0) {
    seeds = {day};
  } else {
    seeds.assign(std::begin(k_kept), std::end(k_kept));
    Random random(testing_basics::drawn_seed("ledger simulation"));
    for (auto n = number_in("CAVUM_SIMULATION_SEEDS",
                            std::getenv("CAVUM_DEEP") != nullptr ? 10'000 : 100);
         n > 0; --n)
      seeds.push_back(random.next());
  }
  const auto begun = std::chrono::steady_clock::now();
  Campaign campaign;
  live_through(seeds, campaign);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  std::cout << seeds.size() << " days in " << seconds << " s\n";
  for (const auto& [what, n] : campaign.counts) std::cout << "  " << n << " " << what << "\n";
  std::cout << campaign.wrong.size() << " findings\n";
  for (std::size_t i = 0; i < std::min<std::size_t>(campaign.wrong.size(), 40); ++i)
    ADD_FAILURE() << campaign.wrong[i];
}

TEST(LedgerSimulation, TheSameSeedGivesTheSameDay) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    Campaign once, again;
    live_through({seed}, once);
    live_through({seed}, again);
    EXPECT_EQ(once.counts, again.counts) << seed;
    EXPECT_EQ(once.wrong, again.wrong) << seed;
    EXPECT_GT(once.counts["calls"], 0u);
  }
}

}  // namespace
}  // namespace cavum::simulation
