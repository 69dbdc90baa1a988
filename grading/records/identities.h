// Who is behind a pseudonym: the only file with names, apart from ledger and sessions. A candidate
// has a pseudonym for each exam, drawn, so that nothing but this file leads from one to another or
// to a person. Forgetting removes the rows, after which nobody, not even the school with its key,
// can tell who sat; all proofs stay valid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/session/sqlite.h"
#include "grading/records/finding.h"
#include "grading/records/ledger_key.h"

namespace cavum::records {

struct Identity {
  std::string pseudonym;
  std::string exam;  ///< id of the scenario
  std::string id;  ///< how the school's other systems name the candidate: a matriculation number or
                   ///< mail address
  std::string name;  ///< for people; may be empty
};

class Identities {
 public:
  /// Opens the file; with `make` makes it (mode 0600). Throws Error, also when it is missing: names
  /// that are lost are restored, not begun anew.
  explicit Identities(const std::string& path, bool make = false);
  /// What does not hold: a row that the school's key did not seal, so that marks would go to
  /// somebody else.
  [[nodiscard]] Findings check(const SigningKey& school);
  /// Seals all rows with another key of the school. Throws Error when neither `before` nor `now`
  /// has sealed one of them.
  void seal_again(const SigningKey& before, const SigningKey& now);
  /// The candidate's pseudonym for an exam: as before, or a new one. Throws Error when `id` is
  /// empty or no plain text.
  std::string enrol(const std::string& id, const std::string& name, const std::string& exam,
                    const SigningKey& school);
  [[nodiscard]] std::optional<Identity> of_pseudonym(const std::string& pseudonym);
  /// All pseudonyms of the school's own number; none when it is not known.
  [[nodiscard]] std::vector<Identity> of_id(const std::string& id);
  /// Those of the person whom `who` names, by number or pseudonym.
  [[nodiscard]] std::vector<Identity> of_person(const std::string& who);
  [[nodiscard]] std::vector<Identity> all();
  /// Removes the identity and overwrites its bytes. False when there is none.
  bool forget(const std::string& pseudonym);

 private:
  Database database_;
};

}  // namespace cavum::records
