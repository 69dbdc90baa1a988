// A new rubric over all of an exam at the office: marked in the background, looked at, and then
// counted by who asked for it, or dropped. One at a time. What is marked lives in memory; a note on
// disk lets the office say after a restart whether it counts: it does whole, or not at all.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "grading/records/class_regrade.h"
#include "ui/office/desk.h"

namespace cavum::office {

class Regrades {
 public:
  /// `note`: path of the file that outlives the server. Throws Error when it cannot be read.
  Regrades(Desk& desk, std::string ledger_folder, std::string note);
  /// Ends the marking between two sessions.
  ~Regrades();
  Regrades(const Regrades&) = delete;
  Regrades& operator=(const Regrades&) = delete;

  // Each throws Error in the words of what is wrong.
  /// Marks in the background from now on. Throws Error while another one is marked.
  [[nodiscard]] RegradeId begin(const BeginRegrade& asked, const Account& by);
  /// What was looked at counts from now on. Only for who began it.
  [[nodiscard]] RegradeCounted count(const CountRegrade& asked, const Account& by);
  /// Nothing of it counts; marking that runs is ended.
  void drop(const std::string& id, const Account& by);
  /// Throws Error unless `id` is a new rubric that waits and that this person began.
  void require_ready(const std::string& id, const Account& by) const;

  /// Lost: the server ended before it counted. With an estimate of what is left.
  [[nodiscard]] RegradeShown state() const;
  /// Each session with points and verdict before and after, by pseudonyms; none unless it is ready.
  [[nodiscard]] std::optional<std::vector<RegradeRow>> rows() const;
  /// Waits until something is another than at `seen`, `patience_ms` at most; returns the new
  /// number.
  [[nodiscard]] std::uint64_t wait(std::uint64_t seen, int patience_ms) const;

 private:
  using State = RegradeState;
  void mark();
  void end_marking();
  void change(State state, const Message& problem = {});
  void write_note() const;
  void read_note();

  Desk& desk_;
  std::string ledger_folder_, note_;
  std::mutex one_at_a_time_;  // of begin, count and drop
  mutable std::mutex lock_;   // of what follows
  mutable std::condition_variable changed_;
  std::uint64_t version_ = 1;
  State state_ = State::none;
  std::string id_, by_, begun_, rubric_sha256_;
  Message problem_;
  records::ClassRegrade plan_;
  std::uint64_t entries_ = 0;  // of the ledger when it began
  std::size_t done_ = 0, of_ = 0;
  std::uint64_t first_entry_ = 0, counted_ = 0;
  double left_s_ = -1;
  bool stop_ = false;
  std::thread worker_;
};

}  // namespace cavum::office
