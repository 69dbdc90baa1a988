#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include "engine/base/independent_runs.h"
#include "engine/base/write_file.h"
#include "grading/pool/makers.h"

namespace cavum::pool {
namespace {

constexpr int k_attempts = 3;

double core_s_of_thread() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Makes the lines of `wanted`, some at the same time; `take` gets each. Returns those that could
/// not be made.
std::vector<std::size_t> make(
    const Work& work, const std::vector<std::size_t>& wanted, std::size_t threads, const Run& run,
    const std::function<void(std::size_t, std::string, const Spent&)>& take) {
  grading::ExamContexts grounds;  // of the whole class
  std::mutex mutex;               // of what follows, and of `take`
  std::vector<std::size_t> missing = wanted;
  for (int attempt = 0; attempt < k_attempts && !missing.empty(); ++attempt) {
    std::vector<std::size_t> again;
    const auto one = [&](std::size_t i) {
      const std::size_t index = missing[i];
      {
        const std::lock_guard lock(mutex);
        if (run.stop && run.stop()) return again.push_back(index);
      }
      try {
        const auto begin = std::chrono::steady_clock::now();
        const double core_s = core_s_of_thread();
        std::string line = line_of(work, index, grounds);
        const Spent spent{seconds_since(begin), core_s_of_thread() - core_s};
        const std::lock_guard lock(mutex);
        take(index, std::move(line), spent);
      } catch (const std::bad_alloc&) {  // perhaps when others have ended
        const std::lock_guard lock(mutex);
        again.push_back(index);
      }
    };
    independent_runs(missing.size(), one, threads);
    std::sort(again.begin(), again.end());
    missing = std::move(again);
  }
  return missing;
}

std::size_t threads_for(const Run& run, std::size_t lines) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  return std::clamp<std::size_t>(run.threads > 0 ? static_cast<std::size_t>(run.threads) : cores, 1,
                                 std::max<std::size_t>(1, lines));
}

}  // namespace

Made by_threads(const Work& work, const Run& run) {
  const auto begin = std::chrono::steady_clock::now();
  Parts there{std::vector<std::optional<std::string>>(work.sessions.size()),
              std::vector<Spent>(work.sessions.size()),
              {}};
  std::unique_ptr<PartWriter> part;
  if (!run.parts.empty()) {
    make_private_folder(run.parts);
    there = read_parts(work, part_files(run.parts));
    leave_out_changed(work, there);
    part = std::make_unique<PartWriter>(fmt::format("{}/threads.part", run.parts), id_of(work));
  }
  const auto wanted = there.missing();
  Made out;
  out.found = work.sessions.size() - wanted.size();
  out.workers = threads_for(run, wanted.size());
  out.remarks = there.remarks;
  std::size_t done = out.found;
  out.missing = make(work, wanted, out.workers, run,
                     [&](std::size_t index, std::string line, const Spent& spent) {
                       if (part) part->add(index, line, spent);
                       there.lines[index] = std::move(line);
                       there.spent[index] = spent;
                       ++done;
                       if (run.told) run.told(done, work.sessions.size());
                     });
  for (auto& line : there.lines) out.lines.push_back(line ? std::move(*line) : std::string());
  for (const auto& s : there.spent) out.spent += s;
  out.wall_s = seconds_since(begin);
  return out;
}

std::size_t make_shard(const Work& work, std::size_t shard, std::size_t of, const std::string& path,
                       const Run& run) {
  std::vector<std::size_t> wanted;
  Parts there{std::vector<std::optional<std::string>>(work.sessions.size()), {}, {}};
  if (std::filesystem::exists(path)) {
    there = read_parts(work, {path});
    leave_out_changed(work, there);
  }
  std::size_t lines = 0;
  for (std::size_t i = shard - 1; i < work.sessions.size(); i += of, ++lines)
    if (!there.lines[i]) wanted.push_back(i);
  PartWriter part(path, id_of(work));
  std::size_t done = lines - wanted.size();
  const auto missing = make(work, wanted, threads_for(run, wanted.size()), run,
                            [&](std::size_t index, const std::string& line, const Spent& spent) {
                              part.add(index, line, spent);
                              if (run.told) run.told(++done, lines);
                            });
  return wanted.size() - missing.size();
}

void make_lines(const Work& work, std::span<const std::size_t> wanted, PartWriter& part) {
  static_cast<void>(make(work, {wanted.begin(), wanted.end()}, 1, {},
                         [&](std::size_t index, const std::string& line, const Spent& spent) {
                           part.add(index, line, spent);
                         }));
}

}  // namespace cavum::pool
