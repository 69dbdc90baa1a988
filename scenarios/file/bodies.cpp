#include "scenarios/file/bodies.h"

#include <fmt/ranges.h>

#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

using Spec = ShapeSpec;

constexpr double k_largest_mm = 100.0;

BodyField must(const char* key, double Spec::*value, double low, double high, double otherwise, const char* label, const char* meaning = "") {
  return {key, true, NumberField{value, low, high, otherwise, label}, meaning};
}
BodyField may(const char* key, double Spec::*value, double low, double high, double otherwise, const char* label, const char* meaning = "") {
  return {key, false, NumberField{value, low, high, otherwise, label}, meaning};
}
BodyField any_length(const char* key, double Spec::*value, const char* label) { return must(key, value, 0.05, k_largest_mm, 1, label); }
BodyField turn() { return may("turn_deg", &Spec::turn_deg, -360, 360, 0, nullptr); }
BodyField word(const char* key, std::vector<std::string> words, bool required, const char* meaning, void (*choose)(Spec&, std::size_t)) {
  return {key, required, WordField{std::move(words), choose}, meaning};
}
BodyField side(const char* positive, const char* negative) {
  return word("side", {positive, negative}, true, "", [](Spec& s, std::size_t i) { s.side = i == 1 ? -1 : 1; });
}
BodyField part() {
  return word("part", {"all", "chamber"}, false, "", [](Spec& s, std::size_t i) { s.part = i == 1 ? TissuePart::chamber : TissuePart::all; });
}
BodyField tissue(bool required) { return {"tissue", required, TissueField{}, ""}; }
BodyField file() { return {"file", true, FileField{}, ""}; }
BodyField place(const char* meaning) { return {"at_mm", true, PlaceField{}, meaning}; }
BodyField axis() { return {"axis", false, AxisField{}, ""}; }
BodyField size() { return {"size_mm", true, SizeField{}, ""}; }
BodyField bottom() { return {"bottom", true, BottomField{}, ""}; }
BodyField outline(OutlineSeen seen) {
  return {"outline", true, OutlineField{seen}, seen == OutlineSeen::from_side ? "x from the neck's middle to mesial, y above the neck" : ""};
}

const std::vector<BodyKind>& kinds() {
#define BODY(KIND, WORD, IS, WHAT, ...) {#KIND, WORD, IS, WHAT, {__VA_ARGS__}},
  static const std::vector<BodyKind> k_kinds{
#include "scenarios/file/bodies_table.inc"
  };
  return k_kinds;
}

/// "at_mm (centre)", "side = "mesial" or "distal"", "depth_mm 0.2 to 5".
std::string field_text(const BodyField& f, bool ranges) {
  std::string text = f.key;
  if (const auto* words = std::get_if<WordField>(&f.as)) text += fmt::format(" = \"{}\"", fmt::join(words->words, "\" or \""));
  if (const auto* number = std::get_if<NumberField>(&f.as); number != nullptr && ranges)
    text += fmt::format(" {} to {}", plain_number(number->low), plain_number(number->high));
  return *f.meaning == '\0' ? text : fmt::format("{} ({})", text, f.meaning);
}

std::string fields_text(const BodyKind& kind, bool ranges) {
  std::vector<std::string> texts;
  for (const BodyField& f : kind.fields) texts.push_back(field_text(f, ranges));
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace

const BodyKind& body_kind(Spec::Kind kind) { return kinds()[static_cast<std::size_t>(kind)]; }

const std::vector<std::string>& body_names() {
  static const std::vector<std::string> k_names = [] {
    std::vector<std::string> names;
    for (const BodyKind& kind : kinds()) names.emplace_back(kind.name);
    return names;
  }();
  return k_names;
}

std::string bodies_as_comments() {
  std::string text;
  for (const BodyKind& k : kinds()) text += fmt::format("#   {:12} {}{}{}\n", k.name, fields_text(k, false), *k.what == '\0' ? "" : ": ", k.what);
  return text;
}

std::string bodies_as_table() {
  std::string text;
  for (const BodyKind& k : kinds()) text += fmt::format("| `{}` | {} | {} |\n", k.name, fields_text(k, true), k.what);
  return text;
}

}  // namespace cavum::scenarios
