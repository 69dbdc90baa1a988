// What an entry of the ledger says: a struct for each kind, and the variant of them all. Whoever
// reads entries visits the variant, so that a new kind does not compile until each reader has an
// answer for it. As text they are written and read in entry_text.h alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "engine/base/hash.h"
#include "engine/session/motion_source.h"
#include "grading/records/finding.h"
#include "grading/records/opening.h"
#include "grading/records/ticket.h"

namespace cavum::records {

/// On whose behalf an entry is made: a person of the office by the name of his account, or an
/// enrolled station that asked; and why, as the person wrote it. Each may be empty.
struct Actor {
  std::string account;
  std::string reason;
  std::string station;  ///< public key, hexadecimal
};

/// Entry 0 and no other.
struct InitEntry {
  static constexpr char k_kind[] = "init";
  std::string ledger;      ///< its id, 32 hexadecimal digits, drawn
  std::string public_key;  ///< the school's, hexadecimal
  std::string school;      ///< its name
};

/// What became of the first sitting that a makeup takes the place of.
enum class FirstSitting {
  missed,       ///< its time is over, and nothing of it is known
  interrupted,  ///< it was begun, and did not come to its end as it should
};
struct MakesUp {
  std::uint64_t ticket = 0;  ///< entry of the first sitting's ticket
  FirstSitting became = FirstSitting::missed;
};
/// A ticket was issued. The ledger does not hold its accommodations.
struct TicketEntry {
  static constexpr char k_kind[] = "ticket";
  Ticket ticket;
  std::string signature;  ///< hexadecimal
  std::optional<MakesUp> makes_up;
};
/// The ticket of that entry does not count any more.
struct CancelEntry {
  static constexpr char k_kind[] = "cancel";
  std::uint64_t ticket = 0;
};

/// The ledger's word that an exam may begin.
struct Begin {
  std::string ledger, ticket;  ///< the ledger's id, the ticket's number
  std::string nonce;           ///< 32 hexadecimal digits, drawn
  std::int64_t utc_ns = 0;     ///< by the ledger's clock
  std::string public_key;      ///< of the school, hexadecimal
};
struct BeginEntry {
  static constexpr char k_kind[] = "begin";
  Begin begin;
  std::string signature;  ///< hexadecimal
  bool again = false;     ///< it was let begin before
};

/// A recording was filed.
struct SessionEntry {
  static constexpr char k_kind[] = "session";
  std::string candidate, scenario_id;
  std::string file_sha256, chain_sha256, station_key;  ///< hexadecimal
  std::string nonce;                                   ///< of its ticket; empty without one
  MotionSource source;                                 ///< what moved the stylus in the beginning
  std::string simulated;  ///< what moved it instead of a hand; empty for people
  std::int64_t begun_utc_ns = 0, closed_utc_ns = 0;  ///< by the station's clock
  std::int64_t ticks = 0;
  Findings findings;
  std::int64_t grading_version = 0,
               physics_version = 0;  ///< that marked it on filing, that it was recorded under
  Opening result;                    ///< the school's own mark; null when it could not be marked
  std::optional<Opening>
      sealed;  ///< the JSON text of the result that the station sealed, where that is another
};
/// A result beside the others of that session: marked anew, or decided by a person.
struct RegradeEntry {
  static constexpr char k_kind[] = "regrade";
  std::uint64_t session = 0;
  Opening result;
  std::map<std::string, std::string> by;  ///< SHA-256 (hexadecimal) of documents by their names:
                                          ///< `rubric.toml`, `scenario.toml`, `attachment/NAME`
  std::string person;                     ///< who decided; empty: it was marked
};
/// Results, by the entries that hold them, go out, or are taken back.
struct ReleaseEntry {
  static constexpr char k_kind[] = "release";
  std::vector<std::uint64_t> results;
};
struct RetractEntry {
  static constexpr char k_kind[] = "retract";
  std::vector<std::uint64_t> results;
};

struct AppealEntry {
  static constexpr char k_kind[] = "appeal";
  std::uint64_t session = 0;
};
/// How an appeal ends: the result is as it was, or another one was entered since.
enum class Outcome { stands, changed };
struct AnswerEntry {
  static constexpr char k_kind[] = "answer";
  std::uint64_t session = 0, answers = 0;  ///< entries of the session and of the appeal
  Outcome outcome = Outcome::stands;
};

/// The stations that something is for.
struct Audience {
  std::string room = {};                   ///< as it was chosen; empty: all, or one station
  std::vector<std::string> stations = {};  ///< public keys; empty: all that there are and will be
  [[nodiscard]] bool holds(const std::string& station) const;
};
struct AnnounceEntry {
  static constexpr char k_kind[] = "announce";
  std::string text;
  Audience audience;
};
/// The exams of an audience stand still from now on.
struct HoldEntry {
  static constexpr char k_kind[] = "hold";
  Audience audience;
};
/// The pause of that entry is over.
struct GoOnEntry {
  static constexpr char k_kind[] = "go_on";
  std::uint64_t hold = 0;
};
struct IncidentEntry {
  static constexpr char k_kind[] = "incident";
  std::string about_station, candidate;  ///< public key, pseudonym; each may be empty
  Opening words;
};
/// Where the candidate of a ticket's entry is to sit: a station's public key, or nothing for any.
struct Seat {
  std::uint64_t ticket = 0;
  std::string station;
};
struct SeatsEntry {
  static constexpr char k_kind[] = "seats";
  std::vector<Seat> seats;
};

/// A score that a learning platform has answered. No points and no person.
struct PassbackEntry {
  static constexpr char k_kind[] = "passback";
  std::uint64_t session = 0,
                result = 0;         ///< entries; result 0: the platform was to clear its score
  std::string platform, line_item;  ///< issuer; address of the column
  int status = 0;                   ///< of HTTP
  std::string answer;               ///< the platform's words, one line
  [[nodiscard]] bool accepted() const { return status >= 200 && status <= 299; }
};

/// What was erased of an earlier entry.
struct ErasedPart {
  std::uint64_t entry = 0;
  Part what = Part::motion;
};
struct EraseEntry {
  static constexpr char k_kind[] = "erase";
  std::vector<ErasedPart> erased;
};
/// The identity of a pseudonym was removed.
struct ForgetEntry {
  static constexpr char k_kind[] = "forget";
  std::string candidate;
  std::vector<ErasedPart> erased;
};

/// From this entry on another key of the school signs, or the same until another time.
struct KeyEntry {
  static constexpr char k_kind[] = "key";
  std::string public_key;         ///< hexadecimal
  std::int64_t until_utc_ns = 0;  ///< 0: without end
  std::string signature;          ///< by the key before it, hexadecimal
};

struct SizeAndRoot {
  std::uint64_t size = 0;
  Sha256 root{};
};
/// The ledger goes on from a backup here.
struct RestoreEntry {
  static constexpr char k_kind[] = "restore";
  SizeAndRoot backup;             ///< of the entries before this one
  std::vector<SizeAndRoot> lost;  ///< what anything at hand had seen of later entries, by size
  std::vector<std::string>
      missing_sessions;  ///< filed, and not in the backup: SHA-256 of their files
};

/// A one-time code was given out for a station of this name.
struct InviteEntry {
  static constexpr char k_kind[] = "invite";
  std::string name;
  std::string code_key;  ///< hexadecimal: the public key of the code
  std::int64_t until_utc_ns = 0;
};
struct Stylus {
  std::string name, serial;
};
/// What a station asks, so as to be enrolled.
struct StationRequest {
  std::string school;      ///< public key of whom is asked; keys are hexadecimal
  std::string public_key;  ///< the station's
  std::string by;          ///< the code's key, or the station's old one
  std::int64_t made_utc_ns = 0;
  std::vector<Stylus> devices;  ///< empty: any
};
struct SignedRequest {
  StationRequest request;
  std::string signature;  ///< by the station's key
  std::string code_signature,
      old_signature;  ///< one of them: by the code's key, or by the key that is replaced
};
struct EnrolEntry {
  static constexpr char k_kind[] = "enrol";
  SignedRequest asked;
  std::int64_t until_utc_ns = 0;  ///< 0: without end
};
struct RevokeEntry {
  static constexpr char k_kind[] = "revoke";
  std::string public_key;
};
struct RoomEntry {
  static constexpr char k_kind[] = "room";
  std::string public_key, room;
};

using Entry =
    std::variant<InitEntry, TicketEntry, CancelEntry, BeginEntry, SessionEntry, RegradeEntry,
                 ReleaseEntry, RetractEntry, AppealEntry, AnswerEntry, AnnounceEntry, HoldEntry,
                 GoOnEntry, IncidentEntry, SeatsEntry, PassbackEntry, EraseEntry, ForgetEntry,
                 KeyEntry, RestoreEntry, InviteEntry, EnrolEntry, RevokeEntry, RoomEntry>;

/// One entry of a ledger.
struct LedgerEntry {
  std::uint64_t seq = 0;
  std::int64_t utc_ns = 0;
  Actor by;
  std::optional<Entry> what;  ///< none: its text cannot be read, which is a finding
  std::string text;           ///< that is hashed
  Sha256 leaf{};              ///< its hash in the tree
  /// What it says, where it is of that kind; else null.
  template <class Kind>
  [[nodiscard]] const Kind* as() const {
    return what ? std::get_if<Kind>(&*what) : nullptr;
  }
};

/// For std::visit: a function for each kind.
template <class... F>
struct OfEach : F... {
  using F::operator()...;
};
template <class... F>
OfEach(F...) -> OfEach<F...>;

}  // namespace cavum::records
