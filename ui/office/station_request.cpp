#include "ui/office/station_request.h"

#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "grading/records/ledger_key.h"

namespace cavum::office {
namespace {

using nlohmann::json;

constexpr char k_request_format[] = "cavum request 1";
constexpr std::int64_t k_leeway_ns = k_clock_leeway_s * 1'000'000'000;
constexpr std::size_t k_nonce_bytes = 16, k_max_received = 500'000;

Bytes message_of_request(const json& facts) {
  const std::string text = "CVSTATRQ" + facts.dump();
  return {text.begin(), text.end()};
}

}  // namespace

std::string sign_request(StationRequest r, const SigningKey& key) {
  const json facts = {{"format", k_request_format},
                      {"ledger", r.ledger},
                      {"method", r.method},
                      {"path", r.path},
                      {"body_sha256", r.body_sha256},
                      {"nonce", records::random_hex(k_nonce_bytes)},
                      {"public_key", to_hex(key.public_key)},
                      {"utc_ns", r.utc_ns}};
  return json{{"request", facts}, {"signature", to_hex(key.sign(message_of_request(facts)))}}
      .dump();
}

StationRequest parse_request(const std::string& text) {
  const json j = parse_json_or_null(text, {4096, 100, 4});
  const json& facts = member_of(j, "request");
  const auto refuse = [](const Message& why) {
    throw Error(msg("the station's request"), why,
                msg("sign it anew, by the key that was enrolled"));
  };
  if (text_in(facts, "format") != k_request_format)
    refuse(msg("is not signed as the office knows it"));
  StationRequest r{text_in(facts, "ledger"),
                   text_in(facts, "method"),
                   text_in(facts, "path"),
                   text_in(facts, "body_sha256"),
                   text_in(facts, "nonce"),
                   text_in(facts, "public_key"),
                   require_whole<std::int64_t>(facts, "utc_ns", "the station's request")};
  if (r.nonce.size() != 2 * k_nonce_bytes || r.public_key.size() != 64)
    refuse(msg("has no number of its own"));
  if (!is_signed_by(r.public_key, message_of_request(facts), text_in(j, "signature")))
    refuse(msg("was changed after it was signed"));
  return r;
}

Message ReceivedRequests::hear(const StationRequest& r, std::int64_t now_utc_ns) {
  if (r.utc_ns < now_utc_ns - k_leeway_ns || r.utc_ns > now_utc_ns + k_leeway_ns ||
      r.utc_ns < begun_utc_ns_)
    return msg("its time is not the office's: take the office's time, and sign it anew");
  const std::lock_guard lock(lock_);
  if (received_.size() >= k_max_received)
    std::erase_if(received_, [&](const auto& one) { return one.second < now_utc_ns; });
  if (received_.size() >= k_max_received)
    return msg("there are too many at once: wait, and sign it anew");
  if (!received_.emplace(r.public_key + r.nonce, r.utc_ns + k_leeway_ns).second)
    return msg("it was heard before");
  return {};
}

}  // namespace cavum::office
