// The line to the service of a Haply Inverse3: a WebSocket on this computer, over Boost.Beast.
// Every call ends within its patience; it belongs to a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace cavum {

class Inverse3Link {
 public:
  /// Connects to 127.0.0.1:`port`. Throws Error when nobody listens there, or it is no WebSocket.
  Inverse3Link(std::uint16_t port, double patience_s);
  /// Says goodbye, for a tenth of a second at most.
  ~Inverse3Link();
  Inverse3Link(const Inverse3Link&) = delete;
  Inverse3Link& operator=(const Inverse3Link&) = delete;

  /// Throws Error when it is not taken in time, or the line is cut.
  void send(const std::string& text, double patience_s);
  /// The next whole message; false when none came in time: half of one waits for its rest. Throws
  /// Error when the line is cut, and for one that is no text or larger than k_inverse3_largest.
  [[nodiscard]] bool hear(std::string& text, double patience_s);

 private:
  struct Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace cavum
