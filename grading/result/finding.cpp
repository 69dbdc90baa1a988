#include "grading/result/finding.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "engine/base/error.h"
#include "grading/result/result_json.h"

namespace cavum::grading {
namespace {

[[noreturn]] void refuse() {
  throw Error(msg("result"), msg("is none as grading writes it"), msg("use an intact copy"));
}

}  // namespace

Value finding_detail::as_sealed(Value value) {
  if (auto* n = std::get_if<Number>(&value))
    n->value = rounded(n->value), n->bound = rounded(n->bound);
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
  for (std::size_t i = f.row().gaps(); i < f.values.size(); ++i)
    fact = std::move(fact).with(f.row().values[i], f.values[i]);
  return fact;
}

nlohmann::ordered_json to_json(const Finding& f) { return encode(f.row(), f.values); }

Finding finding_in(const nlohmann::json& json) {
  try {
    return {decode_fact<FindingKind>(json)};
  } catch (const std::invalid_argument&) {
    refuse();
  }
}

Findings findings_in(const nlohmann::json& list) {
  if (!list.is_array() && !list.is_null()) refuse();
  Findings all;
  for (const auto& f : list) all.push_back(finding_in(f));
  return all;
}

}  // namespace cavum::grading
