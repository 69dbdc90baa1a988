// The force terms that there are, by name. A new term is one class, and one line in term_kinds.cpp; its
// parameters with their ranges are data here, so that reading, writing and fitting need no code of their own.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/toml_reader.h"
#include "engine/physics/force/force_term.h"

namespace cavum {

using ForceTermPtr = std::shared_ptr<const ForceTerm>;

struct TermParameter {
  const char* name;                 ///< ends in its unit
  double low, high;                 ///< range, inclusive
  std::optional<double> otherwise;  ///< value when the file does not give it; none = it must
};

struct TermKind {
  const char* name;  ///< as in [[terms]]
  std::vector<TermParameter> parameters;
  ForceTermPtr (*make)(const std::vector<double>& values);  ///< values in the order of `parameters`, in range
};

/// All of them, in fixed order.
[[nodiscard]] const std::vector<const TermKind*>& term_kinds();
/// nullptr when there is none of that name.
[[nodiscard]] const TermKind* find_term_kind(const std::string& name);

/// A term from its parameters; those not given take their defaults. Throws Error(where, ...) on an unknown kind or
/// parameter, one missing, or one out of range.
[[nodiscard]] ForceTermPtr make_force_term(const std::string& kind, const std::vector<std::pair<std::string, double>>& parameters,
                                           const std::string& where);
/// One table of [[terms]]. Throws Error(where:line:column, ...), naming the kinds that there are when it is another.
[[nodiscard]] ForceTermPtr read_force_term(const toml::table& table, const std::string& where);
/// The same as text: "[[terms]]\nkind = …\n", to be put at the end of a force model.
[[nodiscard]] std::string force_term_toml(const std::string& kind, const std::vector<std::pair<std::string, double>>& parameters);

}  // namespace cavum
