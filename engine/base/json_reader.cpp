#include "engine/base/json_reader.h"

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

using nlohmann::json;

/// What the library says, without its own name and number in brackets in front.
std::string said(const json::exception& e) {
  const std::string text = one_line(e.what());
  const auto end = text.find("] ");
  return (end == std::string::npos ? text : text.substr(end + 2)).substr(0, 200);
}

}  // namespace

json parse_json(std::string_view text, const std::string& where, const JsonLimits& limits) {
  const auto refuse = [&where](const std::string& what) {
    throw Error(where, "holds JSON " + what, "use an intact file: nothing that Cavum writes is like that");
  };
  if (text.size() > limits.bytes) refuse("of " + std::to_string(text.size()) + " bytes, more than " + std::to_string(limits.bytes));
  std::size_t values = 0;
  const auto count = [&](int depth, json::parse_event_t event, const json&) {
    const bool opens = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && static_cast<std::size_t>(depth) >= limits.depth) refuse("that is nested deeper than " + std::to_string(limits.depth));
    const bool closes = event == json::parse_event_t::object_end || event == json::parse_event_t::array_end;
    if (!closes && ++values > limits.values) refuse("of more than " + std::to_string(limits.values) + " values");
    return true;
  };
  try {
    return json::parse(text, count);
  } catch (const json::exception& e) {
    throw Error(where, "is no JSON (" + said(e) + ")", "correct it, or use an intact copy");
  }
}

json parse_json_or_null(std::string_view text, const JsonLimits& limits) {
  try {
    return parse_json(text, "JSON", limits);
  } catch (const Error&) {
    return nullptr;
  }
}

bool is_json(std::string_view text, const JsonLimits& limits) {
  try {
    static_cast<void>(parse_json(text, "JSON", limits));
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace cavum
