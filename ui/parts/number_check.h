// What an option with a number takes, said in words when it is not.
#pragma once

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

namespace cavum::ui {

/// A number in low..high. CLI::Range lets NaN through.
[[nodiscard]] inline CLI::Validator between(double low, double high) {
  const auto plain = [](double v) {
    std::ostringstream text;
    text << v;
    return text.str();
  };
  const std::string range = fmt::format("{} to {}", plain(low), plain(high));
  return CLI::Validator(
      [low, high, range](const std::string& text) {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && value >= low && value <= high ? std::string{}
                                                                                       : fmt::format("'{}' is no number from {}", text, range);
      },
      range);
}

}  // namespace cavum::ui
