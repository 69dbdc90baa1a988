// What the office asks of a learning platform over HTTPS: its keys, a token, its gradebook. Only
// addresses of hosts that an officer set up are asked, no redirect is followed, and no answer is
// read beyond a limit.
#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/base/error.h"
#include "ui/office/lti/platforms.h"

namespace cavum::office {

/// The platform does not answer, or cannot be spoken with safely: it is tried again later.
class PlatformUnreachable : public Error {
 public:
  using Error::Error;
};

struct PlatformAnswer {
  int status = 0;
  nlohmann::json body;  ///< null where it is no JSON
  std::string link;     ///< the field `Link`, of a list with more pages
};

/// One request, in a connection of its own. Throws Error for an address that this platform may not
/// name, PlatformUnreachable when nothing comes back. Once `stopped` is true, it ends within a
/// second.
[[nodiscard]] PlatformAnswer ask_platform(const LtiPlatform& platform, const std::string& method,
                                          const std::string& address,
                                          const std::map<std::string, std::string>& fields = {},
                                          const std::string& body = "",
                                          const std::atomic<bool>* stopped = nullptr);

/// Keys of platforms, kept for an hour; those of a platform whose key is not among them are fetched
/// anew, once in a minute at most.
class PlatformKeys {
 public:
  /// A key set. Throws as ask_platform does, and PlatformUnreachable when the platform answers with
  /// anything else.
  [[nodiscard]] nlohmann::json of(const LtiPlatform& platform, const std::string& kid);

 private:
  struct Kept {
    nlohmann::json keys;
    std::chrono::steady_clock::time_point fetched;
  };
  std::mutex lock_;
  std::map<std::string, Kept> kept_;  // by address
};

}  // namespace cavum::office
