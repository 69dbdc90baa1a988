// A station that speaks with the office by itself: tickets, the word to begin, a report a second,
// what the office has to say, and recordings that are handed in once they are closed. All of it in
// threads of its own that wait for nobody's picture or tick: the window sets what it does and reads
// what was said. Without a network it goes on with the tickets that it has, and hands in later.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "engine/session/station_key.h"
#include "ui/office/board.h"

namespace cavum::office {

class StationClient;

struct LinkOptions {
  std::string server, certificate;  ///< as StationClient takes them
  std::string school;               ///< public key, hexadecimal
  std::string
      tickets;  ///< folder where the office's tickets lie; what the office takes back is removed
  std::vector<std::string> recordings;  ///< session files, or folders of them, that are handed in
};

/// What an announcement says.
struct ReceivedAnnouncement {
  std::uint64_t entry = 0;
  std::string text;
  std::int64_t utc_ns = 0;  ///< when it was made, by the office's clock
};
/// What came of handing in a recording.
struct HandedIn {
  bool filed = false;
  std::uint64_t entry = 0;            ///< when it is filed
  std::vector<std::string> findings;  ///< when it was refused
};

/// What a window shows of the office: a copy.
struct LinkView {
  bool reached = false;     ///< it answered last time
  double silent_s = 0.0;    ///< since it last answered, or since the beginning
  Message trouble;          ///< why it does not
  std::uint64_t hold = 0;   ///< entry by which the exam here is paused; 0: it may run
  std::string hold_reason;  ///< why
  std::vector<ReceivedAnnouncement> told;  ///< not read yet, the oldest first
  std::size_t waiting = 0;                 ///< recordings that are not handed in yet
  std::vector<std::string> failed;         ///< that the office refused, by name
};

class StationLink {
 public:
  /// Speaks from now on. Throws Error for an address that is none, or a folder that cannot be made.
  StationLink(const LinkOptions& options, const SigningKey& key);
  /// Ends within a moment, whatever the network does; what is not handed in is when another begins.
  ~StationLink();
  StationLink(const StationLink&) = delete;
  StationLink& operator=(const StationLink&) = delete;

  // None of these waits for the network.
  /// What the station does; the board shows it within a second.
  void say(const StationReport& report);
  [[nodiscard]] LinkView view() const;
  /// The candidate has read it; the board says so.
  void read(std::uint64_t entry);
  /// What of the hold is undone here by an invigilator, while the office cannot be reached.
  void release(std::uint64_t hold);
  /// This one is closed, or should not be looked at: a recording that is under way.
  void recording(const std::string& path);
  /// Looks for recordings at once.
  void hand_in();

  /// The office's word to begin the exam of this ticket's number. Waits for it, a few seconds at
  /// most: not of a window's thread. Empty when the office cannot be reached. Throws Error when it
  /// refuses.
  [[nodiscard]] std::string begin(const std::string& nonce);

  /// What became of a recording: beside it lie NAME.receipt.json or NAME.refused.json. Neither: it
  /// waits.
  [[nodiscard]] static std::optional<HandedIn> outcome(const std::string& recording);

 private:
  void speak();
  void hand_in_all();
  void take(const nlohmann::json& word);
  void fetch_tickets(StationClient& client);
  [[nodiscard]] bool file(StationClient& client, const std::string& path);
  [[nodiscard]] std::vector<std::string> recordings_left();
  [[nodiscard]] bool is_ours(const std::string& path);
  /// Until it is time, or this ends: false.
  [[nodiscard]] bool wait(std::unique_lock<std::mutex>& guard, std::condition_variable& come,
                          int ms);

  LinkOptions options_;
  SigningKey key_;
  mutable std::mutex lock_;
  std::condition_variable speak_, file_;
  bool ending_ = false, look_ = true;
  StationReport said_;
  LinkView view_;
  std::int64_t answered_ns_ = 0;  // steady clock
  std::int64_t tickets_ = -1;     // as the office counts them, of the last time they were fetched
  std::uint64_t received_ = 0;    // last announcement
  std::uint64_t released_ = 0;    // hold that is undone here
  std::string under_way_;
  std::set<std::string> not_ours_;  // of the thread that hands in
  std::unique_ptr<StationClient> speaking_, filing_;
  std::thread speaker_, filer_;
};

}  // namespace cavum::office
