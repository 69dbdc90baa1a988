// Lines that were made, kept in part files by whoever made them: one row a line, sealed for its
// work and its place, so that what is damaged, cut off or of other work is known and made again,
// and what is there is not. The order of the rows and of the files says nothing.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "grading/pool/work.h"

namespace cavum::pool {

/// What making a line took. No part of the line.
struct Spent {
  double wall_s = 0, core_s = 0;
  Spent& operator+=(const Spent& more) noexcept {
    wall_s += more.wall_s, core_s += more.core_s;
    return *this;
  }
};

class PartWriter {
 public:
  /// Adds to the file when it is there. Throws Error when it cannot be written.
  PartWriter(const std::string& path, std::string work_id);
  void add(std::size_t index, const std::string& line, const Spent& spent);

 private:
  std::string path_, work_id_;
  std::ofstream out_;
};

struct Parts {
  std::vector<std::optional<std::string>> lines;  ///< by index; none: missing
  std::vector<Spent> spent;                       ///< by index
  std::vector<Message> remarks;  ///< files that are damaged or of other work, each once
  [[nodiscard]] std::vector<std::size_t> missing() const;
};
/// Reads part files. Throws Error when one cannot be read, or when two hold different lines of one
/// session: then two machines do not compute the same, and neither is believed.
[[nodiscard]] Parts read_parts(const Work& work, const std::vector<std::string>& files);
/// The part files in a folder, sorted; none when it is not there.
[[nodiscard]] std::vector<std::string> part_files(const std::string& folder);
/// Leaves out lines of sessions that are other bytes by now; the line of one that could not be read
/// stays while it cannot be.
void leave_out_changed(const Work& work, Parts& parts);

}  // namespace cavum::pool
