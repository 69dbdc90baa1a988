// A queue between two threads, one that puts in and one that takes out, without locks or
// allocation: how the servo hands its ticks to whoever writes them down.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

namespace cavum {

template <class T>
class SpscRing {
 public:
  /// Room for at least `capacity` items, allocated here and never again.
  explicit SpscRing(std::size_t capacity)
      : items_(std::bit_ceil(capacity)), mask_(items_.size() - 1) {}

  /// Items that certainly fit now. Producer only.
  [[nodiscard]] std::size_t room() const noexcept {
    return items_.size() -
           (put_.load(std::memory_order_relaxed) - taken_.load(std::memory_order_acquire));
  }
  /// All of `items` or, without room for them, none (false). Producer only.
  bool push(std::span<const T> items) noexcept {
    if (items.size() > room()) return false;
    const std::size_t at = put_.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < items.size(); ++i) items_[(at + i) & mask_] = items[i];
    put_.store(at + items.size(), std::memory_order_release);
    return true;
  }
  bool push(const T& item) noexcept { return push(std::span<const T>(&item, 1)); }

  /// Items that can be taken now. Consumer only.
  [[nodiscard]] std::size_t ready() const noexcept {
    return put_.load(std::memory_order_acquire) - taken_.load(std::memory_order_relaxed);
  }
  /// Fills `items`, oldest first, or takes nothing when there are fewer (false). Consumer only.
  bool pop(std::span<T> items) noexcept {
    if (items.size() > ready()) return false;
    const std::size_t at = taken_.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < items.size(); ++i) items[i] = items_[(at + i) & mask_];
    taken_.store(at + items.size(), std::memory_order_release);
    return true;
  }
  bool pop(T& item) noexcept { return pop(std::span<T>(&item, 1)); }

  [[nodiscard]] std::size_t capacity() const noexcept { return items_.size(); }

 private:
  std::vector<T> items_;
  std::size_t mask_;
  alignas(64) std::atomic<std::size_t> put_{0};
  alignas(64) std::atomic<std::size_t> taken_{0};
};

}  // namespace cavum
