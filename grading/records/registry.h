// What a ledger's entries add up to: tickets, sessions, their results and whether these were
// released.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grading/records/exam_day.h"
#include "grading/records/ledger_content.h"
#include "grading/records/stations.h"
#include "grading/records/ticket.h"
#include "grading/result/result_json.h"

namespace cavum::records {

/// A result beside the sealed one.
struct Regrade {
  std::uint64_t seq = 0;  ///< of its entry
  std::int64_t utc_ns = 0;
  std::string reason;
  std::string person;  ///< who decided a result that the program left to a person (decision.h);
                       ///< empty: it was marked anew
  std::map<std::string, std::string>
      documents;  ///< what it was marked by (documents_of); empty when that was not kept
  SharedJson result;
};

/// A candidate's objection to a result, from its entry to the one that answers it.
struct Appeal {
  std::uint64_t seq = 0;
  std::int64_t utc_ns = 0;
  std::string reason;
  std::optional<std::uint64_t> closed_by;  ///< entry of the answer
  Outcome outcome = Outcome::stands;       ///< once it is answered, as is why
  std::string answer;
};

/// What the entries say together.
struct FiledSession {
  std::uint64_t seq = 0;  ///< of its entry
  std::string file_sha256, chain_sha256, candidate, scenario_id, station_key;
  std::string nonce;  ///< of its ticket; empty without one
  SharedJson
      filed;  ///< the school's own mark on filing; null when the recording could not be marked
  SharedJson
      sealed;  ///< what the station sealed, where that is another one; null where it is the same
  std::int64_t grading_version = 0;  ///< that marked it on filing
  SharedJson result;                 ///< that counts: the one that was filed, or the last regrade's
  std::uint64_t result_seq;          ///< of the entry that holds it
  Findings findings;
  std::string simulated;  ///< what moved the stylus instead of a candidate's hand: an operator, a
                          ///< motion file, practice; empty for people
  bool released = false;  ///< the result that counts
  SharedJson shown;  ///< the last one that was released: it stands until another is; null before
  std::uint64_t shown_seq = 0;                ///< of the entry that holds it
  std::int64_t released_utc_ns = 0;           ///< when that was released
  std::optional<std::uint64_t> retracted_by;  ///< entry that took the last one that was released
                                              ///< back; none after a new release
  std::string retracted_why;                  ///< its reason
  std::vector<Appeal> appeals;                ///< the oldest first
  std::int64_t received_utc_ns = 0;
  std::optional<std::uint64_t> motion_erased_by, result_erased_by;  ///< entries that say so
  std::vector<Regrade> regrades;                                    ///< the oldest first
  std::vector<std::uint64_t> contested_by;  ///< entries of other endings of the same exam, filed
                                            ///< with findings: a person decides which one counts
  /// The regrade that gave the result in `entry`; null for the sealed one.
  [[nodiscard]] const Regrade* regrade(std::uint64_t entry) const {
    for (const auto& r : regrades)
      if (r.seq == entry) return &r;
    return nullptr;
  }
  /// The appeal that nobody answered yet; null: none.
  [[nodiscard]] const Appeal* open_appeal() const {
    for (const auto& a : appeals)
      if (!a.closed_by) return &a;
    return nullptr;
  }
  std::optional<std::uint64_t> made_up_by;  ///< entry of the ticket of a makeup sitting, which
                                            ///< counts in the place of this one
  std::optional<MakesUp> makes_up;          ///< of a makeup sitting
  std::uint64_t first_sitting = 0;  ///< entry of the ticket with which the row of sittings began
                                    ///< that makeups go on; 0: there was no ticket
  bool chosen = false;  ///< released by name although it was filed with findings or contested: a
                        ///< person has looked at it, and it alone counts
  /// The program leaves it to a person, and none has decided.
  [[nodiscard]] bool undecided() const {
    return result->is_object() && grading::verdict_in(*result) == grading::Verdict::review;
  }
  /// Taken back, and no other result was entered since: it is released by name only.
  [[nodiscard]] bool taken_back() const { return retracted_by && result_seq < *retracted_by; }
  /// The person's decision that gave the result in `entry`; null: it was marked.
  [[nodiscard]] const Regrade* decision(std::uint64_t entry) const {
    const Regrade* r = regrade(entry);
    return r != nullptr && !r->person.empty() ? r : nullptr;
  }
  /// The last decision of a person, whether it counts or not; null: there was none.
  [[nodiscard]] const Regrade* last_decision() const {
    for (auto r = regrades.rbegin(); r != regrades.rend(); ++r)
      if (!r->person.empty()) return &*r;
    return nullptr;
  }
  /// Filed with findings, or contested: it is released by name only.
  [[nodiscard]] bool questioned() const { return !findings.empty() || !contested_by.empty(); }
  /// The same, and no person has looked at it yet: it counts for nobody.
  [[nodiscard]] bool doubtful() const { return questioned() && !chosen; }
};
/// The ledger's word that an exam may begin, as entered.
struct LetBegin {
  std::uint64_t seq = 0;
  std::string nonce;
  std::int64_t utc_ns = 0;
};
struct IssuedTicket {
  std::uint64_t seq = 0;
  Ticket ticket;  ///< without its accommodations, which the ledger does not hold
  std::optional<std::uint64_t> used_by;       ///< entry of the session
  std::optional<std::uint64_t> cancelled_by;  ///< entry that says so
  std::vector<LetBegin> begins;               ///< the last one counts
  std::string seat = {};  ///< public key of the station where the candidate is to sit; empty: any
  std::optional<MakesUp> makes_up = {};
  std::string why = {};  ///< it makes up another
  std::optional<std::uint64_t> made_up_by =
      {};  ///< entry of the ticket that makes this one up: nothing is sat with this one any more
  std::uint64_t first_sitting =
      0;  ///< entry of the ticket with which the row of makeups began; its own without any
  /// Neither used, cancelled nor made up, and good at this time or later.
  [[nodiscard]] bool live(std::int64_t utc_ns) const {
    return !used_by && !cancelled_by && !made_up_by && ticket.not_after_utc_ns >= utc_ns;
  }
};
struct Registry {
  StationRegister stations;
  ExamDay day;
  std::vector<IssuedTicket> tickets;
  std::vector<FiledSession> sessions;
  std::vector<PassbackEntry> passbacks;
  /// What entries contradict each other in: a ticket used twice, a session entered twice, a regrade
  /// or release of nothing.
  Findings findings;
  /// Releases without effect: of an ending of an exam when another one was chosen, or of two at
  /// once; of a sitting when another one counts. None is a contradiction.
  Findings remarks;
  /// Of that entry; null where it is no session's or ticket's.
  [[nodiscard]] const FiledSession* session(std::uint64_t seq) const;
  [[nodiscard]] const IssuedTicket* ticket(std::uint64_t seq) const;
  /// A ticket of the candidate for this exam that is neither used nor cancelled, and good at this
  /// time or later; null when there is none.
  [[nodiscard]] const IssuedTicket* live_ticket(const std::string& candidate,
                                                const std::string& exam, std::int64_t utc_ns) const;
  /// A released session of another sitting of the same exam by the same candidate, where one makes
  /// up the other; null when there is none.
  [[nodiscard]] const FiledSession* shown_adjacent(const FiledSession& session) const;
  /// Entries of the sessions that count, by candidate and exam: of several attempts the last one
  /// that is released.
  [[nodiscard]] std::map<std::pair<std::string, std::string>, std::uint64_t> counting() const;
  /// Entries of the sessions that were filed after a rubric or corrected scenario was counted over
  /// all of their exam (two sessions or more), and were not marked by it yet: they are released by
  /// name only.
  [[nodiscard]] std::set<std::uint64_t> marked_otherwise() const;
  /// The ending that was chosen of this session's exam, when it is another one; else null.
  [[nodiscard]] const FiledSession* chosen_instead_of(const FiledSession& session) const;
};
[[nodiscard]] Registry read_registry(const LedgerContent& content);
class RegistryReader;
/// The registry of a ledger that grows: only entries that are new since it was asked last are read.
/// Begin a new one where entries were read anew.
class GrowingRegistry {
 public:
  GrowingRegistry();
  ~GrowingRegistry();
  GrowingRegistry(GrowingRegistry&&) noexcept;
  GrowingRegistry& operator=(GrowingRegistry&&) noexcept;
  [[nodiscard]] const Registry& of(const LedgerContent& content);

 private:
  std::unique_ptr<RegistryReader> reader_;
  std::size_t read_ = 0;
};
/// Path of a session's recording. Throws Error when it was erased.
[[nodiscard]] std::string recording_of(const LedgerPaths& places, const FiledSession& session);

}  // namespace cavum::records
