#include "engine/device/hardware/inverse3_link.h"

#include <fmt/core.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>

#include "engine/base/text.h"
#include "engine/device/device_error.h"
#include "engine/device/hardware/inverse3_protocol.h"

namespace cavum {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using Clock = std::chrono::steady_clock;
using Outcome = std::optional<beast::error_code>;  // of what was begun; empty while it goes on

Clock::time_point in(double seconds) {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

struct Inverse3Link::Socket {
  asio::io_context context{1};
  beast::websocket::stream<beast::tcp_stream> stream{context};
  beast::flat_buffer heard{k_inverse3_largest};
  bool listens = false;
  Outcome read;

  /// True when `outcome` is there by `until`.
  bool wait_for(const Outcome& outcome, Clock::time_point until) {
    while (!outcome) {
      context.restart();
      if (context.run_one_until(until) == 0) return outcome.has_value();
    }
    return true;
  }
  /// Waits for what `begin` begins with the handler that it is given.
  template <class Begin>
  beast::error_code wait(double patience_s, Begin begin) {
    const auto outcome = std::make_shared<Outcome>();  // the handler may outlive this call
    begin([outcome](beast::error_code error, auto&&...) { *outcome = error; });
    return wait_for(*outcome, in(patience_s)) ? **outcome
                                              : beast::error_code(beast::error::timeout);
  }
};

Inverse3Link::Inverse3Link(std::uint16_t port, double patience_s)
    : socket_(std::make_unique<Socket>()) {
  Socket& s = *socket_;
  const std::string at = fmt::format("127.0.0.1:{}", port);
  const asio::ip::tcp::endpoint service(asio::ip::address_v4::loopback(), port);
  auto error = s.wait(patience_s, [&](auto done) {
    s.stream.next_layer().async_connect(service, std::move(done));
  });
  if (error)
    throw inverse3_error(
        DeviceError::no_service,
        msg("no service listens at {} ({})", at, one_line(error.message())),
        msg("start the Haply Inverse Service (`systemctl start haply-inverse-service`), or name its port in stylus-inverse3.toml"));
  beast::error_code ignored;
  s.stream.next_layer().socket().set_option(asio::ip::tcp::no_delay(true), ignored);
  s.stream.read_message_max(k_inverse3_largest);
  error =
      s.wait(patience_s, [&](auto done) { s.stream.async_handshake(at, "/", std::move(done)); });
  if (error)
    throw inverse3_error(
        DeviceError::no_service,
        msg("what listens at {} is no Haply Inverse Service ({})", at, one_line(error.message())),
        msg("name the service's port in stylus-inverse3.toml; 10001 is usual"));
}

Inverse3Link::~Inverse3Link() {
  constexpr double k_goodbye_s = 0.1;
  if (socket_->stream.is_open() && !socket_->read) {
    try {
      socket_->wait(k_goodbye_s, [&](auto done) {
        socket_->stream.async_close(beast::websocket::close_code::normal, std::move(done));
      });
    } catch (const std::exception&) {  // no memory for it: the line is cut instead
    }
  }
  beast::error_code ignored;
  socket_->stream.next_layer().socket().close(ignored);
}

void Inverse3Link::send(const std::string& text, double patience_s) {
  // kept by the operation until it is over, in time or not
  const auto kept = std::make_shared<std::string>(text);
  const auto error = socket_->wait(patience_s, [&](auto done) {
    socket_->stream.async_write(
        asio::buffer(*kept), [kept, done](beast::error_code e, std::size_t) mutable { done(e); });
  });
  if (error)
    throw inverse3_error(DeviceError::lost,
                         msg("the line to the service is cut ({})", one_line(error.message())),
                         msg("see whether the Haply Inverse Service still runs"));
}

bool Inverse3Link::hear(std::string& text, double patience_s) {
  Socket& s = *socket_;
  if (!s.listens) {
    s.listens = true;
    s.heard.clear();
    s.stream.async_read(s.heard, [&s](beast::error_code error, std::size_t) { s.read = error; });
  }
  if (!s.wait_for(s.read, in(patience_s))) return false;
  const beast::error_code error = *s.read;
  if (error == beast::websocket::error::message_too_big ||
      error == beast::websocket::error::buffer_overflow)
    throw inverse3_error(DeviceError::malformed_message,
                         msg("the service sent more than {} bytes at once", k_inverse3_largest),
                         msg("update the Haply Inverse Service"));
  if (error)
    throw inverse3_error(DeviceError::lost,
                         msg("the line to the service is cut ({})", one_line(error.message())),
                         msg("see whether the Haply Inverse Service still runs"));
  if (!s.stream.got_text())
    throw inverse3_error(DeviceError::malformed_message,
                         msg("the service sent bytes that are no text"),
                         msg("update the Haply Inverse Service"));
  text.assign(static_cast<const char*>(s.heard.data().data()), s.heard.size());
  s.read.reset();
  s.listens = false;
  return true;
}

}  // namespace cavum
