// What --seed takes: a whole number that 64 bits hold, said in words when it is not.
#pragma once

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <string>

namespace cavum::ui {

[[nodiscard]] inline CLI::Validator seed_check() {
  return {[](std::string& text) -> std::string {
            std::uint64_t seed = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
            return error == std::errc() && end == text.data() + text.size()
                       ? ""
                       : fmt::format("'{}' is no whole number from 0 to 18446744073709551615", text);
          },
          "", "seed"};
}

}  // namespace cavum::ui
