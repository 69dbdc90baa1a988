// Who may sign in at the office: names, roles, and the Argon2id hash of each password, in a file of
// the school's own folder, apart from the ledger.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "ui/office/routes.h"

namespace cavum::office {

struct Account {
  std::string name;  ///< of a person, as entries of the ledger will name him: one line
  Role role = Role::reader;
  std::string password_hash;  ///< Argon2id, as libsodium writes it
  std::string code_secret;    ///< of the second factor, base 32; empty: none
  std::string known_as = {};  ///< what the school's sign-on calls him (proxy.h); empty: he signs in
                              ///< by his password alone
  friend bool operator==(const Account&, const Account&) = default;
};

inline constexpr std::size_t k_shortest_password = 12, k_longest_password = 200;

/// The file. Each call reads it, so that an account that was removed is gone at once.
class Accounts {
 public:
  /// A file that is missing holds nobody.
  explicit Accounts(std::string path) : path_(std::move(path)) {}

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Throws Error when the file is none of accounts.
  [[nodiscard]] std::vector<Account> all() const;
  [[nodiscard]] std::optional<Account> of(const std::string& name) const;
  /// The account that the school's sign-on calls so; none for an empty name.
  [[nodiscard]] std::optional<Account> called(const std::string& known_as) const;
  /// Adds an account, or gives the one of that name another password and role. With `second_factor`
  /// a new secret is drawn. Throws Error when the name is no line of text, the password too short
  /// or too long, or another account is known as that.
  Account set(const std::string& name, Role role, const std::string& password, bool second_factor,
              const std::string& known_as = {});
  /// Throws Error when there is none.
  void remove(const std::string& name);
  /// The account whose password this is. Takes a tenth of a second, as long for a name that nobody
  /// has; one at a time, for the memory that it takes.
  [[nodiscard]] std::optional<Account> sign_in(const std::string& name,
                                               const std::string& password) const;

 private:
  void write(const std::vector<Account>& accounts) const;

  std::string path_;
};

/// "otpauth://totp/…" as authenticator apps read it.
[[nodiscard]] std::string code_address(const Account& account, const std::string& school);

}  // namespace cavum::office
