// `cavum rig` as a user runs it: small experiments, their JSON and files, and bad input.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/ui/program.h"

namespace cavum::ui {
namespace {

using nlohmann::json;
using testing_ui::Ran;

class RigVerbs : public testing_ui::Program {};

TEST_F(RigVerbs, CubeWritesFiguresPictureAndRecordings) {
  const Ran r = run("rig cube --runs 1 --k 0.4,0.8 --model consistent --json --out " +
                    path("c.svg") + " --csv " + path("c.csv"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const json j = json::parse(r.out);
  EXPECT_EQ(j["experiment"], "cube");
  ASSERT_EQ(j["sets"].size(), 1u);
  const json& rows = j["sets"][0]["rows"];
  ASSERT_EQ(rows.size(), 2u);
  for (const char* key : {"k_n_per_mm", "c_n_s_per_mm", "mean_n", "sd_n", "without_friction_mean_n",
                          "closed_form_n", "eq_6_n", "left_out"})
    EXPECT_TRUE(rows[0].contains(key)) << key;
  EXPECT_DOUBLE_EQ(j["eq_6"]["slope_mm"], 0.505);
  EXPECT_TRUE(j["reading"].is_string());
  EXPECT_TRUE(read_text_file(path("c.csv")).starts_with("session,t_s,x_mm,f_n"));
  EXPECT_NE(read_text_file(path("rig.toml")).find("k_n_per_mm = 0.8"), std::string::npos);
  const std::string svg = read_text_file(path("c.svg"));
  EXPECT_TRUE(svg.starts_with("<svg")) << svg.substr(0, 100);
}

TEST_F(RigVerbs, ToothComputesThePapersConstants) {
  ASSERT_EQ(
      std::system(
          (std::string(CAVUM_BINARY) +
           " tooth make block --size-mm 4,4,3 --layers enamel:0.4,dentin:0.4,pulp:1.5,dentin:0.7 --leaf-mm 0.05 --out " +
           path("b.cvt") + " >" + path("made"))
              .c_str()),
      0);
  const Ran r =
      run("rig tooth --tooth " + path("b.cvt") + " --runs 2 --json --out " + path("t.svg"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const json j = json::parse(r.out);
  EXPECT_NEAR(j["paper"]["c_at_k_0_8_n_s_per_mm"], 1.789, 5e-4);
  EXPECT_NEAR(j["paper"]["k_of_tooth_n_per_mm"], 0.788, 5e-4);
  EXPECT_EQ(j["layers"].size(), 3u);
  EXPECT_LT(j["after_n"]["mean"], j["before_n"]["mean"]);
  EXPECT_TRUE(read_text_file(path("t.svg")).starts_with("<svg"));
}

TEST_F(RigVerbs, PressOfASingleCellSaysWhetherItIsWithinTheLimits) {
  const Ran r =
      run("rig press --k 0.8 --c paper --delay 1 --hand 300 --press 1 --speed 20 --json --out " +
          path("p.svg"));
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const json j = json::parse(r.out);
  EXPECT_TRUE(j["within_limits"]);
  ASSERT_EQ(j["presses"].size(), 1u);
  ASSERT_EQ(j["contacts"].size(), 1u);
  EXPECT_LE(j["presses"][0]["ours"]["sd_n"], 0.02);
  EXPECT_GT(j["presses"][0]["explicit"]["sd_n"], 0.3);
  EXPECT_NE(read_text_file(path("p.svg")).find("300 N/m"), std::string::npos);
}

TEST_F(RigVerbs, GrindSaysHowFastEachTissueGoesUnderALoad) {
  const Ran r = run("rig grind --load-n 0.65,1.05 --json");
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const json j = json::parse(r.out);
  ASSERT_EQ(j["rows"].size(), 8u);  // dentin, enamel, gum and lesion, each at two loads
  EXPECT_EQ(j["rows"][0]["tissue"], "dentin");
  EXPECT_LT(j["rows"][1]["rpm"], j["rows"][0]["rpm"]) << "more load, less speed";
  EXPECT_GT(j["rows"][1]["mm3_per_min"], j["rows"][0]["mm3_per_min"]);
  EXPECT_NE(run("rig grind --bur round-1.0 --load-n 0.65").out.find("enamel"), std::string::npos);
}

TEST_F(RigVerbs, BadInputIsRefusedInOneLineThatSaysWhatToDo) {
  write_text_file(path("bad.toml"), "name = \"bad\"\n[cutting]\nrpm_ref = -1\n");
  for (const auto& [verb, named] : std::vector<std::pair<std::string, std::string>>{
           {"cube --out " + path("c.png"), "c.png"},
           {"cube --out " + path("no/folder/c.svg"), "c.svg"},
           {"cube --k 0.4 --csv " + path("c.csv"), "--csv-k"},
           {"cube --model nothing", "nothing.toml"},
           {"cube --runs 0", "--runs"},
           {"cube --k -1", "--k"},
           {"tooth --tooth " + path("nothing.cvt"), "nothing.cvt"},
           {"tooth --at 40,0 --tooth " + testing_basics::data_path("teeth/lower_molar.cvt"), ""},
           {"press --c strong", "'strong'"},
           {"press --k 0", "--k"},
           {"servo --seconds nan --out " + path("s.cavum"), "'nan'"},
           {"servo", "--out"},
           {"grind --load-n 0", "--load-n"},
           {"cube --model clinical", "clinical"},
           {"tooth --model clinical", "clinical"},
           {"tooth --model " + path("bad.toml"), "bad.toml:3"}})
    expect_refused("rig " + verb, {named});
  for (const char* nan : {"cube --k nan", "cube --csv-k nan", "tooth --spread-mm nan",
                          "press --press nan", "press --hand nan", "press --k nan"})
    expect_refused(std::string("rig ") + nan, {"'nan'"});
}

}  // namespace
}  // namespace cavum::ui
