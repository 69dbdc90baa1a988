#include "grading/result/finding.h"

#include <nlohmann/json.hpp>

#include "engine/base/message_json.h"
#include "grading/result/result_json.h"

namespace cavum::grading {
namespace {

/// A name or figure by itself as such; a sentence as our own files keep it.
nlohmann::ordered_json json_of_message(const Message& message);

nlohmann::ordered_json json_of_value(const Value& value) {
  struct Of {
    nlohmann::ordered_json operator()(std::int64_t whole) const { return whole; }
    nlohmann::ordered_json operator()(const Number& n) const { return rounded(n.value); }
    nlohmann::ordered_json operator()(const ClockTime& c) const { return rounded(c.seconds); }
    nlohmann::ordered_json operator()(Vec3 p) const { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }
    nlohmann::ordered_json operator()(const Name& n) const { return n.text; }
    nlohmann::ordered_json operator()(const FilePlace& p) const { return p.file; }
    nlohmann::ordered_json operator()(const Term& t) const { return t.english; }
    nlohmann::ordered_json operator()(const Authored& a) const { return a.english; }
    nlohmann::ordered_json operator()(const List& list) const {
      auto all = nlohmann::ordered_json::array();
      for (const Message& m : list.items) all.push_back(json_of_message(m));
      return all;
    }
    nlohmann::ordered_json operator()(const Message& m) const { return json_of_message(m); }
  };
  return std::visit(Of(), static_cast<const Value::variant&>(value));
}

nlohmann::ordered_json json_of_message(const Message& message) {
  return message.english() == std::string_view("{}") ? json_of_value(message.values().front()) : encode(message);
}

}  // namespace

List sentences(const Findings& findings) {
  List all{{}, true};
  for (const Finding& f : findings) all.items.push_back(f.message());
  return all;
}

nlohmann::ordered_json values_json(const Finding& f) {
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < f.values.size(); ++i)
    if (const char* name = f.row().values[i]; *name != 0) values[name] = json_of_value(f.values[i]);
  return values;
}

nlohmann::ordered_json to_json(const Finding& f) {
  return {{"kind", f.row().name}, {"values", values_json(f)}, {"text", english_text(f.message())}, {"said", encode(f.message())}};
}

}  // namespace cavum::grading
