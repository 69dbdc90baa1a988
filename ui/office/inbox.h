// Exams that stations hand in: each is streamed to disk, then verified and filed by a thread of its
// own. A station is told "filed" only when the entry stands in the ledger; a server that is killed
// in between goes on with what lies on disk, and what does not is sent again.
#pragma once

#include <sodium.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "grading/records/filing.h"
#include "ui/office/wire.h"

namespace cavum::office {

/// The same message, in which a place on this computer, and what lies below it, is called
/// otherwise.
[[nodiscard]] Message with_location_as(const Message& message, const std::string& place,
                                       const Message& name);

/// An exam that is on its way to disk.
class Arriving {
 public:
  /// Throws Error when no file can be made in `folder`.
  Arriving(const std::string& folder, std::string sha256);
  ~Arriving();
  Arriving(const Arriving&) = delete;
  Arriving& operator=(const Arriving&) = delete;
  void take(std::string_view part);
  /// On disk, under its hash. Throws Error when the disk refused some of it, or the hash is
  /// another.
  void keep();

 private:
  std::string folder_, sha256_, path_;
  int file_ = -1;
  bool refused_ = false;
  crypto_hash_sha256_state hash_{};
};

/// What became of an exam that was handed in.
struct Handed {
  using State = HandedState;
  State state = State::unknown;
  std::uint64_t entry = 0;          ///< of the ledger, when it is filed
  records::Findings findings = {};  ///< why it was refused
  std::string station =
      {};  ///< key of who handed it in, or of who sealed it; empty: neither is known
  std::string candidate = {};  ///< of one that was refused and can be read; else empty
};

class Inbox {
 public:
  /// `folder` keeps what waits; what was refused goes to `folder`/refused. `filed` is called after
  /// each that is done, by the thread that files.
  Inbox(std::string folder, std::string ledger_folder, SigningKey school,
        records::FilingOptions options, std::function<void()> filed);
  ~Inbox();
  Inbox(const Inbox&) = delete;
  Inbox& operator=(const Inbox&) = delete;

  [[nodiscard]] std::unique_ptr<Arriving> receive(const std::string& sha256) const;
  /// A file of the same disk, with this hash, becomes one that is to be filed.
  void adopt(const std::string& path, const std::string& sha256, const std::string& station);
  /// It lies on disk, handed in by this station: to be filed.
  void add(const std::string& sha256, const std::string& station);
  /// Of this program's time; the ledger knows what was filed before.
  [[nodiscard]] Handed of(const std::string& sha256) const;
  [[nodiscard]] std::size_t waiting() const;
  /// What was refused, by hash, the newest last.
  [[nodiscard]] std::vector<std::pair<std::string, Handed>> refused() const;
  /// Why nothing can be filed at the moment, in words; empty: nothing is wrong.
  [[nodiscard]] Message trouble() const;

 private:
  void work();
  /// False: the disk or the ledger refused, and it is tried again.
  [[nodiscard]] bool file(const std::string& sha256);
  void refuse(const std::string& sha256, Handed why);
  /// For people elsewhere: without this computer's folders.
  [[nodiscard]] Message without_locations(const Message& message, const std::string& sha256) const;
  [[nodiscard]] std::string path_of(const std::string& sha256) const {
    return folder_ + "/" + sha256 + ".cavum";
  }

  std::string folder_, ledger_folder_;
  SigningKey school_;
  records::FilingOptions options_;
  std::function<void()> filed_;
  mutable std::mutex lock_;
  std::condition_variable come_;
  std::deque<std::string> queue_;
  std::map<std::string, Handed> handed_;
  std::vector<std::string> refused_;
  Message trouble_;
  bool stopping_ = false;
  grading::ExamContexts grounds_;            // of a class; the worker's alone, as the next
  std::unique_ptr<records::Ledger> ledger_;  // null: to be opened
  std::thread worker_;
};

}  // namespace cavum::office
