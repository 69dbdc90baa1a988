#include "grading/result/finding.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/message_json.h"
#include "grading/result/result_json.h"

namespace cavum::grading {
namespace {

[[noreturn]] void refuse() { throw Error(msg("result"), msg("is none as grading writes it"), msg("use an intact copy")); }

}  // namespace

Value finding_detail::as_sealed(Value value) {
  if (auto* n = std::get_if<Number>(&value)) n->value = rounded(n->value), n->bound = rounded(n->bound);
  if (auto* p = std::get_if<Vec3>(&value)) *p = {rounded(p->x), rounded(p->y), rounded(p->z)};
  return value;
}

List sentences(const Findings& findings) {
  List all{{}, true};
  for (const Finding& f : findings) all.items.push_back(f.message());
  return all;
}

Fact fact_of(const Finding& f) {
  const auto said = f.row().values.begin() + static_cast<std::ptrdiff_t>(f.row().gaps());
  Fact fact(f.row().name, {f.row().values.begin(), said}, f.message());
  for (std::size_t i = f.row().gaps(); i < f.values.size(); ++i) fact = std::move(fact).with(f.row().values[i], f.values[i]);
  return fact;
}

nlohmann::ordered_json to_json(const Finding& f) {
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < f.values.size(); ++i) values[f.row().values[i]] = encode(f.values[i]);
  return {{"kind", f.row().name}, {"values", values}};
}

Finding finding_in(const nlohmann::json& json) {
  const auto& values = member_of(json, "values");
  const std::string name = text_in(json, "kind");
  const auto* const row = std::find_if(std::begin(k_findings), std::end(k_findings), [&](const FindingRow& r) { return name == r.name; });
  if (row == std::end(k_findings) || !values.is_object() || values.size() != row->count()) refuse();
  Finding f{static_cast<FindingKind>(row - k_findings), {}};
  try {
    for (std::size_t i = 0; i < row->count(); ++i) f.values.push_back(decode_value(member_of(values, row->values[i])));
  } catch (const std::invalid_argument&) {
    refuse();
  }
  return f;
}

Findings findings_in(const nlohmann::json& list) {
  if (!list.is_array() && !list.is_null()) refuse();
  Findings all;
  for (const auto& f : list) all.push_back(finding_in(f));
  return all;
}

}  // namespace cavum::grading
