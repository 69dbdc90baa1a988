// A school for the ledger's tests: a folder with its own keys, a ledger, an enrolled station,
// tickets, and a short exam on a block. What sits it is a simulated candidate in the place of a
// hand: the recording names a device, and its clocks run as they would in real time.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/file.h"
#include "grading/marking/session_input.h"
#include "grading/records/check_ledger.h"
#include "grading/records/filing.h"
#include "grading/records/identities.h"
#include "grading/records/issue.h"
#include "grading/records/stations.h"
#include "grading/result/result_json.h"
#include "scenarios/operators/simulated_exam.h"
#include "tests/engine/session/fixture.h"
#include "tests/engine/support/basics.h"

namespace cavum::testing_ledger {

inline const std::string k_scenario =
    std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
inline constexpr std::int64_t k_hour_ns = 3'600'000'000'000;
inline constexpr std::size_t k_first_entries =
    3;  ///< of a new school: its beginning, an invitation, an enrolled station

/// Another station's folder of its own, while this lives.
class AtStation {
 public:
  explicit AtStation(const std::string& home) : before_(getenv("CAVUM_HOME")) {
    setenv("CAVUM_HOME", home.c_str(), 1);
  }
  ~AtStation() { setenv("CAVUM_HOME", before_.c_str(), 1); }
  AtStation(const AtStation&) = delete;
  AtStation& operator=(const AtStation&) = delete;

 private:
  std::string before_;
};

class School {
 public:
  /// With its first station enrolled, which takes two entries.
  explicit School(bool with_station = true) {
    records::Ledger::create(ledger_folder(), "School of Dentistry", key());
    const records::Identities made(places().identities(), true);
    write_text_file(records::school_public_key_path(), to_hex(key().public_key) + "\n");
    if (with_station) enrol("Seat 1");
  }
  /// The same school with all its files, in a folder of its own; CAVUM_HOME points there.
  School(const School& other) : folder_() {
    for (const auto& entry : std::filesystem::directory_iterator(other.folder_.file("")))
      std::filesystem::copy(entry.path(), folder_.file(entry.path().filename().string()),
                            std::filesystem::copy_options::recursive);
  }
  School& operator=(const School&) = delete;
  [[nodiscard]] std::string ledger_folder() const { return folder_.file("ledger"); }
  [[nodiscard]] records::LedgerPaths places() const { return {ledger_folder()}; }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] static SigningKey key() {
    return records::load_school_key(records::school_key_path(), true);
  }
  [[nodiscard]] records::Ledger ledger() const { return records::Ledger(ledger_folder(), key()); }

  /// Invites and enrols the station whose key lies in the present CAVUM_HOME.
  void enrol(const std::string& name, const std::vector<MotionSource>& devices = {}) const {
    records::Ledger ledger = this->ledger();
    const std::string code =
        records::invite_station(ledger, name, read_clocks().utc_ns + k_hour_ns);
    static_cast<void>(
        records::enrol_station(ledger,
                               records::station_request(load_station_key(station_key_path()),
                                                        ledger.content().public_key, devices, code),
                               0, "request"));
  }

  /// A ticket for an hour around now, issued in the ledger, also beside a live one; `change` may
  /// spoil it before it is signed.
  std::string ticket(const std::string& candidate,
                     const std::function<void(records::Ticket&)>& change = {}) const {
    records::Ledger ledger = this->ledger();
    const std::int64_t now = read_clocks().utc_ns;
    records::Ticket t = records::promise(*scenarios::prepare_exam(k_scenario, {}), ledger.content(),
                                         now - k_hour_ns, now + k_hour_ns);
    if (change) change(t);
    return records::issue(
        ledger, t,
        records::Identities(places().identities()).enrol(candidate, "", t.exam, ledger.key()),
        records::Another::allow);
  }
  /// The exam, sat by a simulated candidate of this skill; `change` may alter what the station
  /// runs.
  std::string sit(const std::string& ticket, const std::string& skill = "expert",
                  const std::function<void(scenarios::ExamOptions&)>& change = {}) const {
    static int number = 0;
    std::string path = folder_.file("exam-" + std::to_string(++number) + ".cavum");
    scenarios::ExamOptions options;
    options.candidate =
        ticket.empty() ? "nobody" : records::parse_ticket(ticket, "", "ticket").candidate;
    options.source = {SourceKind::device, "emulated stylus", "E1"};
    options.position_quantum_mm = OmniModel{}.quantum_mm;
    if (!ticket.empty()) options.notes.emplace_back(records::k_ticket_note, ticket);
    if (change) change(options);
    const auto setup = scenarios::prepare_exam(k_scenario, options);
    auto candidate = scenarios::make_simulated_candidate(*setup, skill, 7, OmniModel{});
    std::int64_t ticks = 0;
    const Clocks begun = read_clocks();
    const auto in_real_time = [&] {
      const std::int64_t ns = ticks * 1'000'000;
      return Clocks{begun.monotonic_ns + ns, begun.boot_ns + ns, begun.utc_ns + ns};
    };
    const auto exam = scenarios::Exam::start(*setup, path, candidate.start_mm(), in_real_time);
    for (TickInput input; !exam->over() && candidate.next(exam->last(), exam->last_input(), input);
         ++ticks)
      static_cast<void>(exam->tick(input));
    if (!exam->over()) exam->end();
    exam->recorder().flush();
    grading::ExamContexts grounds(*setup);
    const auto graded = grading::load_for_grading(SessionReader(path), exam->tooth_now(), grounds);
    exam->close(grading::to_json(grading::grade(graded->input(), graded->rubric)).dump());
    return path;
  }

 private:
  test::Folder folder_;
};

using Kind = records::FindingKind;

inline std::string_view name_of(Kind kind) {
  return names_of(kind)[static_cast<std::size_t>(kind)];
}

/// Expects one of `messages` to tell all of `parts`: names and figures, however the sentence goes.
inline void expect_told(const std::vector<Message>& messages,
                        const std::vector<std::string>& parts) {
  const auto tells_all = [&](const std::string& text) {
    return std::all_of(parts.begin(), parts.end(),
                       [&](const std::string& p) { return text.find(p) != std::string::npos; });
  };
  EXPECT_TRUE(std::any_of(messages.begin(), messages.end(),
                          [&](const Message& m) { return tells_all(english_text(m)); }))
      << "none with '" << parts.front() << "' among\n"
      << testing_basics::text_of(messages);
}

/// Expects a finding of this group that tells all of `parts`.
inline void expect_finding(const records::Findings& findings, Kind kind,
                           const std::vector<std::string>& parts = {""}) {
  records::Findings of_kind;
  std::copy_if(findings.begin(), findings.end(), std::back_inserter(of_kind),
               [&](const records::Finding& f) { return f.group() == kind; });
  EXPECT_FALSE(of_kind.empty()) << "no " << name_of(kind) << " among\n"
                                << testing_basics::text_of(words_of(findings));
  if (!of_kind.empty()) expect_told(words_of(of_kind), parts);
}

/// Expects findings of these groups, in this order, and no others.
inline void expect_kinds(const records::Findings& findings, const std::vector<Kind>& kinds) {
  std::vector<Kind> found;
  for (const auto& f : findings) found.push_back(f.group());
  EXPECT_EQ(found, kinds) << testing_basics::text_of(words_of(findings));
}

}  // namespace cavum::testing_ledger
