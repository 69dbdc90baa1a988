#include "ui/office/http_server.h"

#include <fmt/core.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <system_error>
#include <thread>

#include "engine/base/error.h"
#include "ui/office/http_talk.h"

namespace cavum::office {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using Tcp = asio::ip::tcp;
using Tls = boost::beast::ssl_stream<Tcp::socket>;
using Steady = std::chrono::steady_clock;

constexpr auto k_watch = std::chrono::milliseconds(250);
asio::ssl::context make_context(const CertificateFiles& files) {
  asio::ssl::context context(asio::ssl::context::tls_server);
  context.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_tlsv1 |
                      asio::ssl::context::no_tlsv1_1 | SSL_OP_NO_RENEGOTIATION |
                      SSL_OP_NO_COMPRESSION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_mode(context.native_handle(), SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_cipher_list(context.native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20");
  error_code wrong;
  context.use_certificate_chain_file(files.certificate, wrong);
  if (wrong)
    throw Error(files.certificate, msg("is no certificate that can be used: {}", wrong.message()),
                msg("give a chain in PEM, the server's own first"));
  context.use_private_key_file(files.key, asio::ssl::context::pem, wrong);
  if (wrong)
    throw Error(files.key, msg("is no key that can be used: {}", wrong.message()),
                msg("give the certificate's key in PEM, without a password"));
  if (SSL_CTX_check_private_key(context.native_handle()) != 1)
    throw Error(files.key, msg("is not the key of {}", files.certificate),
                msg("name files that belong together"));
  return context;
}

}  // namespace

struct HttpServer::Parts {
  /// How far a connection has come. Whoever is trusted keeps its place; of the others the least
  /// gives way when there is no more room.
  enum class Stage { silent, speaks, asks, trusted, leaves };
  /// Of a connection, for whoever watches the clock: its socket is shut when the time is over,
  /// which ends every read and write on it.
  struct Open {
    int socket = -1;
    Steady::time_point deadline;
    Stage stage = Stage::silent;
  };

  Parts(const std::string& address, std::uint16_t port, const CertificateFiles& files,
        Welcome handler, const HttpLimits& allowed)
      : welcome(std::move(handler)), limits(allowed), tls(make_context(files)), acceptor(context) {
    error_code wrong;
    const auto place = asio::ip::make_address(address, wrong);
    if (wrong)
      throw Error("--listen " + address, msg("is no address"),
                  msg("give one such as 127.0.0.1:8443, or [::1]:8443"));
    const Tcp::endpoint end(place, port);
    acceptor.open(end.protocol(), wrong);
    if (!wrong) acceptor.set_option(Tcp::acceptor::reuse_address(true), wrong);
    if (!wrong) acceptor.bind(end, wrong);
    if (!wrong) acceptor.listen(asio::socket_base::max_listen_connections, wrong);
    if (wrong)
      throw Error(fmt::format("--listen {}:{}", address, port),
                  msg("cannot be listened at: {}", wrong.message()), msg("name another place"));
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
      if (!room(guard)) continue;  // closed as it came
      const auto place = open.insert(
          open.end(), {socket.native_handle(),
                       Steady::now() + std::chrono::seconds(limits.handshake_s), Stage::silent});
      guard.unlock();
      try {
        std::thread([this, place, moved = std::move(socket)]() mutable {
          serve(std::move(moved), place);
        }).detach();
      } catch (const std::system_error&) {  // no thread is to be had
        forget(place);
      }
    }
  }

  /// Makes room for one more, where there is none, and nobody's address counts: the oldest of those
  /// that have not said a byte leaves, or else of those whose first head was not read yet, or else
  /// of those who asked as nobody. False: all that are here are trusted.
  bool room(std::unique_lock<std::mutex>& guard) {
    const auto free = [&] { return open.size() < limits.most_connections; };
    if (free()) return true;
    const auto least = std::min_element(
        open.begin(), open.end(), [](const Open& a, const Open& b) { return a.stage < b.stage; });
    if (least->stage >= Stage::trusted) return false;
    least->stage = Stage::leaves;
    ::shutdown(least->socket, SHUT_RDWR);
    return ended.wait_for(guard, k_watch, free);
  }

  void watch() {
    while (!stopping) {
      std::this_thread::sleep_for(k_watch);
      const std::lock_guard guard(lock);
      for (const Open& o : open)
        if (Steady::now() > o.deadline) ::shutdown(o.socket, SHUT_RDWR);
    }
  }

  /// Time for who has asked something; the others keep what they had when they came.
  void allow(std::list<Open>::iterator place, std::int64_t seconds) {
    const std::lock_guard guard(lock);
    if (place->stage == Stage::asks || place->stage == Stage::trusted)
      place->deadline = Steady::now() + std::chrono::seconds(seconds);
  }
  void reach(std::list<Open>::iterator place, Stage stage) {
    const std::lock_guard guard(lock);
    place->stage = std::max(place->stage, stage);
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
        const std::string address =
            stream.next_layer().remote_endpoint(wrong).address().to_string();
        stream.next_layer().set_option(Tcp::no_delay(true), wrong);
        stream.next_layer().wait(Tcp::socket::wait_read, wrong);
        reach(place, Stage::speaks);
        stream.handshake(asio::ssl::stream_base::server, wrong);
        if (!wrong) {
          const std::function<void(std::int64_t)> allows = [&](std::int64_t seconds) {
            allow(place, seconds);
          };
          const Welcome knows = [&](const Head& head) {
            reach(place, Stage::asks);
            auto exchange = welcome(head);
            if (exchange->trusted()) reach(place, Stage::trusted);
            return exchange;
          };
          http_talk::Talk<Tls>(stream, {knows, limits, address, allows, stopping}).run();
        }
        allow(place, limits.handshake_s);
        if (!wrong) stream.shutdown(wrong);
      } catch (const std::exception&) {  // of this connection alone: memory, a disk
      }
      const std::lock_guard guard(lock);
      place->socket = -1;  // before its number can be another connection's
    }
    forget(place);
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

HttpServer::HttpServer(const std::string& address, std::uint16_t port,
                       const CertificateFiles& files, Welcome welcome, const HttpLimits& limits)
    : parts_(std::make_unique<Parts>(address, port, files, std::move(welcome), limits)) {}
HttpServer::~HttpServer() = default;
std::uint16_t HttpServer::port() const noexcept {
  error_code wrong;
  return parts_->acceptor.local_endpoint(wrong).port();
}

}  // namespace cavum::office
