#include "engine/base/message_json.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <cmath>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "engine/base/text.h"

namespace cavum {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t k_max_bytes = 4096, k_max_values = 64, k_max_messages = 10'000;
constexpr int k_deepest = 8, k_max_digits = 12;

[[noreturn]] void refuse(const char* why) { throw std::invalid_argument(why); }

/// The same text for as long as the program runs: a message points to its sentence.
const char* lasting(const std::string& text) {
  static std::mutex lock;
  static std::set<std::string> texts;
  const std::lock_guard guard(lock);
  if (texts.size() >= k_max_messages && !texts.contains(text)) refuse("other sentences than ours");
  return texts.insert(text).first->c_str();
}

std::string text_of(const nlohmann::json& j) {
  const auto* text = j.get_ptr<const std::string*>();
  if (text == nullptr || text->size() > k_max_bytes) refuse("a text is missing or too long");
  return *text;
}

double number_of(const nlohmann::json& j) {
  if (!j.is_number() || !std::isfinite(j.get<double>())) refuse("a number is missing");
  return j.get<double>();
}

int small_number(const nlohmann::json& j, int most) {
  if (!j.is_number_integer()) refuse("a whole number is missing");
  const auto n = j.get<std::int64_t>();
  if (n < -1 || n > most) refuse("a number is out of its range");
  return static_cast<int>(n);
}

void check_gaps(const std::string& english, std::size_t values) {
  fmt::dynamic_format_arg_store<fmt::format_context> store;
  for (std::size_t i = 0; i < values; ++i) store.push_back(std::string_view());
  try {
    (void)fmt::vformat(english, store);
  } catch (const fmt::format_error&) {
    refuse("the gaps are not those of the values");
  }
}

Message message_of(const nlohmann::json& j, int depth);

std::vector<Message> messages_of(const nlohmann::json& j, int depth) {
  if (!j.is_array() || j.size() > k_max_messages)
    refuse("a list of messages is missing or too long");
  std::vector<Message> out;
  for (const auto& m : j) out.push_back(message_of(m, depth));
  return out;
}

Value value_of(const nlohmann::json& j, int depth) {
  if (j.is_number_integer()) return j.get<std::int64_t>();
  if (j.is_string()) return Name{text_of(j)};
  if (!j.is_object()) refuse("a value of no known kind");
  if (j.contains("value")) {
    Number n{number_of(j.at("value")), Unit::none, k_as_needed};
    if (j.contains("unit")) {
      const auto unit = unit_of(text_of(j.at("unit")));
      if (!unit) refuse("a unit that is not known");
      n.unit = *unit;
    }
    if (j.contains("digits")) n.digits = small_number(j.at("digits"), k_max_digits);
    if (j.contains("bound")) n.bound = number_of(j.at("bound"));
    n.sign = j.contains("sign");
    return n;
  }
  if (j.contains("clock_s")) return ClockTime{number_of(j.at("clock_s"))};
  if (j.contains("place_mm")) {
    const auto& p = j.at("place_mm");
    if (!p.is_array() || p.size() != 3) refuse("a place without three numbers");
    return Vec3{number_of(p[0]), number_of(p[1]), number_of(p[2])};
  }
  if (j.contains("file")) {
    constexpr int k_max_lines = 1'000'000'000;
    return FileLocation{text_of(j.at("file")),
                        small_number(j.value("line", nlohmann::json(0)), k_max_lines),
                        small_number(j.value("column", nlohmann::json(0)), k_max_lines)};
  }
  if (j.contains("term")) return Term{text_of(j.at("term"))};
  if (j.contains("authored")) return Authored{text_of(j.at("authored"))};
  if (j.contains("list"))
    return List{messages_of(j.at("list"), depth + 1), j.contains("sentences")};
  return message_of(j, depth + 1);
}

Message message_of(const nlohmann::json& j, int depth) {
  if (depth > k_deepest) refuse("too many messages inside each other");
  if (!j.is_object() || !j.contains("say")) refuse("no message");
  const auto values_of = j.value("of", nlohmann::json::array());
  if (!values_of.is_array() || values_of.size() > k_max_values)
    refuse("the values of a message are no list or too many");
  const std::string english = text_of(j.at("say"));
  check_gaps(english, values_of.size());
  std::vector<Value> values;
  for (const auto& v : values_of) values.push_back(value_of(v, depth));
  if (!j.contains("many")) return {lasting(english), nullptr, 0, std::move(values)};
  const std::string many = text_of(j.at("many"));
  check_gaps(many, values.size());
  if (!j.contains("count") || !j.at("count").is_number_integer()) refuse("a count is missing");
  return {lasting(english), lasting(many), j.at("count").get<std::int64_t>(), std::move(values)};
}

}  // namespace

nlohmann::ordered_json encode(const Message& message) {
  Json j = {{"say", message.empty() ? "" : message.english()}};
  if (!message.empty() && message.plural() != nullptr) {
    j["many"] = message.plural();
    j["count"] = message.count();
  }
  if (!message.values().empty()) {
    j["of"] = Json::array();
    for (const Value& v : message.values()) j["of"].push_back(encode(v));
  }
  return j;
}

nlohmann::json values_json(const Message& message) {
  nlohmann::json values = nlohmann::json::array();
  for (const Value& v : message.values()) values.emplace_back(encode(v));
  return values;
}

nlohmann::json fact_json(std::string_view kind, const Message& message) {
  return {{"kind", kind}, {"values", values_json(message)}, {"text", message}};
}

nlohmann::ordered_json encode(const std::vector<Message>& messages) {
  Json list = Json::array();
  for (const Message& m : messages) list.push_back(encode(m));
  return list;
}

nlohmann::ordered_json encode(const Value& value) {
  struct Coder {
    Json operator()(std::int64_t whole) const { return whole; }
    Json operator()(const Number& n) const {
      Json j = {{"value", n.value}};
      if (n.unit != Unit::none) j["unit"] = unit_id(n.unit);
      if (n.digits != k_as_needed) j["digits"] = n.digits;
      if (n.bound != 0) j["bound"] = n.bound;
      if (n.sign) j["sign"] = true;
      return j;
    }
    Json operator()(const ClockTime& c) const { return {{"clock_s", c.seconds}}; }
    Json operator()(const Vec3& p) const { return {{"place_mm", {p.x, p.y, p.z}}}; }
    Json operator()(const Name& n) const { return one_line(n.text); }
    Json operator()(const FileLocation& p) const {
      return {{"file", one_line(p.file)}, {"line", p.line}, {"column", p.column}};
    }
    Json operator()(const Term& t) const { return {{"term", t.english}}; }
    Json operator()(const Authored& a) const { return {{"authored", one_line(a.english)}}; }
    Json operator()(const List& l) const {
      Json j = {{"list", encode(l.items)}};
      if (l.sentences) j["sentences"] = true;
      return j;
    }
    Json operator()(const Message& m) const { return encode(m); }
  };
  return std::visit(Coder{}, static_cast<const Value::variant&>(value));
}

Value decode_value(const nlohmann::json& json) { return value_of(json, 0); }

Message decode_message(const nlohmann::json& json) { return message_of(json, 0); }

std::vector<Message> decode_messages(const nlohmann::json& json) { return messages_of(json, 0); }

}  // namespace cavum
