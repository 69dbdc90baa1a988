// Who may go which route: the table against one that is written here, and the running server
// against both.
#include "ui/office/routes.h"

#include <set>

#include "tests/ui/office/opened.h"

namespace cavum::office {
namespace {

using namespace testing_office;

/// Letters of roles: o officer, e examiner, i invigilator, r reader; - nobody has to be known, s a
/// station, c who came from a learning platform, f a form that a platform sends.
const std::map<std::string, std::string> k_expected = {
    {"GET /", "-"},
    {"GET /office.js", "-"},
    {"GET /office.css", "-"},
    {"GET /api/words", "-"},
    {"POST /api/sign-in", "-"},
    {"POST /api/sign-in/proxy", "-"},
    {"POST /api/sign-out", "oeir"},
    {"GET /api/me", "oeir"},
    {"GET /api/exams", "o"},
    {"POST /api/roster/preview", "o"},
    {"POST /api/roster/issue", "o"},
    {"GET /api/tickets", "oi"},
    {"POST /api/tickets/cancel", "o"},
    {"POST /api/tickets/makeup", "o"},
    {"GET /api/board", "oi"},
    {"GET /api/board/events", "oi"},
    {"POST /api/stations/invite", "o"},
    {"POST /api/stations/revoke", "o"},
    {"POST /api/stations/room", "o"},
    {"POST /api/seats", "o"},
    {"GET /api/attendance", "oi"},
    {"GET /api/cards.pdf", "o"},
    {"GET /api/sign-in-sheet.pdf", "oi"},
    {"POST /api/announce", "oi"},
    {"POST /api/hold", "oi"},
    {"POST /api/go-on", "oi"},
    {"GET /api/incidents", "oi"},
    {"POST /api/incidents", "oi"},
    {"GET /api/queue", "oe"},
    {"POST /api/decide", "e"},
    {"GET /api/results", "oer"},
    {"POST /api/release", "o"},
    {"POST /api/retract", "o"},
    {"GET /api/regrade", "oe"},
    {"GET /api/regrade/events", "oe"},
    {"POST /api/regrade/begin", "e"},
    {"POST /api/regrade/count", "e"},
    {"POST /api/regrade/drop", "e"},
    {"GET /api/appeals", "oe"},
    {"POST /api/appeals/open", "o"},
    {"POST /api/appeals/answer", "e"},
    {"POST /api/trail", "oer"},
    {"GET /api/report/*", "oe"},
    {"GET /api/gradebook.csv", "o"},
    {"GET /api/criteria.csv", "oer"},
    {"GET /api/lti", "o"},
    {"POST /api/lti/set", "o"},
    {"POST /api/lti/remove", "o"},
    {"POST /api/lti/link", "o"},
    {"POST /api/lti/new-key", "o"},
    {"POST /api/lti/send", "o"},
    {"GET /lti/jwks", "-"},
    {"GET /lti/login", "-"},
    {"POST /lti/login", "f"},
    {"POST /lti/launch", "f"},
    {"GET /lti/result", "c"},
    {"GET /lti/report/*", "c"},
    {"GET /station/hello", "-"},
    {"POST /station/enrol", "-"},
    {"GET /station/tickets", "s"},
    {"POST /station/begin", "s"},
    {"POST /station/report", "s"},
    {"PUT /station/pieces/*", "s"},
    {"GET /station/pieces/*", "s"},
    {"PUT /station/sessions/*", "s"},
    {"GET /station/sessions/*", "s"},
};

std::string name_of_route(const Route& route) {
  return std::string(route.method) + " " + std::string(route.path);
}

TEST(Routes, AreThoseOfThisTableAndNoOthers) {
  std::map<std::string, std::string> found;
  for (const Route& route : routes()) {
    std::string who = route.asks == Asks::nobody    ? "-"
                      : route.asks == Asks::station ? "s"
                      : route.asks == Asks::came    ? "c"
                      : route.asks == Asks::form    ? "f"
                                                    : "";
    if (route.asks == Asks::person)
      for (const Role r : all_roles())
        if (route.lets(r)) who += name_of(r)[0];
    EXPECT_TRUE(found.emplace(name_of_route(route), who).second)
        << name_of_route(route) << " twice";
    if (route.asks != Asks::person) {
      EXPECT_EQ(route.roles, 0U);
    }
  }
  EXPECT_EQ(found, k_expected);
}

TEST(Routes, ANameOfARoleReadsBack) {
  for (const Role r : all_roles()) EXPECT_EQ(role_named(name_of(r)), r);
  EXPECT_EQ(role_named("Officer"), std::nullopt);
  EXPECT_EQ(role_named(""), std::nullopt);
}

TEST(Routes, OnlyTheExactPathIsOne) {
  EXPECT_NE(route_for("GET", "/api/me"), nullptr);
  const std::string hash(64, 'a');
  EXPECT_NE(route_for("PUT", "/station/sessions/" + hash), nullptr);
  for (const std::string path : {"/api/me/", "/API/me", "//api/me", "/api/../api/me", "/api/%6de",
                                 "/api/me;x", "", "api/me"})
    EXPECT_EQ(route_for("GET", path), nullptr) << path;
  for (const std::string& tail : {std::string(64, 'A'), std::string(63, 'a'), std::string(65, 'a'),
                                  "../" + std::string(61, 'a'), std::string()})
    EXPECT_EQ(route_for("PUT", "/station/sessions/" + tail), nullptr) << tail;
  EXPECT_EQ(route_for("HEAD", "/"), nullptr);
  EXPECT_EQ(route_for("DELETE", "/api/me"), nullptr);
}

TEST(Wire, ARefusalNamesTheField) {
  const auto why = [](const nlohmann::json& asked) -> std::string {
    try {
      static_cast<void>(json_value_of<Issue>(asked, asked_json()));
    } catch (const Error& wrong) {
      return wrong.what();
    }
    return {};
  };
  const nlohmann::json right = {
      {"base64", "aWQK"}, {"exam", "e"}, {"from", "f"}, {"until", "u"}, {"reason", "r"}};
  EXPECT_EQ(why(right), "");
  for (const auto& [field, value] : std::vector<std::pair<std::string, nlohmann::json>>{
           {"base64", 1},
           {"answers", "id"},
           {"exam", std::string(k_longest_line + 1, 'x')},
           {"reason", " "},
           {"reason", nullptr},
           {"another", 1},
           {"at_once", 0},
           {"minutes_apart", 10'081},
           {"first", -1},
           {"most", 1.5}}) {
    nlohmann::json wrong = right;
    wrong[field] = value;
    EXPECT_NE(why(wrong).find("'" + field + "'"), std::string::npos) << wrong << why(wrong);
  }
  nlohmann::json within = right;
  within["answers"] = {"id", 7};
  EXPECT_NE(why(within).find("'answers[1]'"), std::string::npos) << why(within);
}

TEST(Wire, WhatIsWrittenReadsBack) {
  ResultRow row;
  row.session = 7;
  row.verdict = "pass";
  row.points = 12.5;
  row.decided = Decided{9, "Eva", "pass", "looked at it", true};
  row.findings = {{records::FindingKind::clock, "a"}, {records::FindingKind::no_hand, "b"}};
  const nlohmann::json written = to_json_value(row);
  EXPECT_FALSE(written.contains("later"));
  const auto read = json_value_of<ResultRow>(written, asked_json());
  EXPECT_EQ(to_json_value(read), written);
  EXPECT_EQ(read.decided->by, "Eva");
}

/// Every route with every role, signed in and not, with the token and without: the server lets in
/// exactly whom the table names.
class EveryRoute : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { opened_ = new Opened(); }
  static void TearDownTestSuite() { delete opened_; }
  static Heard try_route(const Visitor& v, const Route& route,
                         const std::map<std::string, std::string>& more = {}) {
    if (route.path.ends_with("/events")) {  // it does not end
      Wire wire(v.port);
      wire.send("GET " + std::string(route.path) + " HTTP/1.1\r\nHost: x\r\n" +
                (v.cookie.empty() ? "" : "Cookie: __Host-cavum=" + v.cookie + "\r\n") + "\r\n");
      const std::string begin = wire.hear_for(std::chrono::milliseconds(700));
      return {begin.size() > 12 ? std::stoi(begin.substr(9, 3)) : 0, {}, begin};
    }
    return v.ask(std::string(route.method),
                 route.path_of(route.path.ends_with('*') ? std::string(64, '0') : ""),
                 route.method == "GET" ? "" : "{}", more);
  }
  static inline Opened* opened_ = nullptr;
};

TEST_F(EveryRoute, IsClosedToThoseWhoHaveNotSignedIn) {
  for (const Route& route : routes())
    if (route.asks != Asks::nobody && route.asks != Asks::form) {
      EXPECT_EQ(try_route(opened_->visitor(), route).status, 401) << name_of_route(route);
    }
  Visitor guessed{opened_->port(), std::string(64, '0'), std::string(64, '0')};
  for (const Route& route : routes())
    if (route.asks != Asks::nobody && route.asks != Asks::form) {
      EXPECT_EQ(try_route(guessed, route).status, 401) << name_of_route(route);
    }
}

TEST_F(EveryRoute, LetsInExactlyTheRolesOfTheTable) {
  for (const Role role : all_roles()) {
    for (const Route& route : routes()) {
      if (route.asks == Asks::nobody || route.asks == Asks::form || route.path == "/api/sign-out")
        continue;
      static std::map<Role, Visitor> known;
      if (!known.contains(role)) known[role] = opened_->signed_in(role);
      const Visitor& v = known[role];
      const std::string& expected = k_expected.at(name_of_route(route));
      const int status = try_route(v, route).status;
      if (route.asks == Asks::station || route.asks == Asks::came)
        EXPECT_EQ(status, 401) << name_of_route(route) << " for a person";
      else if (expected.find(name_of(role)[0]) == std::string::npos)
        EXPECT_EQ(status, 403) << name_of_route(route) << " for " << name_of(role);
      else
        EXPECT_TRUE(status == 200 || status == 400)
            << name_of_route(route) << " for " << name_of(role) << ": " << status;
      if (route.asks != Asks::person || !route.changes()) continue;
      EXPECT_EQ(try_route(v, route, {{"X-Cavum-Token", "-"}}).status, 403)
          << name_of_route(route) << " without token";
      EXPECT_EQ(try_route(v, route, {{"X-Cavum-Token", std::string(64, 'f')}}).status, 403)
          << name_of_route(route) << " with another token";
      EXPECT_EQ(try_route(v, route, {{"Origin", "https://elsewhere.example"}}).status, 403)
          << name_of_route(route) << " from another page";
      EXPECT_EQ(try_route(v, route, {{"Content-Type", "text/plain"}}).status, 415)
          << name_of_route(route) << " as a form could send it";
    }
  }
  EXPECT_EQ(opened_->content().entries.size(), testing_ledger::k_first_entries)
      << "none of all that added anything";
}

TEST_F(EveryRoute, ATokenOfAnotherSignInIsNone) {
  const Visitor a = opened_->signed_in(Role::officer), b = opened_->signed_in(Role::officer);
  EXPECT_EQ(Visitor({a.port, a.cookie, b.token}).post("/api/tickets/cancel", {}).status, 403);
}

}  // namespace
}  // namespace cavum::office
