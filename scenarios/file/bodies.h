// What is known of each kind of body, of the rows of bodies_table.inc: what a file says of it, and what the exam must know of it beside its shape.
// The reader, the mistakes it names, the comments of `scenario new`, the table of docs/scenarios.md and the numbers that the station offers are made
// of them.
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
struct NumberField {
  double ShapeSpec::*value;
  double low, high, otherwise;
  const char* label;
};
/// One of `words`, the first where it may be left out.
struct WordField {
  std::vector<std::string> words;
  void (*choose)(ShapeSpec&, std::size_t);
};
struct TissueField {};
struct FileField {};
struct PlaceField {};
struct AxisField {};
struct SizeField {};
struct BottomField {};
/// A prism's outline lies across its axis; one on a side is counted from the neck. Both are drawn: they follow no tissue and no fissure.
enum class OutlineSeen { from_occlusal, along_axis, from_side };
struct OutlineField {
  OutlineSeen seen;
};

struct BodyField {
  const char* key;
  bool required;
  std::variant<NumberField, WordField, TissueField, FileField, PlaceField, AxisField, SizeField, BottomField, OutlineField> as;
  const char* meaning;  ///< empty where the key says it
};

/// What is done with each sort of field: one function a sort.
template <class... Function>
struct ForEachSort : Function... {
  using Function::operator()...;
};

struct BodyKind {
  const char *name, *word;
  unsigned is;
  const char* what;
  std::vector<BodyField> fields;
};

[[nodiscard]] const BodyKind& body_kind(ShapeSpec::Kind kind);
/// In the file, by their kind.
[[nodiscard]] std::vector<std::string> body_names();
[[nodiscard]] inline bool body_is(const ShapeSpec& shape, BodyIs what) { return (body_kind(shape.kind).is & what) != 0; }
/// The first of a kind's fields that is of one sort; null where it has none.
template <class Sort>
[[nodiscard]] const Sort* field_of(ShapeSpec::Kind kind) {
  for (const BodyField& field : body_kind(kind).fields)
    if (const auto* found = std::get_if<Sort>(&field.as)) return found;
  return nullptr;
}

/// All kinds with their fields, a line each: as comments of a scenario, and as the table of docs/scenarios.md, with ranges.
[[nodiscard]] std::string bodies_as_comments();
[[nodiscard]] std::string bodies_as_table();

}  // namespace cavum::scenarios
