#include "ui/office/lti/client.h"

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "ui/office/lti/https.h"
#include "ui/office/lti/lti_error.h"

namespace cavum::office {
namespace {

using nlohmann::json;
using Steady = std::chrono::steady_clock;

constexpr auto k_patience = std::chrono::seconds(15);
constexpr std::chrono::seconds k_keys_last(3600), k_between_fetches(60);
constexpr std::uint64_t k_largest_answer = 1U << 20;

}  // namespace

PlatformAnswer ask_platform(const LtiPlatform& platform, const std::string& method,
                            const std::string& address,
                            const std::map<std::string, std::string>& fields,
                            const std::string& body, const std::atomic<bool>* stopped) {
  if (!platform.may_ask(address))
    throw Error(LtiError::address, Message(Name{one_line(address)}),
                msg("is no address of this platform that was set up"),
                msg("the office asks no other host, and nothing but https"));
  const HttpsAnswer answer =
      Https({platform.certificate, ""}, stopped)
          .ask({method, address, body, fields, k_patience, k_largest_answer, "Link"});
  if (!answer.wrong.empty())
    throw PlatformUnreachable(origin_of(address), msg("cannot be reached: {}", answer.wrong),
                              msg("it is tried again later"));
  return {static_cast<int>(answer.status),
          parse_json_or_null(answer.body, {k_largest_answer, 50'000, 16}), answer.field};
}

json PlatformKeys::of(const LtiPlatform& platform, const std::string& kid) {
  if (platform.jwks_url.empty()) return platform.key_set;
  const std::lock_guard guard(lock_);
  const auto now = Steady::now();
  const auto found = kept_.find(platform.jwks_url);
  if (found != kept_.end()) {
    const auto age = now - found->second.fetched;
    if (age < k_between_fetches || (age < k_keys_last && has_key(found->second.keys, kid)))
      return found->second.keys;
  }
  const PlatformAnswer answer =
      ask_platform(platform, "GET", platform.jwks_url, {{"Accept", "application/json"}});
  if (answer.status != 200 || !member_of(answer.body, "keys").is_array())
    throw PlatformUnreachable(origin_of(platform.jwks_url),
                              msg("does not show its keys ({})", answer.status),
                              msg("look at the address of its key set"));
  kept_[platform.jwks_url] = {answer.body, now};
  return answer.body;
}

}  // namespace cavum::office
