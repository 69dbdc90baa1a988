// A scenario's text and its tooth's landmarks while their author works on them: changes, undo and
// redo, and saving, which never overwrites what somebody else wrote meanwhile, nor a tooth that
// ships.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/hash.h"
#include "engine/tooth/tooth.h"
#include "scenarios/file/edit_text.h"

namespace cavum::station {

class AuthorDocument {
 public:
  /// Throws Error when the scenario's file cannot be read. A tooth that cannot be read is none: its
  /// landmarks are nobody's.
  explicit AuthorDocument(const std::string& path);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const std::string& text() const noexcept { return now_.text; }
  /// The landmarks that a person put, as the tooth is to have them.
  [[nodiscard]] const std::vector<NamedPoint>& landmarks() const noexcept { return now_.landmarks; }
  /// Another number after each change of either.
  [[nodiscard]] std::uint64_t version() const noexcept { return version_; }
  /// Another number after each reading of the files.
  [[nodiscard]] std::uint64_t reading() const noexcept { return reading_; }
  /// Something is not in the files yet.
  [[nodiscard]] bool unsaved() const noexcept { return now_ != on_disk_; }

  /// Makes a change of the text as it is. What follows under the same name, until `rest`, is undone
  /// together with it: a pull of the mouse.
  void make(const scenarios::TextChange& change, const std::string& name);
  /// The same for the landmarks. Throws Error when the tooth could not be read.
  void put(const std::vector<NamedPoint>& landmarks, const std::string& name);
  void rest() { pulled_.clear(); }
  /// False when there is nothing to take back, or to make again.
  bool undo();
  bool redo();

  /// Where the landmarks were changed and the tooth's own file must stay as it is, a name for a new
  /// one beside the scenario: that file ships, or does not lie beside the scenario. Throws Error
  /// when the tooth cannot be read.
  [[nodiscard]] std::optional<std::string> new_tooth_name() const;
  /// Writes the scenario as one step, and before it, where its landmarks differ, the tooth: anew
  /// beside the scenario, what stood there kept as NAME.before; or under `tooth_name`, a name
  /// without folders, which the text then bears. Throws Error when a file is not as it was read or
  /// saved last, there is one of that name already, or it cannot be written; nothing is lost then.
  void save(const std::string& tooth_name = "");
  /// Takes what the files hold; what stood here can be had again by undo. Throws Error when the
  /// scenario cannot be read.
  void read_again();
  /// Keeps what is unsaved beside the file, NAME.unsaved and, where landmarks differ,
  /// NAME.unsaved.cvt. Returns their names.
  [[nodiscard]] std::vector<std::string> keep_aside() const;

 private:
  struct Draft {
    std::string text;
    std::vector<NamedPoint> landmarks;
    friend bool operator==(const Draft&, const Draft&) = default;
  };
  struct ToothFile {
    std::string path;
    Sha256 sum{};
    Tooth tooth;
  };
  void set(const Draft& draft);
  void change_to(const Draft& draft, const std::string& name);
  void read_landmarks();
  [[nodiscard]] ToothFile tooth_of(const std::string& text) const;
  /// The text's tooth where its file has other landmarks.
  [[nodiscard]] std::optional<ToothFile> tooth_to_write() const;
  [[nodiscard]] bool may_be_overwritten(const ToothFile& file) const;

  std::string path_;
  Draft now_, on_disk_;
  std::vector<Draft> before_, after_;  // to go back and forth to
  std::string pulled_;                 // name of the running change
  std::string tooth_path_;             // of the tooth that was read or saved last; empty: none
  Sha256 tooth_sum_{};                 // of its bytes
  std::vector<std::string> kept_;      // teeth of which the first state is kept
  std::uint64_t version_ = 1, reading_ = 1;
};

}  // namespace cavum::station
