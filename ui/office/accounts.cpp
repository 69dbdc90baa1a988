#include "ui/office/accounts.h"

#include <fmt/core.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/json_reader.h"
#include "engine/base/json_struct.h"
#include "engine/base/text.h"
#include "grading/records/decision.h"
#include "ui/office/one_time_code.h"

namespace cavum::office {

struct AccountsFile {
  std::vector<Account> accounts;
};
void json_fields(auto& of, JsonOf<Account> auto& self) {
  CAVUM_NAMES((name), (role), (code_secret), (known_as))
  of("password", self.password_hash);
}
void json_fields(auto& of, JsonOf<AccountsFile> auto& file) {
  of("format", JsonFormat{"cavum accounts 1"}), of("accounts", file.accounts);
}

namespace {

std::string hash_of(const std::string& password) {
  std::array<char, crypto_pwhash_STRBYTES> hash{};
  if (sodium_init() < 0 || crypto_pwhash_str(hash.data(), password.data(), password.size(),
                                             crypto_pwhash_OPSLIMIT_INTERACTIVE,
                                             crypto_pwhash_MEMLIMIT_INTERACTIVE) != 0)
    throw Error(msg("the password"), msg("cannot be hashed: there is no memory for it"),
                msg("close other programs"));
  return hash.data();
}

bool is_password(const std::string& hash, const std::string& password) {
  std::array<char, crypto_pwhash_STRBYTES> kept{};
  hash.copy(kept.data(), kept.size() - 1);
  return sodium_init() >= 0 &&
         crypto_pwhash_str_verify(kept.data(), password.data(), password.size()) == 0;
}

std::string in_address(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.')
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return out;
}

}  // namespace

std::vector<Account> Accounts::all() const {
  if (!std::filesystem::exists(path_)) return {};
  const JsonSource source{path_, msg("restore it, or remove it and add the accounts anew")};
  auto out = json_value_of<AccountsFile>(parse_json(read_text_file(path_), path_), source).accounts;
  for (const Account& a : out)
    if (a.name.empty() || !a.password_hash.starts_with("$argon2id$"))
      throw Error(path_, msg("is no file of accounts"), source.advice);
  return out;
}

std::optional<Account> Accounts::of(const std::string& name) const {
  for (auto& a : all())
    if (a.name == name) return a;
  return std::nullopt;
}

void Accounts::write(const std::vector<Account>& accounts) const {
  make_private_folder(std::filesystem::path(path_).parent_path().string());
  write_private_text_file(path_, to_json_value(AccountsFile{accounts}).dump(1) + "\n");
}

std::optional<Account> Accounts::called(const std::string& known_as) const {
  if (known_as.empty()) return std::nullopt;
  for (auto& a : all())
    if (a.known_as == known_as) return a;
  return std::nullopt;
}

Account Accounts::set(const std::string& name, Role role, const std::string& password,
                      bool second_factor, const std::string& known_as) {
  if (name.empty() || name.size() > records::k_longest_person || !is_plain_text(name))
    throw Error(msg("the account's name"), msg("is no line of text of at most 200 bytes"),
                msg("give the person's name: entries of the ledger will bear it"));
  if (password.size() < k_shortest_password || password.size() > k_longest_password)
    throw Error(msg("the password"), msg("has {} bytes", password.size()),
                msg("give {} to {}: four words that do not belong together", k_shortest_password,
                    k_longest_password));
  if (known_as.size() > records::k_longest_person ||
      (!known_as.empty() && !is_plain_text(known_as)))
    throw Error("--known-as", msg("is no line of text of at most 200 bytes"),
                msg("write it as the school's sign-on says it"));
  if (const auto other = called(known_as); other && other->name != name)
    throw Error("--known-as " + one_line(known_as), msg("is another account's"),
                msg("give each person one of his own"));
  Account made{name, role, hash_of(password), second_factor ? base32(new_code_secret()) : "",
               known_as};
  std::vector<Account> accounts = all();
  std::erase_if(accounts, [&](const Account& a) { return a.name == name; });
  accounts.push_back(made);
  write(accounts);
  return made;
}

void Accounts::remove(const std::string& name) {
  std::vector<Account> accounts = all();
  if (std::erase_if(accounts, [&](const Account& a) { return a.name == name; }) == 0)
    throw Error(msg("account {}", one_line(name)), msg("is not there"),
                msg("see `cavum serve --accounts`"));
  write(accounts);
}

std::optional<Account> Accounts::sign_in(const std::string& name,
                                         const std::string& password) const {
  static std::mutex one_at_a_time;
  static const std::string nobodys = hash_of("nobody has this password");
  if (password.size() > k_longest_password) return std::nullopt;
  const std::optional<Account> account = of(name);
  const std::lock_guard lock(one_at_a_time);
  const bool right = is_password(account ? account->password_hash : nobodys, password);
  return account && right ? account : std::nullopt;
}

std::string code_address(const Account& account, const std::string& school) {
  return fmt::format("otpauth://totp/Cavum:{}?secret={}&issuer={}", in_address(account.name),
                     account.code_secret, in_address("Cavum " + school));
}

}  // namespace cavum::office
