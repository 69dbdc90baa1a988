// The force terms that there are, by name; each is a record in term_laws.h. Its parameters with
// their ranges are data, so that reading, writing and fitting need no code of their own.
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
  const char* name;    ///< as in [[terms]]
  const char* adds;    ///< its formula
  const char* source;  ///< of the formula; "" without one
  const char* notes;   ///< and which values have no source
  std::vector<TermParameter> parameters;
  /// ForceTerm::evaluate; `p`: values in the order of `parameters`, in range.
  TermForce (*law)(const double* p, const TermInput& in, TermMemory& memory) noexcept;
  bool counts_removed = false;  ///< it looks at what was removed
};

/// All of them, in fixed order.
[[nodiscard]] const std::vector<TermKind>& term_kinds();
/// nullptr when there is none of that name.
[[nodiscard]] const TermKind* find_term_kind(const std::string& name);

/// A term from its parameters; those not given take their defaults. Throws Error(where, ...) on an
/// unknown kind or parameter, one missing, or one out of range.
[[nodiscard]] ForceTermPtr make_force_term(
    const std::string& kind, const std::vector<std::pair<std::string, double>>& parameters,
    const std::string& where);
/// One table of [[terms]]. Throws Error(where:line:column, ...), naming the kinds that there are
/// when it is another.
[[nodiscard]] ForceTermPtr read_force_term(const toml::table& table, const std::string& where);
/// The same as text: "[[terms]]\nkind = …\n", to be put at the end of a force model.
[[nodiscard]] std::string force_term_toml(
    const std::string& kind, const std::vector<std::pair<std::string, double>>& parameters);

}  // namespace cavum
