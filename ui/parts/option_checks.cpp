#include "ui/parts/option_checks.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>

#include "ui/language/say.h"

namespace cavum::ui {

CLI::Validator between(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& text) {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && value >= low && value <= high
                   ? std::string{}
                   : tr("'{}' is no number from {} to {}", as_is(text), as_number(low),
                        as_number(high));
      },
      tr("{} to {}", as_number(low), as_number(high)));
}

CLI::Validator seed_check() {
  return {[](std::string& text) -> std::string {
            std::uint64_t seed = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
            return error == std::errc() && end == text.data() + text.size()
                       ? ""
                       : tr("'{}' is no whole number from 0 to 18446744073709551615", as_is(text));
          },
          "", "seed"};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::Validator(
      [words](const std::string& text) {
        return std::find(words.begin(), words.end(), text) != words.end()
                   ? std::string{}
                   : tr("'{}' is not one of {}", as_is(text), list_of(words));
      },
      fmt::format("{{{}}}", fmt::join(words, ",")));
}

CLI::Validator existing_file() {
  return CLI::Validator(
      [](const std::string& path) {
        std::error_code none;
        return std::filesystem::exists(path, none) && !std::filesystem::is_directory(path, none)
                   ? std::string{}
                   : tr("there is no file '{}'", as_is(path));
      },
      tr("FILE"));
}

CLI::Validator existing_folder() {
  return CLI::Validator(
      [](const std::string& path) {
        std::error_code none;
        return std::filesystem::is_directory(path, none)
                   ? std::string{}
                   : tr("there is no folder '{}'", as_is(path));
      },
      tr("FOLDER"));
}

}  // namespace cavum::ui
