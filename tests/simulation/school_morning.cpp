// The school on the morning of every day: made once, in a world without faults.
#include <filesystem>

#include "engine/base/file.h"
#include "grading/records/identities.h"
#include "grading/records/issue.h"
#include "grading/records/stations.h"
#include "tests/grading/records/short_exam.h"
#include "tests/simulation/school_day.h"

namespace cavum::simulation {
namespace {

constexpr std::int64_t k_s_ns = 1'000'000'000, k_hour_ns = 3600 * k_s_ns;
const std::string k_scenario = std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";

/// A station's clock, and the words of the finding that names it when it is wrong.
struct Seat {
  testing_ledger::StationClock clock;
  WrongClock named = WrongClock::none;
};

}  // namespace

Morning make_morning() {
  std::map<std::string, Disk> empty;
  for (const char* name : {"office", "station", "cosigner"}) empty.emplace(name, Disk());
  World world(1, empty, 0);
  Morning out;
  std::string school_key, code;
  const auto ledger = [] {
    return records::Ledger("/sim/office/ledger",
                           records::load_school_key(records::school_key_path()));
  };
  world.calmly("office", [&] {
    make_private_folder("/sim/office/home");
    make_private_folder("/sim/office/exams");
    make_private_folder("/sim/office/receipts");
    make_private_folder("/sim/office/tmp");
    records::Ledger::create("/sim/office/ledger", "School of Dentistry",
                            records::load_school_key(records::school_key_path(), true));
    records::Identities("/sim/office/ledger/identities.db", true);
    records::Ledger l = ledger();
    school_key = l.content().public_key;
    code = records::invite_station(l, "Seat 1", read_clocks().utc_ns + k_hour_ns);
  });
  std::string request;
  world.calmly("station", [&] {
    make_private_folder("/sim/station/home");
    make_private_folder("/sim/station/tmp");
    request = records::station_request(load_station_key(station_key_path()), school_key, {}, code);
  });
  const std::vector<Seat> clocks = {{},
                                    {},
                                    {},
                                    {{2 * k_hour_ns, 0, 0}, WrongClock::ahead},
                                    {{-2 * k_hour_ns, 0, 0}, WrongClock::behind},
                                    {{0, 60 * k_s_ns, 0}, WrongClock::uneven},
                                    {{0, -60 * k_s_ns, 0}, WrongClock::uneven},
                                    {{0, 0, 100 * k_s_ns}, WrongClock::uneven}};
  std::vector<std::string> tickets;
  world.calmly("office", [&] {
    records::Ledger l = ledger();
    static_cast<void>(records::enrol_station(l, request, 0, "request"));
    const std::int64_t now = read_clocks().utc_ns;
    out.promise = records::promise(*scenarios::prepare_exam(k_scenario, {}), l.content(),
                                   now - 3 * k_hour_ns, now + 3 * k_hour_ns);
    records::Identities identities(l.places().identities());
    for (std::size_t i = 0; i < clocks.size(); ++i)
      tickets.push_back(records::issue(
          l, out.promise,
          identities.enrol("morning-" + std::to_string(i), "", out.promise.exam, l.key())));
  });
  std::vector<Bytes> files;
  world.calmly("station", [&] {
    for (std::size_t i = 0; i < clocks.size(); ++i) {
      const std::string path = "/sim/station/exam-" + std::to_string(i) + ".cavum";
      testing_ledger::sit_shortly(k_scenario, path, tickets[i], clocks[i].clock);
      files.push_back(read_file(path));
      out.exams.push_back({"/sim/office/exams/" + std::to_string(i) + ".cavum", clocks[i].named,
                           SessionReader(path).created().utc_ns,
                           SessionReader(path).seal()->clocks.utc_ns});
    }
  });
  world.calmly("office", [&] {
    for (std::size_t i = 0; i < clocks.size(); ++i) write_file(out.exams[i].path, files[i]);
  });
  world.calmly("cosigner", [&] {
    make_private_folder("/sim/cosigner/home");
    const SigningKey key = load_signing_key("/sim/cosigner/home/cosigner.key", "cosigner");
    const std::string line =
        records::key_line({"cosigner.example", records::NoteKind::cosignature, key.public_key});
    code = line;
  });
  world.calmly("office", [&] { write_text_file(records::known_cosigners_path(), code + "\n"); });
  for (auto& [name, computer] : world.computers()) {
    computer.disk.settle();
    out.disks.emplace(name, computer.disk.copy());
  }
  out.true_ns = world.true_ns() + 600 * k_s_ns;
  return out;
}

}  // namespace cavum::simulation
