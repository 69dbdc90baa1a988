// Computers, their processes, disks and clocks, all in one process of the real machine and repeated
// exactly by a seed. A process is a stack of its own; at every call to the system (libc_calls.cpp
// takes them all: files, locks, clocks, sleep, random numbers) another may go on, and the seed says
// which. A killed process never goes on, as if the machine had taken it away between two calls; a
// power cut kills all of a computer and cuts its disk back.
#pragma once

#include <ucontext.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/random.h"
#include "tests/simulation/sim_disk.h"

namespace cavum::simulation {

/// What happens at the n-th call to the system.
struct Event {
  enum class Kind {
    kill,        ///< the process that makes the call
    power_cut,   ///< `computer` goes dark, and is switched on again
    disk_full,   ///< nothing more fits on its disk for `ns`
    sync_fails,  ///< the next sync on it fails, once
    set_clock,   ///< its wall clock is moved by `ns`
    drift        ///< it runs fast or slow by `ns` a second from then on
  };
  std::uint64_t at_call = 0;
  Kind kind = Kind::kill;
  std::string computer;
  std::int64_t ns = 0;
};

struct Computer {
  std::string name;
  Disk disk;
  std::int64_t clock_ahead_ns = 0, drift_ns_per_s = 0, drift_since_ns = 0;
  std::int64_t full_until_ns = 0;
  bool next_sync_fails = false;
  bool had_faults = false;  ///< its disk was full, or did not sync
  int clock_changes = 0;
  /// By how much its wall clock is wrong at this true time.
  [[nodiscard]] std::int64_t clock_error_ns(std::int64_t true_ns) const;
};

struct OpenFile {
  int process = 0;
  NodePtr node;
  std::int64_t offset = 0;
  int flags = 0;
  bool random = false;  ///< /dev/urandom
};

/// One run of a program.
struct Process {
  int number = 0;
  std::uint64_t device = 0;  ///< of no other process of any world
  std::string name;          ///< whose it is
  Computer* computer = nullptr;
  std::string home;  ///< its CAVUM_HOME
  std::function<void()> body;
  ucontext_t context{};
  std::unique_ptr<char[]> stack;
  std::int64_t wakes_ns = 0;
  bool done = false, killed = false, calm = false;
  struct {
    void* caught = nullptr;
    unsigned int uncaught = 0;
  } exceptions;  ///< the C++ library keeps one such for each thread; these share one
};

class World {
 public:
  /// `computers` begin with copies of these disks.
  World(std::uint64_t seed, const std::map<std::string, Disk>& disks, std::int64_t true_ns);
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  Process& start(const std::string& computer, const std::string& name, std::function<void()> body);
  /// Runs until every process has ended or was killed. `at_end` is told of each, and may start
  /// others.
  void run(const std::function<void(Process&)>& at_end);
  /// `action` on a computer without any interruption, fault or other process.
  void calmly(const std::string& computer, const std::function<void()>& action);

  [[nodiscard]] Computer& computer(const std::string& name) { return computers_.at(name); }
  [[nodiscard]] std::map<std::string, Computer>& computers() { return computers_; }
  [[nodiscard]] std::int64_t true_ns() const noexcept { return now_ns_; }
  [[nodiscard]] std::uint64_t calls() const noexcept { return calls_; }
  [[nodiscard]] Random& random() noexcept { return random_; }
  /// What the system gives out as random: of its own, for SQLite asks for some when another process
  /// had asked last, be it on another day.
  [[nodiscard]] Random& given_out() noexcept { return given_out_; }
  void plan(Event event) { events_.push_back(std::move(event)); }
  /// At each call another process may go on, in so many of a hundred.
  void switch_percent(unsigned percent) { switch_percent_ = percent; }
  void cut_power(Computer& computer);
  void wait(std::int64_t ns) { now_ns_ += ns; }
  [[nodiscard]] bool stuck() const noexcept { return stuck_; }

  // what the calls to the system ask
  [[nodiscard]] static World* here() noexcept;  ///< null: this is the real machine
  [[nodiscard]] Process& process() noexcept { return *running_; }
  void pause();  ///< a call to the system begins: time passes, things happen, others go on
  void sleep(std::int64_t ns);
  [[nodiscard]] std::int64_t utc_ns() const;  ///< by the computer's clock
  [[nodiscard]] NodePtr find(const std::string& path, NodePtr* folder, std::string* name) const;
  std::map<int, OpenFile> files;
  int last_file = 1 << 20;

 private:
  void happen(const Event& event);
  void leave(Process& process);
  void resume(Process& process);
  void to_scheduler();
  [[noreturn]] void never_again();
  static void enter(unsigned high, unsigned low);

  Random random_, given_out_;
  std::map<std::string, Computer> computers_;
  std::vector<std::unique_ptr<Process>> processes_;
  std::vector<Event> events_;
  Process* running_ = nullptr;
  ucontext_t scheduler_{};
  std::int64_t now_ns_ = 0;
  std::uint64_t calls_ = 0;
  int last_process_ = 1;
  unsigned switch_percent_ = 30;
  bool stuck_ = false;
  decltype(Process::exceptions) scheduler_exceptions_;
};

/// Where the simulated disks are seen: /sim/COMPUTER/...
inline constexpr char k_root[] = "/sim/";
/// The wall clock when true time is 0, ns since 1970.
inline constexpr std::int64_t k_begin_utc_ns = 1'800'000'000'000'000'000;

}  // namespace cavum::simulation
