#include "ui/office/lti/client.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "ui/office/lti/lti_error.h"

namespace cavum::office {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using nlohmann::json;
using Tcp = asio::ip::tcp;
using Steady = std::chrono::steady_clock;

constexpr auto k_patience = std::chrono::seconds(15);
constexpr std::chrono::seconds k_keys_last(3600), k_between_fetches(60);
constexpr std::uint64_t k_largest_answer = 1U << 20;
constexpr unsigned k_http_1_1 = 11;

struct PlaceOf {
  std::string host, port, target;
};

PlaceOf place_of(const std::string& address) {
  const std::string rest = address.substr(std::string_view("https://").size());
  const auto slash = std::min(rest.find_first_of("/?"), rest.size());
  std::string host = rest.substr(0, slash), port = "443", target = rest.substr(slash);
  if (const auto colon = host.rfind(':'); colon != std::string::npos && host.find(']', colon) == std::string::npos) {
    port = host.substr(colon + 1);
    host.resize(colon);
  }
  if (host.starts_with('[')) host = host.substr(1, host.size() - 2);
  if (!target.starts_with('/')) target = "/" + target;
  return {host, port, target};
}

}  // namespace

PlatformAnswer ask_platform(const LtiPlatform& platform, const std::string& method, const std::string& address,
                            const std::map<std::string, std::string>& fields, const std::string& body) {
  if (!platform.may_ask(address))
    throw Error(LtiError::address, Message(Name{one_line(address)}), msg("is no address of this platform that was set up"),
                msg("the office asks no other host, and nothing but https"));
  const PlaceOf place = place_of(address);
  asio::io_context context;
  asio::ssl::context tls(asio::ssl::context::tls_client);
  tls.set_options(asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1);
  beast::error_code wrong;
  if (platform.certificate.empty())
    tls.set_default_verify_paths(wrong);
  else
    tls.add_certificate_authority(asio::buffer(platform.certificate), wrong);
  if (wrong) throw Error(msg("the platform's certificate"), msg("cannot be read: {}", wrong.message()), msg("give it as PEM"));
  beast::ssl_stream<beast::tcp_stream> stream(context, tls);
  stream.set_verify_mode(asio::ssl::verify_peer);
  stream.set_verify_callback(asio::ssl::host_name_verification(place.host));
  SSL_set_tlsext_host_name(stream.native_handle(), place.host.c_str());
  beast::get_lowest_layer(stream).expires_after(k_patience);
  const auto wait = [&](const auto& begin) {
    beast::error_code outcome = beast::error::timeout;
    begin([&outcome](beast::error_code error, auto&&...) { outcome = error; });
    context.restart();
    context.run();
    if (outcome) throw PlatformUnreachable(origin_of(address), msg("cannot be reached: {}", outcome.message()), msg("it is tried again later"));
  };
  Tcp::resolver resolver(context);
  const auto ends = resolver.resolve(place.host, place.port, wrong);
  if (wrong) throw PlatformUnreachable(origin_of(address), msg("cannot be found: {}", wrong.message()), msg("it is tried again later"));
  http::request<http::string_body> request(http::string_to_verb(method), place.target, k_http_1_1, body);
  request.set(http::field::host, origin_of(address).substr(std::string_view("https://").size()));
  request.set(http::field::user_agent, "Cavum");
  for (const auto& [name, value] : fields) request.set(name, value);
  request.prepare_payload();
  http::response_parser<http::string_body> parser;
  parser.body_limit(k_largest_answer);
  beast::flat_buffer heard;
  wait([&](auto done) { beast::get_lowest_layer(stream).async_connect(ends, done); });
  wait([&](auto done) { stream.async_handshake(asio::ssl::stream_base::client, done); });
  wait([&](auto done) { http::async_write(stream, request, done); });
  wait([&](auto done) { http::async_read(stream, heard, parser, done); });
  const auto& reply = parser.get();
  return {static_cast<int>(reply.result_int()), parse_json_or_null(reply.body(), {k_largest_answer, 50'000, 16}), std::string(reply["Link"])};
}

json PlatformKeys::of(const LtiPlatform& platform, const std::string& kid) {
  if (platform.jwks_url.empty()) return platform.key_set;
  const std::lock_guard guard(lock_);
  const auto now = Steady::now();
  const auto found = kept_.find(platform.jwks_url);
  if (found != kept_.end()) {
    const auto age = now - found->second.fetched;
    if (age < k_between_fetches || (age < k_keys_last && has_key(found->second.keys, kid))) return found->second.keys;
  }
  const PlatformAnswer answer = ask_platform(platform, "GET", platform.jwks_url, {{"Accept", "application/json"}});
  if (answer.status != 200 || !member_of(answer.body, "keys").is_array())
    throw PlatformUnreachable(origin_of(platform.jwks_url), msg("does not show its keys ({})", answer.status),
                              msg("look at the address of its key set"));
  kept_[platform.jwks_url] = {answer.body, now};
  return answer.body;
}

}  // namespace cavum::office
