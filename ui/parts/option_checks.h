// What an option takes, said in the reader's language when it is something else. CLI11's own checks
// say it in English, and let NaN through. And the types of CLI11 by name, for headers: it takes
// seconds to compile.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class ParseError;
class Validator;
}  // namespace CLI

namespace cavum::ui {

/// A number in low..high.
[[nodiscard]] CLI::Validator between(double low, double high);
/// What --seed takes: a whole number that 64 bits hold.
[[nodiscard]] CLI::Validator seed_check();
[[nodiscard]] CLI::Validator one_of(const std::vector<std::string>& words);
[[nodiscard]] CLI::Validator existing_file();
[[nodiscard]] CLI::Validator existing_folder();

}  // namespace cavum::ui
