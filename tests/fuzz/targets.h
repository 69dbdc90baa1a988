// What the fuzzers feed, and the ordinary test with them: one function for each reader of files
// that come from elsewhere. It takes any bytes and returns; an Error is an answer, and every other
// exception, a crash, a sanitizer's report or memory out of proportion is a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"

namespace cavum::fuzz {

using Data = std::span<const std::uint8_t>;

void fuzz_session(Data data);  ///< a `.cavum` file's bytes
void fuzz_recording(
    Data data);  ///< edits of what the rows of a sound session hold, see recording_target.cpp
void fuzz_replay(Data data);      ///< ticks of motion, run through the servo
void fuzz_settings(Data data);    ///< force model, servo settings or bur, by the first byte
void fuzz_ticket(Data data);      ///< a ticket's file
void fuzz_receipt(Data data);     ///< a receipt's file
void fuzz_candidates(Data data);  ///< the class as CSV
void fuzz_marks(Data data);       ///< people's marks as CSV
void fuzz_scenario(Data data);    ///< a scenario's text, and the same as a rubric
void fuzz_motion(Data data);      ///< poses as CSV
void fuzz_tooth(Data data);  ///< a tooth file; the first byte says how the rest is wrapped, see
                             ///< tooth_target.cpp
void fuzz_mesh(
    Data data);  ///< a surface; the first byte chooses STL in memory, STL, PLY, OBJ or OFF
void fuzz_explain(Data data);  ///< a rig's recording, or the rig, by the first byte
void fuzz_results(Data data);  ///< exported results
void fuzz_notes(Data data);    ///< signed notes, keys and requests to cosign, by the first byte
void fuzz_entries(Data data);  ///< what a ledger's entries say, stations' requests among them, and
                               ///< what is exported of them
void fuzz_ledger(
    Data data);  ///< edits of a ledger's database and the log beside it, see ledger_file_target.cpp
void fuzz_office(Data data);  ///< a connection to the exam office; the first byte says who asks,
                              ///< see office_target.cpp
void fuzz_volume(Data data);  ///< a volume's file or a DICOM slice, read in a child process; the
                              ///< first byte says which

struct Target {
  const char* name;
  void (*run)(Data);
  std::vector<Bytes> (*seeds)();  ///< sound and nearly sound inputs, made by the program itself
};
/// For the test's name, which would else show addresses.
inline void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }
/// All of them, in the order above.
[[nodiscard]] const std::vector<Target>& targets();

// of the single targets
[[nodiscard]] std::vector<Bytes> session_seeds();
[[nodiscard]] std::vector<Bytes> recording_seeds();
[[nodiscard]] std::vector<Bytes> replay_seeds();
[[nodiscard]] std::vector<Bytes> settings_seeds();
[[nodiscard]] std::vector<Bytes> ticket_seeds();
[[nodiscard]] std::vector<Bytes> receipt_seeds();
[[nodiscard]] std::vector<Bytes> candidates_seeds();
[[nodiscard]] std::vector<Bytes> marks_seeds();
[[nodiscard]] std::vector<Bytes> scenario_seeds();
[[nodiscard]] std::vector<Bytes> motion_seeds();
[[nodiscard]] std::vector<Bytes> tooth_seeds();
[[nodiscard]] std::vector<Bytes> mesh_seeds();
[[nodiscard]] std::vector<Bytes> explain_seeds();
[[nodiscard]] std::vector<Bytes> results_seeds();
[[nodiscard]] std::vector<Bytes> notes_seeds();
[[nodiscard]] std::vector<Bytes> entries_seeds();
[[nodiscard]] std::vector<Bytes> ledger_seeds();
[[nodiscard]] std::vector<Bytes> office_seeds();
[[nodiscard]] std::vector<Bytes> volume_seeds();

}  // namespace cavum::fuzz
