// Stations that all hand in at once, to a server that is killed with -9 at random moments and whose
// disk is full now and then: nothing that it acknowledged is lost, every exam is filed once, and
// the stations send again by themselves. 200 stations and 50 kills with CAVUM_DEEP=1.
#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>

#include "tests/grading/records/short_exam.h"
#include "tests/ui/office/served.h"
#include "ui/office/station_link.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using Steady = std::chrono::steady_clock;

struct Seat {
  std::string recording, sha256;
  SigningKey key;
};

/// A seat that is enrolled, with an exam that was sat there.
Seat sat(const School& school, int number) {
  const std::string home = school.file("seat-" + std::to_string(number)),
                    ticket = school.ticket("c" + std::to_string(number));
  std::filesystem::create_directories(home);
  Seat seat{home + "/exam.cavum", "", {}};
  std::string request;
  records::Ledger ledger = school.ledger();
  const std::string code = records::invite_station(ledger, "Seat " + std::to_string(number + 2),
                                                   read_clocks().utc_ns + k_hour_ns);
  {
    const testing_ledger::AtStation here(home);
    seat.key = load_station_key(station_key_path());
    sit_shortly(k_scenario, seat.recording, ticket);
  }
  static_cast<void>(records::enrol_station(
      ledger, records::station_request(seat.key, ledger.content().public_key, {}, code), 0,
      "request"));
  seat.sha256 = to_hex(sha256(read_file(seat.recording)));
  return seat;
}

/// Each that has a receipt stands in the ledger as the receipt says.
std::size_t acknowledged(const School& school, const std::vector<Seat>& seats,
                         const std::string& when) {
  const auto content = records::read_ledger(school.places());
  EXPECT_TRUE(content.findings.empty())
      << when << ": " << english_text(content.findings.front().message());
  std::size_t n = 0;
  for (const Seat& seat : seats) {
    const auto outcome = StationLink::outcome(seat.recording);
    if (!outcome) continue;
    EXPECT_TRUE(outcome->filed) << when << ": "
                                << (outcome->findings.empty() ? "" : outcome->findings.front());
    if (!outcome->filed) continue;
    EXPECT_LT(outcome->entry, content.entries.size()) << when;
    if (outcome->entry < content.entries.size()) {
      EXPECT_EQ(content.entries[outcome->entry].as<records::SessionEntry>()->file_sha256,
                seat.sha256)
          << when;
    }
    ++n;
  }
  return n;
}

TEST(FilingStorm, NothingAcknowledgedIsLostAndEveryExamIsFiledOnce) {
  const bool deep = std::getenv("CAVUM_DEEP") != nullptr;
  const int stations = deep ? 200 : 12, kills = deep ? 50 : 6;
  constexpr long k_max_kb = 1'000'000;
  const School school;
  const std::uint64_t seed = test::drawn_seed("when the server is killed in the storm");
  std::mt19937_64 random(seed);
  std::vector<Seat> seats;
  for (int i = 0; i < stations; ++i) seats.push_back(sat(school, i));

  auto served = std::make_unique<Served>(school);
  const std::uint16_t port = served->port();
  std::vector<std::unique_ptr<StationLink>> links;
  for (const Seat& seat : seats)
    links.push_back(
        std::make_unique<StationLink>(LinkOptions{served->address(),
                                                  station_path("office") + "/certificate.pem",
                                                  to_hex(School::key().public_key),
                                                  seat.recording + ".tickets",
                                                  {seat.recording}},
                                      seat.key));
  long most_kb = 0;
  int full = 0, at_work = 0;
  std::size_t before = 0;
  for (int kill = 0; kill < kills; ++kill) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100 + random() % 1500));
    most_kb = std::max(most_kb, served->peak_kb());
    served->kill();
    const std::size_t now = acknowledged(
        school, seats, "kill " + std::to_string(kill) + ", seed " + std::to_string(seed));
    EXPECT_GE(now, before);
    before = now;
    at_work += now < seats.size() ? 1 : 0;
    const bool disk_is_full = random() % 4 == 0;  // for the next of its lives
    full += disk_is_full ? 1 : 0;
    served = std::make_unique<Served>(
        school, port,
        disk_is_full ? std::filesystem::file_size(school.places().database()) + 4096 : 0);
  }
  served->kill();
  served = std::make_unique<Served>(school, port);
  const auto from = Steady::now();
  std::size_t filed = 0;
  while ((filed = acknowledged(school, seats, "at the end")) < seats.size() &&
         Steady::now() - from < std::chrono::minutes(5))
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  most_kb = std::max(most_kb, served->peak_kb());
  links.clear();
  EXPECT_EQ(filed, seats.size()) << "seed " << seed;
  std::multiset<std::string> entries;
  for (const auto& e : records::read_ledger(school.places()).entries)
    if (const auto* s = e.as<records::SessionEntry>()) entries.insert(s->file_sha256);
  for (const Seat& seat : seats) EXPECT_EQ(entries.count(seat.sha256), 1U) << "seed " << seed;
  EXPECT_LE(most_kb, k_max_kb);
  std::printf(
      "FilingStorm: %d stations, %d kills, %d of them before all was filed, %d lives with a full disk; %zu filed before the last life, all %.1f s "
      "after it began; %ld kB\n",
      stations, kills, at_work, full, before,
      std::chrono::duration<double>(Steady::now() - from).count(), most_kb);
}

}  // namespace
}  // namespace cavum::office
