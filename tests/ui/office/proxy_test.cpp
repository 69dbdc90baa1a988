// Sign-in by a reverse proxy: believed from its address and with the secret alone, for accounts
// that exist, with the office's own roles.
#include "ui/office/proxy.h"

#include "engine/base/error.h"
#include "tests/ui/office/opened.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using nlohmann::json;

const std::string k_secret = "0123456789abcdef0123456789abcdef";
constexpr char k_eva[] = "eva.stein@uni.example";
using Fields = std::map<std::string, std::string>;

Fields by_proxy(const std::string& who, const std::string& secret = k_secret) {
  return {{"X-Auth-Request-Email", who}, {"X-Cavum-Proxy-Secret", secret}};
}

TEST(ProxyWord, IsBelievedFromItsAddressWithItsSecretAlone) {
  const ProxySignOn proxy = proxy_sign_on("192.0.2.7", k_secret, "X-Auth-Request-Email");
  const auto heard = [&](const std::string& address,
                         const std::map<std::string, std::string>& fields) {
    Head head;
    head.address = address, head.fields = fields;
    return proxy_word(head, proxy);
  };
  const std::map<std::string, std::string> right = {{"x-auth-request-email", k_eva},
                                                    {"x-cavum-proxy-secret", k_secret}};
  EXPECT_EQ(heard("192.0.2.7", right).known_as, k_eva);
  EXPECT_EQ(heard("::ffff:192.0.2.7", right).known_as, k_eva)
      << "the same address at a socket for IPv6";
  EXPECT_TRUE(heard("192.0.2.8", right).refused);
  EXPECT_TRUE(heard("192.0.2.70", right).refused);
  EXPECT_TRUE(heard("", right).refused);
  EXPECT_TRUE(heard("192.0.2.7", {{"x-auth-request-email", k_eva}}).refused)
      << "without the secret";
  EXPECT_TRUE(heard("192.0.2.7",
                    {{"x-auth-request-email", k_eva}, {"x-cavum-proxy-secret", k_secret + "0"}})
                  .refused);
  EXPECT_TRUE(
      heard("192.0.2.7", {{"x-auth-request-email", k_eva}, {"x-cavum-proxy-secret", ""}}).refused);
  EXPECT_TRUE(heard("192.0.2.7",
                    {{"x-auth-request-email", "two\nlines"}, {"x-cavum-proxy-secret", k_secret}})
                  .refused);
  EXPECT_FALSE(heard("192.0.2.8", {}).refused) << "a station, or a person with a password";
  const ProxyWord nobody = heard("192.0.2.7", {{"x-cavum-proxy-secret", k_secret}});
  EXPECT_FALSE(nobody.refused);
  EXPECT_EQ(nobody.known_as, "");
  Head head;
  head.address = "192.0.2.7", head.fields = right;
  EXPECT_EQ(proxy_word(head, std::nullopt).known_as, "") << "off unless it is set up";
}

TEST(ProxyWord, IsSetUpOnlyWithAnAddressAFieldAndASecretThatAreSome) {
  EXPECT_EQ(proxy_sign_on("::0001", k_secret, "Remote-User").address, "::1");
  for (const auto& [address, secret, field] :
       {std::tuple<std::string, std::string, std::string>{"proxy.example", k_secret, "Remote-User"},
        {"", k_secret, "Remote-User"},
        {"127.0.0.1/8", k_secret, "Remote-User"},
        {"127.0.0.1", "short", "Remote-User"},
        {"127.0.0.1", k_secret, ""},
        {"127.0.0.1", k_secret, "Remote User"},
        {"127.0.0.1", k_secret, "X-Cavum-Proxy-Secret"}})
    EXPECT_THROW(static_cast<void>(proxy_sign_on(address, secret, field)), Error)
        << address << " " << field;
}

class BehindAProxy : public ::testing::Test {
 protected:
  void SetUp() override {
    opened_.accounts().set("Eva Stein", Role::examiner, k_password, false, k_eva);
    stand_behind("127.0.0.1");
  }
  void stand_behind(const std::string& address) {
    opened_.close();
    opened_.stand_behind(proxy_sign_on(address, k_secret, "X-Auth-Request-Email"));
    opened_.open();
  }
  [[nodiscard]] Heard sign_in(Visitor& v, const Fields& fields) const {
    const Heard heard = v.ask("POST", "/api/sign-in/proxy", "{}", fields);
    if (heard.status != 200) return heard;
    const std::string cookie = heard.fields.at("set-cookie");
    v.cookie = cookie.substr(cookie.find('=') + 1, 64);
    v.token = heard.json()["token"];
    return heard;
  }
  Opened opened_;
};

TEST_F(BehindAProxy, APersonWithAnAccountHasItsRole) {
  Visitor v = opened_.visitor();
  const json me = sign_in(v, by_proxy(k_eva)).json();
  EXPECT_EQ(me["name"], "Eva Stein");
  EXPECT_EQ(me["role"], "examiner");
  EXPECT_EQ(v.ask("GET", "/api/queue", "", by_proxy(k_eva)).status, 200);
  EXPECT_EQ(v.ask("POST", "/api/release", "{}", by_proxy(k_eva)).status, 403)
      << "roles stay the office's";
}

TEST_F(BehindAProxy, NobodyElseComesIn) {
  Visitor v = opened_.visitor();
  EXPECT_EQ(sign_in(v, by_proxy("mallory@uni.example")).status, 403) << "no account";
  EXPECT_EQ(sign_in(v, by_proxy("EVA.stein@uni.example")).status, 403) << "letter by letter";
  EXPECT_EQ(sign_in(v, by_proxy("Eva Stein")).status, 403)
      << "an account's name is not what the proxy says";
  EXPECT_EQ(sign_in(v, by_proxy("")).status, 401);
  EXPECT_EQ(sign_in(v, {}).status, 401);
  EXPECT_EQ(sign_in(v, by_proxy(k_eva, std::string(32, '0'))).status, 403);
  EXPECT_EQ(sign_in(v, {{"X-Auth-Request-Email", k_eva}}).status, 403);
  EXPECT_EQ(sign_in(v, {{"X-Auth-Request-Email", k_eva},
                        {"x-auth-request-EMAIL", k_eva},
                        {"X-Cavum-Proxy-Secret", k_secret}})
                .status,
            400)
      << "twice";
  EXPECT_EQ(v.ask("GET", "/", "", {{"X-Auth-Request-Email", k_eva}}).status, 403)
      << "whatever is asked";
  EXPECT_EQ(v.ask("POST", "/api/sign-in/proxy", "{}",
                  [] {
                    Fields f = by_proxy(k_eva);
                    f["Origin"] = "https://elsewhere.example";
                    return f;
                  }())
                .status,
            403);
  EXPECT_EQ(v.get("/").status, 200) << "without the fields all is as ever";
}

TEST_F(BehindAProxy, ASignInLastsOnlyAsLongAsTheProxySaysSo) {
  Visitor v = opened_.visitor();
  ASSERT_EQ(sign_in(v, by_proxy(k_eva)).status, 200);
  EXPECT_EQ(v.get("/api/me").status, 401) << "the cookie without the proxy";
  EXPECT_EQ(v.ask("GET", "/api/me", "", by_proxy("mallory@uni.example")).status, 401)
      << "another person at the same computer";
  EXPECT_EQ(v.ask("GET", "/api/me", "", by_proxy(k_eva)).status, 200);
  opened_.accounts().remove("Eva Stein");
  EXPECT_EQ(v.ask("GET", "/api/me", "", by_proxy(k_eva)).status, 401);
  EXPECT_EQ(opened_.signed_in(Role::officer).get("/api/me").status, 200)
      << "by a password, as ever";
}

TEST_F(BehindAProxy, FromAnotherAddressNothingIsBelieved) {
  stand_behind("127.0.0.2");
  Visitor v = opened_.visitor();
  EXPECT_EQ(sign_in(v, by_proxy(k_eva)).status, 403) << "even with the secret";
}

TEST_F(BehindAProxy, TwoAccountsAreNotKnownAsOne) {
  EXPECT_THROW(opened_.accounts().set("Mallory", Role::officer, k_password, false, k_eva), Error);
  EXPECT_THROW(opened_.accounts().set("Mallory", Role::officer, k_password, false, "a\nb"), Error);
}

TEST(WithoutAProxy, TheDoorIsNone) {
  const Opened opened;
  EXPECT_EQ(opened.visitor().ask("POST", "/api/sign-in/proxy", "{}", by_proxy(k_eva)).status, 404);
}

}  // namespace
}  // namespace cavum::office
