#include "ui/office/site.h"

#include <sodium.h>

#include <algorithm>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/sqlite.h"
#include "grading/records/class_list.h"
#include "ui/language/say.h"

namespace cavum::office {
namespace {

constexpr std::size_t k_cookie_digits = 64;

bool equal(const std::string& a, const std::string& b) {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

/// Of a sign-in or a visit; empty when it is none.
std::string cookie_in(const std::string& field, std::string_view name) {
  std::string found = cookie_named(field, name);
  return found.size() == k_cookie_digits ? found : "";
}

}  // namespace

std::string cookie_named(const std::string& field, std::string_view name) {
  std::string found;
  bool twice = false;
  for (std::size_t at = 0; at < field.size();) {
    const auto end = std::min(field.find(';', at), field.size());
    const std::string_view one = without_blanks(std::string_view(field).substr(at, end - at));
    if (one.starts_with(name) && one.size() > name.size() && one[name.size()] == '=') {
      twice = twice || !found.empty();
      found = std::string(one.substr(name.size() + 1));
    }
    at = end + 1;
  }
  return twice ? "" : found;
}

nlohmann::json Call::json() const {
  return parse_json(body, msg("the request"), {8U << 20, 100'000, 16});
}

Reply error_reply(int status, const Message& message) {
  return json_reply({{"error", one_line(tr(message))}}, status);
}
Reply json_reply(const nlohmann::json& body, int status) {
  return {status, "application/json",
          body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

/// A request on its way to its handler.
class Site::Visit : public Exchange {
 public:
  Visit(Site& site, const Head& head) {
    call_.head = head;
    const Route* route = route_for(head.method, head.path);
    if (route == nullptr) {
      refusal_ = error_reply(404, msg("there is nothing here"));
      return;
    }
    largest_ = route->largest_bytes;
    call_.tail = tail_of(*route, head.path);
    guarded([&] {
      refusal_ = site.refuse(*route, call_, body_sha256_);
      served_ = &site.served_.at(route->name);
      if (!refusal_ && served_->parts) taker_ = served_->parts(call_);
    });
    if (!body_sha256_.empty()) crypto_hash_sha256_init(&hash_);
  }

  [[nodiscard]] const Reply* refusal() const override { return refusal_ ? &*refusal_ : nullptr; }
  [[nodiscard]] bool trusted() const override {
    return call_.by.has_value() || !call_.station.empty();
  }
  [[nodiscard]] std::uint64_t largest_bytes() const override { return largest_; }
  void take(std::string_view part) override {
    if (!body_sha256_.empty())
      crypto_hash_sha256_update(&hash_, reinterpret_cast<const unsigned char*>(part.data()),
                                part.size());
    if (taker_)
      taker_->take(part);
    else
      call_.body += part;
  }
  [[nodiscard]] Reply answer() override {
    Reply reply;
    guarded([&] {
      if (!body_sha256_.empty()) {
        Sha256 hash{};
        crypto_hash_sha256_final(&hash_, hash.data());
        if (to_hex(hash) != body_sha256_) {
          reply = error_reply(401, msg("the body is not the one that was signed"));
          return;
        }
      }
      reply = taker_ ? taker_->done() : served_->whole(call_);
    });
    return refusal_ ? *refusal_ : reply;
  }

 private:
  template <class Do>
  void guarded(const Do& what) {
    try {
      what();
    } catch (const Refused& e) {
      refusal_ = error_reply(e.status, e.message);
    } catch (const DatabaseError& e) {
      refusal_ = error_reply(507, e.message());
    } catch (const records::ListMistakes& e) {
      std::string lines;
      for (const Error& mistake : e.mistakes())
        lines += (lines.empty() ? "" : "\n") + one_line(tr(mistake.message()));
      refusal_ = json_reply({{"error", lines}}, 400);
    } catch (const Error& e) {
      refusal_ = error_reply(400, e.message());
    } catch (const std::bad_alloc&) {
      refusal_ = Reply{503, "application/json", R"({"error":"there is not enough memory"})"};
    } catch (const std::exception&) {  // its words may tell of our insides
      refusal_ = error_reply(500, msg("this did not work; nothing is said to have been done"));
    }
  }

  Call call_;
  std::optional<Reply> refusal_;
  std::uint64_t largest_ = 0;
  std::string body_sha256_;  // that a station signed
  crypto_hash_sha256_state hash_{};
  const Served* served_ = nullptr;
  std::unique_ptr<Taker> taker_;
};

Site::Site(Knows knows) : knows_(std::move(knows)), received_(knows_.utc_ns()) {}

std::unique_ptr<Exchange> Site::welcome(const Head& head) {
  return std::make_unique<Visit>(*this, head);
}

std::optional<Reply> Site::refuse(const Route& route, Call& call, std::string& body_sha256) {
  const ProxyWord proxied = proxy_word(call.head, knows_.proxy);
  if (proxied.refused)
    return error_reply(
        403, msg("a field of this request is the proxy's alone, and the proxy did not send it"));
  call.proxied_as = proxied.known_as;
  if (route.asks == Asks::form)  // of another place's page by its nature; its handler lets nobody
                                 // in without a platform's signature
    return call.head.field("content-type").starts_with("application/x-www-form-urlencoded")
               ? std::nullopt
               : std::optional(error_reply(415, msg("send a form")));
  // a page of another place cannot send this type without asking first, and is refused then
  if (route.method == "POST" && call.head.field("content-type") != "application/json")
    return error_reply(415, msg("say Content-Type: application/json"));
  if (const std::string origin = call.head.field("origin");
      !origin.empty() && route.changes() && origin != "https://" + call.head.field("host"))
    return error_reply(403, msg("another page asks this"));
  switch (route.asks) {
    case Asks::nobody:
    case Asks::form:
      return std::nullopt;
    case Asks::came:
      call.cookie = cookie_in(call.head.field("cookie"), k_visit_cookie);
      return knows_.came && knows_.came(call.cookie)
                 ? std::nullopt
                 : std::optional(error_reply(401, msg("open the link on the platform again")));
    case Asks::person:
      return refuse_person(route, call);
    case Asks::station:
      return refuse_station(call, body_sha256);
  }
  return error_reply(404, msg("there is nothing here"));
}

std::optional<Reply> Site::refuse_person(const Route& route, Call& call) {
  call.cookie = cookie_in(call.head.field("cookie"), k_cookie);
  call.by = sign_ins_.of(call.cookie, knows_.now_s());
  if (call.by && knows_.account(call.by->account.name) !=
                     call.by->account) {  // removed, or given another password or role
    sign_ins_.end(call.cookie);
    call.by.reset();
  }
  if (call.by && call.by->proxied_as != call.proxied_as && !call.by->proxied_as.empty())
    call.by.reset();  // not by the proxy, or by another person
  if (!call.by) return error_reply(401, msg("nobody is signed in"));
  if (!route.lets(call.by->account.role))
    return error_reply(403, msg("this account may not do that"));
  if (route.changes() && !equal(call.head.field(k_token_field), call.by->token))
    return error_reply(403, msg("the page's token is missing; load it again"));
  return std::nullopt;
}

bool Site::still(const Call& call) {
  return call.by && sign_ins_.lasts(call.cookie, knows_.now_s()) &&
         knows_.account(call.by->account.name) == call.by->account;
}

std::optional<Reply> Site::refuse_station(Call& call, std::string& body_sha256) {
  const std::string line = call.head.field(k_station_field);
  if (line.empty()) return error_reply(401, msg("no station has signed this request"));
  const auto refused = [&](const Message& why) {
    Reply reply = error_reply(401, why);
    reply.fields.emplace_back("X-Cavum-Time", std::to_string(knows_.utc_ns()));
    return reply;
  };
  StationRequest request;
  try {
    request = parse_request(line);
  } catch (const Error& wrong) {
    return refused(wrong.message());
  }
  const std::string target =
      call.head.path + (call.head.query.empty() ? "" : "?" + call.head.query);
  if (request.ledger != knows_.ledger || request.method != call.head.method ||
      request.path != target)
    return refused(msg("another request was signed"));
  if (const Message problem = knows_.station_problem(request.public_key); !problem.empty())
    return refused(problem);
  if (const Message problem = received_.hear(request, knows_.utc_ns()); !problem.empty())
    return refused(problem);
  body_sha256 = request.body_sha256.empty() ? "none" : request.body_sha256;
  call.station = request.public_key;
  return std::nullopt;
}

}  // namespace cavum::office
