// What happens on an exam day and stands in no recording alone: what candidates were told, when the
// office paused their exams, and incidents. Each is an entry: who, when, why.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grading/records/entry.h"

namespace cavum::records {

class Ledger;

struct Announcement {
  std::uint64_t seq = 0;
  std::int64_t utc_ns = 0;
  std::string words;
  Audience audience;
};
/// The exams of an audience stand still: a fire alarm.
struct Hold {
  std::uint64_t seq = 0;
  std::int64_t utc_ns = 0;
  std::string reason;
  Audience audience;
  std::optional<std::uint64_t> ended_by;  ///< entry that lets them go on
  std::int64_t ended_utc_ns = 0;
};
struct Incident {
  std::uint64_t seq = 0;
  std::int64_t utc_ns = 0;
  std::string account;             ///< who noted it
  std::string station, candidate;  ///< public key, pseudonym; empty: none in particular
  std::string words;               ///< empty: erased
  std::optional<std::uint64_t> erased_by;
};
struct ExamDay {
  std::vector<Announcement> announcements;
  std::vector<Hold> holds;
  std::vector<Incident> incidents;
  /// The first hold that lasts and that this station is in; null when its exam may run.
  [[nodiscard]] const Hold* hold_of(const std::string& station) const;
};

/// Throws Error when that pause does not last.
void take_go_on(ExamDay& day, const LedgerEntry& entry, const GoOnEntry& what);

// Each throws Error when `words` or `reason` is no line of at most k_longest_words bytes, a station
// is not enrolled, or the audience is nobody.
inline constexpr std::size_t k_longest_words = 500;
const LedgerEntry& announce(Ledger& ledger, const std::string& words, const Audience& audience);
const LedgerEntry& hold_exams(Ledger& ledger, const std::string& reason, const Audience& audience);
/// Throws Error when entry `hold` holds nobody.
const LedgerEntry& let_go_on(Ledger& ledger, std::uint64_t hold, const std::string& reason);
/// `words` can be erased later, and are when the candidate is forgotten.
const LedgerEntry& note_incident(Ledger& ledger, const std::string& station,
                                 const std::string& candidate, const std::string& words);

/// A time for which a recording's clock stood still because of the office, from and to, by the
/// station's clock, UTC in ns.
using HeldTime = std::pair<std::int64_t, std::int64_t>;
/// Which of them the ledger does not know of: a station may not give its candidate time by itself.
[[nodiscard]] Findings unexplained_holds(const ExamDay& day, const std::string& station,
                                         std::span<const HeldTime> held,
                                         std::int64_t received_utc_ns);

}  // namespace cavum::records
