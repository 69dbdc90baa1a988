// What one exam's recording is made of: what was examined, the motion in chunks of a second,
// events, and the seal of closing. Plain values, shared by the recorder, the reader and the
// verifier.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/hash.h"
#include "engine/base/vec.h"
#include "engine/physics/servo/tick.h"
#include "engine/session/event.h"

namespace cavum {

/// Version of the session file's layout (SQLite `user_version`); see docs/formats/session.md.
inline constexpr int k_session_format = 1;
/// SQLite `application_id`: "Cavu".
inline constexpr std::int64_t k_session_application_id = 0x43617675;
/// Most ticks of one chunk: one second of an exam.
inline constexpr std::int64_t k_chunk_ticks = 1000;

/// Everything that fixes an exam before its first tick. Texts are kept as they were read, so that a
/// recording never depends on a file outside it.
struct SessionSetup {
  std::string candidate;    ///< pseudonym, never a name
  std::string calibration;  ///< the device's calibration, as text
  MotionSource source;      ///< what moves the stylus
  std::string scenario_toml;
  std::string rubric_toml;  ///< empty when the scenario's own rubric counts
  std::string force_model_toml;
  std::string servo_toml;                      ///< to_toml(ServoConfig)
  std::vector<std::string> burs_toml;          ///< burs in the order of the tray
  Bytes tooth;                                 ///< compact tooth file before the first tick
  std::array<std::int32_t, 3> first_tip_nm{};  ///< where the servo state starts, tooth frame
  Notes notes;                                 ///< further facts by key (operator's seed, room …)
  std::string
      landmarks_json;  ///< of the tooth, where the scenario's zones follow them; empty otherwise
  std::vector<std::pair<std::string, Bytes>>
      attachments;  ///< files that the scenario names, by name

  [[nodiscard]] Vec3 first_tip_mm() const noexcept {
    return {first_tip_nm[0] * 1e-6, first_tip_nm[1] * 1e-6, first_tip_nm[2] * 1e-6};
  }
};

/// Readings of three clocks at one moment, ns. `monotonic` stops in suspend, `boot` does not, `utc`
/// can be set.
struct Clocks {
  std::int64_t monotonic_ns = 0, boot_ns = 0, utc_ns = 0;
  friend bool operator==(const Clocks&, const Clocks&) = default;
};
[[nodiscard]] Clocks read_clocks();
/// Where a recording gets its clocks from: the computer's, or a test's.
using ReadClocks = std::function<Clocks()>;
/// Names the running boot, for `boot_ns` compares only within one; empty when the system does not
/// tell.
[[nodiscard]] std::string boot_id();
/// "2026-11-21T02:30:00Z"
[[nodiscard]] std::string utc_text(std::int64_t utc_ns);

/// A file kept inside the session.
struct Artifact {
  std::string name;
  Sha256 sha256{};
  Bytes bytes;
};
inline constexpr char k_final_tooth[] = "final_tooth.cvt";

/// One row of `event`.
struct EventRow : TimedEvent {
  std::int64_t seq = 0;
  std::int64_t chunk = 0;  ///< the chunk it was committed with
};

/// One row of `chunk`: up to a second of motion as packed by chunk_codec.h. No ticks = events only.
struct ChunkRow {
  std::int64_t seq = 0;
  std::int64_t first_tick = 0;
  std::int64_t ticks = 0;
  Bytes inputs, records, removed;
  std::uint64_t state_hash = 0;  ///< state_hash(ServoState) after the last tick
  Clocks clocks;                 ///< when the chunk was complete
  Sha256 inputs_sha256{}, records_sha256{}, removed_sha256{}, events_sha256{};
  Sha256 prev_sha256{}, sha256{};  ///< links of the chain, see chain.h
};

/// The row of `seal`: written once, on closing.
struct Seal {
  Sha256 chain_sha256{};        ///< sha256 of the last chunk, or the genesis hash without any
  Sha256 final_tooth_sha256{};  ///< of the compact tooth file's bytes
  Sha256 result_sha256{};       ///< of the result's JSON text
  std::int64_t chunks = 0, ticks = 0, events = 0;
  Clocks clocks;
  std::array<std::uint8_t, 32> public_key{};  ///< Ed25519, of the station
  std::array<std::uint8_t, 64> signature{};   ///< over seal_message (chain.h)
};

/// The setup as artifacts, in their fixed order and with their fixed names.
[[nodiscard]] std::vector<Artifact> artifacts_of(const SessionSetup& setup);

}  // namespace cavum
