// The second factor of an account: six digits that change every 30 s, as authenticator apps make
// them of a shared secret. Source: RFC 6238 (TOTP with HMAC-SHA-1, T0 = 0, X = 30 s) over RFC 4226
// (HOTP); secrets in base 32, RFC 4648, section 6.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "engine/base/bytes.h"

namespace cavum::office {

inline constexpr std::int64_t k_code_step_s = 30;

/// The code of a counter, with `digits` digits (6 to 8).
[[nodiscard]] std::string one_time_code(const Bytes& secret, std::uint64_t counter, int digits = 6);
/// The latest counter within one step of `unix_s` whose code this is; a code is good once, so take
/// none up to the one that was taken last. None: it is not good.
[[nodiscard]] std::optional<std::uint64_t> counter_of_code(const Bytes& secret,
                                                           const std::string& code,
                                                           std::int64_t unix_s);
/// Which codes were used, also before a restart: the last counter of each account lies in a file.
class UsedCodes {
 public:
  /// Throws Error for a file that is none.
  explicit UsedCodes(std::string path);
  /// False where this counter or a later one was used. Throws Error when it cannot be kept; the
  /// code is then as good as before.
  [[nodiscard]] bool use(const std::string& account, std::uint64_t counter);

 private:
  std::string path_;
  std::mutex lock_;
  std::map<std::string, std::uint64_t> last_;
};
/// 160 random bits.
[[nodiscard]] Bytes new_code_secret();
/// As people type it, without padding.
[[nodiscard]] std::string base32(const Bytes& bytes);
/// None for what is no base 32.
[[nodiscard]] std::optional<Bytes> from_base32(const std::string& text);

}  // namespace cavum::office
