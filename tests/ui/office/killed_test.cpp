// A server that is killed with -9 again and again while exams are handed in: what it said was filed
// is in the ledger, and the rest is sent again.
#include <random>
#include <set>

#include "tests/grading/records/short_exam.h"
#include "tests/ui/office/served.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

TEST(Killed, NothingThatWasAcknowledgedIsLost) {
  constexpr int k_exams = 6, k_kills = 8;
  const School school;
  const std::uint64_t seed = test::drawn_seed("when the server is killed");
  std::mt19937_64 random(seed);
  std::vector<Bytes> exams;
  for (int i = 0; i < k_exams; ++i) {
    const std::string path = school.file("e" + std::to_string(i) + ".cavum");
    sit_shortly(k_scenario, path, school.ticket("c" + std::to_string(i)));
    exams.push_back(read_file(path));
  }
  std::map<std::string, std::uint64_t> acknowledged;  // entries by hash, as the server said
  const auto try_all = [&](const std::string& address, std::chrono::steady_clock::time_point until,
                           const auto& ready) {
    StationClient station(address, station_path("office") + "/certificate.pem",
                          to_hex(School::key().public_key), load_station_key(station_key_path()));
    while (std::chrono::steady_clock::now() < until && acknowledged.size() < exams.size()) {
      for (const Bytes& image : exams) {
        const std::string hash = to_hex(sha256(image));
        if (acknowledged.contains(hash)) continue;
        const json state = station.handed(hash);
        if (state["state"] == "filed") acknowledged[hash] = state["entry"];
        if (state["state"] == "unknown") station.hand_in(image);
        EXPECT_NE(state["state"], "refused") << state;
      }
      ready();
    }
  };
  for (int i = 0; i < k_kills; ++i) {
    Served served(school);
    const int after_ms = static_cast<int>(random() % 400);
    std::thread killer([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(after_ms));
      served.kill();
    });
    try {
      try_all(served.address(), std::chrono::steady_clock::now() + std::chrono::seconds(5), [] {});
    } catch (const Error&) {  // it was killed meanwhile
    }
    killer.join();
    const auto content = records::read_ledger(school.places());
    EXPECT_TRUE(content.findings.empty()) << "seed " << seed;
    for (const auto& [hash, entry] : acknowledged)
      EXPECT_EQ(content.entries.at(entry).as<records::SessionEntry>()->file_sha256, hash)
          << "seed " << seed;
  }
  {
    const Served served(school);
    try_all(served.address(), std::chrono::steady_clock::now() + std::chrono::seconds(60),
            [] { std::this_thread::sleep_for(std::chrono::milliseconds(50)); });
  }
  EXPECT_EQ(acknowledged.size(), exams.size()) << "seed " << seed;
  const auto content = records::read_ledger(school.places());
  EXPECT_TRUE(content.findings.empty());
  std::multiset<std::string> filed;
  for (const auto& e : content.entries)
    if (const auto* s = e.as<records::SessionEntry>()) filed.insert(s->file_sha256);
  for (const Bytes& image : exams)
    EXPECT_EQ(filed.count(to_hex(sha256(image))), 1u) << "each once; seed " << seed;
}

}  // namespace
}  // namespace cavum::office
