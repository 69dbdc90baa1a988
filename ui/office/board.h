// What the stations say of themselves, as it is shown live: kept in memory alone, for it changes
// every second and proves nothing.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>

#include "ui/office/wire.h"

namespace cavum::office {

class Board {
 public:
  void report(const std::string& public_key, const StationReport& report, std::int64_t utc_ns);
  /// Something else that the board shows has changed: entries, filings.
  void touch();
  /// A station asked to begin an exam that another one has begun: shown until it reports that
  /// candidate no more.
  void refused(const std::string& public_key, const std::string& candidate);
  /// Candidates that some station has said it has, since this program began.
  [[nodiscard]] std::set<std::string> candidates() const;
  /// By key.
  [[nodiscard]] std::map<std::string, StationStatus> stations() const;
  /// When the candidate who is at this station signed in there; 0: nobody is.
  [[nodiscard]] std::int64_t since_utc_ns(const std::string& public_key) const;
  [[nodiscard]] std::uint64_t version() const;
  /// Waits until the version is another than `seen`, `patience_ms` at most; returns it.
  [[nodiscard]] std::uint64_t wait(std::uint64_t seen, int patience_ms) const;

 private:
  mutable std::mutex lock_;
  mutable std::condition_variable changed_;
  std::map<std::string, StationStatus> seen_;
  std::set<std::string> candidates_;
  std::uint64_t version_ = 1;
};

}  // namespace cavum::office
