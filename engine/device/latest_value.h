// Hands the latest value from one thread to another: neither ever waits, a value is never torn, and
// what was overtaken is forgotten. Three places go round between the one who writes and the one who
// reads.
#pragma once

#include <array>
#include <atomic>

namespace cavum {

template <class T>
class LatestValue {
 public:
  /// Writing thread only.
  void put(const T& value) noexcept {
    places_[back_].value = value;
    back_ = between_.exchange(back_ | k_new, std::memory_order_acq_rel) & k_place;
  }
  /// The last value put, or T{} before the first; `is_new` when nobody has taken it yet. Reading
  /// thread only.
  [[nodiscard]] const T& take(bool& is_new) noexcept {
    is_new = (between_.load(std::memory_order_relaxed) & k_new) != 0;
    if (is_new) front_ = between_.exchange(front_, std::memory_order_acq_rel) & k_place;
    return places_[front_].value;
  }
  [[nodiscard]] const T& take() noexcept {
    bool is_new = false;
    return take(is_new);
  }

 private:
  static constexpr unsigned k_place = 3, k_new = 4;
  struct alignas(64) Place {
    T value{};
  };
  std::array<Place, 3> places_;
  unsigned back_ = 0, front_ = 1;  // of the writer, of the reader
  std::atomic<unsigned> between_{2};
};

}  // namespace cavum
