// By whom a verb's sessions are simulated and marked: threads here, or a Slurm cluster; and what is
// said of it meanwhile.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "grading/pool/makers.h"
#include "ui/parts/option_checks.h"

namespace cavum::ui {

struct PoolOptions {
  int threads = 0;
  bool slurm = false;
  std::size_t a_task = 100;
  std::string work, sbatch;
};
void add_pool_options(CLI::App& verb, PoolOptions& options);
/// Makes the lines as the options say, shows progress and an estimate of the end on standard error,
/// and ends in order when it is interrupted: then it throws Error. Lines that could not be made are
/// named on standard error.
[[nodiscard]] pool::Made make_lines(const pool::Work& work, const PoolOptions& options);
/// "123 of 1000, 41 a minute, until about 14:05"; on a terminal in place, else a line each minute.
[[nodiscard]] std::function<void(std::size_t, std::size_t)> shown_progress();

}  // namespace cavum::ui
