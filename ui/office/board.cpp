#include "ui/office/board.h"

#include <algorithm>
#include <chrono>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/language/shown.h"

namespace cavum::office {

using nlohmann::json;

StationReport parse_report(const std::string& text) {
  constexpr std::size_t k_longest = 200;
  constexpr std::int64_t k_day_s = 86'400;
  const json j = parse_json_or_null(text, {16U << 10, 100, 4});
  StationReport r{text_in(j, "state"), text_in(j, "candidate"), text_in(j, "step"), text_in(j, "alarm"), -1, member_of(j, "held") == true, 0};
  if (j.is_object() && j.contains("left_s")) r.left_s = require_whole<std::int64_t>(j, "left_s", "the station's report");
  if (j.is_object() && j.contains("heard")) r.heard = require_whole<std::uint64_t>(j, "heard", "the station's report");
  if (j.is_object() && j.contains("here_s")) r.here_s = require_whole<std::int64_t>(j, "here_s", "the station's report");
  const auto refuse = [](const char* why) { throw Error("the station's report", why, "see docs/office.md"); };
  if (std::none_of(std::begin(k_station_states), std::end(k_station_states), [&](const char* s) { return r.state == s; }))
    refuse("names no state that the board knows");
  for (const std::string* t : {&r.candidate, &r.step, &r.alarm})
    if (t->size() > k_longest || !is_plain_text(*t)) refuse("holds a text that is no line of 200 bytes");
  if (r.left_s < -1 || r.left_s > k_day_s || r.here_s < -1 || r.here_s > k_day_s) refuse("has a time beyond a day");
  return r;
}

void Board::report(const std::string& public_key, const StationReport& report, std::int64_t utc_ns) {
  const std::lock_guard guard(lock_);
  Seen& seen = seen_[public_key];
  const bool same = seen.since_utc_ns != 0 && seen.report.candidate == report.candidate;
  std::int64_t since = 0;  // where the station does not say it, he is here since he was first seen
  if (!report.candidate.empty()) since = report.here_s >= 0 ? utc_ns - report.here_s * 1'000'000'000 : same ? seen.since_utc_ns : utc_ns;
  seen = {report, utc_ns, since};
  if (!report.candidate.empty()) candidates_.insert(report.candidate);
  if (!report.candidate.empty() && report.state != "free") refused_.erase(public_key);
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
  refused_[public_key] = candidate;
  ++version_;
  changed_.notify_all();
}

std::set<std::string> Board::candidates() const {
  const std::lock_guard guard(lock_);
  return candidates_;
}

std::map<std::string, json> Board::stations() const {
  const std::lock_guard guard(lock_);
  std::map<std::string, json> out;
  for (const auto& [key, seen] : seen_) {
    const auto refused = refused_.find(key);
    out[key] = {
        {"state", seen.report.state},        {"candidate", seen.report.candidate}, {"step", seen.report.step},
        {"alarm", shown(seen.report.alarm)}, {"left_s", seen.report.left_s},       {"seen_utc_ns", seen.utc_ns},
        {"held", seen.report.held},          {"heard", seen.report.heard},         {"refused", refused == refused_.end() ? "" : refused->second},
        {"since_utc_ns", seen.since_utc_ns}};
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
  changed_.wait_for(guard, std::chrono::milliseconds(patience_ms), [&] { return version_ != seen; });
  return version_;
}

}  // namespace cavum::office
