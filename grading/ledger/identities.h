// Who is behind a pseudonym: the only file with personal data, apart from ledger and sessions. Forgetting a candidate removes the
// row and its salt, after which nobody, not even the school with its key, can tell who sat under that pseudonym; all proofs stay valid.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/session/sqlite.h"
#include "grading/ledger/ledger_key.h"

namespace cavum {

struct Identity {
  std::string pseudonym;
  std::string id;    ///< how the school's other systems name the candidate: a matriculation number or mail address
  std::string name;  ///< for people; may be empty
};

class Identities {
 public:
  /// Opens the file; with `make` makes it (mode 0600). Throws Error, also when it is missing: names that are lost are restored, not begun anew.
  explicit Identities(const std::string& path, bool make = false);
  /// What does not hold, in words: a number or salt that does not give its pseudonym under the school's key, so that marks would go to somebody else.
  [[nodiscard]] std::vector<std::string> check(const SigningKey& school);
  /// The candidate's pseudonym: as before, or a new one. Throws Error when `id` is empty or no plain text.
  std::string enrol(const std::string& id, const std::string& name, const SigningKey& school);
  [[nodiscard]] std::optional<Identity> of_pseudonym(const std::string& pseudonym);
  [[nodiscard]] std::optional<Identity> of_id(const std::string& id);
  [[nodiscard]] std::vector<Identity> all();
  /// Removes the identity and overwrites its bytes. False when there is none.
  bool forget(const std::string& pseudonym);

 private:
  Database database_;
};

}  // namespace cavum
