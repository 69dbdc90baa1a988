// What a console says and does when an exam's recording cannot be written: the exam goes on in
// memory, and at its end it is written again when there is room, or saved to another place that
// somebody names.
#pragma once

#include <functional>
#include <string>

#include "engine/base/message.h"
#include "scenarios/exam/exam.h"

namespace cavum::ui {

/// Tells on standard error, once each: that the disk refuses, that recording goes on elsewhere,
/// that all is on disk again.
class RecordingWatch {
 public:
  explicit RecordingWatch(std::string path) : path_(std::move(path)) {}
  /// Before the first look: it is recorded at `path`, which is not where it was to be when that
  /// disk was full already.
  void begun(const std::string& path);
  /// `problem` is empty while all is well; `path` is where it is recorded now.
  void look(const Message& problem, const std::string& path);

 private:
  std::string path_;
  bool told_ = false;
};

/// Calls `write` until it throws no DatabaseError. In between: first the second place, if there is
/// one; then standard input is asked, where an empty line tries again and a name is a new place; at
/// its end the folder for temporary files, as the last. Throws Error when even that is full.
void write_somewhere(scenarios::Exam& exam, const std::string& second_path,
                     const std::function<void()>& write);

}  // namespace cavum::ui
