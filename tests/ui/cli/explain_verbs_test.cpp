// `cavum explain` as a user runs it, on the data that ship.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

using testing_ui::k_data;

class ExplainVerbs : public testing_ui::Program {};

TEST_F(ExplainVerbs, TheTableOfFig6IsAnAliasAndItsReportSaysWhy) {
  const auto j =
      run_json("explain " + k_data + "/measured/fig6/fig6.csv --out " + path("fig6.html"));
  EXPECT_EQ(j["verdict"], "alias");
  EXPECT_EQ(j["next_experiment"]["kind"], "with_motion");
  EXPECT_TRUE(j["notes"][0]["values"].is_object());
  const std::string page = read_text_file(path("fig6.html"));
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("http://", page.find("</head>")), page.find("http://www.w3.org/2000/svg"))
      << "self-contained";
  expect_refused("explain " + k_data + "/measured/fig6/fig6.csv --model-out " + path("m.toml"),
                 {"fig6.csv"});
}

TEST_F(ExplainVerbs, TheModelOfTheHuntIsLoadedByRigExamAndExplain) {
  const std::string recording = k_data + "/measured/hunt/recording.csv", model = path("found.toml");
  const auto found = run_json("explain " + recording + " --seed 3 --model-out " + model +
                              " --out " + path("hunt.html"));
  ASSERT_EQ(found["verdict"], "named");
  EXPECT_EQ(run_json("explain " + recording + " --seed 3"), found)
      << "the same seed gives the same answer";
  const std::string page = read_text_file(path("hunt.html"));
  EXPECT_GE(std::count(page.begin(), page.end(), '\n'), 20) << page.substr(0, 500);

  EXPECT_EQ(run_json("explain " + recording + " --model " + model)["verdict"], "clean");
  EXPECT_EQ(run_json("rig cube --model " + model + " --k 0.4,0.8,1.2 --runs 1")["experiment"],
            "cube");
  const auto exam =
      run("exam " + k_data + "/scenarios/slot.toml --candidate x --operator expert --model " +
          model + " --out " + path("s.cavum") + " --quiet");
  EXPECT_EQ(exam.exit_code, 0) << exam.err;
  EXPECT_EQ(run("replay " + path("s.cavum") + " --verify").exit_code, 0);
  // the session, explained: no force was measured in it, and it says so
  const auto session = run_json("explain " + path("s.cavum"));
  EXPECT_EQ(session["notes"][0]["kind"], "force_of_own_law");
}

TEST_F(ExplainVerbs, ASessionTakesNoColumnsAndARecordingNoForce) {
  expect_refused("explain " + path("none.cavum"), {"none.cavum"});
  expect_refused("explain " + path("none.cavum") + " --column x_mm=z", {"none.cavum"});
  expect_refused("explain " + k_data + "/measured/hunt/recording.csv --force f.csv", {"--force"});
}

TEST_F(ExplainVerbs, NothingThatIsReadIsWrittenOver) {
  const std::string data = read_text_file(k_data + "/measured/hunt/recording.csv"),
                    rig = read_text_file(k_data + "/measured/hunt/rig.toml");
  write_text_file(path("r.csv"), data);
  write_text_file(path("rig.toml"), rig);
  for (const std::string& options :
       {"--out " + path("r.csv"), "--out " + path("./r.csv"), "--model-out " + path("rig.toml"),
        "--model-out " + path("r.csv"),
        "--out " + path("a.html") + " --model-out " + path("a.html")})
    expect_refused("explain " + path("r.csv") + " " + options, {"cavum"});
  EXPECT_EQ(read_text_file(path("r.csv")), data);
  EXPECT_EQ(read_text_file(path("rig.toml")), rig);
  // a rig.toml of somebody's own beside a recording that a rig would write
  write_text_file(path("rig.toml"), "k_n_per_mm = 0.9\n");
  ASSERT_EQ(run("explain --protocol " + path("protocol.html")).exit_code, 0);
  expect_refused(
      "rig record --motion " + path("protocol.csv") + " --sessions 1 --csv " + path("new.csv"),
      {"rig.toml"});
  expect_refused(
      "rig record --motion " + path("protocol.csv") + " --sessions 1 --csv " + path("protocol.csv"),
      {});
  expect_refused("explain --protocol " + path("p.csv"), {"p.csv"});
  EXPECT_EQ(read_text_file(path("rig.toml")), "k_n_per_mm = 0.9\n");
}

TEST_F(ExplainVerbs, WrongOptionsAreRefused) {
  const std::string hunt = "explain " + k_data + "/measured/hunt/recording.csv ";
  for (const std::string wrong : {"--seed -1", "--twins 5", "--material pulp --model consistent",
                                  "--material unobtainium --model consistent", "--material dentin",
                                  "--out r.pdf", "--protocol p.html"})
    expect_refused(hunt + wrong, {"cavum"});
}

TEST_F(ExplainVerbs, ForceOfTheWrongSignIsRefusedAndSaysSoInJsonWhateverElseIsAsked) {
  const std::string data = read_text_file(k_data + "/measured/hunt/recording.csv");
  std::istringstream in(data);
  std::string line, turned;
  std::getline(in, line);
  turned = line + "\n";
  const auto comma = [&](std::size_t n) {
    std::size_t at = 0;
    for (std::size_t i = 0; i < n; ++i) at = line.find(',', at) + 1;
    return at;
  };
  while (std::getline(in, line)) {
    const std::size_t at = comma(3);
    turned += line[at] == '-' ? line.substr(0, at) + line.substr(at + 1) + "\n"
                              : line.substr(0, at) + "-" + line.substr(at) + "\n";
  }
  write_text_file(path("turned.csv"), turned);
  const auto ran = run("explain " + path("turned.csv") + " --json --model-out " + path("m.toml"));
  EXPECT_EQ(ran.exit_code, 2);
  const auto j = nlohmann::json::parse(ran.out);
  EXPECT_EQ(j["error"]["code"], "data_fault");
  EXPECT_EQ(j["error"]["where"]["name"], path("turned.csv"));
  EXPECT_NE(j["error"]["advice"].get<std::string>().find("--negate f"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(path("m.toml")));
  expect_refused("explain " + path("turned.csv"), {"turned.csv"});
}

TEST_F(ExplainVerbs, ADryRunSaysWhatWasUnderstoodAndExplainsNothing) {
  std::string table = "Press 7;24.11.2026\nZeit [ms];Weg [mm];Kraft [mN]\n";
  for (int i = 0; i < 400; ++i)
    table += fmt::format("{};{},5;{}\n", 5 * i, 37 + (i % 200) / 50,
                         -20 * std::max(0, i % 200 - 100) - i % 3);
  write_text_file(path("press.csv"), table);
  const auto j =
      run_json("explain " + path("press.csv") + " --dry-run --out " + path("press.html"));
  EXPECT_EQ(j["rows"], 400);
  EXPECT_EQ(j["table"]["decimal"], "comma");
  EXPECT_EQ(j["columns"][2]["factor"], 1e-3);
  EXPECT_FALSE(j.contains("verdict"));
  const std::string page = read_text_file(path("press.html"));
  EXPECT_NE(page.find("Kraft [mN]"), std::string::npos);
  const auto said = run("explain " + path("press.csv") + " --dry-run");
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_NE(said.out.find("Kraft [mN]"), std::string::npos);
  expect_refused("explain " + path("press.csv") + " --dry-run --unit f=stone", {"'stone'", "lbf"});
  expect_refused("explain " + path("press.csv") + " --dry-run --column f=Kraf", {"'Kraft [mN]'"});
}

TEST_F(ExplainVerbs, ARecordingIsMadeAlongTheProtocolsMotion) {
  ASSERT_EQ(run("explain --protocol " + path("protocol.html")).exit_code, 0);
  ASSERT_EQ(run("rig record --motion " + path("protocol.csv") +
                " --sessions 1 --rate-hz 25 --csv " + path("r.csv"))
                .exit_code,
            0);
  EXPECT_TRUE(read_text_file(path("r.csv")).starts_with("session,t_s,x_mm,f_n"));
  EXPECT_NE(read_text_file(path("rig.toml")).find("k_n_per_mm = 0.8"), std::string::npos);
  expect_refused("rig record --motion " + path("protocol.csv") + " --csv " + path("x/rig.toml"),
                 {"rig.toml"});
}

}  // namespace
}  // namespace cavum::ui
