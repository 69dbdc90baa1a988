#include "ui/office/station_client.h"

#include <fmt/core.h>

#include <chrono>
#include <regex>

#include "engine/base/error.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "ui/office/certificate.h"
#include "ui/office/pieces.h"
#include "ui/office/station_request.h"

namespace cavum::office {
namespace {

using nlohmann::json;

constexpr std::uint64_t k_slowest_bytes_s = 64U << 10;
constexpr std::uint64_t k_largest_answer = 64U << 20;
constexpr std::size_t k_first_piece = 256U << 10;
constexpr auto k_quick = std::chrono::seconds(2);
constexpr int k_max_disputes = 5;
constexpr unsigned k_conflict = 409;

}  // namespace

StationClient::StationClient(const std::string& address, const std::string& certificate,
                             std::string school, const SigningKey& key)
    : certificate_(certificate),
      school_(std::move(school)),
      key_(key),
      piece_bytes_(k_first_piece) {
  static const std::regex k_address(
      R"((https://(?:\[[0-9a-fA-F:]+\]|[A-Za-z0-9.-]+)(?::\d{1,5})?)/?)");
  std::smatch found;
  if (!std::regex_match(address, found, k_address))
    throw Error("--server " + one_line(address), msg("is no address"),
                msg("give one such as https://office:8443"));
  origin_ = found[1];
}

Answer StationClient::send(const std::string& method, const std::string& path,
                           const std::string& body, const std::string& line) {
  if (stopped_.load())
    throw OfficeUnreachable(Name{origin_}, msg("is not asked any more: this station ends"),
                            msg("begin again"));
  if (!https_)
    https_.emplace(HttpsTrust{"", certificate_.empty() ? "" : fingerprint_of(certificate_)},
                   &stopped_);
  std::map<std::string, std::string> fields;
  if (!line.empty()) fields[k_station_field] = line;
  if (!body.empty()) fields["Content-Type"] = "application/json";
  const HttpsAnswer heard =
      https_->ask({method, origin_ + path, body, fields,
                   patience_ + std::chrono::seconds(body.size() / k_slowest_bytes_s),
                   k_largest_answer, "X-Cavum-Time"});
  if (!heard.wrong.empty())
    throw OfficeUnreachable(
        Name{origin_}, msg("the office cannot be reached: {}", heard.wrong),
        msg("look at network and address; a certificate of its own is named with --certificate"));
  Answer answer{static_cast<int>(heard.status), parse_json_or_null(heard.body)};
  if (!heard.field.empty() && answer.body.is_object())
    answer.body["utc_ns"] = std::stoll(heard.field);
  return answer;
}

json StationClient::require(Answer answer) const {
  if (answer.status >= 200 && answer.status < 300) return std::move(answer.body);
  const std::string why = text_in(answer.body, "error");
  throw Error(origin_, why.empty() ? msg("refuses ({})", answer.status) : Message(Name{why}),
              msg("ask the office"));
}

void StationClient::meet() {
  if (!ledger_.empty()) return;
  const json hello = require(send("GET", route::hello::row.path_of(), "", ""));
  if (text_in(hello, "public_key") != school_)
    throw Error(Name{origin_}, msg("is the office of another school than this station's"),
                msg("look at the address, and at school.pub"));
  ahead_ns_ =
      require_whole<std::int64_t>(hello, "utc_ns", "the office's greeting") - read_clocks().utc_ns;
  ledger_ = text_in(hello, "ledger");
}

std::string StationClient::sign(const std::string& method, const std::string& path,
                                const std::string& body) {
  meet();
  return sign_request(
      {ledger_, method, path, to_hex(sha256(body)), "", "", read_clocks().utc_ns + ahead_ns_},
      key_);
}

Answer StationClient::ask(const std::string& method, const std::string& path,
                          const std::string& body, const std::string& line) {
  if (!line.empty()) return send(method, path, body, line);
  Answer answer = send(method, path, body, sign(method, path, body));
  if (answer.status == 401 &&
      whole_in(answer.body, "utc_ns") != 0) {  // the office began anew, or a clock was set
    ahead_ns_ = whole_in(answer.body, "utc_ns") - read_clocks().utc_ns;
    answer = send(method, path, body, sign(method, path, body));
  }
  return answer;
}

Answer StationClient::ask(const Route& route, const std::string& body, std::string_view tail,
                          const std::string& query) {
  return ask(std::string(route.method), route.path_of(tail) + query, body);
}

json StationClient::enrol(const std::string& request) {
  meet();
  return require(send("POST", route::enrol::row.path_of(), request, ""));
}
json StationClient::tickets() { return require(ask(route::station_tickets::row)).at("tickets"); }
Message clock_problem(std::int64_t behind_ns) {
  constexpr std::int64_t k_max_ns = 120'000'000'000, k_second_ns = 1'000'000'000;
  if (std::abs(behind_ns) <= k_max_ns) return {};
  return behind_ns > 0 ? msg("is {} s behind the office's", behind_ns / k_second_ns)
                       : msg("is {} s ahead of the office's", -behind_ns / k_second_ns);
}

std::string StationClient::begin(const std::string& nonce) {
  meet();
  if (const Message problem = clock_problem(ahead_ns_); !problem.empty())
    throw Error(msg("this computer's clock"), problem,
                msg("set it right, and begin then: the exam's times would be refused"));
  return text_in(require(ask(route::begin_exam::row, to_json_value(AskBegin{nonce}).dump())),
                 "begin");
}
json StationClient::report(const json& state) {
  return require(ask(route::station_report::row, state.dump()));
}
json StationClient::hand_in_pieces(const Bytes& image) {
  const std::string hash = to_hex(sha256(image));
  const auto place = [&](const json& said) {  // of another size, it is not this recording's
    return whole_in(said, "of") == static_cast<std::int64_t>(image.size())
               ? static_cast<std::size_t>(whole_in(said, "have"))
               : 0;
  };
  std::size_t at = place(require(ask(route::pieces_had::row, "", hash)));
  for (int disputes = 0;;) {
    if (at >= image.size())
      return {{"state", "waiting"}};  // all of it is there, and its hash is being made
    const std::size_t size = std::min(piece_bytes_, image.size() - at);
    const auto begun = std::chrono::steady_clock::now();
    Answer answer;
    try {
      const auto first = image.begin() + static_cast<std::ptrdiff_t>(at);
      answer = ask(route::add_piece::row, {first, first + static_cast<std::ptrdiff_t>(size)}, hash,
                   fmt::format("?at={}&of={}", at, image.size()));
    } catch (const OfficeUnreachable&) {
      piece_bytes_ = std::max<std::size_t>(k_smallest_piece, piece_bytes_ / 2);
      throw;
    }
    if (answer.status == k_conflict &&
        ++disputes < k_max_disputes) {  // an answer was lost on the way: the office has it
      at = place(answer.body);
      continue;
    }
    json said = require(std::move(answer));
    if (!text_in(said, "state").empty()) return said;
    at = place(said);
    disputes = 0;
    if (std::chrono::steady_clock::now() - begun < k_quick)
      piece_bytes_ = std::min<std::size_t>(k_largest_piece, 2 * piece_bytes_);
  }
}

json StationClient::hand_in(const Bytes& image) {
  if (image.size() > k_first_piece) return hand_in_pieces(image);
  return require(ask(route::hand_in::row, {image.begin(), image.end()}, to_hex(sha256(image))));
}
json StationClient::handed(const std::string& sha256) {
  return require(ask(route::handed_in::row, "", sha256));
}

}  // namespace cavum::office
