// One hash over plain state. A struct names its members once, by CAVUM_STATE(Type, members...); a
// member that is left out there does not compile. What is no state, for it can be found again, is
// kept in a struct of its own, which says so by CAVUM_NO_STATE(Type).
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "engine/base/hash.h"
#include "engine/base/pose.h"
#include "engine/base/vec.h"

#define CAVUM_STATE(TYPE, ...)                                 \
  template <class Visit>                                       \
  void each_member(Visit& visit, const TYPE& state) noexcept { \
    const auto& [__VA_ARGS__] = state;                         \
    visit(__VA_ARGS__);                                        \
  }
#define CAVUM_NO_STATE(TYPE) \
  template <class Visit>     \
  void each_member(Visit&, const TYPE&) noexcept {}

namespace cavum {

CAVUM_STATE(Vec3, x, y, z)
CAVUM_STATE(Mat3, row_x, row_y, row_z)

/// XXH3 over the bits of numbers, in the order in which they come; not for evidence.
class StateHash {
 public:
  explicit StateHash(std::uint64_t seed) noexcept : hash_(seed) {}
  template <class... Parts>
  void operator()(const Parts&... parts) noexcept {
    (take(parts), ...);
  }
  [[nodiscard]] std::uint64_t value() noexcept {
    hash_ = fast_hash(words_.data(), count_ * sizeof words_[0], hash_);
    count_ = 0;
    return hash_;
  }

 private:
  template <class Part>
  void take(const Part& part) noexcept {
    if constexpr (std::is_arithmetic_v<Part> || std::is_enum_v<Part>) {
      static_assert(sizeof part <= sizeof words_[0]);
      if (count_ == words_.size()) (void)value();
      words_[count_] = 0;
      std::memcpy(&words_[count_++], &part, sizeof part);
    } else {
      each_member(*this, part);
    }
  }
  template <class T, std::size_t n>
  void take(const std::array<T, n>& list) noexcept {
    for (const T& one : list) take(one);
  }

  std::uint64_t hash_;
  std::size_t count_ = 0;
  std::array<std::uint64_t, 256> words_;
};

}  // namespace cavum
