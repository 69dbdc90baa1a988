// Two hundred stations at once against one server: every report is taken, the live board shows it
// within two seconds, memory stays bounded.
#include <atomic>

#include "tests/ui/office/served.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using Steady = std::chrono::steady_clock;

TEST(ManyStations, AreAllHeardAndShownWithinTwoSeconds) {
  constexpr std::size_t k_stations = 200;
  constexpr int k_rounds = 3;
  constexpr long k_max_kb = 1'000'000;
  const School school;
  Accounts(station_path("office") + "/accounts.json")
      .set("Ian", Role::invigilator, k_password, false);
  std::vector<SigningKey> keys;
  {
    records::Ledger ledger = school.ledger();
    for (std::size_t i = 0; i < k_stations; ++i) {
      keys.push_back(load_signing_key(school.file("key-" + std::to_string(i)), "station"));
      const std::string code = records::invite_station(ledger, "Seat " + std::to_string(i + 2),
                                                       read_clocks().utc_ns + k_hour_ns);
      static_cast<void>(records::enrol_station(
          ledger, records::station_request(keys.back(), ledger.content().public_key, {}, code), 0,
          "request"));
    }
  }
  const std::string public_key = to_hex(School::key().public_key);
  const Served served(school);
  Visitor invigilator{served.port()};
  ASSERT_EQ(invigilator.sign_in("Ian", k_password).status, 200);

  std::atomic<int> refused = 0;
  std::atomic<std::int64_t> slowest_ms = 0;
  std::vector<Steady::time_point> last(k_stations);
  std::vector<std::thread> stations;
  for (std::size_t i = 0; i < k_stations; ++i)
    stations.emplace_back([&, i] {
      try {
        StationClient station(served.address(), station_path("office") + "/certificate.pem",
                              public_key, keys[i]);
        for (int round = 1; round <= k_rounds; ++round) {
          const auto from = Steady::now();
          station.report({{"state", "exam"},
                          {"step", round == k_rounds ? "the last step" : "an earlier step"},
                          {"left_s", 600}});
          last[i] = Steady::now();
          const std::int64_t ms =
              std::chrono::duration_cast<std::chrono::milliseconds>(last[i] - from).count();
          for (std::int64_t seen = slowest_ms;
               round > 1 && ms > seen && !slowest_ms.compare_exchange_weak(seen, ms);) {
          }
          if (round < k_rounds) std::this_thread::sleep_for(std::chrono::seconds(2));
        }
      } catch (const std::exception& e) {
        std::printf("%s\n", e.what());
        ++refused;
      }
    });
  Wire wire(served.port());
  wire.send("GET /api/board/events HTTP/1.1\r\nHost: x\r\nCookie: __Host-cavum=" +
            invigilator.cookie + "\r\n\r\n");
  Steady::time_point shown;
  static_cast<void>(wire.hear_for(
      std::chrono::seconds(60),
      [&](const std::string& text) {  // until one event shows all of them at their last step
        const auto end = text.rfind("\n\n");
        if (end == std::string::npos) return false;
        const auto begin = text.rfind("data: ", end);
        std::size_t n = 0;
        for (auto at = text.find("the last step", begin); at < end;
             at = text.find("the last step", at + 1))
          ++n;
        shown = Steady::now();
        return n == k_stations;
      }));
  for (auto& s : stations) s.join();
  EXPECT_EQ(refused, 0);
  const auto behind = std::chrono::duration_cast<std::chrono::milliseconds>(
                          shown - *std::max_element(last.begin(), last.end()))
                          .count();
  const long kb = served.peak_kb();
  std::printf(
      "%zu stations: board %lld ms behind the last report, slowest report %lld ms, peak memory %ld kB\n",
      k_stations, static_cast<long long>(behind), static_cast<long long>(slowest_ms), kb);
  EXPECT_LE(behind, 2000);
  EXPECT_LE(kb, k_max_kb);
}

}  // namespace
}  // namespace cavum::office
