// What stands between a request and its handler: is there such a door, who asks, may he, is it his own page that asks. Every handler is registered
// for a row of the table of doors, and is only reached through it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "ui/office/doors.h"
#include "ui/office/http_server.h"
#include "ui/office/proxy.h"
#include "ui/office/sign_ins.h"
#include "ui/office/station_request.h"

namespace cavum::office {

/// A request that was let in.
struct Call {
  Head head;
  std::string body;                           ///< empty where a handler takes it part by part
  std::string cookie;                         ///< of the sign-in, or of who came from a learning platform
  std::optional<SignedIn> by;                 ///< the person; where a door asks for one
  std::string proxied_as;                     ///< who it is, as the proxy says; empty: it does not
  std::string station;                        ///< key of the station; where a door asks for one
  std::string tail;                           ///< what stands for `*` in the door's path
  [[nodiscard]] nlohmann::json json() const;  ///< the body; throws Error when it is none
};
using Handler = std::function<Reply(const Call&)>;
/// Takes a body part by part, for what is too large to be held.
class Taker {
 public:
  virtual ~Taker() = default;
  virtual void take(std::string_view part) = 0;
  /// All of it came.
  virtual Reply done() = 0;
};
using MakeTaker = std::function<std::unique_ptr<Taker>(const Call&)>;

/// What a site asks about those who come.
struct Knows {
  std::function<std::optional<Account>(const std::string& name)> account;     ///< as it is now
  std::function<std::string(const std::string& public_key)> station_problem;  ///< empty: it is an enrolled one's
  std::function<std::int64_t()> now_s, utc_ns;
  std::string ledger;                                        ///< id
  std::optional<ProxySignOn> proxy = {};                     ///< none: nobody signs in by a proxy
  std::function<bool(const std::string& cookie)> came = {};  ///< whose cookie is that of somebody from a learning platform; empty: nobody's
};

class Site {
 public:
  explicit Site(Knows knows);
  /// Throws std::logic_error when the table has no such row, or it has a handler already.
  void on(const std::string& method, const std::string& path, Handler handler);
  void on_parts(const std::string& method, const std::string& path, MakeTaker taker);
  /// Throws std::logic_error when a row of the table has no handler.
  void require_complete() const;
  [[nodiscard]] SignIns& sign_ins() noexcept { return sign_ins_; }
  /// The person who was let in is still signed in, with the same account: for replies that go on.
  [[nodiscard]] bool still(const Call& call);

  [[nodiscard]] std::unique_ptr<Exchange> welcome(const Head& head);

 private:
  class Visit;
  struct Served {
    Handler whole;
    MakeTaker parts;
  };
  void put(const std::string& method, const std::string& path, Served served);
  /// Fills `call`, or says why not.
  [[nodiscard]] std::optional<Reply> refuse(const Door& door, Call& call, std::string& body_sha256);
  [[nodiscard]] std::optional<Reply> refuse_person(const Door& door, Call& call);
  [[nodiscard]] std::optional<Reply> refuse_station(Call& call, std::string& body_sha256);

  Knows knows_;
  SignIns sign_ins_;
  HeardRequests heard_;
  std::map<const Door*, Served> served_;
};

/// The cookie of the sign-in: its name keeps browsers from taking it over anything but HTTPS, or for another path or host.
inline constexpr char k_cookie[] = "__Host-cavum";
inline constexpr char k_visit_cookie[] = "__Host-cavum-visit";  ///< of who came from a learning platform
inline constexpr char k_token_field[] = "x-cavum-token";

/// Of `name=value; name=value`; empty when it is not there, or twice.
[[nodiscard]] std::string cookie_named(const std::string& field, std::string_view name);
/// {"error": ...} in the reader's language.
[[nodiscard]] Reply error_reply(int status, const std::string& english);
[[nodiscard]] Reply json_reply(const nlohmann::json& body, int status = 200);

}  // namespace cavum::office
