// The register of stations: whose recordings count. A station is invited with a one-time code, asks
// with it and its own key to be enrolled, and is known by that key from then on, until the key is
// replaced, revoked or runs out. Each of these is an entry of the ledger.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/where.h"
#include "engine/session/motion_source.h"
#include "engine/session/station_key.h"
#include "grading/records/entry.h"

namespace cavum::records {

class Ledger;

/// A key that was enrolled.
struct Station {
  std::uint64_t seq = 0;  ///< of the entry that enrolled it
  std::string name;       ///< for people: "Seat 3"
  std::string public_key;
  std::int64_t enrolled_utc_ns = 0;
  std::int64_t until_utc_ns = 0;  ///< what is closed later does not count; 0 = without end
  std::optional<std::int64_t>
      revoked_utc_ns;  ///< what comes in later does not count, whenever it says to have been sat
  std::string replaced_by;            ///< key that took its place; empty: none
  std::vector<MotionSource> devices;  ///< styluses it was enrolled with; empty: any
  std::string room = {};              ///< where it stands, for people; empty: nobody said
};
/// A one-time code that was given out. The ledger keeps the public half of a key made from it, so
/// that anybody can check later who held the code.
struct StationInvitation {
  std::uint64_t seq = 0;
  std::string name, code_key;
  std::int64_t until_utc_ns = 0;
  bool used = false;
};
struct StationRegister {
  std::vector<Station> stations;
  std::vector<StationInvitation> invitations;
  [[nodiscard]] const Station* of(const std::string& public_key) const;
  /// Why a recording that this key closed at `closed_utc_ns` and that came in at `received_utc_ns`
  /// does not count; none when it does.
  [[nodiscard]] std::optional<Finding> problem(const std::string& public_key,
                                               std::int64_t closed_utc_ns,
                                               std::int64_t received_utc_ns) const;
};

// What an entry says of stations. Each throws Error when it contradicts what is there; `school`:
// its public key then.
void take_invite(StationRegister& stations, const LedgerEntry& entry, const InviteEntry& what);
void take_enrol(StationRegister& stations, const LedgerEntry& entry, const EnrolEntry& what,
                const std::string& school);
void take_revoke(StationRegister& stations, const LedgerEntry& entry, const RevokeEntry& what);
void take_room(StationRegister& stations, const RoomEntry& what);

/// "S-7K3M-Q9WD-XT20-4FVA-HB6E", 100 random bits.
[[nodiscard]] std::string new_station_code();
/// A station's request, one line of JSON {"code_signature" or
/// "old_signature","request","signature"}: signed by the station's key, and by the key that the
/// code gives, or by the one that it takes the place of. `school`: public key, hexadecimal, of whom
/// is asked.
[[nodiscard]] std::string station_request(const SigningKey& key, const std::string& school,
                                          const std::vector<MotionSource>& devices,
                                          const std::string& code);
[[nodiscard]] std::string station_request(const SigningKey& key, const std::string& school,
                                          const std::vector<MotionSource>& devices,
                                          const SigningKey& replaced);

/// Enters an invitation and returns its code, which the ledger does not keep. `name`: for people, a
/// line of text. Throws Error.
[[nodiscard]] std::string invite_station(Ledger& ledger, const std::string& name,
                                         std::int64_t until_utc_ns);
/// Enters the station that a request is of, known until `until_utc_ns` (0 = without end). Throws
/// Error(`where`, ...) when the code is unknown, used or run out, or a signature does not hold.
const LedgerEntry& enrol_station(Ledger& ledger, const std::string& request,
                                 std::int64_t until_utc_ns, const Where& where);
/// Enters in which room a station stands; an empty one: in none. Throws Error when it is not
/// enrolled, or `room` is no line of at most 80 bytes.
const LedgerEntry& place_station(Ledger& ledger, const std::string& public_key,
                                 const std::string& room);
/// Enters that nothing counts any more that this key signs and that comes in from now on. Throws
/// Error when it is not enrolled, or was revoked before.
const LedgerEntry& revoke_station(Ledger& ledger, const std::string& public_key,
                                  const std::string& reason);

}  // namespace cavum::records
