#include "tests/simulation/sim_world.h"

#include <cxxabi.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace cavum::simulation {
namespace {

constexpr std::size_t k_stack = 1 << 20;
constexpr std::uint64_t k_max_calls = 2'000'000;
World* g_world = nullptr;
std::uint64_t g_devices = 0x1000;

std::vector<std::unique_ptr<char[]>>& spare_stacks() {
  static std::vector<std::unique_ptr<char[]>> stacks;
  return stacks;
}

}  // namespace

World* World::here() noexcept {
  return g_world != nullptr && g_world->running_ != nullptr ? g_world : nullptr;
}

std::int64_t Computer::clock_error_ns(std::int64_t true_ns) const {
  return clock_ahead_ns + (true_ns - drift_since_ns) / 1'000'000 * drift_ns_per_s / 1000;
}

World::World(std::uint64_t seed, const std::map<std::string, Disk>& disks, std::int64_t true_ns)
    : random_(seed), given_out_(~seed), now_ns_(true_ns) {
  // its locks between threads are of no use here, and one that a killed process holds would be held
  // for ever
  static const int unlocked = sqlite3_config(SQLITE_CONFIG_SINGLETHREAD);
  if (unlocked != SQLITE_OK) throw std::logic_error("SQLite was used before the first world");
  sqlite3_randomness(0, nullptr);  // it draws its seed anew, from this world's random numbers
  for (const auto& [name, disk] : disks) {
    Computer& c = computers_[name];
    c.name = name;
    c.disk = disk.copy();
  }
  g_world = this;
}

World::~World() {
  for (auto& p : processes_)
    if (p->stack) spare_stacks().push_back(std::move(p->stack));
  g_world = nullptr;
}

void World::enter(unsigned high, unsigned low) {
  auto* process = reinterpret_cast<Process*>(static_cast<std::uintptr_t>(high) << 32 | low);
  process->body();
  process->done = true;
  g_world->to_scheduler();
}

Process& World::start(const std::string& computer, const std::string& name,
                      std::function<void()> body) {
  Process& p = *processes_.emplace_back(std::make_unique<Process>());
  p.number = ++last_process_;
  p.device = ++g_devices;
  p.name = name;
  p.computer = &computers_.at(computer);
  p.home = k_root + computer + "/home";
  p.body = std::move(body);
  if (spare_stacks().empty()) {
    p.stack = std::make_unique_for_overwrite<char[]>(k_stack);
  } else {
    p.stack = std::move(spare_stacks().back());
    spare_stacks().pop_back();
  }
  ::getcontext(&p.context);
  p.context.uc_stack.ss_sp = p.stack.get();
  p.context.uc_stack.ss_size = k_stack;
  p.context.uc_link = nullptr;
  const auto address = reinterpret_cast<std::uintptr_t>(&p);
  ::makecontext(&p.context, reinterpret_cast<void (*)()>(&World::enter), 2,
                static_cast<unsigned>(address >> 32), static_cast<unsigned>(address));
  return p;
}

void World::resume(Process& p) {
  void* of_thread = abi::__cxa_get_globals();
  std::memcpy(&scheduler_exceptions_, of_thread, sizeof scheduler_exceptions_);
  std::memcpy(of_thread, &p.exceptions, sizeof p.exceptions);
  running_ = &p;
  ::swapcontext(&scheduler_, &p.context);
  running_ = nullptr;
  std::memcpy(&p.exceptions, of_thread, sizeof p.exceptions);
  std::memcpy(of_thread, &scheduler_exceptions_, sizeof scheduler_exceptions_);
}

void World::to_scheduler() { ::swapcontext(&running_->context, &scheduler_); }

void World::never_again() {
  to_scheduler();
  std::terminate();  // it was resumed all the same
}

void World::run(const std::function<void(Process&)>& at_end) {
  std::stable_sort(events_.begin(), events_.end(),
                   [](const Event& a, const Event& b) { return a.at_call > b.at_call; });
  std::vector<Process*> told;
  for (;;) {
    std::vector<Process*> ready;
    std::int64_t first = 0;
    bool any = false;
    for (std::size_t i = 0; i < processes_.size(); ++i) {
      Process* p = processes_[i].get();
      if (p->done || p->killed) {
        if (std::find(told.begin(), told.end(), p) != told.end()) continue;
        told.push_back(p);
        leave(*p);
        at_end(*p);
        continue;
      }
      first = any ? std::min(first, p->wakes_ns) : p->wakes_ns;
      any = true;
      if (p->wakes_ns <= now_ns_) ready.push_back(p);
    }
    if (!any && told.size() == processes_.size()) return;
    if (calls_ > k_max_calls) {
      stuck_ = true;
      return;
    }
    if (ready.empty()) {
      if (any) now_ns_ = std::max(now_ns_, first);
      continue;
    }
    resume(*ready[random_.below(ready.size())]);
  }
}

/// What the system does with the files of a process that is no more.
void World::leave(Process& p) {
  std::erase_if(files, [&](const auto& f) {
    if (f.second.process != p.number) return false;
    if (f.second.node) {
      std::erase_if(f.second.node->locks, [&](const ByteLock& l) { return l.process == p.number; });
      if (f.second.node->whole_lock_holder == f.first) f.second.node->whole_lock_holder = 0;
    }
    return true;
  });
}

void World::calmly(const std::string& computer, const std::function<void()>& action) {
  Process p;
  p.number = ++last_process_;
  p.device = ++g_devices;
  p.computer = &computers_.at(computer);
  p.home = k_root + computer + "/home";
  p.calm = true;
  struct Running {
    World& world;
    Process& process;
    Running(World& w, Process& q) : world(w), process(q) { world.running_ = &process; }
    ~Running() {
      world.running_ = nullptr;
      world.leave(process);
    }
  } running(*this, p);
  action();
}

void World::cut_power(Computer& computer) {
  for (auto& p : processes_)
    if (p->computer == &computer && !p->done) {
      p->killed = true;
      leave(*p);
    }
  computer.disk.lose_power(random_);
  computer.full_until_ns = 0;
  computer.next_sync_fails = false;
}

void World::happen(const Event& e) {
  if (e.kind == Event::Kind::kill) {
    running_->killed = true;
    return;
  }
  Computer& c = computers_.at(e.computer);
  c.had_faults |= e.kind == Event::Kind::disk_full || e.kind == Event::Kind::sync_fails;
  c.clock_changes += e.kind == Event::Kind::set_clock || e.kind == Event::Kind::drift;
  switch (e.kind) {
    case Event::Kind::power_cut:
      cut_power(c);
      break;
    case Event::Kind::disk_full:
      c.full_until_ns = now_ns_ + e.ns;
      break;
    case Event::Kind::sync_fails:
      c.next_sync_fails = true;
      break;
    case Event::Kind::set_clock:
      c.clock_ahead_ns += e.ns;
      break;
    case Event::Kind::drift:
      c.clock_ahead_ns = c.clock_error_ns(now_ns_);
      c.drift_since_ns = now_ns_;
      c.drift_ns_per_s = e.ns;
      break;
    case Event::Kind::kill:
      break;
  }
}

void World::pause() {
  now_ns_ += static_cast<std::int64_t>(1000 * (1 + random_.below(100)));
  if (running_->calm) return;
  ++calls_;
  while (!events_.empty() && events_.back().at_call <= calls_) {
    const Event e = events_.back();
    events_.pop_back();
    happen(e);
  }
  if (running_->killed) never_again();
  if (random_.below(100) < switch_percent_) to_scheduler();
}

void World::sleep(std::int64_t ns) {
  if (running_->calm) {
    now_ns_ += ns;
    return;
  }
  running_->wakes_ns = now_ns_ + ns;
  to_scheduler();
}

std::int64_t World::utc_ns() const {
  return k_begin_utc_ns + now_ns_ + running_->computer->clock_error_ns(now_ns_);
}

NodePtr World::find(const std::string& path, NodePtr* folder, std::string* name) const {
  const std::string own = k_root + running_->computer->name;
  if (path + "/" == k_root) return running_->computer->disk.root();
  if (!path.starts_with(own) || (path.size() > own.size() && path[own.size()] != '/'))
    return nullptr;
  std::string inside = path.substr(own.size());
  while (!inside.empty() && inside.back() == '/') inside.pop_back();
  const auto slash = inside.rfind('/');
  if (slash != std::string::npos) {
    if (folder != nullptr) *folder = running_->computer->disk.find(inside.substr(0, slash));
    if (name != nullptr) *name = inside.substr(slash + 1);
  }
  return running_->computer->disk.find(inside);
}

}  // namespace cavum::simulation
