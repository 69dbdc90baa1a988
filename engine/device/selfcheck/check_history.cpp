#include "engine/device/selfcheck/check_history.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "engine/base/hash.h"
#include "engine/base/json_reader.h"
#include "engine/base/system_error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

constexpr const char* k_put_away =
    noop("put the file away and keep it; the next check begins a new one");

/// A line is no larger.
constexpr std::size_t k_longest_line = 16384;

/// An open file that nobody else adds to.
class LockedFile {
 public:
  explicit LockedFile(const std::string& path)
      : path_(path), fd_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600)) {
    if (fd_ < 0 || ::flock(fd_, LOCK_EX) != 0) fail();
  }
  ~LockedFile() {
    if (fd_ >= 0) ::close(fd_);
  }
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;

  [[nodiscard]] std::size_t size() const {
    struct stat info {};
    if (::fstat(fd_, &info) != 0) fail();
    return static_cast<std::size_t>(info.st_size);
  }
  /// In place of what comes after the first `at` bytes.
  void write_at(std::size_t at, const std::string& text) const {
    const auto length = static_cast<off_t>(at);
    if (::ftruncate(fd_, length) != 0 ||
        ::pwrite(fd_, text.data(), text.size(), length) != static_cast<ssize_t>(text.size()) ||
        ::fsync(fd_) != 0) {
      const int why = errno;
      static_cast<void>(::ftruncate(fd_, length) == 0);
      errno = why;
      fail();
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(path_, msg("cannot be written ({})", system_words(errno)),
                msg("make room on its disk and its folder writable, then check again"));
  }
  std::string path_;
  int fd_;
};

}  // namespace

std::string check_history_path() { return station_path("selfcheck.jsonl"); }

std::string station_name(const SigningKey& key) {
  constexpr std::size_t k_digits = 8;
  const std::string path = station_path("station.name");
  if (!std::filesystem::exists(path))
    return "station " + to_hex(key.public_key).substr(0, k_digits);
  std::string name = read_text_file(path, 1024);
  while (!name.empty() && name.back() == '\n') name.pop_back();
  if (name.empty() || name.size() > k_longest_station_name || one_line(name) != name)
    throw Error(path, msg("holds no station's name"),
                msg("name it anew with `cavum devices --station-name NAME`"));
  return name;
}

void set_station_name(const std::string& name) {
  if (name.empty() || name.size() > k_longest_station_name || one_line(name) != name)
    throw Error(FileError::malformed, Name{"--station-name"},
                msg("is no name: one line of 1 to {} bytes", k_longest_station_name),
                msg("name it as it stands on its desk"));
  const std::string path = station_path("station.name");
  make_private_folder(std::filesystem::path(path).parent_path().string());
  write_private_text_file(path, name + "\n");
}

CheckHistory::CheckHistory(std::string path) : path_(std::move(path)) {
  if (!std::filesystem::exists(path_)) return;
  const std::string text = read_text_file(path_, k_largest_history);
  std::size_t from = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos;
       from = end + 1, end = text.find('\n', from)) {
    const std::string where = fmt::format("{}:{}", path_, lines_.size() + 1),
                      line = text.substr(from, end - from);
    if (line.size() > k_longest_line)
      throw Error(where, msg("is longer than a check"), msg(k_put_away));
    CheckEntry entry;
    try {
      entry = read_check_entry(parse_json(line, where), where);
    } catch (const Error& e) {
      throw Error(FileError::damaged, Name{where}, msg("is damaged ({})", e.where_and_problem()),
                  msg(k_put_away));
    }
    if (entry.previous != (lines_.empty() ? std::string() : to_hex(sha256(lines_.back()))))
      throw Error(FileError::damaged, Name{where},
                  msg("does not follow the line before it: lines were changed or taken out"),
                  msg(k_put_away));
    entries_.push_back(std::move(entry));
    lines_.push_back(line);
  }
  sound_bytes_ = from;
}

std::vector<ArmFigures> CheckHistory::earlier(const CheckedStylus& stylus) const {
  std::vector<ArmFigures> found;
  for (const CheckEntry& e : entries_) {
    if (!(e.stylus == stylus)) continue;
    if (e.kind == CheckEntry::Kind::new_history) found.clear();
    if (e.kind == CheckEntry::Kind::check && (e.verdict.outcome == CheckOutcome::learning ||
                                              e.verdict.outcome == CheckOutcome::unchanged))
      found.push_back(e.figures);
  }
  return found;
}

namespace {

/// Places of the last check of `stylus` since its last new history, and of the decision on it; or
/// their number.
std::pair<std::size_t, std::size_t> last_of(const std::vector<CheckEntry>& entries,
                                            const CheckedStylus& stylus) {
  std::size_t check = entries.size(), decision = entries.size();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!(entries[i].stylus == stylus)) continue;
    if (entries[i].kind == CheckEntry::Kind::new_history) check = decision = entries.size();
    if (entries[i].kind == CheckEntry::Kind::check) {
      check = i;
      decision = entries.size();
    }
    if (entries[i].kind == CheckEntry::Kind::decision) decision = i;
  }
  return {check, decision};
}

}  // namespace

std::optional<CheckEntry> CheckHistory::last_check(const CheckedStylus& stylus) const {
  const auto [check, decision] = last_of(entries_, stylus);
  return check < entries_.size() ? std::optional(entries_[check]) : std::nullopt;
}

std::optional<CheckEntry> CheckHistory::last_decision(const CheckedStylus& stylus) const {
  const auto [check, decision] = last_of(entries_, stylus);
  return decision < entries_.size() ? std::optional(entries_[decision]) : std::nullopt;
}

std::string CheckHistory::session_note(const CheckedStylus& stylus) const {
  const auto [check, decision] = last_of(entries_, stylus);
  if (check == entries_.size()) return {};
  return decision < entries_.size()
             ? fmt::format("{{\"check\":{},\"decision\":{}}}", lines_[check], lines_[decision])
             : fmt::format("{{\"check\":{}}}", lines_[check]);
}

CheckVerdict CheckHistory::add_check(const CheckedStylus& stylus, const ArmFigures& figures,
                                     std::int64_t utc_ns, const SigningKey& key) {
  CheckEntry e;
  e.utc_ns = utc_ns;
  e.stylus = stylus;
  e.figures = figures;
  e.verdict = judge_check(figures, earlier(stylus));
  if (e.verdict.outcome == CheckOutcome::changed) {
    e.since_utc_ns = utc_ns;
    const auto before = last_check(stylus);
    if (before && before->verdict.outcome == CheckOutcome::changed)
      e.since_utc_ns = before->since_utc_ns;
  }
  const CheckVerdict verdict = e.verdict;
  add(std::move(e), key);
  return verdict;
}

void CheckHistory::add_decision(const CheckedStylus& stylus, bool go_on, const std::string& by,
                                const std::string& reason, std::int64_t utc_ns,
                                const SigningKey& key) {
  CheckEntry e;
  e.kind = CheckEntry::Kind::decision;
  e.utc_ns = utc_ns;
  e.stylus = stylus;
  e.go_on = go_on;
  e.by = by;
  e.reason = reason;
  add(std::move(e), key);
}

void CheckHistory::begin_again(const CheckedStylus& stylus, const std::string& reason,
                               std::int64_t utc_ns, const SigningKey& key) {
  if (reason.empty())
    throw Error(FileError::missing, Name{"--new-history"}, msg("gives no reason"),
                msg("say what was repaired or changed"));
  CheckEntry e;
  e.kind = CheckEntry::Kind::new_history;
  e.utc_ns = utc_ns;
  e.stylus = stylus;
  e.reason = reason;
  add(std::move(e), key);
}

void CheckHistory::add(CheckEntry entry, const SigningKey& key) {
  if (entry.reason.size() > k_longest_check_reason)
    throw Error(msg("the reason"), msg("is longer than {} bytes", k_longest_check_reason),
                msg("say it shorter"));
  entry.station = station_name(key);
  entry.station_key = to_hex(key.public_key);
  entry.previous = lines_.empty() ? std::string() : to_hex(sha256(lines_.back()));
  const std::string line = to_signed_json(entry, key).dump();
  if (sound_bytes_ + line.size() + 1 > k_largest_history)
    throw Error(path_, msg("is full"), msg(k_put_away));
  make_private_folder(std::filesystem::path(path_).parent_path().string());
  const LockedFile file(path_);
  const std::size_t there = file.size();
  if (there < sound_bytes_ ||
      (there > sound_bytes_ && CheckHistory(path_).lines_.size() != lines_.size()))
    throw Error(FileError::inconsistent, Name{path_},
                msg("was changed by another program meanwhile"), msg("check again"));
  file.write_at(sound_bytes_, line + "\n");
  sync_folder_of(path_);
  sound_bytes_ += line.size() + 1;
  lines_.push_back(line);
  entries_.push_back(std::move(entry));
}

}  // namespace cavum
