// `cavum grade` beyond a single result: the worked page of grading/README.md row by row, why points
// were lost, and regrading beside the sealed result.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/text.h"
#include "tests/ui/program.h"
#include "tests/ui/report/kinds.h"

namespace cavum::ui {
namespace {

using nlohmann::json;
using testing_report::holds;
using testing_report::of_kind;
using testing_ui::Ran;

const std::string k_source = CAVUM_SOURCE_DIR;
const std::string k_worked = k_source + "/tests/grading/worked/hole";

class GradeVerb : public testing_ui::Program {
 protected:
  /// The session of the worked page.
  [[nodiscard]] std::string hole(const std::string& name = "hole.cavum") const {
    EXPECT_EQ(
        run("tooth make block --size-mm 4,4,3 --layers enamel:2.5,pulp:0.5 --leaf-mm 0.05 --out " +
            path("hole.cvt"))
            .exit_code,
        0);
    const Ran r = run("exam " + k_worked + ".toml --tooth " + path("hole.cvt") +
                      " --candidate hand --motion " + k_worked + ".csv --out " + path(name));
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return path(name);
  }
};

std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> list;
  std::istringstream in(row);
  std::string cell;
  while (std::getline(in, cell, '|')) {
    const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
    list.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return list;
}

/// Where the JSON states the bound of the figure at `pointer`.
std::string bound_pointer(const std::string& pointer) {
  const auto last = pointer.rfind('/');
  const std::string name = pointer.substr(last + 1);
  const auto in = [&](const char* part) { return pointer.rfind(part, 0) == 0; };
  if (in("/volumes/")) return "/volumes/bounds/" + name;
  if (in("/walls/")) return pointer.substr(0, last) + "/bounds/" + name;
  if (in("/shape/")) return name == "taper_deg" ? "/shape/taper_bound_deg" : "/shape/bound_mm";
  if (in("/criteria/")) return pointer + "_bound";
  if (in("/score/")) return "/score/bound";
  return "/bounds/" + (in("/force/") ? "force_n" : name);
}

TEST_F(GradeVerb, PrintsTheTableOfMeasuresWithoutASession) {
  ASSERT_EQ(std::system(
                ("env -u CAVUM_ALTER_SENTENCES " CAVUM_BINARY " grade --measures >" + path("m.md"))
                    .c_str()),
            0);
  EXPECT_EQ(read_text_file(path("m.md")), read_text_file(k_source + "/docs/measures.md"));
  EXPECT_EQ(run("grade").exit_code, 2);
}

TEST_F(GradeVerb, PrintsTheFiguresOfTheWorkedPage) {
  const json result = run_json("grade " + hole());
  // the closed forms once more, in full digits: the page's own column must not drift
  const double pi = std::acos(-1.0), disc = pi * 0.25, target = pi * 0.36,
               lag = 0.8 * 0.05 * 2.02 + 0.012 * 0.05;
  const std::map<std::string, double> by_hand{
      {"/volumes/target_mm3", target},
      {"/volumes/removed_mm3", disc * 1.1},
      {"/volumes/missed_mm3", target - disc},
      {"/volumes/target_removed_percent", 100 * disc / target},
      {"/volumes/overcut/leeway_bottom_mm3", disc * 0.05},
      {"/volumes/overcut/container_bottom_mm3", disc * 0.05},
      {"/volumes/dice", 2 * disc / (target + disc * 1.1)},
      {"/walls/floor/mean_mm", disc * 0.1 / (disc + 2 * pi * 0.5 * 0.2)},
      {"/force/peak_n", lag},
      {"/force/mean_n", lag * 22 / 40.1},
      {"/score/points",
       100 * disc / target - 50 + 30 * (0.1 - disc * 0.05) / 0.09 + 10 * 0.1 / 0.15 + 10 + 7.9995}};
  std::istringstream page(read_text_file(k_source + "/grading/README.md"));
  std::string line;
  int rows = 0;
  std::size_t recomputed = 0;
  while (std::getline(page, line)) {
    if (line.rfind("| `/", 0) != 0) continue;
    ++rows;
    const auto cell = cells(line);
    ASSERT_EQ(cell.size(), 6u) << line;
    const std::string pointer = cell[1].substr(1, cell[1].size() - 2);
    const double found = result.at(json::json_pointer(pointer)).get<double>();
    const auto rounding_of = [](const std::string& text) {
      return 0.5000001 * std::pow(10.0, -static_cast<double>(text.size() - text.find('.') - 1));
    };
    const double rounding = rounding_of(cell[4]),
                 bound = result.at(json::json_pointer(bound_pointer(pointer))).get<double>();
    EXPECT_NEAR(std::stod(cell[4]), found, rounding) << line << " prints " << found;
    EXPECT_NEAR(std::stod(cell[5]), bound, rounding_of(cell[5])) << line << " states " << bound;
    const double idealised = pointer.rfind("/force/", 0) == 0 ? 0.0002 : 0.0;
    EXPECT_NEAR(std::stod(cell[3]), found, bound + idealised + 2 * rounding)
        << line << ": outside the bound";
    if (const auto hand = by_hand.find(pointer); hand != by_hand.end()) {
      ++recomputed;
      EXPECT_NEAR(std::stod(cell[3]), hand->second, rounding) << line;
    }
  }
  EXPECT_GE(rows, 30);
  EXPECT_EQ(recomputed, by_hand.size());
  EXPECT_EQ(result["verdict"], "pass");
}

TEST_F(GradeVerb, WhyShowsTicksPlacesAndPointsThatAddUp) {
  const std::string session = hole();
  const json grade = run_json("grade " + session);
  for (const auto& c : grade["criteria"]) {
    const json why = run_json("grade " + session + " --why " + c["id"].get<std::string>());
    EXPECT_EQ(why["criterion"]["points"], c["points"]);
    EXPECT_EQ(why["criterion"]["reason"], c["reason"]);
    EXPECT_FALSE(why["moments"].empty()) << c["id"];
  }
  const json floor = run_json("grade " + session + " --why floor");
  double lost = 0;
  for (const auto& m : floor["moments"]) {
    lost += m["points_lost"].get<double>();
    EXPECT_GT(m["t_s"].get<double>(), 20);  // below the leeway only late
    EXPECT_NEAR(m["t_s"].get<double>() * 1000, m["tick"].get<double>(), 1e-6);
    EXPECT_LT(m["site_mm"][2].get<double>(), -1.0);
  }
  EXPECT_NEAR(lost, floor["points_lost"].get<double>(), 1e-4);
  const json removed = run_json("grade " + session + " --why removed");
  double missed = 0;
  for (const auto& m : removed["moments"]) missed += m["amount"].get<double>();
  EXPECT_NEAR(missed, grade["volumes"]["missed_mm3"].get<double>(), 1e-4);
  EXPECT_NE(run("grade " + session + " --why floor").out.find(floor["moments"][0]["tick"].dump()),
            std::string::npos);
  expect_refused("grade " + session + " --why nonsense", {"removed, floor, walls, whole, time"});
}

TEST_F(GradeVerb, AZoneFromAnStlStaysWithTheSessionAndAChangedOneIsRefused) {
  const std::string tooth = path("hole.cvt"), make = "tooth make block --leaf-mm 0.05 --out ";
  ASSERT_EQ(run(make + tooth + " --size-mm 4,4,3 --layers enamel:2.5,pulp:0.5").exit_code, 0);
  const auto box = [&](const char* size, const char* thick) {
    ASSERT_EQ(
        run(make + path("b.cvt") + " --size-mm " + size + " --layers enamel:" + thick).exit_code,
        0);
    ASSERT_EQ(
        run("tooth mesh " + path("b.cvt") + " --tissue enamel --out " + path("box.stl")).exit_code,
        0);
  };
  box("1.6,1.6,1", "1");
  std::string text = read_text_file(k_worked + ".toml");
  const auto zone = text.find("shape = \"column\""), end = text.find("[rubric]");
  text.replace(zone, end - zone, "shape = \"stl\"\nfile = \"box.stl\"\n\n");
  write_text_file(path("stl.toml"), text);
  const json shown = run_json("scenario show " + path("stl.toml") + " --tooth " + tooth +
                              " --out " + path("stl.svg"));
  EXPECT_NEAR(shown["zones_mm3"]["target"].get<double>(), 1.6 * 1.6, 0.02);
  const Ran exam = run("exam " + path("stl.toml") + " --tooth " + tooth +
                       " --candidate a --operator expert --out " + path("s.cavum"));
  ASSERT_EQ(exam.exit_code, 0) << exam.err;
  const json first = run_json("grade " + path("s.cavum"));
  EXPECT_GT(first["volumes"]["target_removed_percent"], 80);

  std::filesystem::rename(path("box.stl"), path("kept.stl"));  // the session needs no file
  EXPECT_EQ(run_json("grade " + path("s.cavum")), first);
  EXPECT_EQ(run("replay " + path("s.cavum") + " --verify").exit_code, 0);
  expect_refused("grade " + path("s.cavum") + " --scenario " + path("stl.toml"),
                 {"stl.toml:", "'box.stl'"});
  box("1.6,1.6,1.1", "1.1");
  expect_refused(
      "grade " + path("s.cavum") + " --scenario " + path("stl.toml"),
      {"stl.toml:", "'box.stl'", to_hex(sha256(read_file(path("kept.stl")))).substr(0, 8)});
  std::filesystem::rename(path("kept.stl"), path("box.stl"));
  const json again = run_json("grade " + path("s.cavum") + " --scenario " + path("stl.toml"));
  EXPECT_EQ(again["score"], first["score"]);
}

TEST_F(GradeVerb, AnotherRubricGivesANewResultBesideTheSealedOne) {
  const std::string session = hole(), bytes = read_text_file(session);
  write_text_file(path("r.toml"), R"(rule = "compensatory"
pass_percent = 90
borderline_percent = 1
[[criteria]]
id = "removed"
metric = "target_removed_percent"
full = 60
zero = 50
points = 40
[[criteria]]
id = "hand"
metric = "force_peak_n"
full = 0.05
zero = 0.15
points = 10
)");
  const json j = run_json("grade " + session + " --rubric " + path("r.toml"));
  const json& re = j["regrade"];
  EXPECT_EQ(re["old"]["verdict"], "pass");
  EXPECT_EQ(re["new"]["verdict"], j["verdict"]);
  EXPECT_EQ(re["new"]["points"], j["score"]["points"]);
  std::map<std::string, json> by_id;
  for (const auto& c : re["criteria"]) by_id[c["id"]] = c;
  EXPECT_DOUBLE_EQ(by_id.at("removed")["new_points"], 40);
  EXPECT_NEAR(by_id.at("removed")["old_points"].get<double>(), 19.44,
              1.5);  // by hand, see the worked page
  EXPECT_EQ(by_id.at("removed")["old_points"],
            run_json("grade " + session)["criteria"][0]["points"]);
  ASSERT_EQ(by_id.at("removed")["changed"].size(), 1u);
  EXPECT_EQ(by_id.at("removed")["changed"][0]["kind"], "full");
  EXPECT_EQ(by_id.at("removed")["changed"][0]["from"]["value"], 90);
  EXPECT_EQ(by_id.at("removed")["changed"][0]["to"]["value"], 60);
  EXPECT_TRUE(by_id.at("hand")["old_points"].is_null());
  EXPECT_TRUE(by_id.at("floor")["new_points"].is_null());
  EXPECT_EQ(by_id.at("floor")["changed"].size(), 1u);
  EXPECT_FALSE(re["rules"].empty());
  EXPECT_FALSE(run_json("grade " + session).contains("regrade"));
  EXPECT_EQ(read_text_file(session), bytes) << "a session is never written to";
  const std::string out =
      "grade " + session + " --rubric " + path("r.toml") + " --out " + path("new.json");
  EXPECT_EQ(run(out).exit_code, 0);
  EXPECT_EQ(json::parse(read_text_file(path("new.json"))), j);
  EXPECT_EQ(run(out).exit_code, 2) << "a result is never overwritten";
}

TEST_F(GradeVerb, ARubricThatAsksForWhatTheExamDoesNotHaveIsRefusedWithEveryMistake) {
  const std::string session = hole();
  write_text_file(path("r.toml"), R"(rule = "compensatory"
pass_percent = 50
[[criteria]]
id = "pulpa"
metric = "touched_pulpa_mm3"
full = 0
zero = 1
points = 40
[[criteria]]
id = "guard"
metric = "protected_mm3"
full = 0
zero = 1
points = 10
)");
  for (const std::string& verb :
       {"grade " + session, "report " + session + " --out " + path("r.html")}) {
    const Ran r = run(verb + " --rubric " + path("r.toml"));
    EXPECT_EQ(r.exit_code, 2);
    EXPECT_EQ(r.out, "");
    for (const char* told : {"r.toml:5:10: ", "'touched_pulpa_mm3'", "'touched_pulp_mm3'",
                             "r.toml:11:10: ", "'protected_mm3'"})
      EXPECT_NE(r.err.find(told), std::string::npos) << told << " in " << r.err;
  }
  std::string text = read_text_file(k_worked + ".toml");
  const auto metric = text.find("metric = \"container_bottom_mm3\"");
  ASSERT_NE(metric, std::string::npos);
  text.replace(metric, 31, "metric = \"touched_pulpa_mm3\"");
  write_text_file(path("s.toml"), text);
  const Ran scenario = run("grade " + session + " --scenario " + path("s.toml"));
  EXPECT_EQ(scenario.exit_code, 2);
  EXPECT_NE(scenario.err.find("'pulpa'"), std::string::npos) << scenario.err;
  write_text_file(
      path("turned.toml"),
      "rule = \"compensatory\"\npass_percent = 50\n[[criteria]]\nid = \"d\"\nmetric = \"dice\"\nfull = 0\nzero = 1\npoints = 1\n");
  const Ran turned = run("grade " + session + " --rubric " + path("turned.toml"));
  EXPECT_EQ(turned.exit_code, 0);
  EXPECT_NE(turned.err.find("turned.toml:7:8: "), std::string::npos) << turned.err;
}

TEST_F(GradeVerb, AnotherTasksScenarioIsRefusedUnlessAskedFor) {
  const std::string session = hole();
  std::string text = read_text_file(k_worked + ".toml");
  const auto id = text.find("id = \"");
  text.insert(id + 6, "another_");
  write_text_file(path("other.toml"), text);
  expect_refused("grade " + session + " --scenario " + path("other.toml"),
                 {"other.toml: ", "'another_"});
  EXPECT_EQ(run_json("grade " + session + " --another-task --scenario " +
                     path("other.toml"))["regrade"]["by"]["scenario"],
            path("other.toml"));
}

TEST_F(GradeVerb, ARegradesReportSaysSoAndShowsTheSealedVerdictBesideTheNewOne) {
  const std::string session = hole();
  std::string rubric = read_text_file(k_worked + ".toml");
  rubric = rubric.substr(rubric.find("[rubric]"));
  rubric.replace(rubric.find("pass_percent = 60"), 17, "pass_percent = 95");
  write_text_file(path("r.toml"), rubric);
  const std::string again = session + " --rubric " + path("r.toml");
  ASSERT_EQ(run("report " + again + " --out " + path("r.html")).exit_code, 0);
  const std::string html = read_text_file(path("r.html"));
  const std::string points = fixed(run_json("grade " + session)["score"]["points"], 1),
                    table = of_kind(html.substr(html.find("class='verdict ")), "regrade");
  EXPECT_TRUE(
      holds(of_kind(html, "regrade"), path("r.toml"), "fail", points, "100.0", "pass", points));
  EXPECT_TRUE(holds(table, "60 % → 95 %"));
  for (const char* criterion : {"removed", "floor", "walls", "whole", "time"})
    EXPECT_TRUE(holds(table, "<tr><td>" + std::string(criterion) + "</td>")) << criterion;
  const Ran text = run("grade " + again), plain = run("grade " + session);
  EXPECT_TRUE(holds(text.out.substr(0, text.out.find('\n')), path("r.toml")))
      << text.out.substr(0, 200);
  ASSERT_EQ(run("report " + session + " --out " + path("own.html")).exit_code, 0);
  EXPECT_EQ(of_kind(read_text_file(path("own.html")), "regrade"), "");
  EXPECT_EQ(plain.out.find("r.toml"), std::string::npos);
}

TEST_F(GradeVerb, AFoldersTableNamesEverySessionOnceAndWhatWasNotGraded) {
  std::filesystem::create_directory(path("group"));
  const std::string session = hole("group/a.cavum");
  write_text_file(path("group/b.cavum"), "no session");
  const Ran twice =
      run("grade " + path("group") + " " + session + " " + path("group/../group/a.cavum"));
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_TRUE(holds(twice.out.substr(twice.out.rfind('\n', twice.out.size() - 2)), "2 ", "1 ",
                    "pass", "1 "))
      << twice.out;
  std::string rubric = read_text_file(k_worked + ".toml");
  rubric =
      rubric.substr(rubric.find("[rubric]")) +
      "\n[[rubric.criteria]]\nid = \"extra\"\nmetric = \"dice\"\nfull = 1\nzero = 0.99\npoints = 10\n";
  write_text_file(path("r.toml"), rubric);
  const Ran extra = run("grade " + path("group") + " --rubric " + path("r.toml"));
  EXPECT_TRUE(holds(extra.out, "extra", "+0.0")) << extra.out;
}

TEST_F(GradeVerb, ADamagedSessionIsOneLineWithOneAdvice) {
  const std::string session = hole();
  std::string bytes = read_text_file(session);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i)
    bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
  write_text_file(path("bad.cavum"), bytes);
  const Ran bad = run("grade " + path("bad.cavum"));
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_EQ(std::count(bad.err.begin(), bad.err.end(), ';'), 1) << bad.err;
}

TEST_F(GradeVerb, AReportIsWrittenOverAReportAndOverNothingElse) {
  const std::string session = hole();
  const std::string write = "report " + session + " --out " + path("r.html");
  ASSERT_EQ(run(write).exit_code, 0);
  EXPECT_EQ(run(write).exit_code, 0);
  write_text_file(path("r.html"), "<!doctype html>\nmy notes");
  expect_refused(write, {"r.html: "});
  EXPECT_EQ(read_text_file(path("r.html")), "<!doctype html>\nmy notes");
  EXPECT_EQ(run(write + " --overwrite").exit_code, 0);
  const std::string picture = "report " + session + " --out " + path("r.svg");
  ASSERT_EQ(run(picture).exit_code, 0);
  EXPECT_EQ(run(picture).exit_code, 0);
}

TEST_F(GradeVerb, ACorrectedScenarioIsMeasuredAnewForAWholeFolder) {
  std::filesystem::create_directory(path("group"));
  for (const char* name : {"group/a.cavum", "group/b.cavum"}) static_cast<void>(hole(name));
  std::string text = read_text_file(k_worked + ".toml");
  text.replace(text.find("radius_mm = 0.6"), 15, "radius_mm = 0.5");
  text.replace(text.find("z_mm = -1.0"), 11, "z_mm = -1.1");
  write_text_file(path("corrected.toml"), text);
  const json one =
      run_json("grade " + path("group/a.cavum") + " --scenario " + path("corrected.toml"));
  EXPECT_NEAR(one["volumes"]["target_mm3"].get<double>(), std::acos(-1.0) * 0.25 * 1.1, 0.01);
  EXPECT_GT(one["volumes"]["target_removed_percent"], 99.0);
  const json all = run_json("grade " + path("group") + " --scenario " + path("corrected.toml"));
  ASSERT_EQ(all["sessions"].size(), 2u);
  EXPECT_EQ(all["verdicts"], (json{{"stay pass", 2}}));
  for (const auto& s : all["sessions"]) {
    EXPECT_EQ(s["new"]["points"], one["score"]["points"]);
    EXPECT_EQ(s["criteria"], one["regrade"]["criteria"]);
    EXPECT_FALSE(s["criteria"][0]["changed"].empty()) << s["criteria"][0];
  }
  // a damaged session is a row of its own, and the others are graded
  write_text_file(path("group/c.cavum"), "no session");
  const Ran table = run("grade " + path("group") + " --scenario " + path("corrected.toml"));
  EXPECT_EQ(table.exit_code, 1);
  EXPECT_TRUE(holds(table.out, "group/c.cavum", "2 ", "pass")) << table.out;
  EXPECT_EQ(run("grade " + path("group/a.cavum") + " " + path("group/b.cavum") + " --why floor")
                .exit_code,
            2);
  EXPECT_EQ(run("grade " + path("group/a.cavum") + " --scenario " + k_worked + ".csv").exit_code,
            2);
}

}  // namespace
}  // namespace cavum::ui
