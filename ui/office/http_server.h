// HTTPS (Boost.Beast, OpenSSL): connections, limits and time. It knows no ledger and no person:
// what a request means, an Exchange says, made when the head was read and before any of the body
// is. A thread for each connection, at most `most_connections`; one that is too slow is cut off by
// its deadline, whatever it does.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ui/office/certificate.h"

namespace cavum::office {

/// The first part of a request.
struct Head {
  std::string method, path, query;            ///< path as it was sent; query without its `?`
  std::map<std::string, std::string> fields;  ///< names in small letters; none stands twice
  std::string address;                        ///< of who asks
  [[nodiscard]] std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
  }
};

/// Writes one event after the other to a reader who stays. False: he is gone, or the server ends.
using WriteEvent = std::function<bool(std::string_view event)>;

struct Reply {
  int status = 200;
  std::string type = "application/json", body = {};
  std::vector<std::pair<std::string, std::string>> fields =
      {};  ///< beside those that every reply has, or in their place
  std::function<void(const WriteEvent&)> events =
      {};  ///< server-sent events in the place of a body
};

/// One request and its reply.
class Exchange {
 public:
  virtual ~Exchange() = default;
  /// What is answered without reading any of the body: the request is refused.
  [[nodiscard]] virtual const Reply* refusal() const = 0;
  /// Somebody who is signed in asks, or a station that is enrolled: the connection keeps its place
  /// from then on.
  [[nodiscard]] virtual bool trusted() const = 0;
  [[nodiscard]] virtual std::uint64_t largest_bytes() const = 0;
  virtual void take(std::string_view part) = 0;
  [[nodiscard]] virtual Reply answer() = 0;
};
using Welcome = std::function<std::unique_ptr<Exchange>(const Head&)>;

struct HttpLimits {
  std::size_t most_connections = 512;
  std::uint32_t head_bytes = 8192;
  int handshake_s = 10;  ///< until TLS stands and the first head is read
  int head_s = 20;       ///< from a reply to the end of the next head
  int body_s = 20;       ///< of a body, and a second more for each `slowest_bytes_s`
  int slowest_bytes_s = 64 << 10;
  int write_s = 30;  ///< of a reply, and as above
};

class HttpServer {
 public:
  /// Listens from now on, at port 0 on any that is free. Throws Error when the place is taken, or
  /// the certificate cannot be used.
  HttpServer(const std::string& address, std::uint16_t port, const CertificateFiles& files,
             Welcome welcome, const HttpLimits& limits = {});
  /// Ends all connections.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  [[nodiscard]] std::uint16_t port() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cavum::office
