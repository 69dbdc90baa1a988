// Which learning platforms the office speaks with (LTI 1.3), as an officer has set them up, and the
// office's own keys for it: one file of the school's own folder, mode 0600. Beside it, for each
// ledger, what launches have told: courses with their gradebooks, and who is who there.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/json_struct.h"
#include "ui/office/lti/keys.h"

namespace cavum::office {

// Paths of this office that a platform knows.
inline constexpr char k_lti_keys[] = "/lti/jwks", k_lti_login[] = "/lti/login",
                      k_lti_launch[] = "/lti/launch";

/// How what is sent to the office is read.
[[nodiscard]] inline JsonSource asked_json() {
  return {{}, msg("send it as docs/office.md says"), false};
}

using LtiLine = Text<1000>;
/// What both sides agreed on. Addresses are https. `name`: for people: "Moodle"; `office`: this
/// office as browsers reach it: "https://office.example:8443"; issuer and client together name the
/// platform; `deployments`: ids, any other is refused; `token_audience`: `aud` of what we sign for
/// the token endpoint, empty: that endpoint itself; `jwks_url`: empty: `key_set` stands in its
/// place, {"keys":[…]} or its text; `claim`: by what candidates are matched: `sub`, `custom.NAME`
/// or `lis.NAME`, its value is the number of the class list; `hosts`: further origins of its
/// services ("https://school.example"), where these stand elsewhere than its endpoints;
/// `certificate`: PEM of the authority, or of the server itself, that is trusted for it, empty:
/// those that this computer trusts; `accounts`: of the office, by the platform's `sub`.
struct LtiPlatform {
  using Ids = AtMost<std::vector<Text<255>>, 1000>;
  using Hosts = AtMost<std::vector<LtiLine>, 1000>;
  using People = std::map<std::string, Text<1000>>;
  CAVUM_FIELDS((LtiLine, name), (LtiLine, office), (LtiLine, issuer), (LtiLine, client_id),
               (Ids, deployments), (LtiLine, auth_endpoint), (LtiLine, token_endpoint),
               (LtiLine, token_audience, optional), (LtiLine, jwks_url, optional),
               (nlohmann::json, key_set, optional), (LtiLine, claim, optional),
               (Hosts, hosts, optional), (Text<1U << 20>, certificate, optional),
               (People, accounts, optional))
  [[nodiscard]] bool is(const std::string& other_issuer, const std::string& other_client) const {
    return issuer == other_issuer && client_id == other_client;
  }
  /// Whether the office may ask this address: https, and the host and port of an endpoint, or of
  /// `hosts`.
  [[nodiscard]] bool may_ask(const std::string& address) const;
};
/// With origins in the place of addresses. Throws Error for what is missing, or no address of
/// https.
[[nodiscard]] LtiPlatform sound_platform(LtiPlatform given);
[[nodiscard]] LtiPlatform platform_in(const nlohmann::json& given);
/// "https://host[:port]" of an address, in small letters; empty when it is no plain address of
/// https: credentials, blanks or a fragment are none.
[[nodiscard]] std::string origin_of(const std::string& address);

/// The file. Each call reads it, so that a platform that was removed is gone at once.
class LtiPlatforms {
 public:
  explicit LtiPlatforms(std::string path) : path_(std::move(path)) {}
  /// Throws Error when the file is none of platforms.
  [[nodiscard]] std::vector<LtiPlatform> all() const;
  [[nodiscard]] std::optional<LtiPlatform> of(const std::string& issuer,
                                              const std::string& client_id) const;
  /// Adds it, or takes the place of the one of that issuer and client; accounts that were linked
  /// stay, and none is linked by it.
  void set(LtiPlatform platform);
  /// Throws Error when there is none.
  void remove(const std::string& issuer, const std::string& client_id);
  /// Whoever comes as `sub` is this account; empty: nobody's any more. Throws Error when there is
  /// no such platform.
  void link(const std::string& issuer, const std::string& client_id, const std::string& sub,
            const std::string& account);
  /// The newest first, made at first use; the one before stays in the key set for whoever has not
  /// fetched the new one yet.
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
CAVUM_JSON(LtiAddresses, (std::string, tool), (std::string, login), (std::string, redirect),
           (std::string, keys))
[[nodiscard]] LtiAddresses addresses_for(const LtiPlatform& platform);

}  // namespace cavum::office
