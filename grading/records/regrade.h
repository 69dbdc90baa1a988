// What a filed exam is marked anew by: a rubric, or a corrected scenario with its STL files. The
// ledger keeps it with the new result, so that the result can be made again and its report written
// without any file from elsewhere.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grading/records/ledger.h"
#include "grading/records/registry.h"
#include "scenarios/file/surface_files.h"

namespace cavum::records {

struct RegradeBasis {
  std::string rubric_toml,
      scenario_toml;  ///< empty: none; with both, the scenario's zones and the rubric count
  scenarios::SurfaceFiles surfaces;  ///< of the scenario
};

/// Reads the files; an empty path is none. Throws Error when one is no rubric or scenario, or an
/// STL is missing.
[[nodiscard]] RegradeBasis read_basis(const std::string& rubric_path,
                                      const std::string& scenario_path);
/// What the ledger keeps of a regrade; nothing for a decision on a result that was marked on
/// filing.
[[nodiscard]] std::optional<RegradeBasis> kept_basis(const LedgerContent& content,
                                                     const Regrade& regrade);
/// As it is marked by; nothing when the basis has none. `where` names it in errors.
[[nodiscard]] std::optional<scenarios::Scenario> scenario_of(const RegradeBasis& basis,
                                                             const std::string& where);
[[nodiscard]] std::optional<scenarios::RubricSpec> rubric_of(const RegradeBasis& basis,
                                                             const std::string& where);

/// A basis as an entry names it and the ledger keeps it.
struct StoredParts {
  std::map<std::string, std::string> by;  ///< name and SHA-256 (hexadecimal) of each document
  std::vector<Bytes> documents;           ///< of the same
};
[[nodiscard]] StoredParts stored_parts(const RegradeBasis& basis);

/// Enters the result of marking the session of entry `session` by `basis`, and keeps that. Throws
/// Error when `reason` is empty, too long or no plain text.
const LedgerEntry& enter_regrade(Ledger& ledger, std::uint64_t session,
                                 const nlohmann::json& result, const RegradeBasis& basis,
                                 const std::string& reason);

}  // namespace cavum::records
