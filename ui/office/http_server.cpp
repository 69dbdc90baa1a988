#include "ui/office/http_server.h"

#include <fmt/core.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <list>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

#include "engine/base/error.h"

namespace cavum::office {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Tls = boost::beast::ssl_stream<Tcp::socket>;
using Steady = std::chrono::steady_clock;

constexpr std::size_t k_piece_bytes = 64U << 10;
constexpr auto k_watch = std::chrono::milliseconds(250);
constexpr unsigned k_http_1_1 = 11;

/// What every reply says to a browser.
constexpr std::pair<const char*, const char*> k_always[] = {
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

std::string small(boost::beast::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// None: a field stands twice, or the target is no path.
std::optional<Head> head_of(const http::request_header<>& read, const std::string& address) {
  Head head;
  head.address = address;
  head.method = std::string(read.method_string());
  const std::string target(read.target());
  if (!target.starts_with('/')) return std::nullopt;
  const auto question = target.find('?');
  head.path = target.substr(0, question);
  if (question != std::string::npos) head.query = target.substr(question + 1);
  for (const auto& field : read)
    if (!head.fields.emplace(small(field.name_string()), std::string(field.value())).second) return std::nullopt;
  return head;
}

Reply refused(int status, const char* why) { return {status, "application/json", fmt::format(R"({{"error":"{}"}})", why)}; }

asio::ssl::context make_context(const CertificateFiles& files) {
  asio::ssl::context context(asio::ssl::context::tls_server);
  context.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_tlsv1 | asio::ssl::context::no_tlsv1_1 |
                      SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_mode(context.native_handle(), SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_cipher_list(context.native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20");
  error_code wrong;
  context.use_certificate_chain_file(files.certificate, wrong);
  if (wrong) throw Error(files.certificate, "is no certificate that can be used: " + wrong.message(), "give a chain in PEM, the server's own first");
  context.use_private_key_file(files.key, asio::ssl::context::pem, wrong);
  if (wrong) throw Error(files.key, "is no key that can be used: " + wrong.message(), "give the certificate's key in PEM, without a password");
  if (SSL_CTX_check_private_key(context.native_handle()) != 1)
    throw Error(files.key, "is not the key of " + files.certificate, "name files that belong together");
  return context;
}

}  // namespace

struct HttpServer::Parts {
  /// Of a connection, for whoever watches the clock: its socket is shut when the time is over, which ends every read and write on it.
  struct Open {
    int socket = -1;
    Steady::time_point deadline;
  };

  Parts(const std::string& address, std::uint16_t port, const CertificateFiles& files, Welcome handler, const HttpLimits& allowed)
      : welcome(std::move(handler)), limits(allowed), tls(make_context(files)), acceptor(context) {
    error_code wrong;
    const auto place = asio::ip::make_address(address, wrong);
    if (wrong) throw Error("--listen " + address, "is no address", "give one such as 127.0.0.1:8443, or [::1]:8443");
    const Tcp::endpoint end(place, port);
    acceptor.open(end.protocol(), wrong);
    if (!wrong) acceptor.set_option(Tcp::acceptor::reuse_address(true), wrong);
    if (!wrong) acceptor.bind(end, wrong);
    if (!wrong) acceptor.listen(asio::socket_base::max_listen_connections, wrong);
    if (wrong) throw Error(fmt::format("--listen {}:{}", address, port), "cannot be listened at: " + wrong.message(), "name another place");
    watcher = std::thread([this] { watch(); });
    accepter = std::thread([this] { accept(); });
  }

  ~Parts() {
    stopping = true;
    ::shutdown(acceptor.native_handle(), SHUT_RDWR);  // ends accept()
    accepter.join();
    std::unique_lock guard(lock);
    for (const Open& o : open) ::shutdown(o.socket, SHUT_RDWR);
    ended.wait(guard, [&] { return open.empty(); });
    guard.unlock();
    watcher.join();
  }

  void accept() {
    while (!stopping) {
      Tcp::socket socket(context);
      error_code wrong;
      acceptor.accept(socket, wrong);
      if (stopping) return;
      if (wrong) {  // no descriptors are left: others end meanwhile
        std::this_thread::sleep_for(k_watch);
        continue;
      }
      std::unique_lock guard(lock);
      if (open.size() >= limits.most_connections) continue;  // closed as it came
      const auto place = open.insert(open.end(), {socket.native_handle(), Steady::now() + std::chrono::seconds(limits.handshake_s)});
      guard.unlock();
      try {
        std::thread([this, place, moved = std::move(socket)]() mutable { serve(std::move(moved), place); }).detach();
      } catch (const std::system_error&) {  // no thread is to be had
        forget(place);
      }
    }
  }

  void watch() {
    while (!stopping) {
      std::this_thread::sleep_for(k_watch);
      const std::lock_guard guard(lock);
      for (const Open& o : open)
        if (Steady::now() > o.deadline) ::shutdown(o.socket, SHUT_RDWR);
    }
  }

  void allow(std::list<Open>::iterator place, std::int64_t seconds) {
    const std::lock_guard guard(lock);
    place->deadline = Steady::now() + std::chrono::seconds(seconds);
  }
  void forget(std::list<Open>::iterator place) {
    const std::lock_guard guard(lock);
    open.erase(place);
    ended.notify_all();
  }

  void serve(Tcp::socket socket, std::list<Open>::iterator place) {
    {
      Tls stream(std::move(socket), tls);
      try {
        error_code wrong;
        const std::string address = stream.next_layer().remote_endpoint(wrong).address().to_string();
        stream.next_layer().set_option(Tcp::no_delay(true), wrong);
        stream.handshake(asio::ssl::stream_base::server, wrong);
        if (!wrong) converse(stream, address, place);
        allow(place, limits.handshake_s);
        if (!wrong) stream.shutdown(wrong);
      } catch (const std::exception&) {  // of this connection alone: memory, a disk
      }
      const std::lock_guard guard(lock);
      place->socket = -1;  // before its number can be another connection's
    }
    forget(place);
  }

  void converse(Tls& stream, const std::string& address, std::list<Open>::iterator place) {
    boost::beast::flat_buffer buffer(k_piece_bytes);
    for (bool goes_on = true; goes_on && !stopping;) {
      allow(place, limits.head_s);
      http::request_parser<http::buffer_body> parser;
      parser.header_limit(limits.head_bytes);
      parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // its door says, once the head was read
      error_code wrong;
      http::read_header(stream, buffer, parser, wrong);
      if (wrong == http::error::header_limit)
        static_cast<void>(write(stream, place, refused(431, "the head of the request is too large"), false));
      else if (wrong && wrong.category() == http::make_error_code(http::error::bad_method).category() && wrong != http::error::end_of_stream &&
               wrong != http::error::partial_message)
        static_cast<void>(write(stream, place, refused(400, "this is no request of HTTP/1.1"), false));
      if (wrong) return;
      goes_on = answer(stream, buffer, parser, address, place);
    }
  }

  /// False: the connection ends.
  bool answer(Tls& stream, boost::beast::flat_buffer& buffer, http::request_parser<http::buffer_body>& parser, const std::string& address,
              std::list<Open>::iterator place) {
    const auto head = head_of(parser.get(), address);
    if (!head) return write(stream, place, refused(400, "a field stands twice, or this is no path"), false);
    if (parser.chunked()) return write(stream, place, refused(411, "say how long the body is (Content-Length)"), false);
    const std::unique_ptr<Exchange> exchange = welcome(*head);
    const std::uint64_t length = parser.content_length() ? *parser.content_length() : 0;
    if (exchange->refusal() != nullptr) return write(stream, place, *exchange->refusal(), length == 0 && parser.keep_alive());
    if (length > exchange->largest_bytes()) return write(stream, place, refused(413, "the body is too large"), false);
    allow(place, limits.body_s + static_cast<std::int64_t>(length) / limits.slowest_bytes_s);
    parser.body_limit(length);
    std::array<char, k_piece_bytes> piece;  // NOLINT: filled below
    for (error_code wrong; !parser.is_done();) {
      parser.get().body().data = piece.data();
      parser.get().body().size = piece.size();
      http::read(stream, buffer, parser, wrong);
      if (wrong && wrong != http::error::need_buffer) return false;
      exchange->take({piece.data(), piece.size() - parser.get().body().size});
    }
    const Reply reply = exchange->answer();
    if (reply.events) return write_events(stream, place, reply);
    return write(stream, place, reply, parser.keep_alive());
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

  [[nodiscard]] bool write(Tls& stream, std::list<Open>::iterator place, const Reply& reply, bool keep_alive) {
    allow(place, limits.write_s + static_cast<std::int64_t>(reply.body.size()) / limits.slowest_bytes_s);
    http::response<http::string_body> out(header_of(reply), reply.body);
    out.keep_alive(keep_alive);
    out.prepare_payload();
    error_code wrong;
    http::write(stream, out, wrong);
    return !wrong && keep_alive;
  }

  [[nodiscard]] bool write_events(Tls& stream, std::list<Open>::iterator place, const Reply& reply) {
    http::response<http::empty_body> out(header_of(reply));
    out.keep_alive(false);
    http::response_serializer<http::empty_body> serializer(out);
    allow(place, limits.write_s);
    error_code wrong;
    http::write_header(stream, serializer, wrong);
    if (wrong) return false;
    reply.events([&](std::string_view event) {
      if (stopping) return false;
      allow(place, limits.write_s);
      error_code gone;
      asio::write(stream, asio::buffer(event.data(), event.size()), gone);
      return !gone && !stopping;
    });
    return false;
  }

  Welcome welcome;
  HttpLimits limits;
  asio::io_context context;
  asio::ssl::context tls;
  Tcp::acceptor acceptor;
  std::atomic<bool> stopping = false;
  std::mutex lock;
  std::condition_variable ended;
  std::list<Open> open;
  std::thread watcher, accepter;
};

HttpServer::HttpServer(const std::string& address, std::uint16_t port, const CertificateFiles& files, Welcome welcome, const HttpLimits& limits)
    : parts_(std::make_unique<Parts>(address, port, files, std::move(welcome), limits)) {}
HttpServer::~HttpServer() = default;
std::uint16_t HttpServer::port() const noexcept {
  error_code wrong;
  return parts_->acceptor.local_endpoint(wrong).port();
}
std::size_t HttpServer::connections() const noexcept {
  const std::lock_guard guard(parts_->lock);
  return parts_->open.size();
}

}  // namespace cavum::office
