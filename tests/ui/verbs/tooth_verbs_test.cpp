// `cavum tooth landmarks` and what `tooth import` says, as a user sees them.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/tooth/tooth.h"
#include "tests/ui/program.h"

namespace cavum {
namespace {

class ToothVerbs : public testing_ui::Program {
 protected:
  void make() { ASSERT_EQ(run("tooth make molar --leaf-mm 0.2 --periodontium-mm 0 --out " + path("m.cvt")).exit_code, 0); }
};

TEST_F(ToothVerbs, LandmarksArePrintedDrawnPutAndTakenBack) {
  make();
  const auto found = run_json("tooth landmarks " + path("m.cvt") + " --out " + path("m.svg"));
  EXPECT_EQ(found.at("tooth_class").at("name"), "molar");
  EXPECT_EQ(found.at("cusps").size(), 5u);
  EXPECT_TRUE(found.at("moved").empty());
  EXPECT_NE(read_text_file(path("m.svg")).find("central_pit"), std::string::npos);
  const auto put = run_json("tooth landmarks " + path("m.cvt") + " --set central_pit=0.1,0.2,1.0 --set cusp_1=2,3,3 --out-tooth " + path("put.cvt"));
  EXPECT_EQ(put.at("points_mm").at("central_pit"), nlohmann::json::array({0.1, 0.2, 1.0}));
  EXPECT_EQ(put.at("moved").size(), 2u);
  EXPECT_NE(put.at("hash"), found.at("hash"));
  const auto again = run_json("tooth landmarks " + path("put.cvt"));
  EXPECT_EQ(again.at("points_mm"), put.at("points_mm"));
  const auto back = run_json("tooth landmarks " + path("put.cvt") + " --unset central_pit --unset cusp_1 --out-tooth " + path("back.cvt"));
  EXPECT_EQ(back.at("points_mm"), found.at("points_mm"));
  EXPECT_EQ(read_file(path("back.cvt")), read_file(path("m.cvt"))) << "without such points the old bytes";
}

TEST_F(ToothVerbs, LandmarksThatCannotBePutAreRefused) {
  make();
  const std::string verb = "tooth landmarks " + path("m.cvt") + " ", out = " --out-tooth " + path("x.cvt");
  for (const std::string& bad : {"--set nose=0,0,0" + out, "--set central_pit=0,0" + out, "--set central_pit=a,b,c" + out, "--set cusp_9=0,0,0" + out,
                                 "--unset central_pit" + out, std::string("--set central_pit=0,0,0"), out}) {
    const auto r = run(verb + bad);
    EXPECT_EQ(r.exit_code, 2) << bad;
    EXPECT_FALSE(std::filesystem::exists(path("x.cvt"))) << bad;
  }
}

TEST_F(ToothVerbs, ImportSaysWhichToothItIsAndRefusesAnother) {
  if (run("tooth import --enamel x --dentin x --pulp x --out y").err.find("no import") != std::string::npos) GTEST_SKIP() << "built without import";
  make();
  std::string meshes = "tooth import --leaf-mm 0.2 --periodontium-mm 0 --mesial-axis 1,0,0";
  for (const std::string tissue : {"enamel", "dentin", "pulp"}) {
    ASSERT_EQ(run("tooth mesh " + path("m.cvt") + " --tissue " + tissue + " --out " + path(tissue + ".stl")).exit_code, 0);
    meshes += " --" + tissue + " " + path(tissue + ".stl");
  }
  const auto right = run_json(meshes + " --universal 19 --out " + path("i.cvt"));
  EXPECT_EQ(right.at("sense").at("tooth_number").at("fdi"), 36);
  EXPECT_EQ(right.at("sense").at("tooth_class").at("name"), "molar");
  EXPECT_NE(right.at("name").get<std::string>().find("tooth 36 (universal 19)"), std::string::npos);
  const auto wrong = run(meshes + " --tooth-number 11 --out " + path("w.cvt"));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("shape of a molar"), std::string::npos) << wrong.err;
  const auto anyway = run(meshes + " --tooth-number 11 --anyway --out " + path("w.cvt"));
  EXPECT_EQ(anyway.exit_code, 0);
  EXPECT_NE(anyway.err.find("taken anyway"), std::string::npos) << anyway.err;
  EXPECT_EQ(run(meshes + " --tooth-number 36 --universal 19 --out " + path("b.cvt")).exit_code, 2);
  EXPECT_EQ(run(meshes + " --units in --out " + path("u.cvt")).exit_code, 2);
}

}  // namespace
}  // namespace cavum
