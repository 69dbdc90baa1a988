#include "ui/office/board.h"

#include <algorithm>
#include <chrono>

namespace cavum::office {

void Board::report(const std::string& public_key, const StationReport& report,
                   std::int64_t utc_ns) {
  const std::lock_guard guard(lock_);
  StationStatus& seen = seen_[public_key];
  const bool same = seen.since_utc_ns != 0 && seen.candidate == report.candidate;
  std::int64_t since = 0;  // where the station does not say it, he is here since he was first seen
  if (!report.candidate.empty())
    since = report.here_s >= 0 ? utc_ns - report.here_s * 1'000'000'000
            : same             ? seen.since_utc_ns
                               : utc_ns;
  seen = {report, seen.refused, utc_ns, since};
  if (!report.candidate.empty()) candidates_.insert(report.candidate);
  if (!report.candidate.empty() && report.state != AtStation::free) seen.refused.clear();
  ++version_;
  changed_.notify_all();
}

void Board::touch() {
  const std::lock_guard guard(lock_);
  ++version_;
  changed_.notify_all();
}

void Board::refused(const std::string& public_key, const std::string& candidate) {
  const std::lock_guard guard(lock_);
  seen_[public_key].refused = candidate;
  ++version_;
  changed_.notify_all();
}

std::set<std::string> Board::candidates() const {
  const std::lock_guard guard(lock_);
  return candidates_;
}

std::map<std::string, StationStatus> Board::stations() const {
  const std::lock_guard guard(lock_);
  std::map<std::string, StationStatus> out;
  for (const auto& [key, seen] : seen_) {
    if (seen.seen_utc_ns == 0) continue;  // it only asked to begin
    out[key] = seen;
  }
  return out;
}

std::int64_t Board::since_utc_ns(const std::string& public_key) const {
  const std::lock_guard guard(lock_);
  const auto found = seen_.find(public_key);
  return found == seen_.end() ? 0 : found->second.since_utc_ns;
}

std::uint64_t Board::version() const {
  const std::lock_guard guard(lock_);
  return version_;
}

std::uint64_t Board::wait(std::uint64_t seen, int patience_ms) const {
  std::unique_lock guard(lock_);
  changed_.wait_for(guard, std::chrono::milliseconds(patience_ms),
                    [&] { return version_ != seen; });
  return version_;
}

}  // namespace cavum::office
