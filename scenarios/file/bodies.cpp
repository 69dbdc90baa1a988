#include "scenarios/file/bodies.h"

#include <fmt/format.h>

#include <sstream>

#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

/// What the rows are written with.
struct Rows {
  using Spec = ShapeSpec;
  static constexpr double k_largest_mm = 100.0;

  static BodyField must(const char* key, double Spec::*value, double low, double high, double otherwise, const char* label,
                        const char* meaning = "") {
    return {key, true, NumberField{value, low, high, otherwise, label}, meaning};
  }
  static BodyField may(const char* key, double Spec::*value, double low, double high, double otherwise, const char* label, const char* meaning = "") {
    return {key, false, NumberField{value, low, high, otherwise, label}, meaning};
  }
  static BodyField any_length(const char* key, double Spec::*value, const char* label) { return must(key, value, 0.05, k_largest_mm, 1, label); }
  static BodyField turn() { return may("turn_deg", &Spec::turn_deg, -360, 360, 0, nullptr); }
  static BodyField word(const char* key, std::vector<std::string> words, bool required, const char* meaning, void (*choose)(Spec&, std::size_t)) {
    return {key, required, WordField{std::move(words), choose}, meaning};
  }
  static BodyField side(const char* positive, const char* negative) {
    return word("side", {positive, negative}, true, "", [](Spec& s, std::size_t i) { s.side = i == 1 ? -1 : 1; });
  }
  static BodyField part() {
    return word("part", {"all", "chamber"}, false, "", [](Spec& s, std::size_t i) { s.part = i == 1 ? TissuePart::chamber : TissuePart::all; });
  }
  static BodyField tissue(bool required) { return {"tissue", required, TissueField{}, ""}; }
  static BodyField file() { return {"file", true, FileField{}, ""}; }
  static BodyField place(const char* meaning) { return {"at_mm", true, PlaceField{}, meaning}; }
  static BodyField axis() { return {"axis", false, AxisField{}, ""}; }
  static BodyField size() { return {"size_mm", true, SizeField{}, ""}; }
  static BodyField bottom() { return {"bottom", true, BottomField{}, ""}; }
  static BodyField outline(OutlineSeen seen) {
    return {"outline", true, OutlineField{seen}, seen == OutlineSeen::from_side ? "x from the neck's middle to mesial, y above the neck" : ""};
  }
  static std::vector<BodyKind> all() {
#define BODY(KIND, WORD, IS, WHAT, ...) {#KIND, WORD, IS, WHAT, {__VA_ARGS__}},
    return {
#include "scenarios/file/bodies_table.inc"
    };
  }
};

const std::vector<BodyKind>& kinds() {
  static const std::vector<BodyKind> k_kinds = Rows::all();
  return k_kinds;
}

/// "at_mm (centre), side = "mesial" or "distal", depth_mm 0.2 to 5".
std::string fields_text(const BodyKind& kind, bool ranges) {
  std::string text;
  for (const BodyField& f : kind.fields) {
    text += (text.empty() ? "" : ", ") + std::string(f.key);
    if (const auto* words = std::get_if<WordField>(&f.as)) text += fmt::format(" = \"{}\"", fmt::join(words->words, "\" or \""));
    if (const auto* number = std::get_if<NumberField>(&f.as); number != nullptr && ranges)
      text += fmt::format(" {} to {}", plain_number(number->low), plain_number(number->high));
    if (*f.meaning != '\0') text += fmt::format(" ({})", f.meaning);
  }
  return text;
}

}  // namespace

const BodyKind& body_kind(ShapeSpec::Kind kind) { return kinds()[static_cast<std::size_t>(kind)]; }

std::vector<std::string> body_names() {
  std::vector<std::string> names;
  for (const BodyKind& kind : kinds()) names.emplace_back(kind.name);
  return names;
}

std::string bodies_as_comments() {
  constexpr std::size_t k_widest = 150;
  std::string text;
  for (const BodyKind& k : kinds()) {
    std::string line = fmt::format("#   {:12}", k.name);
    std::istringstream words(fields_text(k, false) + (*k.what == '\0' ? "" : ": ") + k.what);
    for (std::string word; words >> word; line += " " + word)
      if (line.size() + word.size() >= k_widest) {
        text += line + "\n";
        line = fmt::format("#{:15}", "");
      }
    text += line + "\n";
  }
  return text;
}

std::string bodies_as_table() {
  std::string text;
  for (const BodyKind& k : kinds()) text += fmt::format("| `{}` | {} | {} |\n", k.name, fields_text(k, true), k.what);
  return text;
}

}  // namespace cavum::scenarios
