#include "tests/ui/office/web.h"

#include <fmt/core.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

namespace cavum::testing_office {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
constexpr auto k_wait = std::chrono::seconds(60);

}  // namespace

struct Wire::Parts {
  asio::io_context context;
  asio::ssl::context tls{asio::ssl::context::tls_client};
  beast::ssl_stream<beast::tcp_stream> stream{context, tls};
  beast::flat_buffer heard;

  template <class Begin>
  beast::error_code wait(std::chrono::milliseconds time, const Begin& begin) {
    beast::error_code outcome = beast::error::timeout;
    beast::get_lowest_layer(stream).expires_after(time);
    begin([&](beast::error_code error, auto&&...) { outcome = error; });
    context.restart();
    context.run();
    return outcome;
  }
};

Wire::Wire(std::uint16_t port) : parts_(std::make_unique<Parts>()) {
  const asio::ip::tcp::endpoint end(asio::ip::make_address("127.0.0.1"), port);
  if (!parts_->wait(k_wait, [&](auto done) {
        beast::get_lowest_layer(parts_->stream).async_connect(end, done);
      }))
    parts_->wait(k_wait, [&](auto done) {
      parts_->stream.async_handshake(asio::ssl::stream_base::client, done);
    });
}
Wire::~Wire() = default;

bool Wire::send(const std::string& bytes) {
  return !parts_->wait(
      k_wait, [&](auto done) { asio::async_write(parts_->stream, asio::buffer(bytes), done); });
}

Heard Wire::hear() {
  http::response_parser<http::string_body> parser;
  parser.body_limit(64U << 20);
  Heard out;
  if (parts_->wait(k_wait, [&](auto done) {
        http::async_read(parts_->stream, parts_->heard, parser, done);
      }))
    return out;
  out.status = static_cast<int>(parser.get().result_int());
  out.body = parser.get().body();
  for (const auto& f : parser.get()) {
    std::string name(f.name_string());
    for (char& c : name) c = static_cast<char>(std::tolower(c));
    out.fields[name] = std::string(f.value());
  }
  return out;
}

std::string Wire::hear_for(std::chrono::milliseconds time,
                           const std::function<bool(const std::string&)>& enough) {
  std::string out, piece(64U << 10, '\0');
  beast::get_lowest_layer(parts_->stream).expires_after(time);
  for (bool ended = false; !ended && !(enough && enough(out));) {
    ended = true;
    parts_->stream.async_read_some(asio::buffer(piece),
                                   [&](beast::error_code error, std::size_t more) {
                                     out.append(piece, 0, more);
                                     ended = error.failed();
                                   });
    parts_->context.restart();
    parts_->context.run();
  }
  return out;
}

Heard Visitor::ask(const std::string& method, const std::string& path, const std::string& body,
                   const std::map<std::string, std::string>& more) const {
  std::map<std::string, std::string> fields{{"Host", "127.0.0.1"},
                                            {"Content-Length", std::to_string(body.size())}};
  if (method != "GET") fields["Content-Type"] = "application/json";
  if (!cookie.empty()) fields["Cookie"] = "__Host-cavum=" + cookie;
  if (!token.empty() && method != "GET") fields["X-Cavum-Token"] = token;
  for (const auto& [name, value] : more) fields[name] = value;
  std::string text = fmt::format("{} {} HTTP/1.1\r\n", method, path);
  for (const auto& [name, value] : fields)
    if (value != "-") text += name + ": " + value + "\r\n";
  Wire wire(port);
  wire.send(text + "\r\n" + body);
  return wire.hear();
}

Heard Visitor::sign_in(const std::string& name, const std::string& password) {
  Heard heard =
      ask("POST", "/api/sign-in", nlohmann::json{{"name", name}, {"password", password}}.dump());
  if (heard.status != 200) return heard;
  token = heard.json()["token"];
  const std::string set = heard.fields.at("set-cookie");
  cookie = set.substr(set.find('=') + 1, 64);
  return heard;
}

}  // namespace cavum::testing_office
