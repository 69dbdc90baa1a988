// `cavum report` with a ledger: who may see what, and when; attempts over time; names only when
// released and asked for.
#include <fmt/core.h>

#include <filesystem>

#include "engine/base/text.h"
#include "tests/ui/program.h"
#include "tests/ui/report/kinds.h"
#include "tests/ui/report/unpack.h"

namespace cavum::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing_report::holds;
using testing_report::of_kind;
using testing_report::times;
using testing_report::verdict_box;
using testing_report::verdict_of;

class ReportVerbs : public testing_ui::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    ASSERT_EQ(run("ledger init " + path("L") + " --school Dentistry").exit_code, 0);
  }
  std::string scenario() const {
    return std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml";
  }
  /// A candidate sits the exam; returns the session, filed.
  std::string sit(const std::string& id, const std::string& name, const std::string& by,
                  const std::string& file) {
    const auto ticket = run("ledger ticket " + path("L") + " " + scenario() +
                            " --another --candidate " + id + " --name '" + name +
                            "' --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --json --out " +
                            path(file + ".ticket"));
    EXPECT_EQ(ticket.exit_code, 0) << ticket.err;
    pseudonym_ = json::parse(ticket.out)["tickets"][0]["candidate"];
    EXPECT_EQ(run("exam " + scenario() + " --ticket " + path(file + ".ticket") + " --operator " +
                  by + " --quiet --out " + path(file + ".cavum"))
                  .exit_code,
              0);
    const auto added =
        run("ledger add " + path("L") + " " + path(file + ".cavum") + " --simulated");
    EXPECT_EQ(added.exit_code, 0) << added.out << added.err;
    return path(file + ".cavum");
  }
  /// Text of a report that must be written.
  std::string report(const std::string& session, const std::string& more) {
    const auto r = run("report " + session + " --out " + path("r.html") + " " + more);
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return read_text_file(path("r.html"));
  }
  std::string pseudonym_;
};

TEST_F(ReportVerbs, AStudentSeesWhatIsReleasedAndNothingElse) {
  const std::string first = sit("4711", "Ann Lee", "novice", "e1"),
                    second = sit("4711", "Ann Lee", "expert", "e2");
  const std::string ledger = "--ledger " + path("L"), student = " --for student " + ledger;
  const std::string entry = run_json("ledger show " + path("L"))["sessions"][0]["seq"].dump();
  expect_refused("report " + first + " --out " + path("r.html") + student, {entry, path("L")});
  expect_refused("report " + first + " --out " + path("r.html") + " " + ledger + " --with-name",
                 {entry});
  EXPECT_FALSE(fs::exists(path("r.html")));

  EXPECT_EQ(times(of_kind(report(first, ledger), "attempts"), " unreleased'"), 2u)
      << "an instructor sees it, marked as that";
  ASSERT_EQ(run("ledger release " + path("L") + " --candidate 4711").exit_code, 0);
  const std::string third = sit("4711", "Ann Lee", "perforator", "e3");

  const std::string seen = report(first, student);
  const std::string attempts = of_kind(seen, "attempts");
  for (const std::string& session : {first, second}) {
    const json g = run_json("grade " + session);
    EXPECT_TRUE(
        holds(attempts, fixed(g["score"]["points"], 1) + " / " + fixed(g["score"]["max"], 1)))
        << session;
  }
  const auto rows = [](const std::string& html) {
    return times(of_kind(html, "attempts"), "<tr") - 1;
  };  // without its head
  EXPECT_EQ(rows(seen), 2u) << "the third is not released";
  EXPECT_EQ(rows(report(first, ledger)), 3u) << "an instructor sees all";
  expect_refused("report " + third + " --out " + path("r3.html") + student, {});

  for (const auto& html : {seen, report(first, ledger), report(first, "--for student")}) {
    EXPECT_EQ(html.find("Ann Lee"), std::string::npos);
    EXPECT_EQ(html.find("4711"), std::string::npos);
    EXPECT_NE(html.find(pseudonym_), std::string::npos);
  }
  EXPECT_NE(report(first, student + " --with-name").find("Ann Lee"), std::string::npos);
  EXPECT_TRUE(holds(of_kind(seen, "integrity"), " " + entry + ",", " 20"));
  EXPECT_NE(of_kind(seen, "replayed_at_filing"), "");
}

TEST_F(ReportVerbs, WhatIsNotInTheLedgerOrNotTheReleasedResultIsRefused) {
  const std::string session = sit("4711", "Ann Lee", "novice", "e1");
  ASSERT_EQ(run("exam " + scenario() + " --candidate B --operator expert --quiet --out " +
                path("other.cavum"))
                .exit_code,
            0);
  expect_refused(
      "report " + path("other.cavum") + " --out " + path("r.html") + " --ledger " + path("L"),
      {"other.cavum: ", path("L")});
  expect_refused("report " + session + " --out " + path("r.html") + " --with-name",
                 {"--with-name: "});
  expect_refused("report " + session + " --out " + path("r.html") + " --ledger " + path("none"),
                 {"none"});
  expect_refused("report " + session + " --out " + path("r.txt"), {"r.txt"});
  write_text_file(path("r.pdf"), "%PDF-1.4 another program's");
  expect_refused("report " + session + " --out " + path("r.pdf"), {"r.pdf: "});
  ASSERT_EQ(
      run("report " + session + " --out " + path("r.pdf") + " --overwrite --no-replay").exit_code,
      0);
  EXPECT_EQ(run("report " + session + " --out " + path("r.pdf") + " --no-replay").exit_code, 0)
      << "a report may be written anew";
}

TEST_F(ReportVerbs, ARegradedResultIsTheOneThatCountsWithReasonAndTheSealedOneBeside) {
  const std::string session = sit("4711", "Ann Lee", "novice", "e1");
  const json sealed = run_json("grade " + session);
  write_text_file(
      path("kind.toml"),
      "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = "
      "\"target_removed_percent\"\nfull = 50\nzero = 0\npoints = 10\n");
  const std::string entry = run_json("ledger show " + path("L"))["sessions"][0]["seq"].dump();
  ASSERT_EQ(run("ledger release " + path("L") + " --all").exit_code, 0);
  const auto regraded = run("ledger regrade " + path("L") + " --session " + entry + " --rubric " +
                            path("kind.toml") + " --reason 'the limit was misprinted' --json");
  ASSERT_EQ(regraded.exit_code, 0) << regraded.err;
  const json kind = json::parse(regraded.out)["after"];
  const std::string new_points = fixed(kind["points"], 1),
                    old_points = fixed(sealed["score"]["points"], 1),
                    old_max = fixed(sealed["score"]["max"], 1);
  ASSERT_NE(old_max, "10.0");
  const std::string student = " --for student --ledger " + path("L"),
                    ledger = "--ledger " + path("L");
  EXPECT_TRUE(holds(verdict_box(report(session, student)), "<br>", old_points, old_max, "<br>"))
      << "until it is released the old one stands";
  fs::remove(path("kind.toml"));  // nothing but the ledger knows it now

  const auto shows_it = [&](const std::string& html) {
    EXPECT_TRUE(holds(verdict_box(html), "<br>", new_points, "10.0", "<br>"));
    EXPECT_TRUE(holds(of_kind(html, "regrade"), sealed["verdict"].get<std::string>(), old_points));
    EXPECT_TRUE(holds(of_kind(html, "regraded"), "the limit was misprinted",
                      " " + json::parse(regraded.out)["seq"].dump() + " ", " 20"));
    const auto from = html.find("<table", html.find(of_kind(html, "regrade")));
    for (const auto& c : sealed["criteria"])
      EXPECT_NE(html.find("<td>" + c["id"].get<std::string>() + "</td>", from), std::string::npos)
          << c["id"];
  };
  const std::string instructors = report(session, ledger);
  shows_it(instructors);
  EXPECT_NE(of_kind(of_kind(instructors, "attempts"), "sound regraded simulated unreleased"), "");
  ASSERT_EQ(run("ledger release " + path("L") + " --all --undecided").exit_code, 0);
  shows_it(report(session, student));
  const auto all = run("ledger report " + path("L") + " --out " + path("reports"));
  ASSERT_EQ(all.exit_code, 0) << all.err;
  shows_it(read_text_file(path("reports/" + pseudonym_ + "-" + entry + ".html")));
  EXPECT_EQ(run("report " + session + " --out " + path("r.pdf") + student).exit_code, 0);

  // What the program leaves to a person, it says to be decided once somebody has.
  ASSERT_EQ(json::parse(regraded.out)["verdict"], "review");
  const auto decided =
      run("ledger decide " + path("L") + " --session " + entry +
          " --verdict fail --person 'Dr. Weber' --reason 'two of three grooves are missing'");
  ASSERT_EQ(decided.exit_code, 0) << decided.err;
  const std::string to_instructors = report(session, ledger);
  EXPECT_TRUE(holds(of_kind(to_instructors, "decided"), "fail", "Dr. Weber",
                    "two of three grooves are missing"));
  EXPECT_TRUE(holds(verdict_box(to_instructors), "<br>", new_points, "10.0", "<br>"))
      << "a decision changes no points";
  EXPECT_EQ(report(session, student).find("two of three grooves"), std::string::npos)
      << "not before it is released";
  ASSERT_EQ(run("ledger release " + path("L") + " --all").exit_code, 0);
  const std::string to_student = report(session, student);
  EXPECT_TRUE(holds(of_kind(to_student, "decided"), "fail", "two of three grooves are missing"));
  EXPECT_EQ(to_student.find("Dr. Weber"), std::string::npos) << "no names in a student's report";

  // another rubric than the one that counts is no student's report, and an instructor is told
  write_text_file(
      path("other.toml"),
      "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = "
      "\"target_removed_percent\"\nfull = 100\nzero = 0\npoints = 77\n");
  expect_refused("report " + session + " --out " + path("no.html") + student + " --rubric " +
                     path("other.toml"),
                 {entry, new_points});
  const std::string what_if = report(session, ledger + " --rubric " + path("other.toml"));
  EXPECT_NE(of_kind(what_if, "not_the_ledgers_result"), "");
  EXPECT_EQ(what_if.find("the limit was misprinted"), std::string::npos);
}

TEST_F(ReportVerbs, OfSeveralDecisionsTheLastIsTheReports) {
  const std::string session = sit("4711", "Ann Lee", "novice", "e1"), L = path("L");
  const std::string entry = run_json("ledger show " + L)["sessions"][0]["seq"].dump(),
                    by_session = " --session " + entry;
  const auto must = [&](const std::string& verb) {
    const auto r = run("ledger " + verb);
    EXPECT_EQ(r.exit_code, 0) << verb << ": " << r.err;
    return r.out;
  };
  const auto rubric = [&](const std::string& name, int points) {
    write_text_file(
        path(name),
        fmt::format(
            "[rubric]\nrule = \"compensatory\"\npass_percent = 10\n[[rubric.criteria]]\nid = \"removed\"\nmetric = "
            "\"target_removed_percent\"\nfull = 50\nzero = 0\npoints = {}\n",
            points));
    must("regrade " + L + by_session + " --rubric " + path(name) + " --reason misprinted");
  };
  const auto decide = [&](const std::string& verdict, const std::string& why) {
    must("decide " + L + by_session + " --verdict " + verdict + " --person 'Dr. Weber' --reason " +
         why);
  };
  /// That of `ledger report`, after the release of all.
  const auto reported = [&](const std::string& verdict) {
    must("release " + L + " --all --undecided");
    EXPECT_TRUE(holds(must("report " + L + " --out " + path("reports")), entry + ".html"))
        << verdict;
    const std::string instructors = report(session, "--ledger " + L);
    EXPECT_EQ(of_kind(instructors, "not_the_ledgers_result"), "") << verdict;
    EXPECT_EQ(verdict_of(instructors), verdict);
    return read_text_file(path("reports/" + pseudonym_ + "-" + entry + ".html"));
  };
  rubric("kind.toml", 10);
  ASSERT_EQ(run_json("ledger show " + L)["sessions"][0]["verdict"], "review");
  decide("fail", "too-little");
  EXPECT_TRUE(holds(of_kind(reported("fail"), "decided"), "fail", "too-little"));

  must("appeal " + L + by_session + " --reason unfair");
  decide("pass", "looked-again");
  must("appeal " + L + by_session + " --outcome changed --reason granted");
  const std::string again = reported("pass");
  EXPECT_TRUE(holds(of_kind(again, "decided"), "pass", "looked-again"));
  EXPECT_EQ(again.find("too-little"), std::string::npos);

  rubric("other.toml", 20);  // its result is the program's again, whoever decided the one before
  EXPECT_EQ(reported("review").find("looked-again"), std::string::npos);
  decide("pass", "as-before");
  EXPECT_TRUE(holds(of_kind(reported("pass"), "decided"), "pass", "as-before"));
}

TEST_F(ReportVerbs, WhatWasFiledWithFindingsStandsNowhereAsSound) {
  const std::string sound = sit("4711", "Ann Lee", "novice", "e1");
  const auto ticket = run(
      "ledger ticket " + path("L") + " " + scenario() +
      " --another --candidate 4711 --from 2020-01-01T00:00Z --until 2190-01-01T00:00Z --json --out " +
      path("e2.ticket"));
  ASSERT_EQ(ticket.exit_code, 0) << ticket.err;
  const std::string bad = path("e2.cavum");
  ASSERT_EQ(run("exam " + scenario() + " --ticket " + path("e2.ticket") +
                " --operator expert --quiet --out " + bad)
                .exit_code,
            0);
  ASSERT_EQ(
      std::system(
          ("python3 -c \"import sqlite3; d = sqlite3.connect('" + bad +
           "'); d.execute('update chunk set utc_ns = utc_ns - 60000000000 where seq = 2'); d.commit()\"")
              .c_str()),
      0);
  ASSERT_EQ(run("ledger add " + path("L") + " " + bad + " --simulated --with-findings").exit_code,
            1);
  ASSERT_EQ(run("ledger release " + path("L") + " --all").exit_code, 0);
  ASSERT_EQ(run("ledger release " + path("L") + " --candidate 4711 --with-findings").exit_code, 0);
  for (const std::string reader : {"student", "instructor"}) {
    const std::string html = report(sound, "--ledger " + path("L") + " --for " + reader);
    const std::string attempts = of_kind(html, "attempts");
    EXPECT_TRUE(holds(of_kind(attempts, "in_doubt simulated"), "pass", " 2"))
        << reader << ": of chunk 2";
    EXPECT_NE(of_kind(attempts, "sound simulated"), "") << "this one is sound";
    EXPECT_EQ(of_kind(html, "in_doubt"), "") << "this one is sound";
  }
}

TEST_F(ReportVerbs, AWholeLedgersReleasedResultsEachGiveAStudentsReport) {
  sit("4711", "Ann Lee", "expert", "e1");
  const std::string ann = pseudonym_;
  sit("4712", "Bob Ray", "novice", "e2");
  const std::string bob = pseudonym_;
  ASSERT_EQ(run("ledger release " + path("L") + " --candidate 4711").exit_code, 0);
  const auto r = run("ledger report " + path("L") + " --out " + path("reports"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  std::vector<std::string> names;
  for (const auto& f : fs::directory_iterator(path("reports")))
    names.push_back(f.path().filename().string());
  ASSERT_EQ(names.size(), 1u);
  EXPECT_TRUE(names[0].starts_with(ann + "-")) << names[0];
  const std::string html = read_text_file(path("reports/" + names[0]));
  EXPECT_EQ(html.find(bob), std::string::npos);
  EXPECT_EQ(html.find("Ann Lee"), std::string::npos);
  EXPECT_NE(of_kind(html, "marks"), "") << "it is a student's";
}

TEST_F(ReportVerbs, AnExamsOwnReportComesAsHtmlOrPdf) {
  ASSERT_EQ(run("exam " + scenario() + " --candidate A --operator expert --quiet --report " +
                path("x.pdf") + " --out " + path("x.cavum"))
                .exit_code,
            0);
  EXPECT_TRUE(read_text_file(path("x.pdf")).starts_with("%PDF-"));
  ASSERT_EQ(run("exam " + scenario() + " --candidate A --operator expert --quiet --report " +
                path("y.html") + " --out " + path("y.cavum"))
                .exit_code,
            0);
  const std::string html = read_text_file(path("y.html"));
  EXPECT_NE(of_kind(html, "integrity")
                .find(run_json("replay " + path("y.cavum") + " --verify")["station_key"]
                          .get<std::string>()),
            std::string::npos)
      << "the session is closed by then";
  EXPECT_NE(of_kind(html, "not_replayed"), "");
}

TEST_F(ReportVerbs, BesideASessionStandsOneOfTheSameExamThatTheReaderMaySee) {
  const std::string mine = sit("4711", "Ann Lee", "novice", "b1"),
                    mine_later = sit("4711", "Ann Lee", "expert", "b2"),
                    others = sit("4712", "Bo Berg", "expert", "b3");
  ASSERT_EQ(run("exam " + testing_ui::k_data +
                "/scenarios/slot.toml --candidate X --operator expert --quiet --out " +
                path("slot.cavum"))
                .exit_code,
            0);
  const std::string out =
      "report " + mine + " --no-replay --out " + path("both.html") + " --compare ";
  expect_refused(out + path("slot.cavum"), {"--compare " + path("slot.cavum")});
  expect_refused(out + others + " --for student", {"--compare " + others});
  expect_refused(out + mine_later + " --for student --ledger " + path("L"), {});
  EXPECT_FALSE(fs::exists(path("both.html")));
  /// Whom the page moves beside the session, and whose picture it shows.
  const auto beside = [](const std::string& html) {
    const std::string name = testing_report::data_in(html)["beside"]["name"];
    EXPECT_TRUE(holds(html, "<figcaption>", name)) << name;
    return name;
  };
  EXPECT_TRUE(holds(beside(report(mine, "--compare " + others)), pseudonym_));
  EXPECT_TRUE(holds(beside(report(mine, "--for student --compare expert")), "100.0", "100.0"));
  EXPECT_TRUE(holds(beside(report(mine_later, "--for student --compare " + mine)),
                    fixed(run_json("grade " + mine)["score"]["points"], 1), "100.0"));
}

}  // namespace
}  // namespace cavum::report
