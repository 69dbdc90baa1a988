// A station's side of the office's server: fetches tickets, asks to begin, reports, and hands in
// what was sat, each request signed by the station's key.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/bytes.h"
#include "engine/base/error.h"
#include "engine/session/station_key.h"
#include "ui/office/lti/https.h"
#include "ui/office/routes.h"

namespace cavum::office {

/// What came back.
struct Answer {
  int status = 0;
  nlohmann::json body;
};

/// The network, not a refusal: whoever can do without the office goes on.
class OfficeUnreachable : public Error {
 public:
  using Error::Error;
};

/// Why no exam begins at a station whose clock stands so far behind the office's (or, below 0,
/// ahead), in words; empty: within two minutes. Filing refuses times that are off by more than
/// five.
[[nodiscard]] Message clock_problem(std::int64_t behind_ns);

class StationClient {
 public:
  /// `address`: "https://office.example:8443". `certificate`: the server's own certificate (PEM),
  /// which must then be exactly that one; empty: one that this computer trusts, of that name.
  /// `school`: public key of the station's school, hexadecimal. Connects when it asks first. Throws
  /// Error for an address that is none.
  StationClient(const std::string& address, const std::string& certificate, std::string school,
                const SigningKey& key);
  StationClient(const StationClient&) = delete;
  StationClient& operator=(const StationClient&) = delete;

  // Each throws OfficeUnreachable when the office does not answer, and Error when it is another
  // school's, or refuses, in its words.
  [[nodiscard]] nlohmann::json enrol(const std::string& request);
  /// A list of {"candidate","nonce","text"}.
  [[nodiscard]] nlohmann::json tickets();
  /// The ledger's word to begin.
  [[nodiscard]] std::string begin(const std::string& nonce);
  /// What the office has to say to that: {"utc_ns","tickets","hold","announcements"}, as
  /// docs/office.md says.
  nlohmann::json report(const nlohmann::json& state);
  /// Sends the bytes of a recording; {"state": ...}. Sent twice is no harm. What is larger than a
  /// piece goes in pieces: after OfficeUnreachable the next call goes on where the line broke, also
  /// of another program.
  nlohmann::json hand_in(const Bytes& image);
  /// What became of it: {"state": unknown, waiting, filed or refused, …}.
  [[nodiscard]] nlohmann::json handed(const std::string& sha256);

  /// From the connection to the end of each answer; bodies have longer.
  void set_patience(std::chrono::seconds patience) noexcept { patience_ = patience; }
  /// Ends what runs, within a second; whatever is asked from then on throws. Any thread.
  void stop() noexcept { stopped_.store(true); }

  /// One signed request, whatever comes back; for tests also one whose signed line is `line`.
  [[nodiscard]] Answer ask(const std::string& method, const std::string& path,
                           const std::string& body, const std::string& line = "");
  /// The same of a route: with `tail` in the place of its `*`, and `query` behind it.
  [[nodiscard]] Answer ask(const Route& route, const std::string& body = "",
                           std::string_view tail = {}, const std::string& query = "");
  /// The line that signs such a request now, by the office's clock.
  [[nodiscard]] std::string sign(const std::string& method, const std::string& path,
                                 const std::string& body);

 private:
  void meet();
  [[nodiscard]] Answer send(const std::string& method, const std::string& path,
                            const std::string& body, const std::string& line);
  [[nodiscard]] nlohmann::json require(Answer answer) const;
  nlohmann::json hand_in_pieces(const Bytes& image);

  std::string origin_, certificate_, school_, ledger_;
  SigningKey key_;
  std::int64_t ahead_ns_ = 0;  // the office's clock before ours
  std::chrono::seconds patience_{20};
  std::size_t piece_bytes_;  // smaller after a line broke, larger after a quick answer
  std::atomic<bool> stopped_{false};
  std::optional<Https> https_;
};

}  // namespace cavum::office
