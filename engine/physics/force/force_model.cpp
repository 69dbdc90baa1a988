#include "engine/physics/force/force_model.h"

#include <fmt/core.h>

#include "engine/base/file_error.h"
#include "engine/base/toml_reader.h"

namespace cavum {

namespace {

std::vector<double> numbers(TomlReader& in, const char* key) {
  std::vector<double> out;
  const auto* array = in.array(key);
  if (array == nullptr)
    in.fail(key, msg("is missing"), msg("give a list of numbers, which may be empty"));
  for (const auto& node : *array) {
    const auto value = node.value<double>();
    if (!value) in.fail(key, msg("holds something that is no number"), msg("give numbers only"));
    out.push_back(*value);
  }
  return out;
}

/// [cutting], and [handpiece] where the law knows a torque.
void read_cutting(TomlReader& in, const std::string& where, ForceModel& model) {
  const auto* t = in.table("cutting");
  if (t == nullptr) in.fail("cutting", msg("is missing"), msg("add [cutting] with rpm_ref"));
  TomlReader cutting(*t, where);
  const std::string law = cutting.text_or("law", "penetration");
  if (law != "penetration" && law != "pressure")
    cutting.fail("law", msg("'{}' is no law of cutting", law),
                 msg("write penetration or pressure"));
  if (law == "penetration") {
    model.rpm_ref = cutting.number("rpm_ref", 1, 1e6);
    cutting.finish();
    return;
  }
  model.law = CuttingLaw::pressure;
  model.force_ratio = cutting.number("force_ratio", 0, 10);
  cutting.finish();
  if (const auto* h = in.table("handpiece")) {
    TomlReader handpiece(*h, where);
    model.drive = {handpiece.number("torque_n_mm", 1e-3, 1e3),
                   handpiece.number("slip_rpm", 1, 1e6)};
    handpiece.finish();
  }
}

}  // namespace

ForceModel parse_force_model(const std::string& text, const std::string& where) {
  const toml::table document = parse_toml(text, where);
  TomlReader in(document, where);
  ForceModel model;
  model.name = in.text("name");
  read_cutting(in, where, model);
  if (const auto* t = in.table("rendering")) {
    TomlReader r(*t, where);
    model.rendering.kvc_n_per_mm = r.number("kvc_n_per_mm", 0, 10);
    model.rendering.filtered_damping_n_s_per_mm = r.number("filtered_damping_n_s_per_mm", 0, 1);
    model.rendering.speed_filter_s = r.number("speed_filter_s", 0, 1);
    model.rendering.drag_n_per_mm =
        r.number_or("drag_n_per_mm", 1e-3, 10, model.rendering.drag_n_per_mm);
    r.finish();
  }
  const auto* materials = in.table("materials");
  if (materials == nullptr)
    in.fail("materials", msg("is missing"), msg("add [materials.NAME] for each tissue"));
  for (const auto& [name, node] : *materials) {
    if (!node.is_table())
      in.fail("materials", msg("holds '{}', which is not a table", name.str()),
              msg("write [materials.NAME]"));
    TomlReader m(*node.as_table(), where);
    Material material;
    material.voigt = {m.number("k_n_per_mm", 0, 100), m.number("c_n_s_per_mm", 0, 100)};
    if (model.law == CuttingLaw::penetration)
      material.tau_s = m.number_or("tau_s", 0, 1e6, 0);
    else
      material.wear_mm3_per_n_m = m.number_or("wear_mm3_per_n_m", 1e-6, 100, 0);
    m.finish();
    model.materials.emplace(name.str(), material);
  }
  if (const auto* terms = in.array("terms")) {
    if (terms->size() > k_max_terms)
      in.fail(FileError::too_large, "terms", msg("are more than {}", k_max_terms),
              msg("leave out the smallest"));
    for (const auto& node : *terms) {
      if (!node.is_table())
        in.fail(FileError::wrong_type, "terms", msg("hold something that is not a table"),
                msg("write [[terms]] with kind = \"…\" for each"));
      model.terms.push_back(read_force_term(*node.as_table(), where));
      TermValues values{node.as_table()->get("kind")->value_or(std::string()), {}};
      for (const auto& p : find_term_kind(values.kind)->parameters)
        if (const auto* given = node.as_table()->get(p.name))
          values.parameters.emplace_back(p.name, given->value_or(0.0));
      model.term_values.push_back(std::move(values));
    }
  }
  if (const auto* effects = in.array("measurement"))
    for (const auto& node : *effects) {
      if (!node.is_table())
        in.fail("measurement", msg("holds something that is not a table"),
                msg("write [[measurement]] with kind, shape and values"));
      TomlReader m(*node.as_table(), where);
      MeasurementEffect effect{m.text("kind"), numbers(m, "shape"), numbers(m, "values")};
      m.finish();
      model.measurement.push_back(std::move(effect));
    }
  in.finish();
  return model;
}

}  // namespace cavum
