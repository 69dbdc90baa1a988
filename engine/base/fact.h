// What is said of something, for programs and for people: its kind, its values by name, and the
// sentence. Who decides asks for the kind.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/message.h"

namespace cavum {

class Fact {
 public:
  Fact() = default;
  /// `names`: of the sentence's values, in their order. `kind` and they are literals. Throws
  /// std::logic_error when they are not as many.
  Fact(std::string_view kind, std::vector<const char*> names, Message what);
  Fact(std::string_view kind, Message what) : Fact(kind, {}, std::move(what)) {}
  /// With a value that its sentence does not say.
  [[nodiscard]] Fact with(const char* name, Value value) &&;

  [[nodiscard]] bool empty() const noexcept { return what_.empty(); }
  [[nodiscard]] std::string_view kind() const noexcept { return kind_; }
  [[nodiscard]] const Message& what() const noexcept { return what_; }
  [[nodiscard]] const std::vector<std::pair<std::string_view, Value>>& values() const noexcept {
    return values_;
  }
  friend bool operator==(const Fact&, const Fact&) = default;

 private:
  std::string_view kind_;
  std::vector<std::pair<std::string_view, Value>> values_;
  Message what_;
};
using Facts = std::vector<Fact>;
[[nodiscard]] std::vector<Message> words_of(const Facts& facts);
/// For other programs: {"kind", "values", "text"}, each value by its name, as encode writes it.
void to_json(nlohmann::json& json, const Fact& fact);
void to_json(nlohmann::ordered_json& json, const Fact& fact);

}  // namespace cavum
