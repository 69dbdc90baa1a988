#include "scenarios/file/bodies.h"

#include <fmt/format.h>

#include <sstream>

#include "engine/base/text.h"

namespace cavum::scenarios {
namespace {

/// What the rows are written with.
template <class S, class... Own>
struct Rows {
  using Spec = S;
  using Row = Field<S, Own...>;
  static constexpr double k_largest_mm = 100.0;
  static Row must(const char* key, double S::*value, double low, double high, double otherwise,
                  const char* label, const char* meaning = "") {
    return {key, true, NumberField<S>{value, low, high, otherwise, label}, meaning};
  }
  static Row may(const char* key, double S::*value, double low, double high, double otherwise,
                 const char* label, const char* meaning = "") {
    return {key, false, NumberField<S>{value, low, high, otherwise, label}, meaning};
  }
  static Row word(const char* key, std::vector<std::string> words, bool required,
                  const char* meaning, void (*choose)(S&, std::size_t)) {
    return {key, required, WordField<S>{std::move(words), choose}, meaning};
  }
  static Row part() {
    return word("part", {"all", "chamber"}, false, "", [](S& s, std::size_t i) {
      s.part = i == 1 ? TissuePart::chamber : TissuePart::all;
    });
  }
  static Row tissue(bool required) { return {"tissue", required, TissueField{}, ""}; }
};

struct BodyRows
    : Rows<ShapeSpec, FileField, PlaceField, AxisField, SizeField, BottomField, OutlineField> {
  static Row any_length(const char* key, double Spec::*value, const char* label) {
    return must(key, value, 0.05, k_largest_mm, 1, label);
  }
  static Row turn() { return may("turn_deg", &Spec::turn_deg, -360, 360, 0, nullptr); }
  static Row side(const char* positive, const char* negative) {
    return word("side", {positive, negative}, true, "",
                [](Spec& s, std::size_t i) { s.side = i == 1 ? -1 : 1; });
  }
  static Row file() { return {"file", true, FileField{}, ""}; }
  static Row place(const char* meaning) { return {"at_mm", true, PlaceField{}, meaning}; }
  static Row axis() { return {"axis", false, AxisField{}, ""}; }
  static Row size() { return {"size_mm", true, SizeField{}, ""}; }
  static Row bottom() { return {"bottom", true, BottomField{}, ""}; }
  static Row outline(OutlineSeen seen) {
    return {"outline", true, OutlineField{seen},
            seen == OutlineSeen::from_side ? "x from the neck's middle to mesial, y above the neck"
                                           : ""};
  }
  static std::vector<BodyKind> all() {
#define BODY(KIND, WORD, IS, WHAT, ...) BodyKind{#KIND, WORD, IS, WHAT, {__VA_ARGS__}},
    return {
#include "scenarios/file/bodies_table.inc"
    };
  }
};

struct OutlineRows : Rows<OutlineSpec, PointsField, CentreField> {
  static Row points(std::size_t at_least, bool closed) {
    return {"points_mm", true, PointsField{at_least, closed}, ""};
  }
  static Row wider() {
    return may("offset_mm", &Spec::offset_mm, -5, 5, 0, noop("outline wider by"));
  }
  static Row centre() { return {"centre_mm", false, CentreField{}, ""}; }
  static Row from() {
    return word("from", {"tooth", "chamber"}, false, "what centre_mm is measured from",
                [](Spec& s, std::size_t i) { s.from_chamber = i == 1; });
  }
  static std::vector<OutlineKind> all() {
#define OUTLINE(KIND, ...) OutlineKind{#KIND, {__VA_ARGS__}},
    return {
#include "scenarios/file/outlines_table.inc"
    };
  }
};

struct BottomRows : Rows<BottomSpec> {
  static Row depth() { return must("depth_mm", &Spec::depth_mm, 0.05, 30, 1, noop("depth")); }
  static Row deeper() {
    return may("deeper_mm", &Spec::deeper_mm, -5, 5, 0, noop("floor deeper than the tissue's"));
  }
  static std::vector<BottomKind> all() {
#define BOTTOM(KIND, ...) BottomKind{#KIND, {__VA_ARGS__}},
    return {
#include "scenarios/file/bottoms_table.inc"
    };
  }
};

/// "at_mm (centre), side = "mesial" or "distal", depth_mm 0.2 to 5".
template <class S, class... Own>
std::string fields_text(const std::vector<Field<S, Own...>>& fields, bool ranges) {
  std::string text;
  for (const auto& f : fields) {
    text += (text.empty() ? "" : ", ") + std::string(f.key);
    if (const auto* words = std::get_if<WordField<S>>(&f.as))
      text += fmt::format(" = \"{}\"", fmt::join(words->words, "\" or \""));
    if (const auto* number = std::get_if<NumberField<S>>(&f.as); number != nullptr && ranges)
      text += fmt::format(" {} to {}", plain_number(number->low), plain_number(number->high));
    if (*f.meaning != '\0') text += fmt::format(" ({})", f.meaning);
  }
  return text;
}

/// "# outline = { kind = "circle", radius_mm }", a line a kind.
template <class Kind>
std::string alternatives(const char* key, const std::vector<Kind>& kinds) {
  std::string text;
  for (const Kind& k : kinds)
    text += fmt::format("# {:7} {} {{ kind = \"{}\", {} }}\n", text.empty() ? key : "",
                        text.empty() ? '=' : '|', k.name, fields_text(k.fields, false));
  return text;
}

}  // namespace

const std::vector<BodyKind>& body_kinds() {
  static const std::vector<BodyKind> k_kinds = BodyRows::all();
  return k_kinds;
}
const std::vector<OutlineKind>& outline_kinds() {
  static const std::vector<OutlineKind> k_kinds = OutlineRows::all();
  return k_kinds;
}
const std::vector<BottomKind>& bottom_kinds() {
  static const std::vector<BottomKind> k_kinds = BottomRows::all();
  return k_kinds;
}

std::string bodies_as_comments() {
  constexpr std::size_t k_widest = 150;
  std::string text;
  for (const BodyKind& k : body_kinds()) {
    std::string line = fmt::format("#   {:12}", k.name);
    std::istringstream words(fields_text(k.fields, false) + (*k.what == '\0' ? "" : ": ") + k.what);
    for (std::string word; words >> word; line += " " + word)
      if (line.size() + word.size() >= k_widest) {
        text += line + "\n";
        line = fmt::format("#{:15}", "");
      }
    text += line + "\n";
  }
  return text + alternatives("outline", outline_kinds()) + alternatives("bottom", bottom_kinds());
}

std::string bodies_as_table() {
  std::string text;
  for (const BodyKind& k : body_kinds())
    text += fmt::format("| `{}` | {} | {} |\n", k.name, fields_text(k.fields, true), k.what);
  return text;
}

}  // namespace cavum::scenarios
