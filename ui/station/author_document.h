// A scenario's text while its author works on it: changes, undo and redo, and saving, which never overwrites what somebody else wrote meanwhile.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/file/edit_text.h"

namespace cavum::station {

class AuthorDocument {
 public:
  /// Throws Error when the file cannot be read.
  explicit AuthorDocument(const std::string& path);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  /// Another number after each change of the text.
  [[nodiscard]] std::uint64_t version() const noexcept { return version_; }
  /// Something is not in the file yet.
  [[nodiscard]] bool unsaved() const noexcept { return text_ != on_disk_; }

  /// Makes a change of the text as it is. What follows under the same name, until `rest`, is undone together with it: a pull of the mouse.
  void make(const scenarios::TextChange& change, const std::string& name);
  void rest() { pulled_.clear(); }
  /// False when there is nothing to take back, or to make again.
  bool undo();
  bool redo();

  /// Writes the file as one step. Throws Error when the file is not as it was read or saved last, or cannot be written; nothing is lost then.
  void save();
  /// Takes the text of the file; what stood here can be had again by undo. Throws Error when it cannot be read.
  void read_again();
  /// Keeps what is unsaved beside the file, NAME.unsaved, and returns that name.
  [[nodiscard]] std::string keep_aside() const;

 private:
  void set(const std::string& text);

  std::string path_, text_, on_disk_;
  std::vector<std::string> before_, after_;  // texts to go back and forth to
  std::string pulled_;                       // name of the running change
  std::uint64_t version_ = 1;
};

}  // namespace cavum::station
