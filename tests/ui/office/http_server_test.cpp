// What a stranger may send to the server: heads, paths and bodies that no browser would send, too much, too slowly, and too many at once.
#include "ui/office/http_server.h"

#include <sys/stat.h>

#include <chrono>

#include "tests/ui/office/opened.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace std::chrono_literals;

HttpLimits hasty() {
  HttpLimits limits;
  limits.handshake_s = limits.head_s = limits.body_s = 1;
  limits.most_connections = 20;
  return limits;
}

class Strangers : public testing::Test {
 protected:
  static void SetUpTestSuite() { opened_ = new Opened(hasty()); }
  static void TearDownTestSuite() { delete opened_; }
  void TearDown() override { EXPECT_EQ(opened_->visitor().get("/").status, 200) << "it still serves"; }
  static Heard raw(const std::string& bytes) {
    Wire wire(opened_->port());
    wire.send(bytes);
    return wire.hear();
  }
  static inline Opened* opened_ = nullptr;
};

TEST_F(Strangers, HearWhatABrowserMayDo) {
  const Heard page = opened_->visitor().get("/");
  EXPECT_EQ(page.fields.at("content-security-policy"),
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; form-action 'self'; "
            "frame-ancestors 'none'; base-uri 'none'");
  EXPECT_TRUE(page.fields.at("strict-transport-security").starts_with("max-age="));
  EXPECT_EQ(page.fields.at("x-content-type-options"), "nosniff");
  EXPECT_EQ(page.fields.at("referrer-policy"), "no-referrer");
  EXPECT_EQ(page.fields.at("cache-control"), "no-store");
  EXPECT_EQ(page.body.find("<style"), std::string::npos);
  EXPECT_EQ(page.body.find("style="), std::string::npos);
  EXPECT_EQ(page.body.find("<script>"), std::string::npos);
  EXPECT_EQ(opened_->visitor().get("/nothing").fields.at("content-security-policy"), page.fields.at("content-security-policy"));
}

TEST_F(Strangers, FindNothingBehindTrickyPaths) {
  for (const char* path : {"/../etc/passwd", "/%2e%2e/etc/passwd", "//", "/office.js/../office.js", "/office.js%00", "/.", "/api",
                           "/station/sessions/..", "/station/sessions/%2e%2e%2f", "/\\..\\x", "/office.css?../../x/", "/API/ME"}) {
    const int status = opened_->visitor().get(path).status;
    EXPECT_TRUE(status == 404 || status == 400 || (status == 200 && std::string(path).starts_with("/office.css?"))) << path << ": " << status;
  }
  EXPECT_EQ(raw("GET https://elsewhere.example/ HTTP/1.1\r\nHost: x\r\n\r\n").status, 400);
  EXPECT_EQ(raw("GET * HTTP/1.1\r\nHost: x\r\n\r\n").status, 400);
  EXPECT_EQ(raw("CONNECT x:443 HTTP/1.1\r\nHost: x\r\n\r\n").status, 400);
}

TEST_F(Strangers, GetNoRequestPastAnotherByItsHead) {
  const std::string rest = "Host: x\r\nContent-Type: application/json\r\n";
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n").status, 411);
  const int both = raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n").status;
  EXPECT_TRUE(both == 400 || both == 411) << both;
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Content-Length: 2\r\nContent-Length: 3\r\n\r\n{} ").status, 400);
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Content-Length: -1\r\n\r\n").status, 400);
  EXPECT_EQ(raw("POST /api/sign-in HTTP/1.1\r\n" + rest + "Content-Length: 18446744073709551617\r\n\r\n").status, 400);
  EXPECT_EQ(raw("GET / HTTP/1.1\r\nHost: x\r\nX: a\r\nX: b\r\n\r\n").status, 400) << "a field twice";
  EXPECT_EQ(raw("GET / HTTP/1.1\r\nHost: x\r\nX : a\r\n\r\n").status, 400) << "a space before the colon";
  EXPECT_EQ(raw("nonsense\r\n\r\n").status, 400);
  EXPECT_EQ(raw("GET / HTTP/1.1\r\nHost: x\r\nX: " + std::string(9000, 'a') + "\r\n\r\n").status, 431);
}

TEST_F(Strangers, SendNoMoreThanADoorTakes) {
  const auto sized = [&](const char* method, const char* path, std::uint64_t bytes) {
    return raw(std::string(method) + " " + path +
               " HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(bytes) + "\r\n\r\n")
        .status;
  };
  EXPECT_EQ(sized("POST", "/api/sign-in", (16U << 10) + 1), 413);
  EXPECT_EQ(sized("POST", "/api/sign-in", 1ULL << 60), 413);
  EXPECT_EQ(sized("GET", "/", 1), 413);
  EXPECT_EQ(sized("POST", "/station/enrol", 1U << 20), 413);
  const Visitor officer = opened_->signed_in(Role::officer);
  EXPECT_EQ(officer.ask("POST", "/api/roster/preview", std::string((4U << 20) + 1, ' ')).status, 413);
  EXPECT_EQ(officer.ask("POST", "/api/roster/preview", std::string(1U << 20, '[')).status, 400) << "brackets alone";
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
  EXPECT_TRUE(ended_within("POST /api/sign-in HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 10000\r\n\r\n", 6s))
      << "a body that never ends";
}

TEST_F(Strangers, WhoComeAllAtOnceLeaveTheOthersTheirTurn) {
  std::vector<std::unique_ptr<Wire>> idle;
  for (int i = 0; i < 60; ++i) idle.push_back(std::make_unique<Wire>(opened_->port()));
  std::this_thread::sleep_for(2500ms);  // idle ones have had their time
  EXPECT_EQ(opened_->visitor().get("/").status, 200);
}

TEST(Certificate, IsMadeOnceWithAKeyForItsOwnerAlone) {
  const testing_basics::Folder folder;
  const CertificateFiles files{folder.file("office/certificate.pem"), folder.file("office/certificate.key")};
  make_certificate(files, {"localhost", "127.0.0.1", "::1", "office.example"});
  struct stat facts {};
  ASSERT_EQ(::stat(files.key.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777U, 0600U);
  const std::string before = fingerprint_of(files.certificate);
  EXPECT_EQ(before.size(), 64u);
  make_certificate(files, {"other"});
  EXPECT_EQ(fingerprint_of(files.certificate), before);
  std::filesystem::remove(files.key);
  EXPECT_THROW(make_certificate(files, {"localhost"}), Error) << "no other key under a certificate that people know";
  write_text_file(files.certificate, "nothing");
  EXPECT_THROW(static_cast<void>(fingerprint_of(files.certificate)), Error);
}

}  // namespace
}  // namespace cavum::office
