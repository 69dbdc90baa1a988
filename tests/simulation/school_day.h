// A day at a school whose computers fail, as a seed draws it: several people at the office's
// computer enter things into one ledger at the same time, a cosigner signs on another, programs are
// killed, the power goes, the disk is full, clocks are set. What a function acknowledged by
// returning is written down here, in plain lists, and must be there at the end.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "grading/marking/exam_context.h"
#include "grading/records/cosign.h"
#include "grading/records/ledger.h"
#include "grading/records/ticket.h"
#include "tests/simulation/sim_world.h"

namespace cavum::records {
/// What a day that went wrong is told by.
inline std::string text_of(const Findings& findings) {
  std::string all;
  for (const Finding& f : findings) all += english_text(f.message()) + "\n";
  return all;
}
}  // namespace cavum::records

namespace cavum::simulation {

/// How a station's clock was wrong, as a finding names it.
enum class WrongClock { none, ahead, behind, uneven };

/// An exam that was sat and waits to be handed in.
struct SatExam {
  std::string path;  ///< on the office's computer
  WrongClock clock = WrongClock::none;
  std::int64_t begun_utc_ns = 0, closed_utc_ns = 0;  ///< by the station's clock
};

/// The school on the morning of every day: disks of its computers, and the exams that were sat.
struct Morning {
  std::map<std::string, Disk> disks;
  std::int64_t true_ns = 0;
  std::vector<SatExam> exams;
  records::Ticket promise;  ///< of the exam, for nobody yet
};
/// Makes ledger, station, cosigner and exams, in a world of its own.
[[nodiscard]] Morning make_morning();

/// What people do, each a run of the program.
enum class Task {
  issue,
  station,
  file,
  release,
  forget,
  receipt,
  backup,
  checkpoint,
  cosign,
  keep_cosignature,
  verify,
  cancel,
  begin,
  erase
};
inline constexpr int k_tasks = static_cast<int>(Task::erase) + 1;
[[nodiscard]] const char* name_of(Task task);

class SchoolDay {
 public:
  SchoolDay(const Morning& morning, std::uint64_t seed);

  /// Draws who does what, and what happens meanwhile.
  void draw();
  /// These tasks, one after the other, by one person at the office (cosign: at the cosigner's).
  void give(const std::string& person, const std::vector<Task>& tasks);
  [[nodiscard]] World& world() noexcept { return world_; }
  /// The school's key is replaced; at the call `interrupt` (0: none) the power goes first.
  void replace_key_at_the_end(std::uint64_t interrupt) {
    replaces_key_ = true, interrupt_key_ = interrupt;
  }
  /// Runs the day, and compares at its end. What is wrong, in words; empty when nothing is.
  [[nodiscard]] std::vector<std::string> run();
  /// The office's ledger is lost, and restored from its backup, if there is one; at the call
  /// `interrupt` (0: none) the power goes first.
  void lose_ledger_at_the_end(std::uint64_t interrupt) {
    loses_ledger_ = true, interrupt_restore_ = interrupt;
  }
  [[nodiscard]] std::size_t acknowledged() const noexcept { return entries_.size(); }
  /// Counts of what happened, for the campaign's summary.
  [[nodiscard]] const std::map<std::string, std::uint64_t>& counts() const noexcept {
    return counts_;
  }

 private:
  struct Entered {
    std::uint64_t seq = 0;
    std::string text;
    std::int64_t utc_ns = 0;  ///< of the office's clock when it was acknowledged
    nlohmann::json receipt;
  };
  struct Person {
    std::string computer;
    std::vector<Task> tasks;
    std::size_t next = 0;
    std::uint64_t pause_ns = 0;
  };

  void work(const std::string& name);
  void start(const std::string& name);
  void perform(Task task);
  void issue_ticket();
  void enrol_station();
  void file_exam();
  void release_all();
  void forget_somebody();
  void cancel_some_ticket();
  void let_some_exam_begin();
  void erase_some_session();
  void write_receipt();
  void take_backup();
  void ask_cosigner();
  void cosign_here();
  void keep_cosignature();
  void verify();
  void entered(const records::Ledger& ledger, std::uint64_t seq);
  void wrong(const std::string& what);
  void check_end();
  void check_entries(const records::LedgerContent& content);
  void check_clocks(const records::Findings& remarks);
  void check_identities();
  void check_backup();
  void check_cosigner(const records::LedgerContent& content);
  void restore_from_backup();
  void replace_key();
  void put_right();

  const Morning& morning_;
  World world_;
  std::map<std::string, Person> people_;
  std::vector<std::string> wrong_;
  bool loses_ledger_ = false;
  std::uint64_t interrupt_restore_ = 0;
  bool replaces_key_ = false;
  std::uint64_t interrupt_key_ = 0;

  // what was acknowledged
  std::vector<Entered> entries_;  ///< in the order of acknowledgement
  std::map<std::string, std::string>
      filed_files_;                           ///< SHA-256 of a recording; the pseudonym of who sat
  std::set<std::string> to_erase_, erased_;   ///< SHA-256 of recordings: begun, and acknowledged
  std::map<std::size_t, bool> filed_exams_;   ///< by number: begun to be filed, by anybody
  std::map<std::string, std::string> known_;  ///< pseudonym by the school's own number
  std::set<std::string> to_forget_, forgotten_;     ///< pseudonyms: begun, and acknowledged
  std::map<std::string, nlohmann::json> receipts_;  ///< by path
  std::optional<records::Checkpoint> backed_up_;
  std::vector<std::string> notes_;  ///< cosigned
  std::set<std::pair<std::uint64_t, std::string>> kept_cosignatures_;
  std::string to_cosigner_, to_office_;
  std::optional<std::uint64_t> cosigner_asks_since_;
  std::uint64_t cosigned_size_ = 0;
  std::map<std::string, std::uint64_t> counts_;
};

}  // namespace cavum::simulation
