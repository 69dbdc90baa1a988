// What a stranger may send to the server: heads, paths and bodies that no browser would send, too
// much, too slowly, and too many at once.
#include "ui/office/http_server.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>

#include "tests/ui/office/opened.h"
#include "tests/ui/office/served.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace std::chrono_literals;

HttpLimits hasty() {
  HttpLimits limits;
  limits.handshake_s = 2;
  limits.head_s = limits.body_s = 1;
  limits.most_connections = 20;
  return limits;
}

class Strangers : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { opened_ = new Opened(hasty()); }
  static void TearDownTestSuite() { delete opened_; }
  void TearDown() override {
    EXPECT_EQ(opened_->visitor().get("/").status, 200) << "it still serves";
  }
  static Heard raw(const std::string& bytes) {
    Wire wire(opened_->port());
    wire.send(bytes);
    return wire.hear();
  }
  static inline Opened* opened_ = nullptr;
};

TEST_F(Strangers, HearWhatABrowserMayDo) {
  const Heard page = opened_->visitor().get("/");
  EXPECT_EQ(
      page.fields.at("content-security-policy"),
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; form-action 'self'; "
      "frame-ancestors 'none'; base-uri 'none'");
  EXPECT_TRUE(page.fields.at("strict-transport-security").starts_with("max-age="));
  EXPECT_EQ(page.fields.at("x-content-type-options"), "nosniff");
  EXPECT_EQ(page.fields.at("referrer-policy"), "no-referrer");
  EXPECT_EQ(page.fields.at("cache-control"), "no-store");
  EXPECT_EQ(page.body.find("<style"), std::string::npos);
  EXPECT_EQ(page.body.find("style="), std::string::npos);
  EXPECT_EQ(page.body.find("<script>"), std::string::npos);
  EXPECT_EQ(opened_->visitor().get("/nothing").fields.at("content-security-policy"),
            page.fields.at("content-security-policy"));
}

TEST_F(Strangers, FindNothingBehindTrickyPaths) {
  for (const char* path :
       {"/../etc/passwd", "/%2e%2e/etc/passwd", "//", "/office.js/../office.js", "/office.js%00",
        "/.", "/api", "/station/sessions/..", "/station/sessions/%2e%2e%2f", "/\\..\\x",
        "/office.css?../../x/", "/API/ME"}) {
    const int status = opened_->visitor().get(path).status;
    EXPECT_TRUE(status == 404 || status == 400 ||
                (status == 200 && std::string(path).starts_with("/office.css?")))
        << path << ": " << status;
  }
  EXPECT_EQ(raw("GET https://elsewhere.example/ HTTP/1.1\r\nHost: x\r\n\r\n").status, 400);
  EXPECT_EQ(raw("GET * HTTP/1.1\r\nHost: x\r\n\r\n").status, 400);
  EXPECT_EQ(raw("CONNECT x:443 HTTP/1.1\r\nHost: x\r\n\r\n").status, 400);
}

TEST_F(Strangers, GetNoRequestPastAnotherByItsHead) {
  const std::string rest = "Host: x\r\nContent-Type: application/json\r\n";
  EXPECT_EQ(
      raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n")
          .status,
      411);
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest +
                "Transfer-Encoding: xchunked\r\nContent-Length: 2\r\n\r\n{}")
                .status,
            411);
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Content-Length: 2, 2\r\n\r\n{}").status,
            411);
  const int both = raw("POST /api/sign-in HTTP/1.1\r\n" + rest +
                       "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n")
                       .status;
  EXPECT_TRUE(both == 400 || both == 411) << both;
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest +
                "Content-Length: 2\r\nContent-Length: 3\r\n\r\n{} ")
                .status,
            400);
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Content-Length: -1\r\n\r\n").status,
            400);
  EXPECT_EQ(
      raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Content-Length: 18446744073709551617\r\n\r\n")
          .status,
      400);
  EXPECT_EQ(raw("GET / HTTP/1.1\r\nHost: x\r\nX: a\r\nX: b\r\n\r\n").status, 400)
      << "a field twice";
  EXPECT_EQ(raw("GET / HTTP/1.1\r\nHost: x\r\nX : a\r\n\r\n").status, 400)
      << "a space before the colon";
  EXPECT_EQ(raw("nonsense\r\n\r\n").status, 400);
  EXPECT_EQ(raw("GET / HTTP/1.1\r\nHost: x\r\nX: " + std::string(9000, 'a') + "\r\n\r\n").status,
            431);
}

TEST_F(Strangers, SendNoMoreThanADoorTakes) {
  const auto sized = [&](const char* method, const char* path, std::uint64_t bytes) {
    return raw(std::string(method) + " " + path +
               " HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: " +
               std::to_string(bytes) + "\r\n\r\n")
        .status;
  };
  EXPECT_EQ(sized("POST", "/api/sign-in", (16U << 10) + 1), 413);
  EXPECT_EQ(sized("POST", "/api/sign-in", 1ULL << 60), 413);
  EXPECT_EQ(sized("GET", "/", 1), 413);
  EXPECT_EQ(sized("POST", "/station/enrol", 1U << 20), 413);
  const Visitor officer = opened_->signed_in(Role::officer);
  EXPECT_EQ(officer.ask("POST", "/api/roster/preview", std::string((4U << 20) + 1, ' ')).status,
            413);
  EXPECT_EQ(officer.ask("POST", "/api/roster/preview", std::string(1U << 20, '[')).status, 400)
      << "brackets alone";
}

TEST_F(Strangers, AreCutOffWhenTheyAreSlow) {
  const auto ended_within = [&](const std::string& first, std::chrono::milliseconds time) {
    Wire wire(opened_->port());
    wire.send(first);
    const auto from = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - from < time) {
      if (!wire.send("a")) return true;  // a letter each tenth of a second, for ever
      std::this_thread::sleep_for(100ms);
    }
    return false;
  };
  EXPECT_TRUE(ended_within("GET / HTTP/1.1\r\nX: ", 6s)) << "a head that never ends";
  EXPECT_TRUE(ended_within(
      "POST /api/sign-in HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 10000\r\n\r\n",
      6s))
      << "a body that never ends";
}

TEST_F(Strangers, WhoComeAllAtOnceLeaveTheOthersTheirTurn) {
  std::vector<std::unique_ptr<Wire>> idle;
  for (int i = 0; i < 60; ++i) idle.push_back(std::make_unique<Wire>(opened_->port()));
  std::this_thread::sleep_for(2500ms);  // idle ones have had their time
  EXPECT_EQ(opened_->visitor().get("/").status, 200);
}

TEST_F(Strangers, AreToldThatARequestNamesItsHost) {
  EXPECT_EQ(raw("GET / HTTP/1.1\r\nX: a\r\n\r\n").status, 400);
  EXPECT_EQ(raw("GET / HTTP/1.0\r\n\r\n").status, 200) << "the old ones need none";
}

TEST_F(Strangers, HearTheHeadAloneOfWhatTheyWouldGet) {
  for (const char* path : {"/", "/office.css", "/api/me", "/nothing"}) {
    Wire wire(opened_->port());
    wire.send("HEAD " + std::string(path) + " HTTP/1.1\r\nHost: x\r\n\r\nGET " + path +
              " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    const std::string both = wire.hear_for(10s);
    const auto end = both.find("\r\n\r\n");
    ASSERT_NE(end, std::string::npos) << path;
    const std::string rest =
        both.substr(end + 4);  // nothing stands between the first head and the second
    ASSERT_TRUE(rest.starts_with("HTTP/1.1 ")) << path << ": " << rest.substr(0, 80);
    EXPECT_EQ(both.substr(0, 12), rest.substr(0, 12)) << path;
    const std::string body = rest.substr(rest.find("\r\n\r\n") + 4);
    EXPECT_FALSE(body.empty()) << path;
    EXPECT_NE(both.substr(0, end).find("Content-Length: " + std::to_string(body.size())),
              std::string::npos)
        << path;
  }
}

/// Connections that say nothing for ever, each opened anew as soon as the other side ends it.
class Silent {
 public:
  Silent(std::uint16_t port, std::size_t count)
      : port_(port), sockets_(count), opener_([this] { keep_open(); }) {}
  ~Silent() {
    ends_ = true;
    opener_.join();
  }
  Silent(const Silent&) = delete;
  Silent& operator=(const Silent&) = delete;
  [[nodiscard]] std::size_t opened() const { return opened_; }

 private:
  void keep_open() {
    for (pollfd& s : sockets_) open(s);
    while (!ends_) {
      ::poll(sockets_.data(), sockets_.size(), 20);
      for (pollfd& s : sockets_)
        if (s.revents != 0) {
          ::close(s.fd);
          open(s);
        }
    }
    for (const pollfd& s : sockets_) ::close(s.fd);
  }
  void open(pollfd& s) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port_);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    s = {::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), POLLIN, 0};
    if (::connect(s.fd, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) == 0) ++opened_;
  }

  std::uint16_t port_;
  std::vector<pollfd> sockets_;
  std::atomic<bool> ends_ = false;
  std::atomic<std::size_t> opened_ = 0;
  std::thread opener_;
};

TEST(ManySilentConnections, LeaveTheirPlaceToWhoAsksSomething) {
  constexpr std::size_t k_silent = 700;
  constexpr long k_max_kb = 400'000;
  const testing_ledger::School school;
  const Served served(school);
  const std::string ask = "GET /office.css HTTP/1.1\r\nHost: x\r\n\r\n";
  Wire before(served.port());  // as a station that is here
  before.send(ask);
  ASSERT_EQ(before.hear().status, 200);
  const Silent silent(served.port(), k_silent);
  while (silent.opened() < k_silent) std::this_thread::sleep_for(10ms);
  for (int i = 0; i < 20; ++i) {
    const auto from = std::chrono::steady_clock::now();
    EXPECT_EQ((Visitor{served.port()}.get("/office.css").status), 200) << i;
    EXPECT_LT(std::chrono::steady_clock::now() - from, 2s) << i;
    before.send(ask);
    ASSERT_EQ(before.hear().status, 200) << "who is known stays, " << i;
    std::this_thread::sleep_for(200ms);
  }
  EXPECT_GT(silent.opened(), k_silent) << "none of them was ever dropped";
  EXPECT_LT(served.peak_kb(), k_max_kb);
  std::printf("%zu silent connections opened, the server's memory at most %ld kB\n",
              silent.opened(), served.peak_kb());
}

TEST(ManyWhoAskAsNobody, LeaveTheirPlaceToOthersAndTakeNoneFromWhoIsSignedIn) {
  const Opened opened;
  const Visitor officer = opened.signed_in(Role::officer);
  const std::string ask = "GET /station/hello HTTP/1.1\r\nHost: x\r\n\r\n";
  Wire trusted(opened.port());
  const std::string me =
      "GET /api/me HTTP/1.1\r\nHost: x\r\nCookie: __Host-cavum=" + officer.cookie + "\r\n\r\n";
  trusted.send(me);
  ASSERT_EQ(trusted.hear().status, 200);
  std::vector<std::unique_ptr<Wire>> nobody;
  for (int i = 0; i < 600; ++i) {
    nobody.push_back(std::make_unique<Wire>(opened.port()));
    nobody.back()->send(ask);
    ASSERT_EQ(nobody.back()->hear().status, 200) << i;
  }
  EXPECT_EQ(officer.get("/api/me").status, 200) << "a new connection";
  trusted.send(me);
  EXPECT_EQ(trusted.hear().status, 200) << "who is signed in stays";
}

TEST(Certificate, IsMadeOnceWithAKeyForItsOwnerAlone) {
  const testing_basics::Folder folder;
  const CertificateFiles files{folder.file("office/certificate.pem"),
                               folder.file("office/certificate.key")};
  make_certificate(files, {"localhost", "127.0.0.1", "::1", "office.example"});
  struct stat facts {};
  ASSERT_EQ(::stat(files.key.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777U, 0600U);
  const std::string before = fingerprint_of(files.certificate);
  EXPECT_EQ(before.size(), 64u);
  make_certificate(files, {"other"});
  EXPECT_EQ(fingerprint_of(files.certificate), before);
  std::filesystem::remove(files.key);
  EXPECT_THROW(make_certificate(files, {"localhost"}), Error)
      << "no other key under a certificate that people know";
  write_text_file(files.certificate, "nothing");
  EXPECT_THROW(static_cast<void>(fingerprint_of(files.certificate)), Error);
}

}  // namespace
}  // namespace cavum::office
