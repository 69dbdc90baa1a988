// What comes over a connection to the exam office's server. The first byte says who asks (0 nobody,
// 1 to 4 a person of each role, 5 an enrolled station) and what is put right before it is sent (8 =
// the body's length, 16 = the page's token); the rest are the bytes of the connection. Whoever asks
// gets his cookie, or his signature, into the first request. No route may open to somebody that the
// table of routes keeps out.
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/records/stations.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"
#include "ui/office/http_talk.h"
#include "ui/office/office.h"
#include "ui/office/routes.h"
#include "ui/office/site.h"

namespace cavum::fuzz {
namespace {

using nlohmann::json;

constexpr char k_office_password[] = "correct horse trial";
constexpr char k_office_scenario[] = CAVUM_SOURCE_DIR "/tests/replay/block_cavity.toml";
constexpr std::size_t k_station_asks = 5;

/// A connection that brings these bytes, and keeps the beginning of what is said.
class BytesStream {
 public:
  explicit BytesStream(std::string_view bytes) : bytes_(bytes) {}

  template <class Buffers>
  std::size_t read_some(const Buffers& into, boost::system::error_code& wrong) {
    const std::size_t n =
        boost::asio::buffer_copy(into, boost::asio::buffer(bytes_.data(), bytes_.size()));
    bytes_.remove_prefix(n);
    wrong =
        n == 0 ? boost::system::error_code(boost::asio::error::eof) : boost::system::error_code();
    return n;
  }
  template <class Buffers>
  std::size_t read_some(const Buffers& into) {
    boost::system::error_code wrong;
    const std::size_t n = read_some(into, wrong);
    if (wrong) throw boost::system::system_error(wrong);
    return n;
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& from, boost::system::error_code& wrong) {
    constexpr std::size_t k_kept = 512;
    std::array<char, k_kept> piece{};
    const std::size_t n = boost::asio::buffer_copy(boost::asio::buffer(piece), from);
    if (said_.size() < k_kept) said_.append(piece.data(), std::min(n, k_kept - said_.size()));
    wrong = {};
    return boost::asio::buffer_size(from);
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& from) {
    boost::system::error_code none;
    return write_some(from, none);
  }
  [[nodiscard]] const std::string& said() const { return said_; }

 private:
  std::string_view bytes_;
  std::string said_;
};

/// An office with an account of each role and an enrolled station.
class OpenOffice {
 public:
  OpenOffice() : home_(work_folder() + "/office-" + std::to_string(++number_)) {
    std::filesystem::create_directories(home_);
    const std::string folder = home_ + "/ledger";
    records::Ledger::create(folder, "School", school_key());
    {
      records::Ledger ledger(folder, school_key());
      const std::string code = records::invite_station(ledger, "Seat 3", 4'000'000'000'000'000'000);
      static_cast<void>(records::enrol_station(
          ledger, records::station_request(station_key(), ledger.content().public_key, {}, code), 0,
          "request"));
      id_ = ledger.content().id;
    }
    office::OfficeOptions o;
    o.ledger_folder = folder;
    o.school = school_key();
    o.home = home_ + "/office";
    o.exams = {k_office_scenario};
    o.port = 0;
    o.certificate = {o.home + "/certificate.pem", o.home + "/certificate.key"};
    o.report = [](const std::string&) { return std::string("<p>a report</p>"); };
    std::filesystem::create_directories(o.home);
    std::filesystem::permissions(o.home, std::filesystem::perms::owner_all);
    office::make_certificate(o.certificate, {"127.0.0.1"});
    office::Accounts accounts(o.home + "/accounts.json");
    for (const office::Role role : office::all_roles())
      static_cast<void>(accounts.set(std::string(office::name_of(role)), role, k_office_password,
                                     role == office::Role::officer));
    office_ = std::make_unique<office::Office>(o);
    for (const office::Role role : office::all_roles()) sign_in(std::string(office::name_of(role)));
  }
  ~OpenOffice() {
    office_.reset();
    std::error_code none;
    std::filesystem::remove_all(home_, none);
  }
  OpenOffice(const OpenOffice&) = delete;
  OpenOffice& operator=(const OpenOffice&) = delete;

  /// What is said to these bytes.
  [[nodiscard]] std::string say(std::string_view bytes) const {
    BytesStream stream(bytes);
    const office::Welcome welcome = [this](const office::Head& head) {
      return office_->welcome(head);
    };
    const office::HttpLimits limits;
    const std::string address = "192.0.2.1";
    std::atomic<bool> stopping = false;
    const std::function<void(std::int64_t)> allow = [&](std::int64_t) {
      if (stream.said().find("text/event-stream") != std::string::npos)
        stopping = true;  // a page that listens: it goes again
    };
    office::http_talk::Talk<BytesStream>(stream, {welcome, limits, address, allow, stopping}).run();
    return stream.said();
  }
  [[nodiscard]] const std::string& cookie(std::size_t role) const { return cookies_.at(role); }
  [[nodiscard]] const std::string& token(std::size_t role) const { return tokens_.at(role); }
  [[nodiscard]] const std::string& id() const { return id_; }

 private:
  void sign_in(const std::string& name) {
    const std::string body = json{{"name", name}, {"password", k_office_password}}.dump();
    office::Head head{
        "POST", "/api/sign-in", "", {{"content-type", "application/json"}}, "192.0.2.2"};
    const auto exchange = office_->welcome(head);
    exchange->take(body);
    const office::Reply reply = exchange->answer();
    if (reply.status != 200) std::abort();
    tokens_.push_back(json::parse(reply.body).at("token"));
    for (const auto& [field, value] : reply.fields)
      if (field == "Set-Cookie") cookies_.push_back(value.substr(0, value.find(';')));
  }

  static inline int number_ = 0;
  std::string home_, id_;
  std::unique_ptr<office::Office> office_;
  std::vector<std::string> cookies_, tokens_;
};

/// The office that stands. Another one after so many changes, or its ledger would grow with the
/// runs.
OpenOffice& open_office(bool changed) {
  static std::unique_ptr<OpenOffice> office = std::make_unique<OpenOffice>();
  static int changes = 0;
  constexpr int k_max_changes = 100;
  if (changed && ++changes > k_max_changes) {
    changes = 0;
    office.reset();
    office = std::make_unique<OpenOffice>();
  }
  return *office;
}

struct Asked {
  std::string method, target, path, body;
  std::size_t line_end = std::string::npos;  // after its first line
};
Asked first_request(const std::string& text) {
  Asked a;
  const auto end = text.find("\r\n"), gap = text.find("\r\n\r\n");
  if (end == std::string::npos || gap == std::string::npos) return a;
  const std::string line = text.substr(0, end);
  const auto one = line.find(' '), two = line.rfind(' ');
  if (one == std::string::npos || two <= one) return a;
  a.method = line.substr(0, one);
  a.target = line.substr(one + 1, two - one - 1);
  a.path = a.target.substr(0, a.target.find('?'));
  a.body = text.substr(gap + 4);
  a.line_end = end + 2;
  return a;
}

/// With what the first byte asks for.
std::string sent(const OpenOffice& office, std::uint8_t how, std::string text) {
  const Asked a = first_request(text);
  if (a.line_end == std::string::npos) return text;
  const std::size_t who = how % 8;
  std::string fields;
  if ((how & 8U) != 0) fields += "Content-Length: " + std::to_string(a.body.size()) + "\r\n";
  if (who >= 1 && who <= 4) {
    fields += "Cookie: " + office.cookie(who - 1) + "\r\n";
    if ((how & 16U) != 0) fields += "X-Cavum-Token: " + office.token(who - 1) + "\r\n";
  }
  if (who == k_station_asks && is_plain_text(a.method + a.target))  // a station signs text
    fields += std::string(office::k_station_field) + ": " +
              office::sign_request({office.id(), a.method, a.target, to_hex(sha256(a.body)), "", "",
                                    read_clocks().utc_ns},
                                   station_key()) +
              "\r\n";
  return text.insert(a.line_end, fields);
}

}  // namespace

void fuzz_office(Data data) {
  if (data.empty()) return;
  OpenOffice& office = open_office(false);
  const std::uint8_t how = data[0];
  const std::string text = text_of(data.subspan(1));
  const std::string said = office.say(sent(office, how, text));
  if (!said.starts_with("HTTP/1.1 2")) return;
  // it was let in: the table of routes has to say so, too
  const Asked a = first_request(text);
  const office::Route* route = office::route_for(a.method, a.path);
  if (route == nullptr)
    return;  // a method in small letters, a line of other blanks: Beast reads it in its own way
  const std::size_t who = how % 8;
  const bool person = who >= 1 && who <= 4;
  if (route->asks == office::Asks::person &&
      (!person || !route->lets(office::all_roles()[who - 1])))
    std::abort();
  if (route->asks == office::Asks::station && who != k_station_asks) std::abort();
  if (route->asks == office::Asks::person && route->changes() && (how & 16U) == 0) std::abort();
  if (route->changes()) static_cast<void>(open_office(true));
}

std::vector<Bytes> office_seeds() {
  const json all{{"name", "officer"},
                 {"password", k_office_password},
                 {"role", "reader"},
                 {"code", "000000"},
                 {"reason", "asked for by the dean"},
                 {"ticket", "00112233445566778899aabbccddeeff"},
                 {"candidate", "K1"},
                 {"exam", "block_cavity"},
                 {"from", "2026-11-27T08:00:00Z"},
                 {"until", "2036-11-27T10:00:00Z"},
                 {"begin_at_office", true},
                 {"base64", "aWQKSzEKSzIK"},
                 {"answers", json::array({"id"})},
                 {"text", "The building is left by the south door."},
                 {"words", "the light went out"},
                 {"station", "Seat 3"},
                 {"stations", json::array({"Seat 3"})},
                 {"room", "2"},
                 {"public_key", to_hex(station_key().public_key)},
                 {"entry", 4},
                 {"verdict", "pass"},
                 {"outcome", "stands"},
                 {"state", "exam"},
                 {"step", "1"},
                 {"alarm", ""},
                 {"left_s", 12.5},
                 {"held", false},
                 {"heard", 0}};
  std::vector<Bytes> seeds;
  const std::string hash(64, 'a');
  for (const office::Route& route : office::routes()) {
    std::string path(route.path);
    if (path.ends_with('*')) path = path.substr(0, path.size() - 1) + hash;
    char who = route.asks == office::Asks::station ? 5 : 0;
    for (std::size_t i = 0;
         route.asks == office::Asks::person && i < office::all_roles().size() && who == 0; ++i)
      if (route.lets(office::all_roles()[i])) who = static_cast<char>(i + 1);
    std::string text = std::string(route.method) + " " + path + " HTTP/1.1\r\nHost: office\r\n";
    if (route.changes()) text += "Content-Type: application/json\r\n";
    text += "\r\n";
    if (route.method == "POST") text += all.dump();
    if (route.method == "PUT") text += text_of(std::span(small_session()).first(2000));
    seeds.push_back(bytes_of(static_cast<char>(who + (route.changes() ? 24 : 0)) + text));
    if (route.asks != office::Asks::nobody)
      seeds.push_back(bytes_of(static_cast<char>(route.changes() ? 8 : 0) + text));  // by nobody
  }
  seeds.push_back(bytes_of(
      '\0' +
      std::string(
          "GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\nContent-Length: 4\r\n\r\n0\r\n\r\n")));
  seeds.push_back(bytes_of(
      '\0' +
      std::string(
          "GET /api/../api/tickets?x=%2e%2e HTTP/1.1\r\nCookie: a\r\ncookie: b\r\n\r\nGET / HTTP/1.0\r\n\r\n")));
  return seeds;
}

}  // namespace cavum::fuzz
