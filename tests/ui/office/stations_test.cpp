// Stations over the network: who is let in, what is heard once only, tickets, the word to begin,
// and exams that are handed in.
#include "engine/base/json_fields.h"
#include "grading/records/begin.h"
#include "tests/grading/records/short_exam.h"
#include "tests/ui/office/opened.h"
#include "ui/office/inbox.h"
#include "ui/office/station_request.h"

namespace cavum::office {
namespace {

using testing_basics::tells;
using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

/// An office with a ticket; its station is the one of CAVUM_HOME.
class OverTheNetwork : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    opened_ = new Opened();
    officer_ = opened_->signed_in(Role::officer);
  }
  static void TearDownTestSuite() { delete opened_; }
  static json one_ticket(const std::string& number, bool begin_at_office = false) {
    const Heard issued = opened_->issue(officer_, number + "\n", begin_at_office);
    EXPECT_EQ(issued.status, 200) << issued.body;
    const std::string candidate = issued.json()["issued"][0]["candidate"];
    auto station = opened_->station();
    for (const auto& t : station.tickets())
      if (t["candidate"] == candidate) return t;
    ADD_FAILURE() << "no ticket of " << candidate;
    return {};
  }
  static Bytes short_exam(const std::string& ticket) {
    static int n = 0;
    const std::string path = opened_->school().file("short-" + std::to_string(++n) + ".cavum");
    sit_shortly(k_scenario, path, ticket);
    return read_file(path);
  }
  static inline Opened* opened_ = nullptr;
  static inline Visitor officer_;
};

TEST_F(OverTheNetwork, AreHeardOnceAndOnlyAsTheySigned) {
  auto station = opened_->station();
  const std::string body = R"({"state":"free"})",
                    line = station.sign("POST", "/station/report", body);
  EXPECT_EQ(station.ask("POST", "/station/report", body, line).status, 200);
  EXPECT_EQ(station.ask("POST", "/station/report", body, line).status, 401) << "heard before";
  const auto tried = [&](const std::string& method, const std::string& path,
                         const std::string& sent, const std::string& signed_line) {
    return station.ask(method, path, sent, signed_line).status;
  };
  EXPECT_EQ(tried("POST", "/station/report", R"({"state":"exam"})",
                  station.sign("POST", "/station/report", body)),
            401)
      << "another body";
  EXPECT_EQ(tried("POST", "/station/begin", body, station.sign("POST", "/station/report", body)),
            401)
      << "another path";
  EXPECT_EQ(tried("GET", "/station/tickets?x", "", station.sign("GET", "/station/tickets", "")),
            401)
      << "another query";
  EXPECT_EQ(tried("POST", "/station/report", body, "nonsense"), 401);
  std::string changed = station.sign("POST", "/station/report", body);
  changed[changed.find("\"nonce\":\"") + 9] ^= 1;
  EXPECT_EQ(tried("POST", "/station/report", body, changed), 401) << "another number";
}

TEST_F(OverTheNetwork, OfOtherKeysLedgersAndTimesAreRefused) {
  auto station = opened_->station();
  const SigningKey key = load_station_key(station_key_path()),
                   stranger = load_signing_key(opened_->school().file("stranger.key"), "station");
  const auto tried = [&](const SigningKey& by, const std::string& ledger, std::int64_t utc_ns) {
    return station
        .ask("GET", "/station/tickets", "",
             sign_request(
                 {ledger, "GET", "/station/tickets", to_hex(sha256(std::string())), "", "", utc_ns},
                 by))
        .status;
  };
  const std::int64_t now = read_clocks().utc_ns, leeway = k_clock_leeway_s * 1'000'000'000;
  EXPECT_EQ(tried(key, opened_->id(), now), 200);
  EXPECT_EQ(tried(stranger, opened_->id(), now), 401);
  EXPECT_EQ(tried(key, std::string(32, '0'), now), 401);
  EXPECT_EQ(tried(key, opened_->id(), now - leeway - 1'000'000'000), 401);
  EXPECT_EQ(tried(key, opened_->id(), now + leeway + 60'000'000'000), 401);
}

TEST(ReceivedRequests, ForgetNothingThatCountsOverARestart) {
  constexpr std::int64_t k_second_ns = 1'000'000'000;
  ReceivedRequests first(0);
  const StationRequest r{
      "l", "GET", "/", "", std::string(32, '1'), std::string(64, '2'), 100 * k_second_ns};
  EXPECT_EQ(first.hear(r, 100 * k_second_ns), Message());
  EXPECT_NE(first.hear(r, (100 + k_clock_leeway_s) * k_second_ns), Message())
      << "to the last moment of its time";
  ReceivedRequests after(101 * k_second_ns);
  EXPECT_NE(after.hear(r, 102 * k_second_ns), Message()) << "from before the restart";
}

TEST_F(OverTheNetwork, AKeyThatWasRevokedIsShutOutAtOnce) {
  const SigningKey key = load_signing_key(opened_->school().file("seat9.key"), "station");
  const json invited = officer_.post("/api/stations/invite", {{"name", "Seat 9"}}).json();
  StationClient station("https://127.0.0.1:" + std::to_string(opened_->port()),
                        opened_->certificate(), opened_->content().public_key, key);
  EXPECT_THROW(static_cast<void>(station.tickets()), Error) << "not enrolled";
  const std::string request = records::station_request(key, opened_->content().public_key, {},
                                                       invited["code"].get<std::string>());
  EXPECT_EQ(station.enrol(request)["name"], "Seat 9");
  EXPECT_THROW(static_cast<void>(station.enrol(request)), Error) << "a code is good once";
  station.report({{"state", "free"}});
  const std::string line = station.sign("GET", "/station/tickets", "");
  EXPECT_EQ(officer_
                .post("/api/stations/revoke",
                      {{"public_key", to_hex(key.public_key)}, {"reason", "stolen"}})
                .status,
            200);
  EXPECT_EQ(station.ask("GET", "/station/tickets", "", line).status, 401);
  EXPECT_THROW(station.report({{"state", "free"}}), Error);
  const auto last = opened_->content().entries.back();
  EXPECT_EQ(last.by.account, "The officer");
  EXPECT_EQ(last.by.reason, "stolen");
}

TEST_F(OverTheNetwork, AnotherSchoolsOfficeAndAnotherCertificateAreNotSpokenWith) {
  const SigningKey key = load_station_key(station_key_path());
  const std::string address = "https://127.0.0.1:" + std::to_string(opened_->port());
  StationClient other_school(address, opened_->certificate(), std::string(64, 'a'), key);
  EXPECT_THROW(static_cast<void>(other_school.tickets()), Error);
  const CertificateFiles other{opened_->school().file("o.pem"), opened_->school().file("o.key")};
  make_certificate(other, {"127.0.0.1"});
  StationClient pinned(address, other.certificate, opened_->content().public_key, key);
  EXPECT_THROW(static_cast<void>(pinned.tickets()), Error)
      << "another certificate of the same names";
  StationClient trusting(address, "", opened_->content().public_key, key);
  EXPECT_THROW(static_cast<void>(trusting.tickets()), Error)
      << "one that this computer does not know";
  EXPECT_THROW(StationClient("http://127.0.0.1:1", "", "", key), Error);
}

TEST_F(OverTheNetwork, ReportOnlyWhatTheBoardKnowsAndItIsShown) {
  auto station = opened_->station();
  station.report({{"state", "exam"},
                  {"candidate", "C-1"},
                  {"step", "Outline"},
                  {"alarm", "stylus lost"},
                  {"left_s", 61}});
  const json board = officer_.get("/api/board").json();
  json said;
  for (const auto& s : board["stations"])
    if (s["name"] == "Seat 1") said = s["report"];
  EXPECT_EQ(said["state"], "exam");
  EXPECT_EQ(said["alarm"], "stylus lost");
  EXPECT_EQ(said["left_s"], 61);
  for (const json& wrong :
       {json{{"state", "on fire"}}, json{{"state", "free"}, {"step", std::string(201, 'x')}},
        json{{"state", "free"}, {"alarm", "a\nb"}}, json{{"state", "free"}, {"left_s", 1e9}},
        json::array(), json()})
    EXPECT_THROW(station.report(wrong), Error) << wrong;
}

TEST_F(OverTheNetwork, BeginOnceAndASecondStationIsNoticedAtOnce) {
  auto station = opened_->station();
  const json t = one_ticket("begin-1", true);
  const std::string word = station.begin(t["nonce"]);
  EXPECT_EQ(records::parse_begin(word, opened_->content().public_key, "word").ticket, t["nonce"]);
  const auto entry = opened_->content().entries.back();
  EXPECT_NE(entry.as<records::BeginEntry>(), nullptr);
  EXPECT_EQ(entry.by.station, to_hex(load_station_key(station_key_path()).public_key));
  EXPECT_EQ(station.begin(t["nonce"]), word)
      << "its answer may have been lost: the same word, and no other entry";
  EXPECT_EQ(opened_->content().entries.size(), entry.seq + 1);
  const SigningKey other = load_signing_key(opened_->school().file("seat10.key"), "station");
  const std::string code =
      officer_.post("/api/stations/invite", {{"name", "Seat 10"}}).json()["code"];
  StationClient second("https://127.0.0.1:" + std::to_string(opened_->port()),
                       opened_->certificate(), opened_->content().public_key, other);
  static_cast<void>(
      second.enrol(records::station_request(other, opened_->content().public_key, {}, code)));
  EXPECT_THROW(static_cast<void>(second.begin(t["nonce"])), Error);
  EXPECT_THROW(static_cast<void>(second.begin(std::string(32, '0'))), Error);
}

TEST_F(OverTheNetwork, ACancelledTicketLeavesTheStationsAndTheFolder) {
  const json t = one_ticket("cancel-1");
  const std::string file = opened_->home() + "/" + opened_->id() + "/tickets/" +
                           t["nonce"].get<std::string>() + ".ticket";
  EXPECT_TRUE(std::filesystem::exists(file));
  json row;
  const json all = officer_.get("/api/tickets").json();
  for (const auto& one : all["tickets"])
    if (one["id"] == "cancel-1") row = one;
  EXPECT_EQ(row["live"], true);
  EXPECT_EQ(officer_.post("/api/tickets/cancel", {{"entry", row["entry"]}}).status, 400)
      << "without a reason";
  EXPECT_EQ(
      officer_.post("/api/tickets/cancel", {{"entry", row["entry"]}, {"reason", "ill"}}).status,
      200);
  EXPECT_FALSE(std::filesystem::exists(file)) << "its accommodations tell of health";
  auto station = opened_->station();
  for (const auto& one : station.tickets()) EXPECT_NE(one["nonce"], t["nonce"]);
  const auto last = opened_->content().entries.back();
  EXPECT_EQ(last.by.account, "The officer");
  EXPECT_EQ(last.by.reason, "ill");
}

TEST_F(OverTheNetwork, AnExamIsFiledAndItsReceiptHolds) {
  auto station = opened_->station();
  const json t = one_ticket("file-1");
  const Bytes image = short_exam(t["text"]);
  const std::string hash = to_hex(sha256(image));
  EXPECT_EQ(station.handed(hash)["state"], "unknown");
  EXPECT_EQ(station.hand_in(image)["state"], "waiting");
  const json filed = Opened::outcome(station, hash);
  ASSERT_EQ(filed["state"], "filed") << filed;
  const auto content = opened_->content();
  EXPECT_EQ(content.entries.at(filed["entry"]).as<records::SessionEntry>()->file_sha256, hash);
  EXPECT_TRUE(records::check_receipt(filed["receipt"], content.public_key, &content).empty());
  EXPECT_EQ(read_file(opened_->school().places().session(hash)), image);
  EXPECT_EQ(station.hand_in(image)["state"], "waiting") << "sent twice";
  EXPECT_EQ(Opened::outcome(station, hash)["entry"], filed["entry"]);
  EXPECT_EQ(opened_->content().entries.size(), content.entries.size());
  EXPECT_TRUE(std::filesystem::is_empty(opened_->home() + "/" + opened_->id() + "/inbox/refused"));
}

TEST_F(OverTheNetwork, WhatIsNoExamIsRefusedAndSaidSoAlsoAfterARestart) {
  auto station = opened_->station();
  const Bytes nonsense{'n', 'o', 'n', 'e'};
  station.hand_in(nonsense);
  const std::string hash = to_hex(sha256(nonsense));
  const json refused = Opened::outcome(station, hash);
  EXPECT_EQ(refused["state"], "refused");
  EXPECT_EQ(refused["findings"].at(0)["kind"], "file_unreadable");
  const auto shown = [&] { return officer_.get("/api/board").json()["inbox"]["refused"][0]; };
  EXPECT_EQ(shown()["sha256"], hash);
  EXPECT_EQ(shown()["station"], "Seat 1") << "who handed it in, for the file says nothing";
  EXPECT_EQ(shown()["candidate"], "");
  for (const json& said : {refused["findings"], shown()["findings"]})
    EXPECT_EQ(said.dump().find('/'), std::string::npos) << "no folder of this computer: " << said;
  const json before = shown();
  opened_->close();
  opened_->open();
  officer_ = opened_->signed_in(Role::officer);
  auto again = opened_->station();
  EXPECT_EQ(again.handed(hash)["state"], "refused");
  EXPECT_EQ(shown(), before);
  std::filesystem::remove(opened_->home() + "/" + opened_->id() + "/inbox/refused/" + hash +
                          ".json");
  std::filesystem::remove(opened_->home() + "/" + opened_->id() + "/inbox/refused/" + hash +
                          ".cavum");
}

TEST_F(OverTheNetwork, OfARefusedExamTheCandidateIsSaid) {
  auto station = opened_->station();
  const json t = one_ticket("twice-1");
  const Bytes first = short_exam(t["text"]), second = short_exam(t["text"]);
  station.hand_in(first);
  ASSERT_EQ(Opened::outcome(station, to_hex(sha256(first)))["state"], "filed");
  station.hand_in(second);
  const std::string hash = to_hex(sha256(second));
  ASSERT_EQ(Opened::outcome(station, hash)["state"], "refused");
  const json shown = officer_.get("/api/board").json()["inbox"]["refused"].back();  // the newest
  EXPECT_EQ(shown["sha256"], hash);
  EXPECT_EQ(shown["candidate"], t["candidate"]);
  EXPECT_EQ(shown["station"], "Seat 1");
  for (const char* kind : {".json", ".cavum"})
    std::filesystem::remove(opened_->home() + "/" + opened_->id() + "/inbox/refused/" + hash +
                            kind);
}

TEST_F(OverTheNetwork, NoExamIsRefusedForADiskThatTakesNothingAndAllAreFiledAfterwards) {
  auto station = opened_->station();
  const std::string sessions = opened_->school().ledger_folder() + "/sessions";
  std::filesystem::rename(sessions, sessions + ".away");
  write_text_file(sessions, "no folder can be made here");
  std::vector<std::string> hashes;
  for (const char* number : {"disk-1", "disk-2"}) {
    const Bytes image = short_exam(one_ticket(number)["text"]);
    hashes.push_back(to_hex(sha256(image)));
    station.hand_in(image);
  }
  json inbox;
  for (int i = 0; i < 200 && text_in(inbox, "trouble").empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    inbox = officer_.get("/api/board").json()["inbox"];
  }
  EXPECT_NE(text_in(inbox, "trouble"), "");
  EXPECT_EQ(inbox["waiting"], 2);
  for (const auto& hash : hashes) EXPECT_EQ(station.handed(hash)["state"], "waiting");
  std::filesystem::remove(sessions);
  std::filesystem::rename(sessions + ".away", sessions);
  for (const auto& hash : hashes) EXPECT_EQ(Opened::outcome(station, hash)["state"], "filed");
  EXPECT_EQ(officer_.get("/api/board").json()["inbox"]["trouble"], "");
}

TEST_F(OverTheNetwork, ALargeRecordingArrivesWholeAndOneThatIsTooLargeIsNotRead) {
  auto station = opened_->station();
  const Bytes large(3U << 20, 7);
  station.hand_in(large);
  const std::string hash = to_hex(sha256(large));
  EXPECT_EQ(Opened::outcome(station, hash)["state"], "refused")
      << "it is no exam, but all of them came";
  EXPECT_EQ(std::filesystem::file_size(opened_->home() + "/" + opened_->id() + "/inbox/refused/" +
                                       hash + ".cavum"),
            large.size());
  const std::string path = "/station/sessions/" + hash, line = station.sign("PUT", path, "");
  Wire wire(opened_->port());
  wire.send("PUT " + path + " HTTP/1.1\r\nHost: x\r\nX-Cavum-Station: " + line +
            "\r\nContent-Length: 300000000\r\n\r\n");
  EXPECT_EQ(wire.hear().status, 413);
}

TEST_F(OverTheNetwork, ABodyThatIsNotTheNamedOneLeavesNothing) {
  auto station = opened_->station();
  const std::string path = "/station/sessions/" + std::string(64, 'b'), body = "something else";
  EXPECT_EQ(station.ask("PUT", path, body).status, 400);
  EXPECT_EQ(station.handed(std::string(64, 'b'))["state"], "unknown");
  for (const auto& file :
       std::filesystem::directory_iterator(opened_->home() + "/" + opened_->id() + "/inbox"))
    EXPECT_EQ(file.path().filename(), "refused");
}

TEST(Refusals, CallAFolderWhatItIsAndNoWordLikeIt) {
  const Message ledger = msg("{}", "the ledger");
  const auto called = [&](const Message& m, const std::string& place) {
    return with_location_as(m, place, ledger);
  };
  EXPECT_EQ(called(msg("no SQLite header in L"), "L"), msg("no SQLite header in L"))
      << "a sentence is none";
  EXPECT_EQ(called(msg("the {} ended", "exams"), "exam"), msg("the {} ended", "exams"));
  EXPECT_TRUE(tells(called(msg("{} is full", "/a/L"), "/a/L"), "the ledger"));
  EXPECT_FALSE(tells(called(msg("{} is full", "/a/L"), "/a/L"), "/a/L"));
  EXPECT_EQ(english_text(called(msg("{}: is locked", "/a/L/ledger.db"), "/a/L")).find("/a"),
            std::string::npos);
  EXPECT_EQ(
      english_text(called(msg("copy {}", cavum::List{{msg("{}", "/a/L/x"),
                                                      msg("to {}", FileLocation{"/a/L", 3, 1})}}),
                          "/a/L"))
          .find("/a"),
      std::string::npos);
}

}  // namespace
}  // namespace cavum::office
