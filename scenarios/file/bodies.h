// What is known of each kind of body, of the rows of bodies_table.inc: what a file says of it, and
// what the exam must know of it beside its shape. The reader, the mistakes it names, the comments
// of `scenario new`, the table of docs/scenarios.md and the numbers that the station offers are
// made of them.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "scenarios/file/scenario.h"

namespace cavum::scenarios {

/// What a kind is beside its shape, as bits.
enum BodyIs : unsigned {
  k_plain = 0,
  k_by_landmarks = 1,  ///< placed by the tooth's landmarks
  k_from_side = 2,     ///< cut from the buccal or lingual side, `side`
  k_around_stump = 4,  ///< goes round what stays: its floor ends in the air, at a finish line
};

/// Within [low, high]. With a label the station offers it.
template <class Spec>
struct NumberField {
  double Spec::*value;
  double low, high, otherwise;
  const char* label;
};
/// One of `words`, the first where it may be left out.
template <class Spec>
struct WordField {
  std::vector<std::string> words;
  void (*choose)(Spec&, std::size_t);
};
struct TissueField {};
/// A field of a body, of an outline or of a bottom; Own: sorts that only they have.
template <class Spec, class... Own>
struct Field {
  const char* key;
  bool required;
  std::variant<NumberField<Spec>, WordField<Spec>, TissueField, Own...> as;
  const char* meaning;  ///< empty where the key says it
};

struct FileField {};
struct PlaceField {};
struct AxisField {};
struct SizeField {};
struct BottomField {};
/// A prism's outline lies across its axis; one on a side is counted from the neck. Both are drawn:
/// they follow no tissue and no fissure.
enum class OutlineSeen { from_occlusal, along_axis, from_side };
struct OutlineField {
  OutlineSeen seen;
};
struct BodyKind {
  const char *name, *word;
  unsigned is;
  const char* what;
  std::vector<
      Field<ShapeSpec, FileField, PlaceField, AxisField, SizeField, BottomField, OutlineField>>
      fields;
};

struct PointsField {
  std::size_t at_least;
  bool closed;  ///< they go round; else they are a path
};
struct CentreField {};
struct OutlineKind {
  const char* name;
  std::vector<Field<OutlineSpec, PointsField, CentreField>> fields;
};

struct BottomKind {
  const char* name;
  std::vector<Field<BottomSpec>> fields;
};

/// What is done with each sort of field: one function a sort.
template <class... Function>
struct ForEachSort : Function... {
  using Function::operator()...;
};
template <class... Function>
ForEachSort(Function...) -> ForEachSort<Function...>;

/// In the order of their enums.
[[nodiscard]] const std::vector<BodyKind>& body_kinds();
[[nodiscard]] const std::vector<OutlineKind>& outline_kinds();
[[nodiscard]] const std::vector<BottomKind>& bottom_kinds();
/// In the file.
template <class Kind>
[[nodiscard]] std::vector<std::string> names_of(const std::vector<Kind>& kinds) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  return names;
}

[[nodiscard]] inline const BodyKind& kind_of(const ShapeSpec& s) {
  return body_kinds()[static_cast<std::size_t>(s.kind)];
}
[[nodiscard]] inline const OutlineKind& kind_of(const OutlineSpec& o) {
  return outline_kinds()[static_cast<std::size_t>(o.kind)];
}
[[nodiscard]] inline const BottomKind& kind_of(const BottomSpec& b) {
  return bottom_kinds()[static_cast<std::size_t>(b.kind)];
}
[[nodiscard]] inline bool body_is(const ShapeSpec& shape, BodyIs what) {
  return (kind_of(shape).is & what) != 0;
}
/// The first of a body's fields that is of one sort; null where it has none.
template <class Sort>
[[nodiscard]] const Sort* field_of(const ShapeSpec& shape) {
  for (const auto& field : kind_of(shape).fields)
    if (const auto* found = std::get_if<Sort>(&field.as)) return found;
  return nullptr;
}

/// All bodies, outlines and bottoms with their fields, as comments of a scenario; bodies as the
/// table of docs/scenarios.md, with ranges.
[[nodiscard]] std::string bodies_as_comments();
[[nodiscard]] std::string bodies_as_table();

}  // namespace cavum::scenarios
