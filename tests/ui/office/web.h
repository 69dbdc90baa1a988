// A browser's side of the office's server, byte by byte, for tests: what is sent is what the test
// says, also what no browser would send.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace cavum::testing_office {

struct Heard {
  int status = 0;                             ///< 0: the connection ended without a reply
  std::map<std::string, std::string> fields;  ///< names in small letters
  std::string body;
  [[nodiscard]] nlohmann::json json() const { return nlohmann::json::parse(body, nullptr, false); }
};

/// One connection over TLS to 127.0.0.1; whatever certificate is shown is taken.
class Wire {
 public:
  explicit Wire(std::uint16_t port);
  ~Wire();
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  /// False: the other side has ended it.
  bool send(const std::string& bytes);
  /// The next reply.
  [[nodiscard]] Heard hear();
  /// All bytes that come within the time, or until `enough` of them have. The connection is of no
  /// use afterwards.
  [[nodiscard]] std::string hear_for(std::chrono::milliseconds time,
                                     const std::function<bool(const std::string&)>& enough = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Who has signed in, or nobody: cookie and token go with each request.
struct Visitor {
  std::uint16_t port = 0;
  std::string cookie = {}, token = {};

  /// Throws nothing: a refusal leaves cookie and token empty.
  Heard sign_in(const std::string& name, const std::string& password);
  [[nodiscard]] Heard get(const std::string& path) const { return ask("GET", path, ""); }
  [[nodiscard]] Heard post(const std::string& path, const nlohmann::json& body) const {
    return ask("POST", path, body.dump());
  }
  [[nodiscard]] Heard ask(const std::string& method, const std::string& path,
                          const std::string& body,
                          const std::map<std::string, std::string>& more = {}) const;
};

}  // namespace cavum::testing_office
