#include "engine/base/toml_reader.h"

#include <fmt/core.h>

#include <cmath>

#include "engine/base/file_error.h"
#include "engine/base/text.h"
#include "engine/base/toml_limits.h"

namespace cavum {
namespace {

FileLocation place(const std::string& where, const toml::source_region& source) {
  return {where, static_cast<int>(source.begin.line), static_cast<int>(source.begin.column)};
}

}  // namespace

toml::table parse_toml(const std::string& text, const std::string& where) {
  if (const auto beyond = beyond_toml_limits(text))
    throw Error(FileError::too_large, FileLocation{where, static_cast<int>(beyond->line), 1},
                beyond->what, beyond->what_to_do);
  try {
    return toml::parse(text, where);
  } catch (const toml::parse_error& e) {
    throw Error(FileError::malformed, place(where, e.source()), Name{std::string(e.description())},
                msg("correct the TOML at this place"));
  }
}

const toml::node* TomlReader::find(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

void TomlReader::fail(std::string_view key, const Message& what, const Message& todo) const {
  fail(General::error, key, what, todo);
}

void TomlReader::fail(ErrorCode code, std::string_view key, const Message& what,
                      const Message& todo) const {
  const toml::node* node = table_.get(key);
  throw Error(code, place(where_, node != nullptr ? node->source() : table_.source()),
              msg("'{}' {}", key, what), todo);
}

double TomlReader::number(std::string_view key, double low, double high) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(FileError::missing, key, msg("is missing"), msg("add it"));
  const auto value = node->value<double>();
  if (!value || !node->is_number())
    fail(FileError::wrong_type, key, msg("is not a number"), msg("write a number"));
  if (!(*value >= low && *value <= high))
    fail(FileError::out_of_range, key,
         msg("is {}, outside {} .. {}", as_number(*value), as_number(low), as_number(high)),
         msg("choose a value in that range"));
  return *value;
}

double TomlReader::number_or(std::string_view key, double low, double high, double otherwise) {
  return find(key) == nullptr ? otherwise : number(key, low, high);
}

std::string TomlReader::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(FileError::missing, key, msg("is missing"), msg("add it"));
  const auto value = node->value<std::string>();
  if (!value) fail(FileError::wrong_type, key, msg("is not text"), msg("write it in quotes"));
  if (value->find('\0') != std::string::npos)
    fail(FileError::malformed, key, msg("holds a zero byte"), msg("leave it out"));
  return *value;
}

std::string TomlReader::text_or(std::string_view key, const std::string& otherwise) {
  return find(key) == nullptr ? otherwise : text(key);
}

bool TomlReader::truth_or(std::string_view key, bool otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  if (!node->is_boolean())
    fail(FileError::wrong_type, key, msg("is neither true nor false"),
         msg("write true or false, without quotes"));
  return node->as_boolean()->get();
}

const toml::table* TomlReader::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table())
    fail(FileError::wrong_type, key, msg("is not a table"), msg("write [{}]", key));
  return node->as_table();
}

const toml::array* TomlReader::array(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_array())
    fail(FileError::wrong_type, key, msg("is not a list"), msg("write [ ... ]"));
  return node->as_array();
}

void TomlReader::finish() const {
  for (const auto& [key, node] : table_)
    if (!known_.contains(key.str()))
      throw Error(FileError::unknown, place(where_, node.source()),
                  msg("'{}' is not known here", key.str()),
                  msg("remove it or correct its spelling"));
}

}  // namespace cavum
