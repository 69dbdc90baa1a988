#include "scenarios/review/scenario_schema.h"

#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/bodies.h"

namespace cavum::scenarios {
namespace {

using Json = nlohmann::ordered_json;

/// Of another part of the file.
Json defined(const char* name) { return {{"$ref", std::string("#/$defs/") + name}}; }

Json outline_schema(OutlineSeen seen) {
  Json schema = defined("outline");
  if (seen != OutlineSeen::from_occlusal) schema["properties"]["kind"]["enum"] = {"circle", "polygon", "stroke"};
  if (seen == OutlineSeen::from_side) schema["properties"]["from"]["const"] = "tooth";
  return schema;
}

Json field_schema(const BodyField& f) {
  Json schema = std::visit(ForEachSort{[](const NumberField& n) -> Json {
                                         return {{"type", "number"}, {"minimum", n.low}, {"maximum", n.high}};
                                       },
                                       [](const WordField& w) -> Json {
                                         return {{"enum", w.words}};
                                       },
                                       [&](TissueField) { return defined(f.required ? "some_text" : "text"); },
                                       [](FileField) -> Json {
                                         return {{"type", "string"}, {"pattern", "\\.(stl|STL)$"}};
                                       },
                                       [](PlaceField) { return defined("vector"); }, [](AxisField) { return defined("vector"); },
                                       [](SizeField) { return defined("size"); }, [](BottomField) { return defined("bottom"); },
                                       [](OutlineField o) { return outline_schema(o.seen); }},
                           f.as);
  if (*f.meaning != '\0') schema["description"] = f.meaning;
  return schema;
}

Json body_schema(const BodyKind& kind) {
  Json then{{"required", Json::array()}, {"properties", {{"shape", true}, {"combine", true}}}, {"additionalProperties", false}};
  if (*kind.what != '\0') then["description"] = kind.what;
  for (const BodyField& f : kind.fields) {
    if (f.required) then["required"].push_back(f.key);
    then["properties"][f.key] = field_schema(f);
  }
  return {{"if", {{"properties", {{"shape", {{"const", kind.name}}}}}}}, {"then", then}};
}

}  // namespace

Json scenario_schema() {
  Json schema = Json::parse(read_text_file(find_data_file("schemas", "scenario.schema.json", "")));
  Json& shape = schema["$defs"]["shape"];
  shape.erase("description");
  shape["properties"]["shape"] = {{"enum", body_names()}};
  for (std::size_t i = 0; i < body_names().size(); ++i) shape["allOf"].push_back(body_schema(body_kind(static_cast<ShapeSpec::Kind>(i))));
  return schema;
}

}  // namespace cavum::scenarios
