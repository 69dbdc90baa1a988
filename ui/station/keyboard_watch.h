// Which keyboards the computer has, as Linux lists its input devices; so that one that is plugged
// in during an exam is seen.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace cavum::station {

/// Those of a text as in /proc/bus/input/devices: "NAME at PLACE" of each device with the keys of a
/// keyboard. Buttons of the case, remote controls and the like, which have no letters, are none.
[[nodiscard]] std::set<std::string> keyboards_in(const std::string& devices);

class KeyboardWatch {
 public:
  explicit KeyboardWatch(std::string path = "/proc/bus/input/devices");
  /// Keyboards that were not there at the last look (the first one counts as before). Nothing where
  /// the system tells nothing.
  [[nodiscard]] std::vector<std::string> added();

 private:
  [[nodiscard]] std::set<std::string> now() const;
  std::string path_;
  std::set<std::string> known_;
};

}  // namespace cavum::station
