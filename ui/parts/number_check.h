// What an option with a number takes, said in words when it is not.
#pragma once

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

namespace cavum {

/// A number in low..high. CLI::Range lets NaN through.
[[nodiscard]] inline CLI::Validator between(double low, double high) {
  const auto plain = [](double v) {
    std::ostringstream text;
    text << v;
    return text.str();
  };
  const std::string range = plain(low) + " to " + plain(high);
  return CLI::Validator(
      [low, high, range](const std::string& text) {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && value >= low && value <= high ? std::string{} : "'" + text + "' is no number from " + range;
      },
      range);
}

}  // namespace cavum
