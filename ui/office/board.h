// What the stations say of themselves, as it is shown live: kept in memory alone, for it changes every second and proves nothing.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace cavum::office {

/// One report of a station.
struct StationReport {
  std::string state;         ///< one of k_station_states
  std::string candidate;     ///< pseudonym; empty: nobody sits
  std::string step;          ///< of the exam, for people
  std::string alarm;         ///< what an invigilator should see to; empty: nothing
  std::int64_t left_s = -1;  ///< on the exam's clock; -1: no clock runs
  bool held = false;         ///< the exam stands still because the office paused it
  std::uint64_t heard = 0;   ///< entry of the last announcement that was read
  std::int64_t here_s = -1;  ///< since the candidate signed in; -1: not said (stations of before), or nobody did
};
inline constexpr const char* k_station_states[] = {"free", "check", "briefing", "exam", "paused", "ended"};
/// Throws Error for a state of another name, a text too long or no plain line, or a time beyond a day.
[[nodiscard]] StationReport parse_report(const std::string& text);

class Board {
 public:
  void report(const std::string& public_key, const StationReport& report, std::int64_t utc_ns);
  /// Something else that the board shows has changed: entries, filings.
  void touch();
  /// A station asked to begin an exam that another one has begun: shown until it reports that candidate no more.
  void refused(const std::string& public_key, const std::string& candidate);
  /// Candidates that some station has said it has, since this program began.
  [[nodiscard]] std::set<std::string> candidates() const;
  /// By key: {"state","candidate","step","alarm","left_s","held","heard","seen_utc_ns","since_utc_ns","refused"}; `since_utc_ns`: when the candidate
  /// signed in, 0: nobody did; `refused`: the candidate whom it may not begin.
  [[nodiscard]] std::map<std::string, nlohmann::json> stations() const;
  /// When the candidate who is at this station signed in there; 0: nobody is.
  [[nodiscard]] std::int64_t since_utc_ns(const std::string& public_key) const;
  [[nodiscard]] std::uint64_t version() const;
  /// Waits until the version is another than `seen`, `patience_ms` at most; returns it.
  [[nodiscard]] std::uint64_t wait(std::uint64_t seen, int patience_ms) const;

 private:
  struct Seen {
    StationReport report;
    std::int64_t utc_ns = 0, since_utc_ns = 0;
  };
  mutable std::mutex lock_;
  mutable std::condition_variable changed_;
  std::map<std::string, Seen> seen_;
  std::map<std::string, std::string> refused_;  // candidate, by station
  std::set<std::string> candidates_;
  std::uint64_t version_ = 1;
};

}  // namespace cavum::office
