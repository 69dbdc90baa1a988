// Runs that know nothing of one another, on several threads. Each has its own seed and its own
// place for the result, so the figures do not depend on the number of threads or on their order.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace cavum {

/// Calls `run(i)` for i in [0, count), on `threads` threads (0: one for each core), and returns
/// when all have ended. After a failure no further one begins; throws what the first failing one
/// (by number) threw.
template <class Run>
void independent_runs(std::size_t count, const Run& run, std::size_t threads = 0) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failed(count);
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) try {
        run(i);
      } catch (...) {
        failed[i] = std::current_exception();
        next = count;
      }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t t = std::min<std::size_t>(
             threads > 0 ? threads : std::thread::hardware_concurrency(), count);
         t > 1; --t)
      others.emplace_back(work);
    work();
  }
  for (const auto& f : failed)
    if (f) std::rethrow_exception(f);
}

}  // namespace cavum
