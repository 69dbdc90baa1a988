// A vector whose copies keep its spare capacity: state that was given room once can be copied and
// goes on without allocating.
#pragma once

#include <vector>

namespace cavum {

template <class T>
class ReservedVector : public std::vector<T> {
 public:
  ReservedVector() = default;
  ReservedVector(const ReservedVector& other) : std::vector<T>() { *this = other; }
  ReservedVector(ReservedVector&&) noexcept = default;
  ReservedVector& operator=(const ReservedVector& other) {
    if (this != &other) {
      this->clear();
      this->reserve(other.capacity());
      this->insert(this->end(), other.begin(), other.end());
    }
    return *this;
  }
  ReservedVector& operator=(ReservedVector&&) noexcept = default;
  ~ReservedVector() = default;
};

}  // namespace cavum
