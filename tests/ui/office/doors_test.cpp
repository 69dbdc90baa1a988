// Who may pass which door: the table against one that is written here, and the running server against both.
#include "ui/office/doors.h"

#include <set>
#include <stdexcept>

#include "tests/ui/office/opened.h"
#include "ui/office/site.h"

namespace cavum::office {
namespace {

using namespace testing_office;

/// Letters of roles: o officer, e examiner, i invigilator, r reader; - nobody has to be known, s a station, c who came from a learning
/// platform, f a form that a platform sends.
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

std::string name_of_door(const Door& d) { return std::string(d.method) + " " + std::string(d.path); }
std::string path_of_door(const Door& d) {
  return d.path.ends_with('*') ? std::string(d.path.substr(0, d.path.size() - 1)) + std::string(64, '0') : std::string(d.path);
}

TEST(Doors, AreThoseOfThisTableAndNoOthers) {
  std::map<std::string, std::string> found;
  for (const Door& d : doors()) {
    std::string who = d.asks == Asks::nobody ? "-" : d.asks == Asks::station ? "s" : d.asks == Asks::came ? "c" : d.asks == Asks::form ? "f" : "";
    if (d.asks == Asks::person)
      for (const Role r : all_roles())
        if (d.lets(r)) who += name_of(r)[0];
    EXPECT_TRUE(found.emplace(name_of_door(d), who).second) << name_of_door(d) << " twice";
    if (d.asks != Asks::person) {
      EXPECT_EQ(d.roles, 0U);
    }
  }
  EXPECT_EQ(found, k_expected);
}

TEST(Doors, ANameOfARoleReadsBack) {
  for (const Role r : all_roles()) EXPECT_EQ(role_named(name_of(r)), r);
  EXPECT_EQ(role_named("Officer"), std::nullopt);
  EXPECT_EQ(role_named(""), std::nullopt);
}

TEST(Doors, OnlyTheExactPathOpensOne) {
  EXPECT_NE(door_for("GET", "/api/me"), nullptr);
  const std::string hash(64, 'a');
  EXPECT_NE(door_for("PUT", "/station/sessions/" + hash), nullptr);
  for (const std::string path : {"/api/me/", "/API/me", "//api/me", "/api/../api/me", "/api/%6de", "/api/me;x", "", "api/me"})
    EXPECT_EQ(door_for("GET", path), nullptr) << path;
  for (const std::string& tail : {std::string(64, 'A'), std::string(63, 'a'), std::string(65, 'a'), "../" + std::string(61, 'a'), std::string()})
    EXPECT_EQ(door_for("PUT", "/station/sessions/" + tail), nullptr) << tail;
  EXPECT_EQ(door_for("HEAD", "/"), nullptr);
  EXPECT_EQ(door_for("DELETE", "/api/me"), nullptr);
}

TEST(Site, RefusesAHandlerWithoutARowAndARowWithoutAHandler) {
  Site site({[](const std::string&) { return std::optional<Account>(); }, [](const std::string&) { return std::string("none"); },
             [] { return std::int64_t{0}; }, [] { return std::int64_t{0}; }, "ledger"});
  EXPECT_THROW(site.on("GET", "/api/secret", [](const Call&) { return Reply(); }), std::logic_error);
  EXPECT_THROW(site.on("POST", "/api/me", [](const Call&) { return Reply(); }), std::logic_error);
  site.on("GET", "/api/me", [](const Call&) { return Reply(); });
  EXPECT_THROW(site.on("GET", "/api/me", [](const Call&) { return Reply(); }), std::logic_error);
  EXPECT_THROW(site.require_complete(), std::logic_error);
}

/// Every door with every role, signed in and not, with the token and without: the server lets in exactly whom the table names.
class EveryDoor : public testing::Test {
 protected:
  static void SetUpTestSuite() { opened_ = new Opened(); }
  static void TearDownTestSuite() { delete opened_; }
  static Heard try_door(const Visitor& v, const Door& d, const std::map<std::string, std::string>& more = {}) {
    if (d.path.ends_with("/events")) {  // it does not end
      Wire wire(v.port);
      wire.send("GET " + std::string(d.path) + " HTTP/1.1\r\nHost: x\r\n" + (v.cookie.empty() ? "" : "Cookie: __Host-cavum=" + v.cookie + "\r\n") +
                "\r\n");
      const std::string begin = wire.hear_for(std::chrono::milliseconds(700));
      return {begin.size() > 12 ? std::stoi(begin.substr(9, 3)) : 0, {}, begin};
    }
    return v.ask(std::string(d.method), path_of_door(d), d.method == "GET" ? "" : "{}", more);
  }
  static inline Opened* opened_ = nullptr;
};

TEST_F(EveryDoor, IsClosedToThoseWhoHaveNotSignedIn) {
  for (const Door& d : doors())
    if (d.asks != Asks::nobody && d.asks != Asks::form) {
      EXPECT_EQ(try_door(opened_->visitor(), d).status, 401) << name_of_door(d);
    }
  Visitor guessed{opened_->port(), std::string(64, '0'), std::string(64, '0')};
  for (const Door& d : doors())
    if (d.asks != Asks::nobody && d.asks != Asks::form) {
      EXPECT_EQ(try_door(guessed, d).status, 401) << name_of_door(d);
    }
}

TEST_F(EveryDoor, LetsInExactlyTheRolesOfTheTable) {
  for (const Role role : all_roles()) {
    for (const Door& d : doors()) {
      if (d.asks == Asks::nobody || d.asks == Asks::form || d.path == "/api/sign-out") continue;
      static std::map<Role, Visitor> known;
      if (!known.contains(role)) known[role] = opened_->signed_in(role);
      const Visitor& v = known[role];
      const std::string& expected = k_expected.at(name_of_door(d));
      const int status = try_door(v, d).status;
      if (d.asks == Asks::station || d.asks == Asks::came)
        EXPECT_EQ(status, 401) << name_of_door(d) << " for a person";
      else if (expected.find(name_of(role)[0]) == std::string::npos)
        EXPECT_EQ(status, 403) << name_of_door(d) << " for " << name_of(role);
      else
        EXPECT_TRUE(status == 200 || status == 400) << name_of_door(d) << " for " << name_of(role) << ": " << status;
      if (d.asks != Asks::person || !d.changes()) continue;
      EXPECT_EQ(try_door(v, d, {{"X-Cavum-Token", "-"}}).status, 403) << name_of_door(d) << " without token";
      EXPECT_EQ(try_door(v, d, {{"X-Cavum-Token", std::string(64, 'f')}}).status, 403) << name_of_door(d) << " with another token";
      EXPECT_EQ(try_door(v, d, {{"Origin", "https://elsewhere.example"}}).status, 403) << name_of_door(d) << " from another page";
      EXPECT_EQ(try_door(v, d, {{"Content-Type", "text/plain"}}).status, 415) << name_of_door(d) << " as a form could send it";
    }
  }
  EXPECT_EQ(opened_->content().entries.size(), testing_ledger::k_first_entries) << "none of all that added anything";
}

TEST_F(EveryDoor, ATokenOfAnotherSignInIsNone) {
  const Visitor a = opened_->signed_in(Role::officer), b = opened_->signed_in(Role::officer);
  EXPECT_EQ(Visitor({a.port, a.cookie, b.token}).post("/api/tickets/cancel", {}).status, 403);
}

}  // namespace
}  // namespace cavum::office
