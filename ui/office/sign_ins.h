// Who is signed in: a cookie of 256 random bits for each, a token for requests that change
// something, an end after idleness and one after all. Nothing of it is kept on disk: who is signed
// in when the server ends signs in again.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "ui/office/accounts.h"

namespace cavum::office {

inline constexpr std::int64_t k_idle_end_s = 3600, k_absolute_end_s = 43'200;
inline constexpr std::size_t k_max_sign_ins = 1000;

struct SignedIn {
  Account account;
  std::string token;  ///< of requests that change something, 64 hexadecimal digits
  std::int64_t begun_s = 0, seen_s = 0;
  std::string proxied_as =
      {};  ///< where the proxy said who it is: it has to say so in each request
};

class SignIns {
 public:
  /// The new cookie's value, 64 hexadecimal digits. `now_s`: any clock that only goes forward, s.
  /// The oldest gives way beyond k_max_sign_ins. `proxied_as`: what the proxy says; empty for a
  /// password.
  std::string begin(const Account& account, std::int64_t now_s, const std::string& proxied_as = {});
  /// Who holds the cookie, and is seen now; none when it is not known, or its end has come.
  [[nodiscard]] std::optional<SignedIn> of(const std::string& cookie, std::int64_t now_s);
  /// The same without being seen: a page that only listens is no sign of a person.
  [[nodiscard]] bool lasts(const std::string& cookie, std::int64_t now_s);
  void end(const std::string& cookie);

 private:
  std::mutex lock_;
  std::map<std::string, SignedIn>
      by_hash_;  // of the cookie, so that no lookup tells by its time how much of a guess is right
};

/// Tries of a password or code: so many of one key within k_tries_s, then none until they are
/// older.
class Tries {
 public:
  static constexpr std::int64_t k_tries_s = 60;
  /// Counts one more. False: there were `most` already.
  [[nodiscard]] bool allow(const std::string& key, std::size_t most, std::int64_t now_s);
  /// It was right: forgotten.
  void forget(const std::string& key);

 private:
  struct Counted {
    std::int64_t since_s = 0;
    std::size_t n = 0;
  };
  std::mutex lock_;
  std::map<std::string, Counted> by_key_;
};

}  // namespace cavum::office
