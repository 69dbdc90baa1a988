#include "engine/base/fact.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/base/message_json.h"

namespace cavum {
namespace {

template <class Json>
void write(Json& json, const Fact& fact) {
  json = {{"kind", fact.kind()}, {"values", Json::object()}, {"text", fact.what()}};
  for (const auto& [name, value] : fact.values()) json["values"][std::string(name)] = encode(value);
}

}  // namespace

Fact::Fact(std::string_view kind, std::vector<const char*> names, Message what)
    : kind_(kind), what_(std::move(what)) {
  if (names.size() != what_.values().size())
    throw std::logic_error("a fact has another number of values");
  for (std::size_t i = 0; i < names.size(); ++i) values_.emplace_back(names[i], what_.values()[i]);
}

Fact Fact::with(const char* name, Value value) && {
  values_.emplace_back(name, std::move(value));
  return std::move(*this);
}

std::vector<Message> words_of(const Facts& facts) {
  std::vector<Message> words;
  for (const Fact& f : facts) words.push_back(f.what());
  return words;
}

void to_json(nlohmann::json& json, const Fact& fact) { write(json, fact); }
void to_json(nlohmann::ordered_json& json, const Fact& fact) { write(json, fact); }

}  // namespace cavum
