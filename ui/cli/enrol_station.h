// A station asks to be enrolled by the school, with a one-time code or in place of its old key:
// `cavum station --enrol | --replace-key`.
#pragma once

#include <string>
#include <vector>

namespace cavum::ui {

struct EnrolOptions {
  std::string code;  ///< that the school gave
  bool replace_key =
      false;  ///< instead of a code: make a new key, and let the old one speak for it
  std::vector<std::string> styluses;
  std::string out;  ///< request to write
};
/// Writes the request and remembers the key as the one that this station has to keep. Throws Error.
void enrol_station(const EnrolOptions& options);

}  // namespace cavum::ui
