// A large value that copies share until one of them changes it.
#pragma once

#include <memory>
#include <utility>

namespace cavum {

/// Copying costs a pointer. `change` makes a copy of its own first, where others share it. One copy
/// is not for several threads.
template <class T>
class Shared {
 public:
  Shared() : value_(std::make_shared<T>()) {}
  Shared(T value)
      : value_(std::make_shared<T>(std::move(value))) {
  }  // NOLINT(google-explicit-constructor): it stands for its value
  [[nodiscard]] const T& operator*() const { return *value_; }
  [[nodiscard]] const T* operator->() const { return value_.get(); }
  [[nodiscard]] T& change() {
    if (value_.use_count() > 1) value_ = std::make_shared<T>(*value_);
    return *value_;
  }
  friend bool operator==(const Shared& a, const Shared& b) { return *a == *b; }

 private:
  std::shared_ptr<T> value_;
};

}  // namespace cavum
