#include "engine/base/fact_table.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/base/json_fields.h"
#include "engine/base/message_json.h"
#include "engine/base/text.h"

namespace cavum {

std::vector<Value> kept(std::vector<Value> values) {
  constexpr std::size_t k_longest = 2000;
  for (Value& v : values) {
    if (const auto* said = std::get_if<Message>(&v)) v = Name{english_text(*said)};
    auto* name = std::get_if<Name>(&v);
    if (name == nullptr) continue;
    name->text = one_line(name->text);
    if (name->text.size() > k_longest)
      name->text.resize(whole_characters(std::string_view(name->text).substr(0, k_longest)));
  }
  return values;
}

nlohmann::ordered_json encode(const FactRow& row, const std::vector<Value>& values) {
  nlohmann::ordered_json by_name = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < values.size(); ++i) by_name[row.values[i]] = encode(values[i]);
  return {{"kind", row.name}, {"values", by_name}};
}

nlohmann::json fact_json(std::span<const FactRow> rows, std::size_t kind,
                         const std::vector<Value>& values, const Message& message) {
  nlohmann::json json = encode(rows[kind], kept(values));
  json["group"] = rows[rows[kind].group].name;
  json["text"] = message;
  return json;
}

std::pair<std::size_t, std::vector<Value>> decode_fact(const nlohmann::json& json,
                                                       std::span<const FactRow> rows) {
  const auto& values = member_of(json, "values");
  const std::string name = text_in(json, "kind");
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const FactRow& r) { return name == r.name; });
  if (row == rows.end()) throw std::invalid_argument("a kind that is not known");
  if (!values.is_object() || values.size() != row->count())
    throw std::invalid_argument("other values than those of its kind");
  std::vector<Value> read;
  for (std::size_t i = 0; i < row->count(); ++i)
    read.push_back(decode_value(member_of(values, row->values[i])));
  return {static_cast<std::size_t>(row - rows.begin()), std::move(read)};
}

}  // namespace cavum
