// What is said over one connection, in HTTP/1.1 (Boost.Beast), over any stream: heads, lengths of
// bodies, replies. The server gives it TLS, a fuzzer bytes.
#pragma once

#include <fmt/core.h>

#include <array>
#include <atomic>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "ui/office/http_server.h"

namespace cavum::office {
namespace http_talk {

namespace asio = boost::asio;
namespace http = boost::beast::http;

inline constexpr unsigned k_http_1_1 = 11;

/// What every reply says to a browser.
inline constexpr std::pair<const char*, const char*> k_always[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; form-action 'self'; frame-ancestors 'none'; "
     "base-uri 'none'"},
    {"Strict-Transport-Security", "max-age=31536000"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-store"}};

inline std::string small(boost::beast::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// None: a field stands twice, or the target is no path.
inline std::optional<Head> head_of(const http::request_header<>& read, const std::string& address) {
  Head head;
  head.address = address;
  head.method = std::string(read.method_string());
  const std::string target(read.target());
  if (!target.starts_with('/')) return std::nullopt;
  const auto question = target.find('?');
  head.path = target.substr(0, question);
  if (question != std::string::npos) head.query = target.substr(question + 1);
  for (const auto& field : read)
    if (!head.fields.emplace(small(field.name_string()), std::string(field.value())).second)
      return std::nullopt;
  return head;
}

inline Reply refused(int status, const char* why) {
  return {status, "application/json", fmt::format(R"({{"error":"{}"}})", why)};
}

/// What a conversation needs from whoever holds the connection; all of it outlives the
/// conversation.
struct Needs {
  const Welcome& welcome;
  const HttpLimits& limits;
  const std::string& address;  ///< of who asks
  const std::function<void(std::int64_t)>&
      allow;  ///< so many seconds from now on, whatever was allowed before
  const std::atomic<bool>& stopping;
};

template <class Stream>
class Talk {
 public:
  Talk(Stream& stream, const Needs& needs)
      : stream_(stream), needs_(needs), buffer_(k_piece_bytes) {}
  /// One request after the other, until the other side, an error or the server ends it.
  void run() {
    for (bool goes_on = true; goes_on && !needs_.stopping;) {
      needs_.allow(needs_.limits.head_s);
      http::request_parser<http::buffer_body> parser;
      parser.header_limit(needs_.limits.head_bytes);
      parser.body_limit(
          std::numeric_limits<std::uint64_t>::max());  // its route says, once the head was read
      error_code wrong;
      http::read_header(stream_, buffer_, parser, wrong);
      if (wrong == http::error::header_limit)
        static_cast<void>(write(refused(431, "the head of the request is too large"), false));
      else if (wrong &&
               wrong.category() == http::make_error_code(http::error::bad_method).category() &&
               wrong != http::error::end_of_stream && wrong != http::error::partial_message)
        static_cast<void>(write(refused(400, "this is no request of HTTP/1.1"), false));
      if (wrong) return;
      head_alone_ = parser.get().method() == http::verb::head;
      goes_on = answer(parser);
    }
  }

 private:
  using error_code = boost::system::error_code;
  static constexpr std::size_t k_piece_bytes = 64U << 10;

  /// False: the connection ends.
  bool answer(http::request_parser<http::buffer_body>& parser) {
    auto head = head_of(parser.get(), needs_.address);
    if (!head) return write(refused(400, "a field stands twice, or this is no path"), false);
    if (parser.get().version() == k_http_1_1 && !head->fields.contains("host"))
      return write(refused(400, "say for whom this is (Host)"), false);
    if (const auto length = head->fields.find("content-length");
        head->fields.contains("transfer-encoding") ||
        (length != head->fields.end() &&
         length->second.find_first_not_of("0123456789") != std::string::npos))
      return write(refused(411, "say how long the body is (Content-Length)"), false);
    if (parser.chunked())
      return write(refused(411, "say how long the body is (Content-Length)"), false);
    if (head_alone_)
      head->method = "GET";  // answered as that is, without what would come after the head
    const std::unique_ptr<Exchange> exchange = needs_.welcome(*head);
    const std::uint64_t length = parser.content_length() ? *parser.content_length() : 0;
    if (exchange->refusal() != nullptr)
      return write(*exchange->refusal(), length == 0 && parser.keep_alive());
    if (length > exchange->largest_bytes())
      return write(refused(413, "the body is too large"), false);
    needs_.allow(needs_.limits.body_s +
                 static_cast<std::int64_t>(length) / needs_.limits.slowest_bytes_s);
    parser.body_limit(length);
    std::array<char, k_piece_bytes> piece;  // NOLINT: filled below
    for (error_code wrong; !parser.is_done();) {
      parser.get().body().data = piece.data();
      parser.get().body().size = piece.size();
      http::read(stream_, buffer_, parser, wrong);
      if (wrong && wrong != http::error::need_buffer) return false;
      exchange->take({piece.data(), piece.size() - parser.get().body().size});
    }
    const Reply reply = exchange->answer();
    if (reply.events) return write_events(reply);
    return write(reply, parser.keep_alive());
  }

  [[nodiscard]] static http::response_header<> header_of(const Reply& reply) {
    http::response_header<> header;
    header.version(k_http_1_1);
    header.result(static_cast<unsigned>(reply.status));
    header.set(http::field::content_type, reply.type);
    for (const auto& [name, value] : k_always) header.set(name, value);
    for (const auto& [name, value] : reply.fields) header.set(name, value);
    return header;
  }

  [[nodiscard]] bool write(const Reply& reply, bool keep_alive) {
    needs_.allow(needs_.limits.write_s +
                 static_cast<std::int64_t>(reply.body.size()) / needs_.limits.slowest_bytes_s);
    http::response<http::string_body> out(header_of(reply), reply.body);
    out.keep_alive(keep_alive);
    out.prepare_payload();
    http::response_serializer<http::string_body> serializer(out);
    error_code wrong;
    if (head_alone_)
      http::write_header(stream_, serializer, wrong);
    else
      http::write(stream_, serializer, wrong);
    return !wrong && keep_alive;
  }

  [[nodiscard]] bool write_events(const Reply& reply) {
    http::response<http::empty_body> out(header_of(reply));
    out.keep_alive(false);
    http::response_serializer<http::empty_body> serializer(out);
    needs_.allow(needs_.limits.write_s);
    error_code wrong;
    http::write_header(stream_, serializer, wrong);
    if (wrong || head_alone_) return false;
    reply.events([&](std::string_view event) {
      if (needs_.stopping) return false;
      needs_.allow(needs_.limits.write_s);
      error_code gone;
      asio::write(stream_, asio::buffer(event.data(), event.size()), gone);
      return !gone && !needs_.stopping;
    });
    return false;
  }

  Stream& stream_;
  Needs needs_;
  boost::beast::flat_buffer buffer_;
  bool head_alone_ = false;  // HEAD
};

}  // namespace http_talk
}  // namespace cavum::office
