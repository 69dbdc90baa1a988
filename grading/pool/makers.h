// Who makes the lines of a work: threads of this process, tasks of a Slurm cluster, or shards that
// any CI runs. The lines are the same bytes.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "grading/pool/parts.h"
#include "grading/pool/work.h"

namespace cavum::pool {

struct Run {
  int threads = 0;  ///< 0: as many as there are cores
  std::string parts =
      {};  ///< folder for part files, from which a run that was broken off goes on; empty: none
  std::function<void(std::size_t done, std::size_t of)> told = {};  ///< after each line
  std::function<bool()> stop = {};  ///< asked between lines: true ends the run early
};

struct Made {
  std::vector<std::string> lines;    ///< in the order of the list; empty where none could be made
  std::vector<std::size_t> missing;  ///< those
  std::vector<Message> remarks;      ///< what was made again, and why
  std::size_t found = 0;             ///< lines that were there already
  Spent spent;                       ///< by those that are there, whoever made them
  double wall_s = 0;                 ///< of this run
  std::size_t workers = 0;           ///< at most at once
};

/// By whom: for callers that do not mind.
using Maker = std::function<Made(const Work&)>;

/// A line that could not be made for want of memory is tried again, three times in all.
[[nodiscard]] Made by_threads(const Work& work, const Run& run = {});
/// Every `of`-th line from `shard` on (1 to `of`), into one part file. Goes on where the file ends.
/// Returns how many were made.
std::size_t make_shard(const Work& work, std::size_t shard, std::size_t of, const std::string& part,
                       const Run& run = {});

/// The lines of `wanted`, one after the other, into a part.
void make_lines(const Work& work, std::span<const std::size_t> wanted, PartWriter& part);

struct Slurm {
  std::string folder;  ///< of the work: on a disk that all machines see under this name. Part files
                       ///< and logs stay in it
  std::string program;              ///< `cavum`, as the nodes find it
  std::size_t a_task = 100;         ///< sessions
  std::vector<std::string> sbatch;  ///< further options of sbatch: partition, account, time, memory
  int attempts = 3;                 ///< at a session whose task died or whose part is damaged
  double poll_s = 2.0;
};
/// Job arrays of sbatch; squeue is asked what became of them. Throws Error when Slurm is not
/// installed or refuses.
[[nodiscard]] Made by_slurm(const Work& work, const Run& run, const Slurm& slurm);
/// What a task of such an array does: the block that its number in the array (SLURM_ARRAY_TASK_ID)
/// names.
void slurm_task(const std::string& folder, int attempt, const std::string& sessions);

}  // namespace cavum::pool
