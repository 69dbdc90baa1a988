// Requests to a server elsewhere, over HTTPS by libcurl: TLS 1.2 or later, no redirect, no proxy,
// nothing read beyond a limit.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <string>

namespace cavum::office {

/// Whose certificate is taken; nothing here: those of authorities that this computer trusts, for
/// that name.
struct HttpsTrust {
  std::string authority;  ///< PEM of the authority, or of the server itself, which alone is trusted
  std::string exactly;    ///< SHA-256 of the only certificate that is taken, hexadecimal, whatever
                          ///< its names and dates
};

struct HttpsRequest {
  std::string method, address, body;
  std::map<std::string, std::string> fields;
  std::chrono::milliseconds patience;  ///< from the connection to the end of the answer
  std::size_t largest_answer;          ///< bytes
  const char* wanted_field;            ///< of the answer
};

struct HttpsAnswer {
  std::string wrong;  ///< why nothing came back, in libcurl's words; empty: something did
  long status = 0;
  std::string body, field;
};

/// Asks one request after the other, over one connection where the server keeps it.
class Https {
 public:
  /// Once `stopped` is true, what runs ends within a second.
  explicit Https(HttpsTrust trust, const std::atomic<bool>* stopped = nullptr);
  [[nodiscard]] HttpsAnswer ask(const HttpsRequest& request);

 private:
  HttpsTrust trust_;
  const std::atomic<bool>* stopped_;
  std::unique_ptr<void, void (*)(void*)> handle_;
};

}  // namespace cavum::office
