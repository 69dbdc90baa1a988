#include "engine/base/json_reader.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"

namespace cavum {
namespace {

using nlohmann::json;

/// Line and column of a byte, both from 1.
Message place_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);
  const auto line_from = before.rfind('\n') + 1;  // npos + 1 is 0
  return msg("line {}, column {}", std::count(before.begin(), before.end(), '\n') + 1,
             before.size() - line_from + 1);
}

/// Walks through the text and keeps nothing of it. The library's own callback, which could count
/// while it keeps, looks at all members of an object again after each that is an object: 330,000
/// take minutes.
class Count {
 public:
  using Refuse = std::function<void(const Message&)>;
  Count(const JsonLimits& limits, Refuse refuse) : limits_(limits), refuse_(std::move(refuse)) {}

  bool null() { return value(); }
  bool boolean(bool) { return value(); }
  bool number_integer(json::number_integer_t) { return value(); }
  bool number_unsigned(json::number_unsigned_t) { return value(); }
  bool number_float(json::number_float_t, const json::string_t&) { return value(); }
  bool string(json::string_t&) { return value(); }
  bool binary(json::binary_t&) { return value(); }
  bool key(json::string_t&) { return value(); }
  bool start_object(std::size_t) { return open(); }
  bool start_array(std::size_t) { return open(); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  /// Said by the parser that keeps the values.
  static bool parse_error(std::size_t, const std::string&, const json::exception&) { return false; }

 private:
  bool value() {
    if (++values_ > limits_.values)
      refuse_(msg("holds JSON of more than {} values", limits_.values));
    return true;
  }
  bool open() {
    if (depth_++ >= limits_.depth)
      refuse_(msg("holds JSON that is nested deeper than {}", limits_.depth));
    return value();
  }
  bool close() {
    --depth_;
    return true;
  }
  JsonLimits limits_;
  Refuse refuse_;
  std::size_t values_ = 0, depth_ = 0;
};

}  // namespace

json parse_json(std::string_view text, const Where& where, const JsonLimits& limits) {
  const auto refuse = [&where](const Message& what) {
    throw Error(FileError::too_large, where, what,
                msg("use an intact file: nothing that Cavum writes is like that"));
  };
  if (text.size() > limits.bytes)
    refuse(msg("holds JSON of {} bytes, more than {}", text.size(), limits.bytes));
  Count counted(limits, refuse);
  static_cast<void>(json::sax_parse(text, &counted));
  try {
    return json::parse(text);
  } catch (const json::parse_error& e) {
    throw Error(FileError::malformed, where, msg("is no JSON ({})", place_of(text, e.byte)),
                msg("correct it, or use an intact copy"));
  } catch (const json::exception&) {
    throw Error(FileError::out_of_range, where, msg("holds a number that is too large"),
                msg("correct it, or use an intact copy"));
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
