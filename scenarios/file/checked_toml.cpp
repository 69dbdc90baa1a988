#include "scenarios/file/checked_toml.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

Message kind_of(const toml::node& node) {
  if (node.is_string()) return msg("a text");
  if (node.is_number()) return msg("a number");
  if (node.is_boolean()) return msg("true or false");
  if (node.is_array()) return msg("a list");
  if (node.is_table()) return msg("a table");
  return msg("a date or time");
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

Message suggestion(const std::string& wrong, const std::vector<std::string>& words) {
  std::size_t best = 3;
  const std::string* closest = nullptr;
  for (const auto& w : words) {
    const auto d = edit_distance(wrong, w);
    if (d < best && d < w.size()) {
      best = d;
      closest = &w;
    }
  }
  if (closest != nullptr) return msg("did you mean '{}'?", *closest);
  return msg("use one of {}", list_of(words));
}

void ProblemList::add(const toml::source_region& at, const Message& what, const Message& what_to_do,
                      Mistake mistake) {
  add(Place{static_cast<int>(at.begin.line), static_cast<int>(at.begin.column)}, what, what_to_do,
      mistake);
}

void ProblemList::add(Place at, const Message& what, const Message& what_to_do, Mistake mistake) {
  problems_.push_back({{path_, at.line, at.column}, what, what_to_do, false, mistake});
}

std::vector<Problem> ProblemList::take() {
  std::stable_sort(problems_.begin(), problems_.end(), [](const Problem& a, const Problem& b) {
    return a.where.line != b.where.line ? a.where.line < b.where.line
                                        : a.where.column < b.where.column;
  });
  return std::move(problems_);
}

toml::source_region CheckedTable::where(std::string_view key) const {
  if (const auto* node = table_.get(key); node != nullptr && node->source().begin.line > 0)
    return node->source();
  return table_.source();
}

void CheckedTable::problem_in(std::string_view key, std::size_t item, const Message& what,
                              const Message& what_to_do, Mistake mistake) {
  const auto* array = table_[key].as_array();
  const bool known =
      array != nullptr && item < array->size() && (*array)[item].source().begin.line > 0;
  problems_.add(known ? (*array)[item].source() : where(key), what, what_to_do, mistake);
}

void CheckedTable::note(std::map<std::string, Place>& places, std::string_view key,
                        const std::string& name) const {
  const auto* node = table_.get(key);
  if (node == nullptr) return;
  const auto place = [](const toml::node& n) {
    return Place{static_cast<int>(n.source().begin.line),
                 static_cast<int>(n.source().begin.column)};
  };
  places[name] = place(*node);
  if (const auto* array = node->as_array())
    for (std::size_t i = 0; i < array->size(); ++i)
      places[fmt::format("{}/{}", name, i)] = place((*array)[i]);
}

const toml::node* CheckedTable::ask(std::string_view key, bool required) {
  asked_.emplace_back(key);
  const auto* node = table_.get(key);
  if (node == nullptr && required)
    problems_.add(table_.source(), msg("{} has no '{}'", name_, key), msg("add it"),
                  Mistake::missing);
  return node;
}

double CheckedTable::number(std::string_view key, double low, double high, double fallback,
                            bool required) {
  const auto* node = ask(key, required);
  if (node == nullptr) return fallback;
  if (!node->is_number()) {
    problem(key, msg("'{}' is {}", key, kind_of(*node)), msg("write a number"),
            Mistake::wrong_type);
    return fallback;
  }
  const double v = node->value<double>().value_or(fallback);
  if (!(v >= low && v <= high)) {
    problem(key, msg("'{}' is {}", key, as_number(v)),
            msg("use {} to {}", as_number(low), as_number(high)), Mistake::out_of_range);
    return fallback;
  }
  return v;
}

int CheckedTable::whole(std::string_view key, int low, int high, int fallback, bool required) {
  const double v = number(key, low, high, fallback, required);
  if (v == std::floor(v)) return static_cast<int>(v);
  problem(key, msg("'{}' is {}", key, as_number(v)), msg("write a whole number"),
          Mistake::wrong_type);
  return fallback;
}

std::string CheckedTable::text(std::string_view key, const std::string& fallback, bool required) {
  const auto* node = ask(key, required);
  if (node == nullptr) return fallback;
  if (!node->is_string()) {
    problem(key, msg("'{}' is {}", key, kind_of(*node)), msg("write a text in quotes"),
            Mistake::wrong_type);
    return fallback;
  }
  std::string s = node->value<std::string>().value_or(fallback);
  constexpr std::size_t k_longest_title = 300,
                        k_longest_text = 20'000;  // a page is laid out with each of them
  if (const std::size_t most = key == "title" || key == "name" ? k_longest_title : k_longest_text;
      s.size() > most)
    problem(key, msg("'{}' has {} bytes, the limit is {}", key, s.size(), most), msg("shorten it"),
            Mistake::too_large);
  if (s.find('\0') != std::string::npos)
    problem(key, msg("'{}' holds a zero byte", key), msg("leave it out"), Mistake::wrong_type);
  if (required && s.find_first_not_of(" \t\n") == std::string::npos)
    problem(key, msg("'{}' is empty", key), msg("write a text"), Mistake::missing);
  return s;
}

bool CheckedTable::truth(std::string_view key, bool fallback) {
  const auto* node = ask(key, false);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) {
    problem(key, msg("'{}' is {}", key, kind_of(*node)), msg("write true or false"),
            Mistake::wrong_type);
    return fallback;
  }
  return node->value<bool>().value_or(fallback);
}

std::size_t CheckedTable::word(std::string_view key, const std::vector<std::string>& words,
                               std::size_t fallback, bool required) {
  const auto* node = ask(key, false);
  if (node == nullptr) {
    if (required)
      problems_.add(table_.source(), msg("{} has no '{}'", name_, key), suggestion("", words),
                    Mistake::missing);
    return required ? k_wrong : fallback;
  }
  if (!node->is_string()) {
    problem(key, msg("'{}' is {}", key, kind_of(*node)), suggestion("", words),
            Mistake::wrong_type);
    return k_wrong;
  }
  const std::string s = node->value<std::string>().value_or("");
  for (std::size_t i = 0; i < words.size(); ++i)
    if (s == words[i]) return i;
  problem(key, msg("'{}' is \"{}\"", key, s), suggestion(s, words), Mistake::unknown_name);
  return k_wrong;
}

bool CheckedTable::too_many(std::string_view key, std::size_t count, std::size_t most) {
  if (count <= most) return false;
  problem(key, msg("'{}' has {} items", key, count), msg("list at most {}", most),
          Mistake::too_large);
  return true;
}

std::vector<std::string> CheckedTable::texts(std::string_view key, bool required) {
  const auto* node = ask(key, required);
  std::vector<std::string> list;
  if (node == nullptr) return list;
  const auto* array = node->as_array();
  if (array == nullptr) {
    problem(key, msg("'{}' is {}", key, kind_of(*node)),
            msg("write a list of texts, [\"a\", \"b\"]"), Mistake::wrong_type);
    return list;
  }
  if (too_many(key, array->size(), k_max_items)) return list;
  for (const auto& item : *array) {
    if (item.is_string())
      list.push_back(item.value<std::string>().value_or(""));
    else
      problems_.add(item.source(), msg("'{}' holds {}", key, kind_of(item)),
                    msg("write a text in quotes"), Mistake::wrong_type);
  }
  if (required && array->empty())
    problem(key, msg("'{}' is empty", key), msg("list at least one"), Mistake::missing);
  return list;
}

std::vector<double> CheckedTable::numbers(std::string_view key, double low, double high) {
  const auto* node = ask(key, false);
  std::vector<double> list;
  if (node == nullptr) return list;
  const auto* array = node->as_array();
  if (array == nullptr) {
    problem(key, msg("'{}' is {}", key, kind_of(*node)), msg("write a list of numbers, [0.2, 0.5]"),
            Mistake::wrong_type);
    return list;
  }
  if (too_many(key, array->size(), k_max_items)) return list;
  for (const auto& item : *array) {
    const auto value = item.is_number() ? item.value<double>() : std::nullopt;
    if (!value) {
      problems_.add(item.source(), msg("'{}' holds {}", key, kind_of(item)), msg("write a number"),
                    Mistake::wrong_type);
      return {};
    }
    if (!(*value >= low && *value <= high)) {
      problems_.add(item.source(), msg("'{}' holds {}", key, as_number(*value)),
                    msg("write numbers from {} to {}", as_number(low), as_number(high)),
                    Mistake::out_of_range);
      return {};
    }
    list.push_back(*value);
  }
  return list;
}

namespace {

bool read_vector(const toml::node& node, std::size_t count, Vec3& out) {
  const auto* array = node.as_array();
  if (array == nullptr || array->size() != count) return false;
  double v[3] = {};
  for (std::size_t i = 0; i < count; ++i) {
    if (!(*array)[i].is_number()) return false;
    v[i] = (*array)[i].value<double>().value_or(0.0);
    if (!(std::fabs(v[i]) <= 1000.0)) return false;
  }
  out = {v[0], v[1], v[2]};
  return true;
}

}  // namespace

Vec3 CheckedTable::vector(std::string_view key, std::size_t count, Vec3 fallback, bool required) {
  const auto* node = ask(key, required);
  if (node == nullptr) return fallback;
  Vec3 v = fallback;
  if (!read_vector(*node, count, v))
    problem(key, msg("'{}' is not a list of {} numbers within 1000 mm", key, count),
            count == 2 ? msg("write [x, y]") : msg("write [x, y, z]"), Mistake::wrong_type);
  return v;
}

std::vector<Vec3> CheckedTable::points(std::string_view key, std::size_t at_least, bool required) {
  const auto* node = ask(key, required);
  std::vector<Vec3> list;
  if (node == nullptr) return list;
  const auto* array = node->as_array();
  if (array == nullptr || array->size() < at_least) {
    problem(key, msg("'{}' needs at least {} points", key, at_least),
            msg("write [[x, y], [x, y], ...]"), Mistake::missing);
    return list;
  }
  if (too_many(key, array->size(), k_max_points)) return list;
  for (const auto& item : *array) {
    Vec3 v;
    if (read_vector(item, 2, v))
      list.push_back(v);
    else
      problems_.add(item.source(), msg("a point of '{}' is not two numbers within 1000 mm", key),
                    msg("write [x, y]"), Mistake::wrong_type);
  }
  return list;
}

const toml::table* CheckedTable::table(std::string_view key, bool required) {
  const auto* node = ask(key, required);
  if (node == nullptr) return nullptr;
  if (node->as_table() == nullptr)
    problem(key, msg("'{}' is {}", key, kind_of(*node)), msg("write a table, [{}]", key),
            Mistake::wrong_type);
  return node->as_table();
}

std::vector<const toml::table*> CheckedTable::tables(std::string_view key, bool required) {
  const auto* node = ask(key, required);
  std::vector<const toml::table*> list;
  if (node == nullptr) return list;
  if (const auto* one = node->as_table()) return {one};
  const auto* array = node->as_array();
  if (array == nullptr) {
    problem(key, msg("'{}' is {}", key, kind_of(*node)), msg("write tables, [[{}]]", key),
            Mistake::wrong_type);
    return list;
  }
  if (too_many(key, array->size(), k_max_items)) return list;
  for (const auto& item : *array) {
    if (const auto* t = item.as_table())
      list.push_back(t);
    else
      problems_.add(item.source(), msg("'{}' holds {}", key, kind_of(item)),
                    msg("write tables, [[{}]]", key), Mistake::wrong_type);
  }
  if (required && list.empty())
    problem(key, msg("'{}' is empty", key), msg("add at least one"), Mistake::missing);
  return list;
}

void CheckedTable::finish() {
  for (auto&& [key, node] : table_) {
    const std::string name(key.str());
    if (std::find(asked_.begin(), asked_.end(), name) == asked_.end())
      problems_.add(key.source(), msg("{} has an unknown key '{}'", name_, name),
                    asked_.empty() ? msg("take it out") : suggestion(name, asked_),
                    Mistake::unknown_key);
  }
}

}  // namespace cavum::scenarios
