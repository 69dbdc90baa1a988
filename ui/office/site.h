// What stands between a request and its handler: is there such a route, who asks, may he, is it his
// own page that asks. Every handler is registered for a row of the table of routes, and is only
// reached through it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "ui/office/http_server.h"
#include "ui/office/proxy.h"
#include "ui/office/routes.h"
#include "ui/office/sign_ins.h"
#include "ui/office/station_request.h"

namespace cavum::office {

/// A request that was let in.
struct Call {
  Head head;
  std::string body;            ///< empty where a handler takes it part by part
  std::string cookie;          ///< of the sign-in, or of who came from a learning platform
  std::optional<SignedIn> by;  ///< the person; where a route asks for one
  std::string proxied_as;      ///< who it is, as the proxy says; empty: it does not
  std::string station;         ///< key of the station; where a route asks for one
  std::string tail;            ///< what stands for `*` in the route's path
  [[nodiscard]] nlohmann::json json() const;  ///< the body; throws Error when it is none
};
/// Thrown by a handler: answered with this status.
struct Refused {
  int status;
  Message message;
};
/// An answer with another status than 200, or fields of its own.
template <class Answer>
struct Answered {
  Answered(Answer answer, int with = 200) : body(std::move(answer)), status(with) {}
  Answered(Answer answer, const std::string& cookie)
      : body(std::move(answer)), fields{{"Set-Cookie", cookie}} {}
  Answer body;
  int status = 200;
  std::vector<std::pair<std::string, std::string>> fields = {};
};
/// A reply that goes on with events, each an Event.
template <class Event>
struct Stream {
  using Answer = EventsOf<Event>;
  Reply stream;
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
  std::function<std::optional<Account>(const std::string& name)> account;  ///< as it is now
  std::function<Message(const std::string& public_key)>
      station_problem;  ///< empty: it is an enrolled one's
  std::function<std::int64_t()> now_s, utc_ns;
  std::string ledger;                     ///< id
  std::optional<ProxySignOn> proxy = {};  ///< none: nobody signs in by a proxy
  std::function<bool(const std::string& cookie)> came =
      {};  ///< whose cookie is that of somebody from a learning platform; empty: nobody's
};

class Site {
 public:
  explicit Site(Knows knows);
  /// Before the first request.
  void on(const Route& route, Handler handler) { served_[route.name].whole = std::move(handler); }
  void on_parts(const Route& route, MakeTaker taker) {
    served_[route.name].parts = std::move(taker);
  }
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
  /// Fills `call`, or says why not.
  [[nodiscard]] std::optional<Reply> refuse(const Route& route, Call& call,
                                            std::string& body_sha256);
  [[nodiscard]] std::optional<Reply> refuse_person(const Route& route, Call& call);
  [[nodiscard]] std::optional<Reply> refuse_station(Call& call, std::string& body_sha256);

  Knows knows_;
  SignIns sign_ins_;
  ReceivedRequests received_;
  std::map<std::string_view, Served> served_;  // by the route's name
};

/// The cookie of the sign-in: its name keeps browsers from taking it over anything but HTTPS, or
/// for another path or host.
inline constexpr char k_cookie[] = "__Host-cavum";
inline constexpr char k_visit_cookie[] =
    "__Host-cavum-visit";  ///< of who came from a learning platform
inline constexpr char k_token_field[] = "x-cavum-token";

/// Of `name=value; name=value`; empty when it is not there, or twice.
[[nodiscard]] std::string cookie_named(const std::string& field, std::string_view name);
/// {"error": ...} in the reader's language.
[[nodiscard]] Reply error_reply(int status, const Message& message);
[[nodiscard]] Reply json_reply(const nlohmann::json& body, int status = 200);

}  // namespace cavum::office
