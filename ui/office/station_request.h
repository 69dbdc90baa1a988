// How a station proves who it is over the network: each request bears a line of JSON signed by the
// enrolled station's own key, over method, path, body, the office's ledger, a time and a number
// drawn for it. What was heard once is refused the second time.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "engine/session/station_key.h"

namespace cavum::office {

/// The header field that holds the signed line.
inline constexpr char k_station_field[] = "x-cavum-station";
/// How far a station's clock may be from the office's, s.
inline constexpr std::int64_t k_clock_leeway_s = 300;

/// What a station signs of one request.
struct StationRequest {
  std::string ledger;        ///< id
  std::string method, path;  ///< the path with all that follows it
  std::string body_sha256;   ///< hexadecimal
  std::string nonce;         ///< 32 hexadecimal digits, drawn
  std::string public_key;    ///< the station's, hexadecimal
  std::int64_t utc_ns = 0;
};
/// One line of JSON {"request","signature"}: signed over "CVSTATRQ" and the JSON text of `request`.
[[nodiscard]] std::string sign_request(StationRequest request, const SigningKey& key);
/// Throws Error when the text is no such line or the signature does not hold.
[[nodiscard]] StationRequest parse_request(const std::string& text);

/// Remembers the numbers of requests for as long as their time would be taken. Times before its own
/// beginning are refused, so that a restart forgets nothing that counts.
class ReceivedRequests {
 public:
  explicit ReceivedRequests(std::int64_t begun_utc_ns) : begun_utc_ns_(begun_utc_ns) {}
  /// Why it is refused, in words; empty: it is new, and remembered.
  [[nodiscard]] Message hear(const StationRequest& request, std::int64_t now_utc_ns);

 private:
  std::mutex lock_;
  std::int64_t begun_utc_ns_;
  std::map<std::string, std::int64_t>
      received_;  // time until which it is remembered, by key and number
};

}  // namespace cavum::office
