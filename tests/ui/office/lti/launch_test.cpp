// Launches from a learning platform: who sees what, and what is refused. The platform is an
// emulator of its own (platform.py).
#include "engine/base/hash.h"
#include "tests/ui/office/lti/platform.h"
#include "ui/office/lti/client.h"
#include "ui/office/lti/lti_error.h"
#include "ui/office/site.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using nlohmann::json;

/// An office that knows the platform; nobody sat yet.
class Launches : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    opened_ = new Opened();
    platform_ = new Platform(opened_->address());
    platforms().set(platform_in(platform_->set_up()));
  }
  static void TearDownTestSuite() {
    EXPECT_EQ(platform_->control()["violations"], json::array())
        << "what this office sent and a standard refuses";
    delete platform_;
    delete opened_;
  }
  static LtiPlatforms platforms() { return LtiPlatforms(opened_->home() + "/platforms.json"); }
  static Browser browser() { return {opened_->port(), platform_}; }
  static inline Opened* opened_ = nullptr;
  static inline Platform* platform_ = nullptr;
};

TEST_F(Launches, AreLetInWhenAllIsRight) {
  for (const char* right : {"", "aud_list"}) {
    Browser b = browser();
    const Heard come = b.launch("Learner:4711", right);
    EXPECT_EQ(come.status, 303) << come.body;
    EXPECT_EQ(come.fields.at("location"), "/lti/result");
    const Heard page = b.ask("GET", "/lti/result");
    EXPECT_EQ(page.status, 200);
    EXPECT_NE(page.body.find("Name of 4711"), std::string::npos) << page.body;
    EXPECT_EQ(page.body.find("/lti/report/"), std::string::npos) << page.body;
  }
  EXPECT_EQ(browser().ask("GET", "/lti/result").status, 401);
  EXPECT_EQ(browser().ask("GET", "/lti/report/" + std::string(64, 'a')).status, 401);
}

TEST_F(Launches, AreRefusedForWhateverIsWrongInTheToken) {
  const std::vector<std::pair<LtiError, std::vector<std::string>>> attacks = {
      {LtiError::algorithm, {"alg_none", "alg_none_capitals", "hs256", "hs256_der", "rs384"}},
      {LtiError::signature, {"pss_as_rs256", "other_key", "own_jwk", "cut", "changed"}},
      {LtiError::key, {"other_kid", "no_kid", "small_key", "own_jku"}},
      {LtiError::not_understood, {"crit"}},
      {LtiError::twice, {"twice"}},
      {LtiError::too_late, {"expired", "future", "old"}},
      {LtiError::incomplete, {"no_exp", "exp_text", "no_link", "no_sub", "no_roles"}},
      {LtiError::audience, {"aud_other", "aud_two", "azp_other"}},
      {LtiError::platform, {"iss_other"}},
      {LtiError::login, {"nonce_other", "no_nonce"}},
      {LtiError::deployment, {"deployment_other"}},
      {LtiError::message, {"type_other", "version_other"}},
      {LtiError::target, {"target_other"}},
      {LtiError::role, {"role_other"}}};
  PlatformKeys keys;
  for (const auto& [why, list] : attacks)
    for (const std::string& attack : list) {
      Browser b = browser();
      LtiLogins logins;
      const std::int64_t now = read_clocks().utc_ns / 1'000'000'000;
      const LtiLogin login =
          logins.begin(platforms(), form_fields(b.begun("Learner:4711", attack)), now);
      EXPECT_EQ(testing_basics::code_of([&] {
                  static_cast<void>(logins.finish(
                      platforms(), form_fields(b.form_at(login.address)), login.cookie,
                      [&](const LtiPlatform& p, const std::string& kid) { return keys.of(p, kid); },
                      now));
                }),
                why)
          << attack;
      const Heard heard = b.launch("Learner:4711", attack);
      EXPECT_EQ(heard.status, 400) << attack;
      EXPECT_FALSE(b.cookies.contains(k_visit_cookie)) << attack;
      EXPECT_FALSE(b.cookies.contains(k_cookie)) << attack;
    }
  EXPECT_FALSE(platform_->control()["asked"].contains("/elsewhere"))
      << "an address in a token is not asked";
}

TEST_F(Launches, AreGoodOnceAndOnlyInTheBrowserThatBeganThem) {
  Browser b = browser(), other = browser();
  const std::string form = b.form("Learner:4711");
  EXPECT_EQ(other.ask("POST", "/lti/launch", form).status, 400) << "without a cookie";
  static_cast<void>(other.form("Learner:4712"));
  EXPECT_EQ(other.ask("POST", "/lti/launch", form).status, 400) << "another browser's";
  Browser changed = b;
  changed.cookies["__Host-cavum-login"][3] ^= 1;
  EXPECT_EQ(changed.ask("POST", "/lti/launch", form).status, 400);
  EXPECT_EQ(b.ask("POST", "/lti/launch", form + "&state=" + std::string(64, '0')).status, 400)
      << "a field twice";
  EXPECT_EQ(b.ask("POST", "/lti/launch", form, {{"Content-Type", "application/json"}}).status, 415);
  EXPECT_EQ(b.ask("POST", "/lti/launch", form).status, 303);
  EXPECT_EQ(b.ask("POST", "/lti/launch", form).status, 400) << "it was used before";
}

TEST_F(Launches, TakeNoLongerThanTenMinutes) {
  LtiLogins logins;
  const std::string query = browser().begun("Learner:4711");
  const std::int64_t now = read_clocks().utc_ns / 1'000'000'000;
  const LtiLogin login = logins.begin(platforms(), form_fields(query), now);
  const auto at = login.address.find("&state=") + 7;
  const auto finish = [&](LtiLogins& of, std::int64_t when) {
    return testing_basics::code_of([&] {
      static_cast<void>(of.finish(
          platforms(), {{"state", login.address.substr(at, 64)}, {"id_token", "x"}}, login.cookie,
          [](const LtiPlatform&, const std::string&) { return json(); }, when));
    });
  };
  EXPECT_EQ(finish(logins, now + 601), LtiError::too_late);
  EXPECT_EQ(finish(logins, now + 599), LtiError::not_understood)
      << "in time its token is looked at";
  LtiLogins restarted;
  EXPECT_EQ(finish(restarted, now), LtiError::login)
      << "each run of the server has a secret of its own";
}

TEST_F(Launches, LeadNowhereButHere) {
  Browser b = browser();
  const std::string right = b.begun("Learner:4711"),
                    tool = url_encoded(opened_->address() + "/lti/launch");
  const auto with = [&](const std::string& target) {
    std::string out = right;
    return out.replace(out.find(tool), tool.size(), url_encoded(target));
  };
  for (const std::string& target :
       {std::string("https://elsewhere.example/"),
        opened_->address() + ".elsewhere.example/lti/launch",
        opened_->address() + "@elsewhere.example/lti/launch", opened_->address() + "/",
        std::string("//elsewhere.example/lti/launch"), std::string("javascript:alert(1)"),
        opened_->address() + "/lti/launch#x"}) {
    const Heard heard = b.ask("GET", "/lti/login?" + with(target));
    EXPECT_EQ(heard.status, 400) << target;
    EXPECT_FALSE(heard.fields.contains("location")) << target;
  }
  EXPECT_EQ(b.ask("GET", "/lti/login?" + with("https://x\r\nSet-Cookie: a=b")).status, 400);
  std::string unknown = right;
  unknown.replace(unknown.find("cavum-1"), 7, "cavum-2");
  EXPECT_EQ(b.ask("GET", "/lti/login?" + unknown).status, 400);
  EXPECT_EQ(
      b.ask("GET",
            "/lti/login?iss=https%3A%2F%2Felsewhere.example&login_hint=x&target_link_uri=" + tool)
          .status,
      400);
  EXPECT_EQ(b.ask("GET", "/lti/login").status, 400);
  EXPECT_EQ(b.ask("POST", "/lti/login", right).status, 302) << "a form does, too";
}

TEST_F(Launches, OpenAWindowWhereTheyStandInAFrame) {
  Browser b = browser();
  const Heard framed = b.ask("GET", "/lti/login?" + b.begun("Learner:4711", "a%22%3E%3Cscript%3E"),
                             "", {{"Sec-Fetch-Dest", "iframe"}});
  EXPECT_EQ(framed.status, 200);
  EXPECT_NE(framed.body.find("target=\"_blank\""), std::string::npos);
  EXPECT_EQ(framed.body.find("<script"), std::string::npos);
  EXPECT_TRUE(b.cookies.empty());
  const std::string policy = framed.fields.at("content-security-policy");
  EXPECT_NE(policy.find("frame-ancestors " + platform_->issuer()), std::string::npos) << policy;
  EXPECT_EQ(policy.find("script-src"), std::string::npos);
  ASSERT_EQ(b.launch("Learner:4711").status, 303);
  EXPECT_NE(b.ask("GET", "/lti/result")
                .fields.at("content-security-policy")
                .find("frame-ancestors 'none'"),
            std::string::npos)
      << "results never do";
  EXPECT_NE(b.ask("GET", "/").fields.at("content-security-policy").find("frame-ancestors 'none'"),
            std::string::npos);
}

TEST_F(Launches, AnInstructorIsAReaderUnlessAnOfficerLinkedHim) {
  Browser b = browser();
  const Heard come = b.launch("Instructor:anna");
  ASSERT_EQ(come.status, 303) << come.body;
  EXPECT_EQ(come.fields.at("location"), "/");
  EXPECT_NE(come.fields.at("set-cookie").find("SameSite=Strict"), std::string::npos);
  const json me = b.ask("GET", "/api/me").json();
  EXPECT_EQ(me["role"], "reader");
  EXPECT_EQ(b.ask("GET", "/api/results").status, 200);
  EXPECT_EQ(b.ask("GET", "/api/queue").status, 403);
  EXPECT_EQ(b.ask("GET", "/api/gradebook.csv").status, 403);
  EXPECT_EQ(b.ask("GET", "/lti/result").status, 401) << "nobody's own results";
  LtiPlatforms set = platforms();
  set.link(platform_->issuer(), "cavum-1", "u-anna", "The examiner");
  ASSERT_EQ(b.launch("Instructor:anna").status, 303);
  EXPECT_EQ(b.ask("GET", "/api/me").json()["name"], "The examiner");
  Browser learner = browser();
  ASSERT_EQ(learner.launch("Learner:anna").fields.at("location"), "/lti/result")
      << "a learner's role is no instructor's";
  set.link(platform_->issuer(), "cavum-1", "u-anna", "");
  ASSERT_EQ(b.launch("Instructor:anna").status, 303);
  EXPECT_EQ(b.ask("GET", "/api/me").json()["role"], "reader");
  set.remove(platform_->issuer(), "cavum-1");
  EXPECT_EQ(b.ask("GET", "/api/me").status, 401) << "at once";
  EXPECT_EQ(learner.ask("GET", "/lti/result").status, 401);
  EXPECT_EQ(b.ask("GET", "/lti/login?" + b.begun("Learner:4711")).status, 400);
  set.set(platform_in(platform_->set_up()));
}

TEST_F(Launches, AskNoHostThatWasNotSetUp) {
  const LtiPlatform p = platform_in(platform_->set_up());
  const std::string port = std::to_string(platform_->number());
  EXPECT_EQ(ask_platform(p, "GET", p.jwks_url).status, 200);
  for (const std::string& address :
       {"http://127.0.0.1:" + port + "/jwks",
        "https://127.0.0.1:" + std::to_string(opened_->port()) + "/",
        std::string("https://169.254.169.254/"), std::string("https://127.0.0.1/jwks"),
        "https://x@127.0.0.1:" + port + "/jwks",
        "https://127.0.0.1:" + port + "@elsewhere.example/", std::string("file:///etc/passwd"),
        "https://127.0.0.1:" + port + ".elsewhere.example/",
        "https://127.0.0.1:" + port + "/\r\nX: y", std::string()}) {
    // before anything is sent, and not because nobody answers there
    EXPECT_EQ(testing_basics::code_of([&] { static_cast<void>(ask_platform(p, "GET", address)); }),
              LtiError::address)
        << address;
  }
  platform_->control({{"jwks", "redirect"}});
  PlatformKeys keys;
  EXPECT_THROW(static_cast<void>(keys.of(p, "k1")), PlatformUnreachable);
  platform_->control({{"jwks", "endless"}});
  EXPECT_THROW(static_cast<void>(keys.of(p, "k1")), PlatformUnreachable) << "four megabytes";
  const json asked = platform_->control({{"jwks", ""}})["asked"];
  EXPECT_FALSE(asked.contains("/elsewhere")) << "no redirect is followed";
  EXPECT_TRUE(has_key(keys.of(p, "k1"), "k1"));
  const int before = platform_->control()["asked"]["/jwks"];
  for (int i = 0; i < 20; ++i) static_cast<void>(keys.of(p, "drawn-" + std::to_string(i)));
  EXPECT_EQ(platform_->control()["asked"]["/jwks"], before)
      << "unknown keys do not make it ask again and again";
  LtiPlatform stranger = p;
  stranger.certificate = read_text_file(opened_->certificate());
  EXPECT_THROW(static_cast<void>(ask_platform(stranger, "GET", p.jwks_url)), PlatformUnreachable)
      << "another certificate";
  stranger.certificate.clear();
  EXPECT_THROW(static_cast<void>(ask_platform(stranger, "GET", p.jwks_url)), PlatformUnreachable)
      << "none that this computer trusts";
}

TEST_F(Launches, ASetUpNeedsAddressesOfHttpsAndOneSourceOfKeys) {
  const json right = platform_->set_up();
  EXPECT_NO_THROW(static_cast<void>(platform_in(right)));
  const auto with = [&](const char* name, const json& value) {
    json out = right;
    out[name] = value;
    return out;
  };
  for (const char* name : {"office", "issuer", "auth_endpoint", "token_endpoint", "jwks_url"})
    for (const char* wrong : {"http://moodle.example/", "moodle.example", "https://",
                              "https://a b/", "https://a/#x", "https://a:99999/", "javascript:1"})
      EXPECT_THROW(static_cast<void>(platform_in(with(name, wrong))), Error)
          << name << " " << wrong;
  EXPECT_THROW(static_cast<void>(platform_in(with("hosts", {"http://school.example"}))), Error);
  EXPECT_TRUE(platform_in(with("hosts", {"https://School.example/"}))
                  .may_ask("https://school.example/api/lti"));
  EXPECT_FALSE(platform_in(right).may_ask("https://school.example/api/lti"));
  EXPECT_THROW(static_cast<void>(platform_in(with("deployments", json::array()))), Error);
  EXPECT_THROW(static_cast<void>(platform_in(with("claim", "name"))), Error) << "never by name";
  EXPECT_THROW(static_cast<void>(platform_in(with("key_set", {{"keys", json::array()}}))), Error)
      << "two sources of keys";
  EXPECT_THROW(static_cast<void>(platform_in(with("jwks_url", ""))), Error) << "and none";
}

TEST_F(Launches, AreSetUpByAnOfficerWithHisCode) {
  const Visitor officer = opened_->signed_in(Role::officer);
  json other = platform_->set_up();
  other["client_id"] = "cavum-9";
  EXPECT_EQ(officer.post("/api/lti/set", {{"platform", other}, {"code", "000000"}}).status, 400);
  const Heard set = officer.post("/api/lti/set", {{"platform", other}, {"code", opened_->code()}});
  ASSERT_EQ(set.status, 200) << set.body;
  const json shown = set.json();
  ASSERT_EQ(shown["platforms"].size(), 2U);
  EXPECT_EQ(shown["platforms"][1]["addresses"]["login"], opened_->address() + "/lti/login");
  EXPECT_EQ(shown["keys"].size(), 1U);
  EXPECT_EQ(set.body.find("PRIVATE"), std::string::npos) << "a secret";
  const json before = opened_->visitor().get("/lti/jwks").json();
  ASSERT_EQ(officer.post("/api/lti/new-key", {{"code", opened_->code(1)}}).status, 200);
  const json after = opened_->visitor().get("/lti/jwks").json();
  ASSERT_EQ(after["keys"].size(), 2U);
  EXPECT_EQ(after["keys"][1], before["keys"][0]) << "the one before is still known";
  EXPECT_EQ(after.dump().find("\"d\""), std::string::npos);
  platforms().remove(platform_->issuer(), "cavum-9");
}

}  // namespace
}  // namespace cavum::office
