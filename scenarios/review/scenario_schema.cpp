#include "scenarios/review/scenario_schema.h"

#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/bodies.h"
#include "scenarios/file/checked_toml.h"

namespace cavum::scenarios {
namespace {

using Json = nlohmann::ordered_json;

/// Of another part of the file.
Json defined(const char* name) { return {{"$ref", std::string("#/$defs/") + name}}; }

Json outline_schema(OutlineSeen seen) {
  Json schema = defined("outline");
  if (seen != OutlineSeen::from_occlusal)
    schema["properties"]["kind"]["enum"] = {"circle", "polygon", "stroke"};
  if (seen == OutlineSeen::from_side) schema["properties"]["from"]["const"] = "tooth";
  return schema;
}

/// Of the sorts of fields that bodies, outlines and bottoms have alike.
template <class Spec>
struct SharedSchema {
  bool required;
  Json operator()(const NumberField<Spec>& n) const {
    return {{"type", "number"}, {"minimum", n.low}, {"maximum", n.high}};
  }
  Json operator()(const WordField<Spec>& w) const { return {{"enum", w.words}}; }
  Json operator()(TissueField) const { return defined(required ? "some_text" : "text"); }
};

template <class... Own>
Json field_schema(const Field<ShapeSpec, Own...>& f) {
  return std::visit(ForEachSort{SharedSchema<ShapeSpec>{f.required},
                                [](FileField) -> Json {
                                  return {{"type", "string"}, {"pattern", "\\.(stl|STL)$"}};
                                },
                                [](PlaceField) { return defined("vector"); },
                                [](AxisField) { return defined("vector"); },
                                [](SizeField) { return defined("size"); },
                                [](BottomField) { return defined("bottom"); },
                                [](OutlineField o) { return outline_schema(o.seen); }},
                    f.as);
}
template <class... Own>
Json field_schema(const Field<OutlineSpec, Own...>& f) {
  return std::visit(ForEachSort{SharedSchema<OutlineSpec>{f.required},
                                [](PointsField p) -> Json {
                                  return {{"type", "array"},
                                          {"minItems", p.at_least},
                                          {"maxItems", k_max_points},
                                          {"items", defined("point_mm")}};
                                },
                                [](CentreField) { return defined("point_mm"); }},
                    f.as);
}
Json field_schema(const Field<BottomSpec>& f) {
  return std::visit(SharedSchema<BottomSpec>{f.required}, f.as);
}

/// What each kind needs, told by the word of `tag`.
template <class Kind>
void add_kinds(Json& schema, const char* tag, const std::vector<Kind>& kinds) {
  schema["properties"][tag] = {{"enum", names_of(kinds)}};
  for (const Kind& kind : kinds) {
    Json then{{"required", Json::array()},
              {"properties", Json::object()},
              {"additionalProperties", false}};
    for (const auto& [key, value] : schema["properties"].items()) then["properties"][key] = true;
    for (const auto& f : kind.fields) {
      if (f.required) then["required"].push_back(f.key);
      Json& field = then["properties"][f.key] = field_schema(f);
      if (*f.meaning != '\0') field["description"] = f.meaning;
    }
    schema["allOf"].push_back(
        {{"if", {{"properties", {{tag, {{"const", kind.name}}}}}}}, {"then", then}});
  }
}

}  // namespace

Json scenario_schema() {
  Json schema = Json::parse(read_text_file(find_data_file("schemas", "scenario.schema.json", "")));
  Json& parts = schema["$defs"];
  add_kinds(parts["shape"], "shape", body_kinds());
  add_kinds(parts["outline"], "kind", outline_kinds());
  add_kinds(parts["bottom"], "kind", bottom_kinds());
  return schema;
}

}  // namespace cavum::scenarios
