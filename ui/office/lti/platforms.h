// Which learning platforms the office speaks with (LTI 1.3), as an officer has set them up, and the office's own keys for it: one file of the
// school's own folder, mode 0600. Beside it, for each ledger, what launches have told: courses with their gradebooks, and who is who there.
#pragma once

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ui/office/lti/keys.h"

namespace cavum::office {

/// What both sides agreed on. Addresses are https.
struct LtiPlatform {
  std::string name;                      ///< for people: "Moodle"
  std::string office;                    ///< this office as browsers reach it: "https://office.example:8443"
  std::string issuer, client_id;         ///< together they name the platform
  std::vector<std::string> deployments;  ///< ids; any other is refused
  std::string auth_endpoint, token_endpoint;
  std::string token_audience;      ///< `aud` of what we sign for the token endpoint; empty: that endpoint itself
  std::string jwks_url;            ///< empty: `key_set` stands in its place
  nlohmann::json key_set;          ///< {"keys":[…]}, or null
  std::string claim = "sub";       ///< by what candidates are matched: `sub`, `custom.NAME` or `lis.NAME`; its value is the number of the class list
  std::vector<std::string> hosts;  ///< further origins of its services ("https://school.example"), where these stand elsewhere than its endpoints
  std::string certificate;         ///< PEM of the authority, or of the server itself, that is trusted for it; empty: those that this computer trusts
  std::map<std::string, std::string> accounts;  ///< of the office, by the platform's `sub`
  [[nodiscard]] bool is(const std::string& other_issuer, const std::string& other_client) const {
    return issuer == other_issuer && client_id == other_client;
  }
  /// Whether the office may ask this address: https, and the host and port of an endpoint, or of `hosts`.
  [[nodiscard]] bool may_ask(const std::string& address) const;
};
[[nodiscard]] nlohmann::json json_of(const LtiPlatform& platform);
/// Throws Error for what is missing, or no address of https.
[[nodiscard]] LtiPlatform platform_in(const nlohmann::json& given);
/// "https://host[:port]" of an address, in small letters; empty when it is no plain address of https: credentials, blanks or a fragment are none.
[[nodiscard]] std::string origin_of(const std::string& address);

/// The file. Each call reads it, so that a platform that was removed is gone at once.
class LtiPlatforms {
 public:
  explicit LtiPlatforms(std::string path) : path_(std::move(path)) {}
  /// Throws Error when the file is none of platforms.
  [[nodiscard]] std::vector<LtiPlatform> all() const;
  [[nodiscard]] std::optional<LtiPlatform> of(const std::string& issuer, const std::string& client_id) const;
  /// Adds it, or takes the place of the one of that issuer and client; accounts that were linked stay.
  void set(LtiPlatform platform);
  /// Throws Error when there is none.
  void remove(const std::string& issuer, const std::string& client_id);
  /// Whoever comes as `sub` is this account; empty: nobody's any more. Throws Error when there is no such platform.
  void link(const std::string& issuer, const std::string& client_id, const std::string& sub, const std::string& account);
  /// The newest first, made at first use; the one before stays in the key set for whoever has not fetched the new one yet.
  [[nodiscard]] std::vector<LtiKey> keys();
  void rotate();

 private:
  struct File;
  [[nodiscard]] File read() const;
  void write(const File& file) const;
  std::string path_;
  static inline std::mutex lock_;
};

/// What the platform's administrator types in there: addresses of ours.
[[nodiscard]] nlohmann::json shown_addresses(const LtiPlatform& platform);

}  // namespace cavum::office
