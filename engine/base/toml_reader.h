// Strict reading of our TOML files: every value is asked for by name, with its range; what nobody
// asked for is an error. Errors carry file:line:column.
#pragma once

#include <toml++/toml.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/error.h"

namespace cavum {

/// Parses a whole document. Throws Error(`where:line:column`, ...) on a syntax error, and when it
/// is beyond a limit of toml_limits.h.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::string& where);

/// One table of a document. Call `finish` when all known keys were asked for.
class TomlReader {
 public:
  TomlReader(const toml::table& table, std::string where)
      : table_(table), where_(std::move(where)) {}

  /// A number in [low, high]; integers are accepted. Throws Error when missing, not a number, or
  /// out of range.
  [[nodiscard]] double number(std::string_view key, double low, double high);
  [[nodiscard]] double number_or(std::string_view key, double low, double high, double otherwise);
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] std::string text_or(std::string_view key, const std::string& otherwise);
  [[nodiscard]] bool truth_or(std::string_view key, bool otherwise);
  /// A table, or nullptr when absent.
  [[nodiscard]] const toml::table* table(std::string_view key);
  /// An array, or nullptr when absent.
  [[nodiscard]] const toml::array* array(std::string_view key);
  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  /// Throws Error naming the first key that was never asked for.
  void finish() const;
  [[noreturn]] void fail(std::string_view key, const Message& what, const Message& todo) const;
  [[noreturn]] void fail(ErrorCode code, std::string_view key, const Message& what,
                         const Message& todo) const;
  [[nodiscard]] const std::string& where() const noexcept { return where_; }

 private:
  [[nodiscard]] const toml::node* find(std::string_view key);

  const toml::table& table_;
  std::string where_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace cavum
