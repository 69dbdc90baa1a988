// Tokens of learning platforms: JSON Web Signatures (RFC 7515) by RS256 and by nothing else, and
// the keys behind them (RFC 7517). No header of a token chooses how it is checked: another
// algorithm, a key that it brings or an address of one is refused or passed over.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cavum::office {

/// One of the office's own keys, RSA of 3072 bits.
struct LtiKey {
  std::string kid;
  std::string pem;  ///< PKCS #8
  std::int64_t made_utc_ns = 0;
};
[[nodiscard]] LtiKey new_lti_key(std::int64_t utc_ns);
/// {"keys":[…]}: the public halves. Throws Error when a key cannot be read.
[[nodiscard]] nlohmann::json public_key_set(const std::vector<LtiKey>& keys);
/// header.payload.signature, signed by RS256. Throws Error when the key cannot be read.
[[nodiscard]] std::string sign_token(const nlohmann::json& claims, const LtiKey& key);

/// Base64::in_address, of text.
[[nodiscard]] std::string to_base64url(std::string_view bytes);
[[nodiscard]] std::optional<std::string> from_base64url(std::string_view text);

/// A token whose signature has not been looked at.
struct ReadToken {
  std::string kid;
  nlohmann::json claims;
  std::string signed_text, signature;
};
/// Throws Error when it is no JWS of three parts, its algorithm is not RS256, it names no key or
/// something critical, or a name stands twice in it.
[[nodiscard]] ReadToken read_token(const std::string& token);
/// Whether `keys`, a key set (JWK), has a key of that name.
[[nodiscard]] bool has_key(const nlohmann::json& keys, const std::string& kid);
/// Throws Error when no RSA key of at least 2048 bits in `keys` has the token's `kid`, two have, or
/// the signature is not by it.
void require_signed(const ReadToken& token, const nlohmann::json& keys);

}  // namespace cavum::office
