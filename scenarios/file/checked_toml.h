// TOML with all mistakes collected: each value is asked for with what it must be, a wrong one is
// noted with its place and a harmless default returned, and what was never asked for is an unknown
// key.
#pragma once

#include <toml++/toml.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/vec.h"
#include "engine/base/where.h"
#include "scenarios/file/parse.h"

namespace cavum::scenarios {

/// Items of one list, of texts or of tables: a tray, steps, criteria, bodies. Some are compared
/// with all others, and each body with each leaf.
inline constexpr std::size_t k_max_items = 100;
/// Points of all outlines.
inline constexpr std::size_t k_max_points = 100;
/// Burs of a tray: for each it is asked how much of the target it reaches, up to 0.15 s.
inline constexpr std::size_t k_max_tray = 16;

class ProblemList {
 public:
  explicit ProblemList(std::string path) : path_(std::move(path)) {}
  void add(const toml::source_region& at, const Message& what, const Message& what_to_do,
           Mistake mistake = Mistake::other);
  [[nodiscard]] std::size_t size() const noexcept { return problems_.size(); }
  void add(Place at, const Message& what, const Message& what_to_do,
           Mistake mistake = Mistake::other);
  /// Sorted by place.
  [[nodiscard]] std::vector<Problem> take();

 private:
  std::string path_;
  std::vector<Problem> problems_;
};

/// Reads one table. `name` is how messages call it ("[zones.leeway]").
class CheckedTable {
 public:
  CheckedTable(const toml::table& table, Where name, ProblemList& problems)
      : table_(table), name_(std::move(name)), problems_(problems) {}

  [[nodiscard]] bool has(std::string_view key) const { return table_.contains(key); }
  /// A number within [low, high]; `fallback` when absent (a problem if `required`) or wrong.
  double number(std::string_view key, double low, double high, double fallback,
                bool required = false);
  /// A whole number within [low, high].
  int whole(std::string_view key, int low, int high, int fallback, bool required = false);
  std::string text(std::string_view key, const std::string& fallback, bool required = false);
  bool truth(std::string_view key, bool fallback);
  static constexpr std::size_t k_wrong = static_cast<std::size_t>(-1);
  /// Index of one of `words`; `fallback` when absent, k_wrong (a problem) for any other word or
  /// when absent though `required`.
  std::size_t word(std::string_view key, const std::vector<std::string>& words,
                   std::size_t fallback, bool required = false);
  std::vector<std::string> texts(std::string_view key, bool required = false);
  /// A list of numbers within [low, high]; empty when absent or wrong.
  std::vector<double> numbers(std::string_view key, double low, double high);
  /// `count` numbers (2 or 3) as a vector.
  Vec3 vector(std::string_view key, std::size_t count, Vec3 fallback, bool required = false);
  std::vector<Vec3> points(std::string_view key, std::size_t at_least, bool required);
  /// The table under `key`; nullptr when absent (a problem if `required`).
  const toml::table* table(std::string_view key, bool required = false);
  /// Every table of the array under `key`; one table alone counts as an array of one.
  std::vector<const toml::table*> tables(std::string_view key, bool required = false);
  /// Place of a key's value, or of the table.
  [[nodiscard]] toml::source_region where(std::string_view key) const;
  void problem(std::string_view key, const Message& what, const Message& what_to_do,
               Mistake mistake = Mistake::other) {
    problems_.add(where(key), what, what_to_do, mistake);
  }
  /// The same for an item of the list under `key`.
  void problem_in(std::string_view key, std::size_t item, const Message& what,
                  const Message& what_to_do, Mistake mistake = Mistake::other);
  /// Notes where a key's value stands (and, under `name/0` and so on, its items), if it is written.
  void note(std::map<std::string, Place>& places, std::string_view key,
            const std::string& name) const;
  /// Reports keys that nobody asked for. Call last.
  void finish();

 private:
  const toml::node* ask(std::string_view key, bool required);
  /// Notes a list longer than `most`, whose items are then not looked at.
  bool too_many(std::string_view key, std::size_t count, std::size_t most);
  const toml::table& table_;
  Where name_;
  ProblemList& problems_;
  std::vector<std::string> asked_;
};

/// The word of `words` closest to `wrong`, as "did you mean 'x'?", or a list of all when none is
/// close.
[[nodiscard]] Message suggestion(const std::string& wrong, const std::vector<std::string>& words);

}  // namespace cavum::scenarios
