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
  const Ran r = run("rig cube --runs 1 --k 0.4,0.8 --model consistent --json --out " + path("c.svg") + " --csv " + path("c.csv"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const json j = json::parse(r.out);
  EXPECT_EQ(j["experiment"], "cube");
  ASSERT_EQ(j["sets"].size(), 1u);
  const json& rows = j["sets"][0]["rows"];
  ASSERT_EQ(rows.size(), 2u);
  for (const char* key : {"k_n_per_mm", "c_n_s_per_mm", "mean_n", "sd_n", "without_friction_mean_n", "closed_form_n", "eq_6_n", "left_out"})
    EXPECT_TRUE(rows[0].contains(key)) << key;
  EXPECT_DOUBLE_EQ(j["eq_6"]["slope_mm"], 0.505);
  EXPECT_TRUE(j["reading"].is_string());
  EXPECT_TRUE(read_text_file(path("c.csv")).starts_with("session,t_s,x_mm,f_n"));
  EXPECT_NE(read_text_file(path("rig.toml")).find("k_n_per_mm = 0.8"), std::string::npos);
  const std::string svg = read_text_file(path("c.svg"));
  EXPECT_NE(svg.find(", 1 run each"), std::string::npos) << "one run is no 1 runs";
  for (const char* words : {"<svg", "force, N", "spring coefficient k, N/mm", "eq. 6"}) EXPECT_NE(svg.find(words), std::string::npos) << words;
}

TEST_F(RigVerbs, ToothComputesThePapersConstants) {
  ASSERT_EQ(std::system((std::string(CAVUM_BINARY) +
                         " tooth make block --size-mm 4,4,3 --layers enamel:0.4,dentin:0.4,pulp:1.5,dentin:0.7 --leaf-mm 0.05 --out " +
                         path("b.cvt") + " >" + path("made"))
                            .c_str()),
            0);
  const Ran r = run("rig tooth --tooth " + path("b.cvt") + " --runs 2 --json --out " + path("t.svg"));
  ASSERT_EQ(r.exit_code, 0) << r.err;
  const json j = json::parse(r.out);
  EXPECT_NEAR(j["paper"]["c_at_k_0_8_n_s_per_mm"], 1.789, 5e-4);
  EXPECT_NEAR(j["paper"]["k_of_tooth_n_per_mm"], 0.788, 5e-4);
  EXPECT_EQ(j["layers"].size(), 3u);
  EXPECT_LT(j["after_n"]["mean"], j["before_n"]["mean"]);
  EXPECT_NE(read_text_file(path("t.svg")).find("time since contact, s"), std::string::npos);
}

TEST_F(RigVerbs, PressOfASingleCellSaysWhetherItIsWithinTheLimits) {
  const Ran r = run("rig press --k 0.8 --c paper --delay 1 --hand 300 --press 1 --speed 20 --json --out " + path("p.svg"));
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const json j = json::parse(r.out);
  EXPECT_TRUE(j["within_limits"]);
  ASSERT_EQ(j["presses"].size(), 1u);
  ASSERT_EQ(j["contacts"].size(), 1u);
  EXPECT_LE(j["presses"][0]["ours"]["sd_n"], 0.02);
  EXPECT_GT(j["presses"][0]["explicit"]["sd_n"], 0.3);
  EXPECT_NE(read_text_file(path("p.svg")).find("hand 300 N/m"), std::string::npos);
}

TEST_F(RigVerbs, GrindSaysHowFastEachTissueGoesUnderALoad) {
  const Ran r = run("rig grind --load-n 0.65,1.05 --json");
  ASSERT_EQ(r.exit_code, 0) << r.out << r.err;
  const json j = json::parse(r.out);
  ASSERT_EQ(j["rows"].size(), 8u);  // dentin, enamel, gum and lesion, each at two loads
  EXPECT_EQ(j["rows"][0]["tissue"], "dentin");
  EXPECT_LT(j["rows"][1]["rpm"], j["rows"][0]["rpm"]) << "more load, less speed";
  EXPECT_GT(j["rows"][1]["mm3_per_min"], j["rows"][0]["mm3_per_min"]);
  EXPECT_NE(run("rig grind --point round-1.0 --load-n 0.65").out.find("enamel"), std::string::npos);
}

TEST_F(RigVerbs, BadInputIsRefusedInOneLineThatSaysWhatToDo) {
  expect_refused("rig cube --out " + path("c.png"), {"use a name ending in .svg"});
  expect_refused("rig cube --out " + path("no/folder/c.svg"), {"c.svg"});
  expect_refused("rig cube --k 0.4 --csv " + path("c.csv"), {"--csv-k"});
  expect_refused("rig cube --model nothing", {"nothing.toml"});
  expect_refused("rig cube --runs 0", {"--runs"});
  expect_refused("rig cube --k -1", {"--k"});
  expect_refused("rig tooth --tooth " + path("nothing.cvt"), {"nothing.cvt"});
  expect_refused("rig tooth --at 40,0 --tooth " + testing_basics::data_path("teeth/lower_molar.cvt"), {"--at"});
  expect_refused("rig press --c strong", {"paper, consistent or none"});
  expect_refused("rig press --k 0", {"--k"});
  for (const char* nan : {"cube --k nan", "cube --csv-k nan", "tooth --spread-mm nan", "press --press nan", "press --hand nan", "press --k nan"})
    expect_refused(std::string("rig ") + nan, {"'nan' is no number from"});
  expect_refused("rig servo --seconds nan --out " + path("s.cavum"), {"'nan' is no number from"});
  expect_refused("rig servo", {"--out"});
  expect_refused("rig grind --load-n 0", {"--load-n"});
  expect_refused("rig cube --model clinical", {"cuts by pressure", "rig grind"});
  expect_refused("rig tooth --model clinical", {"cuts by pressure"});
  write_text_file(path("bad.toml"), "name = \"bad\"\n[cutting]\nrpm_ref = -1\n");
  expect_refused("rig tooth --model " + path("bad.toml"), {"bad.toml:3"});
}

}  // namespace
}  // namespace cavum::ui
