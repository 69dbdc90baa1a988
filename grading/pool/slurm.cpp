// Slurm by its command line: sbatch begins job arrays, squeue says what became of them, scancel
// ends them.
#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/system_error.h"
#include "engine/base/text.h"
#include "grading/pool/makers.h"

extern char** environ;

namespace cavum::pool {
namespace {

using nlohmann::json;

constexpr double k_patience_s = 300;  // for a controller that does not answer
constexpr std::size_t k_max_tasks =
    1000;  // of an array: Slurm's MaxArraySize is 1001 unless set otherwise

struct Said {
  int code = -1;
  std::string text;  // standard output and error
};

/// Runs a program of the search path to its end. Throws Error when it is not there.
Said run_program(std::vector<std::string> words) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw Error(words[0], system_words(errno), msg("close other programs, and try again"));
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
  std::vector<char*> arguments;
  for (auto& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int failed =
      ::posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  Said said;
  char some[4096];
  for (ssize_t n = 0;
       failed == 0 && ((n = ::read(ends[0], some, sizeof some)) > 0 || (n < 0 && errno == EINTR));)
    if (n > 0) said.text.append(some, static_cast<std::size_t>(n));
  ::close(ends[0]);
  if (failed != 0)
    throw Error(words[0],
                failed == ENOENT ? msg("is not here: Slurm is not installed on this machine")
                                 : system_words(failed),
                msg("install its client (Debian: slurm-client), or leave --slurm out"));
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  said.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return said;
}

/// How many tasks of a job are there, and how many run. None: the controller did not answer.
struct Tasks {
  std::size_t there = 0, running = 0;
};
std::optional<Tasks> tasks_of(const std::string& job) {
  const Said said =
      run_program({"squeue", "--noheader", "--array", "--jobs=" + job, "--format=%T"});
  if (said.code != 0 && said.text.find("Invalid job id") != std::string::npos)
    return Tasks{};  // forgotten: it has ended
  if (said.code != 0) return {};
  Tasks tasks;
  for (std::size_t at = 0; at < said.text.size();) {
    const auto end = std::min(said.text.find('\n', at), said.text.size());
    const std::string state = said.text.substr(at, end - at);
    tasks.there += state.empty() ? 0 : 1;
    tasks.running += state.starts_with("RUNNING") ? 1 : 0;
    at = end + 1;
  }
  return tasks;
}

/// Rows of part files, counted as they grow.
class Growing {
 public:
  explicit Growing(std::string folder) : folder_(std::move(folder)) {}
  std::size_t rows() {
    for (const auto& file : part_files(folder_)) {
      std::ifstream in(file, std::ios::binary);
      auto& at = read_to_[file];
      in.seekg(at);
      char some[65536];
      while (in.read(some, sizeof some) || in.gcount() > 0) {
        rows_ += static_cast<std::size_t>(std::count(some, some + in.gcount(), '\n'));
        at += in.gcount();
      }
    }
    return rows_;
  }

 private:
  std::string folder_;
  std::map<std::string, std::streamoff> read_to_;
  std::size_t rows_ = 0;
};

std::string script_of(const Slurm& slurm, const Work& work, int attempt) {
  const auto quoted = [](const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? "'\\''" : std::string(1, c);
    return out + "'";
  };
  return fmt::format(
      "#!/bin/sh\nexec {} verify-all {} --task {} --attempt {}\n", quoted(slurm.program),
      quoted(std::filesystem::absolute(work.folder.empty() ? "." : work.folder).string()),
      quoted(slurm.folder), attempt);
}

std::string blocks_file(const std::string& folder, int attempt) {
  return fmt::format("{}/blocks-{}.json", folder, attempt);
}

/// As many as hold at least `a_task` sessions each, whose sizes differ by one at most: while a
/// larger one ends the other nodes would be idle.
json blocks_of(const std::vector<std::size_t>& wanted, std::size_t a_task) {
  json blocks = json::array();
  const std::size_t count = std::clamp<std::size_t>(wanted.size() / a_task, 1, k_max_tasks);
  for (std::size_t b = 0; b < count; ++b)
    blocks.push_back(std::vector<std::size_t>(
        wanted.begin() + static_cast<std::ptrdiff_t>(wanted.size() * b / count),
        wanted.begin() + static_cast<std::ptrdiff_t>(wanted.size() * (b + 1) / count)));
  return blocks;
}

/// Hands the blocks to sbatch; returns the job's number.
std::string submit(const Slurm& slurm, const Work& work, const std::vector<std::size_t>& wanted,
                   int attempt) {
  const json blocks = blocks_of(wanted, slurm.a_task);
  write_text_file(blocks_file(slurm.folder, attempt), blocks.dump());
  const std::string script = fmt::format("{}/task-{}.sh", slurm.folder, attempt);
  write_text_file(script, script_of(slurm, work, attempt));
  std::vector<std::string> words = {"sbatch",
                                    "--parsable",
                                    "--requeue",
                                    "--job-name=cavum",
                                    fmt::format("--array=0-{}", blocks.size() - 1),
                                    "--output=" + slurm.folder + "/logs/%A_%a.log",
                                    "--open-mode=append"};
  words.insert(words.end(), slurm.sbatch.begin(), slurm.sbatch.end());
  words.push_back(script);
  const Said said = run_program(words);
  std::string job = said.text.substr(0, said.text.find_first_of(";\n"));
  if (said.code != 0 || job.empty() || job.find_first_not_of("0123456789") != std::string::npos)
    throw Error(msg("sbatch"), msg("refused the work: {}", one_line(said.text)),
                msg("check the cluster with `sinfo`, and the options after --sbatch"));
  return job;
}

/// Until no task of the job is left, or the run is stopped. Returns the most tasks that ran at
/// once.
std::size_t wait_for(const std::string& job, const Slurm& slurm, const Run& run, Growing& growing,
                     std::size_t found, std::size_t of) {
  std::size_t most = 0, told = 0;
  auto heard = std::chrono::steady_clock::now();
  while (true) {
    if (run.stop && run.stop()) {
      static_cast<void>(run_program({"scancel", job}));
      return most;
    }
    const auto tasks = tasks_of(job);
    const auto now = std::chrono::steady_clock::now();
    if (tasks) heard = now, most = std::max(most, tasks->running);
    if (std::chrono::duration<double>(now - heard).count() > k_patience_s)
      throw Error(msg("squeue"), msg("Slurm has not answered for {} s", k_patience_s),
                  msg("run the same command again when it does: what was made is kept"));
    if (const std::size_t rows = std::min(of, found + growing.rows()); run.told && rows != told)
      run.told(told = rows, of);
    if (tasks && tasks->there == 0) return most;
    std::this_thread::sleep_for(std::chrono::duration<double>(slurm.poll_s));
  }
}

}  // namespace

Made by_slurm(const Work& work, const Run& run, const Slurm& wanted) {
  const auto begin = std::chrono::steady_clock::now();
  Slurm slurm = wanted;
  slurm.folder = std::filesystem::absolute(wanted.folder).lexically_normal().string();
  if (slurm.a_task < 1)
    throw Error("--sessions-per-task", msg("is no number of sessions"), msg("give 50 or more"));
  const std::string folder = slurm.folder + "/parts";
  for (const auto& f : {slurm.folder, folder, slurm.folder + "/logs"}) make_private_folder(f);
  const std::string list = slurm.folder + "/work.json", text = to_text(work);
  if (std::filesystem::exists(list) && read_text_file(list, k_largest_file) != text)
    throw Error(slurm.folder, msg("holds other work"),
                msg("name another folder by --work, or remove it"));
  write_text_file(list, text);
  Made out;
  Parts there = read_parts(work, part_files(folder));
  leave_out_changed(work, there);
  out.found = work.sessions.size() - there.missing().size();
  Growing growing(folder);
  const std::size_t rows_before = growing.rows();
  bool stopped = false;
  std::vector<Message> remarks(there.remarks.begin(), there.remarks.end());
  for (int attempt = 1; attempt <= slurm.attempts && !there.missing().empty() && !stopped;
       ++attempt) {
    const auto missing = there.missing();
    if (attempt > 1)
      remarks.push_back(
          msg("{} sessions are made again: their task died, or its part is damaged (attempt {})",
              missing.size(), attempt));
    const std::string job = submit(slurm, work, missing, attempt);
    const std::size_t before = out.found > rows_before ? out.found - rows_before : 0;
    out.workers =
        std::max(out.workers, wait_for(job, slurm, run, growing, before, work.sessions.size()));
    stopped = run.stop && run.stop();
    there = read_parts(work, part_files(folder));
    for (const Message& r : there.remarks)
      if (std::find(remarks.begin(), remarks.end(), r) == remarks.end()) remarks.push_back(r);
  }
  out.missing = there.missing();
  out.remarks = remarks;
  for (auto& line : there.lines) out.lines.push_back(line ? std::move(*line) : std::string());
  for (const auto& s : there.spent) out.spent += s;
  out.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

void slurm_task(const std::string& folder, int attempt, const std::string& sessions) {
  const auto number = [](const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? std::string() : std::string(text);
  };
  const std::string block = number("SLURM_ARRAY_TASK_ID"), restarts = number("SLURM_RESTART_COUNT");
  Work work =
      parse_work(read_text_file(folder + "/work.json", k_largest_file), folder + "/work.json");
  work.folder = sessions;
  const std::string file = blocks_file(folder, attempt);
  const json blocks =
      parse_json(read_text_file(file, k_largest_file), file, {1U << 30, 20'000'000, 8});
  const std::size_t mine =
      block.empty() || block.find_first_not_of("0123456789") != std::string::npos
          ? blocks.size()
          : std::stoul(block);
  if (mine >= blocks.size())
    throw Error("SLURM_ARRAY_TASK_ID", msg("'{}' is none of the blocks of {}", block, file),
                msg("let sbatch begin it, by `cavum verify-all --slurm`"));
  // one that was begun anew elsewhere writes a file of its own: the first may live on
  const std::string stem = fmt::format("{}/parts/{}-{}", folder, attempt, block);
  std::vector<std::string> earlier;
  for (const auto& p : part_files(folder + "/parts"))
    if (p.starts_with(stem + "-")) earlier.push_back(p);
  Parts there = read_parts(work, earlier);
  leave_out_changed(work, there);
  PartWriter part(fmt::format("{}-{}.part", stem, restarts.empty() ? "0" : restarts), id_of(work));
  std::vector<std::size_t> left;
  for (const auto& i : blocks[mine]) {
    const auto index = i.get<std::size_t>();
    if (index >= work.sessions.size())
      throw Error(file, msg("names a session that the list does not have"),
                  msg("make the work anew"));
    if (!there.lines[index]) left.push_back(index);
  }
  make_lines(work, left, part);
}

}  // namespace cavum::pool
