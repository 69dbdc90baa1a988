#include "ui/cli/pool_options.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

#include "ui/language/say.h"
#include "ui/parts/interrupt.h"
#include "ui/parts/option_checks.h"
#include "ui/parts/say.h"

namespace cavum::ui {

void add_pool_options(CLI::App& verb, PoolOptions& o) {
  verb.add_option("--threads", o.threads,
                  tr("sessions at once on this machine (default: its cores)"))
      ->check(between(1, 256));
  verb.add_flag(
      "--slurm", o.slurm,
      tr("by job arrays of a Slurm cluster, which sees --work and the sessions under the same names"));
  verb.add_option("--sessions-per-task", o.a_task, tr("sessions a task of Slurm"))
      ->check(between(1, 100000))
      ->capture_default_str();
  verb.add_option(
      "--sbatch", o.sbatch,
      tr("further options of sbatch, with spaces between: \"--partition=long --time=2:00:00\""));
  verb.add_option(
      "--work", o.work,
      tr("folder in which what was made is kept, so that the same command goes on where it was broken off"));
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
    const double a_second =
        static_cast<double>(done - told->first) /
        std::max(1e-3, std::chrono::duration<double>(now - told->begin).count());
    const auto left =
        std::chrono::seconds(static_cast<std::int64_t>(static_cast<double>(of - done) / a_second));
    const std::time_t then =
        std::chrono::system_clock::to_time_t(std::chrono::system_clock::now() + left);
    const Number rate = as_number(a_second * 60, 0);
    std::cerr << (terminal ? "\r" : "")
              << (end ? tr("{} of {}, {} a minute", done, of, rate)
                      : tr("{} of {}, {} a minute, until about {}", done, of, rate,
                           as_is(fmt::format("{:%H:%M}", fmt::localtime(then)))))
              << (terminal && !end ? "   " : "\n") << std::flush;
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
    if (o.work.empty())
      throw Error(Name{"--slurm"}, msg("needs a folder that all machines see"),
                  msg("name it by --work"));
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
    say_error(
        msg("notice: {} of {} were there already in {}", made.found, work.sessions.size(), o.work));
  for (const auto& r : made.remarks) say_error(msg("notice: {}", r));
  if (Interrupt::asked())
    throw Error(
        msg("cavum"),
        msg("was interrupted with {} of {} still to do", made.missing.size(), work.sessions.size()),
        o.work.empty() ? msg("run it again; with --work it would go on where it stood")
                       : msg("run the same command again: it goes on where it stood"));
  for (const auto i : made.missing)
    say_error(msg("{}: could not be done, after three attempts", work.sessions[i]));
  return made;
}

}  // namespace cavum::ui
