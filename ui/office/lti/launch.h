// A person who comes from a learning platform: the login that the platform begins (OpenID Connect,
// third-party initiated), and the check of the token that it sends back. Whatever is not as LTI 1.3
// and its security framework want it is refused, in plain words.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "ui/office/lti/platforms.h"

namespace cavum::office {

/// Fields of a form or query: `name=value&…`. Throws Error when one stands twice, or is no plain
/// text.
[[nodiscard]] std::map<std::string, std::string> form_fields(std::string_view text);
[[nodiscard]] std::string url_encoded(std::string_view text);

/// Where a login is answered: the browser goes to `address`, and keeps `cookie` until it comes
/// back.
struct LtiLogin {
  std::string address, cookie;
};

/// What a token that holds has told.
struct LtiLaunch {
  LtiPlatform platform;
  std::string deployment, sub;
  std::string
      id;  ///< of the candidate, by the claim that was agreed on; empty: the platform does not tell
  std::string name;           ///< for people; may be empty
  bool teaches = false;       ///< an instructor's; else a learner's
  std::string context, link;  ///< ids of course and link; of the context empty where there is none
  std::string title;          ///< of the course, for people
  std::string exam;  ///< scenario id, of the link's own parameter `exam`; empty: none in particular
  nlohmann::json grades;  ///< the claim of Assignment and Grade Services; null: none
};

/// Seconds that a login may take, that clocks may differ by, and that a token may be old.
inline constexpr std::int64_t k_login_s = 600, k_skew_s = 60, k_oldest_token_s = 600;

class LtiLogins {
 public:
  LtiLogins();
  /// The answer to a login that `fields` ask for. Throws Error when no such platform was set up, or
  /// `target_link_uri` is none of ours.
  [[nodiscard]] LtiLogin begin(const LtiPlatforms& platforms,
                               const std::map<std::string, std::string>& fields,
                               std::int64_t now_s) const;
  /// The platform's keys for a token's `kid`; it may ask the platform for them.
  using KeysOf = std::function<nlohmann::json(const LtiPlatform&, const std::string& kid)>;
  /// What comes back with the cookie of its login. `now_s`: UTC. Throws Error in the words of what
  /// is wrong.
  [[nodiscard]] LtiLaunch finish(const LtiPlatforms& platforms,
                                 const std::map<std::string, std::string>& fields,
                                 const std::string& cookie, const KeysOf& keys_of,
                                 std::int64_t now_s);

 private:
  [[nodiscard]] std::string sealed(const std::string& text) const;
  std::string secret_;  // of this server's run
  std::mutex lock_;
  std::map<std::string, std::int64_t> used_;  // nonces whose token held, until their end
};

/// The claims of a token whose signature holds. Throws Error. `nonce`: of the login.
[[nodiscard]] LtiLaunch checked_claims(const nlohmann::json& claims, const LtiPlatform& platform,
                                       const std::string& nonce, std::int64_t now_s);

}  // namespace cavum::office
