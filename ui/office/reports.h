// Reports of filed exams, for whoever decides: the tooth in three dimensions and its replay. One is
// made at a time, for that takes seconds and the memory of a tooth; the last ones are kept.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <mutex>
#include <string>

#include "ui/office/desk.h"
#include "ui/office/http_server.h"

namespace cavum::office {

class Reports {
 public:
  /// The report (HTML) of the recording at a path. Throws Error.
  using Make = std::function<std::string(const std::string& recording)>;
  explicit Reports(Make make) : make_(std::move(make)) {}
  /// As a page of no site: its script runs, by its hash, and reaches nothing of the office. Throws
  /// Error where it cannot be made, or too many wait.
  [[nodiscard]] Reply of(const Recording& recording);

 private:
  struct Kept {
    std::string path;
    std::size_t entries = 0;
    std::string html;
  };
  Make make_;
  std::atomic<int> waiting_ = 0;
  std::mutex lock_;
  std::deque<Kept> kept_;  // the oldest first
};

}  // namespace cavum::office
