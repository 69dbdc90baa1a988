// Messages in JSON. For other programs: the English sentence. In our own files: {"say": "the wall
// {} lacks {}", "of": ["mesial", {"value": 0.31, "unit": "mm3", "digits": 2}]}. What is kept so can
// still be said in every language.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "engine/base/message.h"

namespace cavum {

// As our own files keep it.
[[nodiscard]] nlohmann::ordered_json encode(const Message& message);
[[nodiscard]] nlohmann::ordered_json encode(const std::vector<Message>& messages);
/// For other programs: the values in the order in which they stand in the English text.
[[nodiscard]] nlohmann::json values_json(const Message& message);
/// For other programs, of a fact of that kind: {"kind", "values", "text"}.
[[nodiscard]] nlohmann::json fact_json(std::string_view kind, const Message& message);
/// A whole number and a name as such, any other value as an object: {"value": 0.31, "unit": "mm3",
/// "digits": 2, "bound": 0.05}, {"term": "enamel"}.
[[nodiscard]] nlohmann::ordered_json encode(const Value& value);
/// Throws std::invalid_argument for what is no message: other fields, gaps that are not as many as
/// the values, more than 4096 bytes of a text, 64 values, 8 messages inside each other.
[[nodiscard]] Message decode_message(const nlohmann::json& json);
/// Throws as decode_message does.
[[nodiscard]] Value decode_value(const nlohmann::json& json);
/// At most 10,000.
[[nodiscard]] std::vector<Message> decode_messages(const nlohmann::json& json);

}  // namespace cavum
