// Runs that know nothing of one another, on all cores. Each has its own seed and its own place for the result, so
// the figures do not depend on the number of threads or on their order.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace cavum {

/// Calls `run(i)` for i in [0, count), some at the same time; throws what the first failing one (by number) threw.
template <class Run>
void independent_runs(std::size_t count, const Run& run) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failed(count);
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) try {
        run(i);
      } catch (...) {
        failed[i] = std::current_exception();
      }
  };
  std::vector<std::thread> others;
  const std::size_t threads = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, std::max<std::size_t>(1, count));
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (auto& t : others) t.join();
  for (const auto& f : failed)
    if (f) std::rethrow_exception(f);
}

}  // namespace cavum
