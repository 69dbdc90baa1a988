#include "engine/base/toml_reader.h"

#include <fmt/core.h>

#include <cmath>

#include "engine/base/text.h"
#include "engine/base/toml_limits.h"

namespace cavum {
namespace {

std::string place(const std::string& where, const toml::source_region& source) {
  return fmt::format("{}:{}:{}", where, source.begin.line, source.begin.column);
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& where) {
  if (const auto beyond = beyond_toml_limits(text)) throw Error(fmt::format("{}:{}:1", where, beyond->line), beyond->what, beyond->what_to_do);
  try {
    return toml::parse(text, where);
  } catch (const toml::parse_error& e) {
    throw Error(place(where, e.source()), std::string(e.description()), "correct the TOML at this place");
  }
}

const toml::node* TomlReader::find(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

void TomlReader::fail(std::string_view key, const std::string& what, const std::string& todo) const {
  const toml::node* node = table_.get(key);
  throw Error(place(where_, node != nullptr ? node->source() : table_.source()), fmt::format("'{}' {}", key, what), todo);
}

double TomlReader::number(std::string_view key, double low, double high) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "is missing", "add it");
  const auto value = node->value<double>();
  if (!value || !node->is_number()) fail(key, "is not a number", "write a number");
  if (!(*value >= low && *value <= high))
    fail(key, fmt::format("is {}, outside {} .. {}", plain_number(*value), plain_number(low), plain_number(high)), "choose a value in that range");
  return *value;
}

double TomlReader::number_or(std::string_view key, double low, double high, double otherwise) {
  return find(key) == nullptr ? otherwise : number(key, low, high);
}

std::string TomlReader::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "is missing", "add it");
  const auto value = node->value<std::string>();
  if (!value) fail(key, "is not text", "write it in quotes");
  if (value->find('\0') != std::string::npos) fail(key, "holds a zero byte", "leave it out");
  return *value;
}

std::string TomlReader::text_or(std::string_view key, const std::string& otherwise) { return find(key) == nullptr ? otherwise : text(key); }

bool TomlReader::truth_or(std::string_view key, bool otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (!node->is_boolean()) fail(key, "is neither true nor false", "write true or false, without quotes");
  return node->as_boolean()->get();
}

const toml::table* TomlReader::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) fail(key, "is not a table", fmt::format("write [{}]", key));
  return node->as_table();
}

const toml::array* TomlReader::array(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_array()) fail(key, "is not a list", "write [ ... ]");
  return node->as_array();
}

void TomlReader::finish() const {
  for (const auto& [key, node] : table_)
    if (!known_.contains(key.str()))
      throw Error(place(where_, node.source()), fmt::format("'{}' is not known here", key.str()), "remove it or correct its spelling");
}

}  // namespace cavum
