// `cavum tooth landmarks` and what `tooth import` says, as a user sees them.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/tooth/tooth.h"
#include "tests/ui/program.h"

namespace cavum {
namespace {

class ToothVerbs : public testing_ui::Program {
 protected:
  void make() {
    ASSERT_EQ(
        run("tooth make molar --leaf-mm 0.2 --periodontium-mm 0 --out " + path("m.cvt")).exit_code,
        0);
  }
};

TEST_F(ToothVerbs, LandmarksArePrintedDrawnPutAndTakenBack) {
  make();
  const auto found = run_json("tooth landmarks " + path("m.cvt") + " --out " + path("m.svg"));
  EXPECT_EQ(found.at("tooth_class").at("name"), "molar");
  EXPECT_EQ(found.at("cusps").size(), 5u);
  EXPECT_TRUE(found.at("moved").empty());
  EXPECT_NE(read_text_file(path("m.svg")).find("central_pit"), std::string::npos);
  const auto put =
      run_json("tooth landmarks " + path("m.cvt") +
               " --set central_pit=0.1,0.2,1.0 --set cusp_1=2,3,3 --out-tooth " + path("put.cvt"));
  EXPECT_EQ(put.at("points_mm").at("central_pit"), nlohmann::json::array({0.1, 0.2, 1.0}));
  EXPECT_EQ(put.at("moved").size(), 2u);
  EXPECT_NE(put.at("hash"), found.at("hash"));
  const auto again = run_json("tooth landmarks " + path("put.cvt"));
  EXPECT_EQ(again.at("points_mm"), put.at("points_mm"));
  const auto back = run_json("tooth landmarks " + path("put.cvt") +
                             " --unset central_pit --unset cusp_1 --out-tooth " + path("back.cvt"));
  EXPECT_EQ(back.at("points_mm"), found.at("points_mm"));
  EXPECT_EQ(read_file(path("back.cvt")), read_file(path("m.cvt")))
      << "without such points the old bytes";
}

TEST_F(ToothVerbs, LandmarksThatCannotBePutAreRefused) {
  make();
  const std::string verb = "tooth landmarks " + path("m.cvt") + " ",
                    out = " --out-tooth " + path("x.cvt");
  for (const std::string& bad :
       {"--set nose=0,0,0" + out, "--set central_pit=0,0" + out, "--set central_pit=a,b,c" + out,
        "--set cusp_9=0,0,0" + out, "--unset central_pit" + out,
        std::string("--set central_pit=0,0,0"), out}) {
    const auto r = run(verb + bad);
    EXPECT_EQ(r.exit_code, 2) << bad;
    EXPECT_FALSE(std::filesystem::exists(path("x.cvt"))) << bad;
  }
}

TEST_F(ToothVerbs, ANeighbourAndGumAreSetBesideATooth) {
  for (const char* seed : {"", " --seed 4"})
    ASSERT_EQ(run("tooth make premolar --leaf-mm 0.2 --out " +
                  path(*seed == 0 ? "p.cvt" : "n.cvt") + seed)
                  .exit_code,
              0);
  const std::string verb = "tooth neighbour " + path("p.cvt");
  const auto row =
      run_json(verb + " --mesial " + path("n.cvt") + " --gum --out " + path("row.cvt"));
  EXPECT_EQ(row.at("out"), path("row.cvt"));
  EXPECT_TRUE(row.at("contact").at("distal").is_null());
  const auto& contact = row.at("contact").at("mesial");
  EXPECT_LT(contact.at("gap_mm"), 0.1) << "they touch";
  const Tooth alone = load_tooth_file(path("p.cvt")), set = load_tooth_file(path("row.cvt"));
  const Vec3 at{contact.at("at_mm")[0], contact.at("at_mm")[1], contact.at("at_mm")[2]};
  const auto tissue_towards = [&](double x) {
    return set.tissue_name(set.octree.tissue_at(at + Vec3{x, 0, 0}));
  };
  EXPECT_EQ(tissue_towards(-0.4), "enamel");
  EXPECT_EQ(tissue_towards(0.4), "neighbour_enamel");
  for (const auto& t : alone.tissues)
    EXPECT_EQ(set.octree.count_leaves()[t.id], alone.octree.count_leaves()[t.id])
        << "the tooth itself: " << t.name;
  for (const char* name : {"neighbour_enamel", "neighbour_dentin", "gingiva"})
    EXPECT_GT(set.octree.count_leaves()[set.tissue_id(name)], 100u) << name;
  EXPECT_EQ(run_json("tooth landmarks " + path("row.cvt")).at("points_mm"),
            run_json("tooth landmarks " + path("p.cvt")).at("points_mm"));

  const auto between = run_json(verb + " --mesial " + path("n.cvt") + " --distal " + path("n.cvt") +
                                " --contact-mm 0.2 --out " + path("two.cvt"));
  EXPECT_LT(between.at("contact").at("distal").at("at_mm")[0],
            between.at("contact").at("mesial").at("at_mm")[0]);
  for (const char* side : {"mesial", "distal"})
    EXPECT_NEAR(between.at("contact").at(side).at("gap_mm").get<double>(), 0.2, 0.05) << side;
  const std::string printed =
      run(verb + " --mesial " + path("n.cvt") + " --out " + path("row.cvt")).out;
  EXPECT_NE(printed.find("mesial"), std::string::npos) << printed;
  EXPECT_EQ(printed.find("gingiva"), std::string::npos) << "no gum unless it is asked for";

  const std::string out = " --out " + path("x.cvt");
  for (const std::string& bad : {out, " --mesial " + path("none.cvt") + out,
                                 " --mesial " + path("n.cvt") + " --contact-mm 5" + out,
                                 " --mesial " + path("n.cvt") + " --out " + path("n.cvt"),
                                 " --gum --out " + path("p.cvt")}) {
    EXPECT_EQ(run(verb + bad).exit_code, 2) << bad;
    EXPECT_FALSE(std::filesystem::exists(path("x.cvt"))) << bad;
  }
  EXPECT_EQ(tooth_hash(load_tooth_file(path("p.cvt"))), tooth_hash(alone));
}

TEST_F(ToothVerbs, ImportSaysWhichToothItIsAndRefusesAnother) {
  if (run("tooth import --enamel none.stl --out y").err.find("none.stl") == std::string::npos)
    GTEST_SKIP() << "built without import";
  make();
  std::string meshes = "tooth import --leaf-mm 0.2 --periodontium-mm 0 --mesial-axis 1,0,0";
  for (const std::string tissue : {"enamel", "dentin", "pulp"}) {
    ASSERT_EQ(run("tooth mesh " + path("m.cvt") + " --tissue " + tissue + " --out " +
                  path(tissue + ".stl"))
                  .exit_code,
              0);
    meshes += " --" + tissue + " " + path(tissue + ".stl");
  }
  const auto right = run_json(meshes + " --universal 19 --out " + path("i.cvt"));
  EXPECT_EQ(right.at("sense").at("tooth_number").at("fdi"), 36);
  EXPECT_EQ(right.at("sense").at("tooth_class").at("name"), "molar");
  EXPECT_EQ(right.at("fdi"), 36);
  expect_refused(meshes + " --tooth-number 11 --out " + path("w.cvt"), {"11 (universal 8"});
  const auto confirmed = run(meshes + " --tooth-number 11 --confirm class --out " + path("w.cvt"));
  EXPECT_EQ(confirmed.exit_code, 0);
  EXPECT_NE(confirmed.err.find("class"), std::string::npos) << confirmed.err;
  const auto info = run("tooth info " + path("w.cvt"));
  for (const char* told : {"(class)", "0.95"})
    EXPECT_NE(info.out.find(told), std::string::npos) << info.out;
  EXPECT_EQ(run(meshes + " --tooth-number 11 --confirm all --out " + path("w.cvt")).exit_code, 2)
      << "by name, one by one";
  EXPECT_EQ(run(meshes + " --tooth-number 36 --universal 19 --out " + path("b.cvt")).exit_code, 2);
  EXPECT_EQ(run(meshes + " --units in --out " + path("u.cvt")).exit_code, 2);
}

}  // namespace
}  // namespace cavum
