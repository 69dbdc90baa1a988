#include "grading/records/regrade.h"

#include <fmt/core.h>

#include "engine/base/file.h"
#include "grading/records/reason.h"
#include "scenarios/file/parse.h"

namespace cavum::records {
namespace {

constexpr char k_rubric[] = "rubric.toml", k_scenario[] = "scenario.toml",
               k_attachment[] = "attachment/";

}  // namespace

RegradeBasis read_basis(const std::string& rubric_path, const std::string& scenario_path) {
  RegradeBasis basis;
  if (!scenario_path.empty()) {
    basis.scenario_toml = read_text_file(scenario_path);
    scenarios::Scenario s = scenarios::parse_scenario(basis.scenario_toml, scenario_path);
    scenarios::require_none(scenarios::read_surfaces(s, basis.surfaces));
  }
  if (!rubric_path.empty()) {
    basis.rubric_toml = read_text_file(rubric_path);
    static_cast<void>(scenarios::parse_rubric(basis.rubric_toml, rubric_path));
  }
  return basis;
}

std::optional<RegradeBasis> kept_basis(const LedgerContent& content, const Regrade& regrade) {
  if (regrade.documents.empty()) return {};
  RegradeBasis basis;
  for (const auto& [name, hash] : regrade.documents) {
    const auto found = content.documents.find(hash);
    if (found == content.documents.end())
      throw Error(msg("entry {}", regrade.seq),
                  msg("the {} that its result was marked by is not in the ledger", name),
                  msg("restore ledger.db from its backup"));
    const Bytes& bytes = found->second;
    if (name == k_rubric) basis.rubric_toml.assign(bytes.begin(), bytes.end());
    if (name == k_scenario) basis.scenario_toml.assign(bytes.begin(), bytes.end());
    if (name.starts_with(k_attachment))
      basis.surfaces.emplace_back(name.substr(sizeof k_attachment - 1), bytes);
  }
  return basis;
}

std::optional<scenarios::Scenario> scenario_of(const RegradeBasis& basis,
                                               const std::string& where) {
  if (basis.scenario_toml.empty()) return {};
  scenarios::Scenario s = scenarios::parse_scenario(basis.scenario_toml, where);
  scenarios::use_surfaces(s, basis.surfaces);
  return s;
}

std::optional<scenarios::RubricSpec> rubric_of(const RegradeBasis& basis,
                                               const std::string& where) {
  if (basis.rubric_toml.empty()) return {};
  return scenarios::parse_rubric(basis.rubric_toml, where);
}

StoredParts stored_parts(const RegradeBasis& basis) {
  StoredParts out;
  const auto keep = [&](const std::string& name, Bytes bytes) {
    out.by[name] = to_hex(sha256(bytes));
    out.documents.push_back(std::move(bytes));
  };
  if (!basis.rubric_toml.empty())
    keep(k_rubric, {basis.rubric_toml.begin(), basis.rubric_toml.end()});
  if (!basis.scenario_toml.empty())
    keep(k_scenario, {basis.scenario_toml.begin(), basis.scenario_toml.end()});
  for (const auto& [name, bytes] : basis.surfaces) keep(k_attachment + name, bytes);
  return out;
}

const LedgerEntry& enter_regrade(Ledger& ledger, std::uint64_t session,
                                 const nlohmann::json& result, const RegradeBasis& basis,
                                 const std::string& reason) {
  require_reason(reason);
  const StoredParts parts = stored_parts(basis);
  return ledger.append(
      [&](const LedgerContent&) {
        return RegradeEntry{session, make_opening(result), parts.by, ""};
      },
      reason, parts.documents);
}

}  // namespace cavum::records
