#include "ui/verbs/pool_options.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "engine/base/text.h"
#include "ui/parts/interrupt.h"

namespace cavum::ui {

void add_pool_options(CLI::App& verb, PoolOptions& o) {
  verb.add_option("--threads", o.threads, "sessions at once on this machine (default: its cores)")->check(CLI::Range(1, 256));
  verb.add_flag("--slurm", o.slurm, "by job arrays of a Slurm cluster, which sees --work and the sessions under the same names");
  verb.add_option("--a-task", o.a_task, "sessions a task of Slurm")->check(CLI::Range(1, 100000))->capture_default_str();
  verb.add_option("--sbatch", o.sbatch, "further options of sbatch, with spaces between: \"--partition=long --time=2:00:00\"");
  verb.add_option("--work", o.work, "folder in which what was made is kept, so that the same command goes on where it was broken off");
}

std::function<void(std::size_t, std::size_t)> shown_progress() {
  using Clock = std::chrono::steady_clock;
  struct Told {
    Clock::time_point begin = Clock::now(), last = begin;
    std::size_t first = 0;
    bool any = false;
  };
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const auto told = std::make_shared<Told>();
  return [=](std::size_t done, std::size_t of) {
    if (!told->any) told->any = true, told->first = done - 1;  // those that were there cost nothing
    const auto now = Clock::now();
    const bool end = done == of;
    const double since_s = std::chrono::duration<double>(now - told->last).count();
    if (!end && since_s < (terminal ? 0.2 : 60.0)) return;
    told->last = now;
    const double a_second = static_cast<double>(done - told->first) / std::max(1e-3, std::chrono::duration<double>(now - told->begin).count());
    const auto left = std::chrono::seconds(static_cast<std::int64_t>(static_cast<double>(of - done) / a_second));
    const std::time_t then = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now() + left);
    const std::string until = end ? "" : fmt::format(", until about {:%H:%M}", fmt::localtime(then));
    std::fprintf(stderr, "%s%zu of %zu, %.0f a minute%s%s", terminal ? "\r" : "", done, of, a_second * 60, until.c_str(),
                 terminal && !end ? "   " : "\n");
  };
}

pool::Made make_lines(const pool::Work& work, const PoolOptions& o) {
  const Interrupt interrupt;
  pool::Run run;
  run.threads = o.threads;
  run.told = shown_progress();
  run.stop = [] { return Interrupt::asked(); };
  pool::Made made;
  if (o.slurm) {
    if (o.work.empty()) throw Error("--slurm", msg("needs a folder that all machines see"), msg("name it by --work"));
    pool::Slurm slurm;
    slurm.folder = o.work;
    slurm.program = std::filesystem::read_symlink("/proc/self/exe").string();
    slurm.a_task = o.a_task;
    std::istringstream words(o.sbatch);
    for (std::string w; words >> w;) slurm.sbatch.push_back(w);
    made = pool::by_slurm(work, run, slurm);
  } else {
    run.parts = o.work;
    made = pool::by_threads(work, run);
  }
  if (made.found > 0)
    std::cerr << fmt::format("cavum: notice: {} of {} were there already in {}\n", made.found, work.sessions.size(), one_line(o.work));
  for (const auto& r : made.remarks) std::cerr << "cavum: notice: " << one_line(r) << "\n";
  if (Interrupt::asked())
    throw Error(msg("cavum"), msg("was interrupted with {} of {} still to do", made.missing.size(), work.sessions.size()),
                o.work.empty() ? msg("run it again; with --work it would go on where it stood")
                               : msg("run the same command again: it goes on where it stood"));
  for (const auto i : made.missing) std::cerr << "cavum: " << one_line(work.sessions[i]) << ": could not be done, after three attempts\n";
  return made;
}

}  // namespace cavum::ui
