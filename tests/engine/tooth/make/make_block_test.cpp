#include "engine/tooth/make/make_block.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

double volume_mm3(const Tooth& tooth, const std::string& tissue) {
  return testing_tooth::volume_mm3(tooth, tooth.tissue_id(tissue));
}

TEST(MakeBlock, VolumesAreExactWhereSizesAreMultiplesOfTheLeaf) {
  const Tooth tooth =
      make_block({10, 10, 6}, parse_layers("enamel:1.2,dentin:2.0,pulp:1.5,dentin:1.3"), 0.05);
  EXPECT_NEAR(volume_mm3(tooth, "enamel"), 120.0, 1e-6);
  EXPECT_NEAR(volume_mm3(tooth, "dentin"), 330.0, 1e-6);
  EXPECT_NEAR(volume_mm3(tooth, "pulp"), 150.0, 1e-6);
  EXPECT_EQ(tooth.octree.tissue_at({0, 0, -0.01}), k_enamel);
  EXPECT_EQ(tooth.octree.tissue_at({4.99, -4.99, -1.19}), k_enamel);
  EXPECT_EQ(tooth.octree.tissue_at({0, 0, -1.21}), k_dentin);
  EXPECT_EQ(tooth.octree.tissue_at({0, 0, -3.21}), k_pulp);
  EXPECT_EQ(tooth.octree.tissue_at({0, 0, -5.99}), k_dentin);
  EXPECT_EQ(tooth.octree.tissue_at({0, 0, 0.01}), k_air);
  EXPECT_EQ(tooth.octree.tissue_at({0, 0, -6.01}), k_air);
}

TEST(MakeBlock, VolumesAreWithinHalfALeafOfTheSurfaceWhereTheyAreNot) {
  const Tooth tooth = make_block({3.03, 2.98, 2.017}, {{"enamel", 1.011}, {"dentin", 1.006}}, 0.05);
  const double surface_mm2 = 2 * (3.03 * 2.98 + 3.03 * 2.017 + 2.98 * 2.017);
  EXPECT_NEAR(volume_mm3(tooth, "enamel") + volume_mm3(tooth, "dentin"), 3.03 * 2.98 * 2.017,
              surface_mm2 * 0.025);
}

// The true distance of a box's face, whatever its place between the leaves; inner solid borders are
// no surface.
TEST(MakeBlock, FlatFacesAreWithinOneMicrometreOfTheTruth) {
  Random random(testing_tooth::drawn_seed("MakeBlock.FlatFacesAreWithinOneMicrometreOfTheTruth"));
  const Tooth tooth =
      make_block({4.037, 3.961, 3.013},
                 {{"enamel", 0.611}, {"dentin", 0.901}, {"pulp", 0.723}, {"dentin", 0.778}}, 0.05);
  const double pulp_top = -1.512, pulp_bottom = -2.235;
  Octree::Cursor cursor;
  for (int i = 0; i < 20000; ++i) {
    const double off = random.uniform(-0.05, 0.05), u = random.uniform(-1.7, 1.7),
                 v = random.uniform(-1.7, 1.7);
    const struct {
      Vec3 at;
      double outwards;
    } faces[4] = {{{u, v, off}, 1},
                  {{u, v, pulp_top + off}, -1},
                  {{u, v, pulp_bottom + off}, 1},
                  {{u, v, -3.013 + off}, -1}};
    for (const auto& f : faces) {
      const auto s = tooth.octree.sample(f.at, cursor);
      ASSERT_NEAR(s.distance_mm, f.outwards * off, 0.001);
      ASSERT_NEAR(s.gradient.z, f.outwards, 0.04);
    }
    const auto side = tooth.octree.sample({4.037 / 2 + off, u, -0.75 + 0.1 * v}, cursor);
    ASSERT_NEAR(side.distance_mm, off, 0.001);
    const auto border = tooth.octree.sample({u, v, -0.611 + off}, cursor);  // enamel to dentin
    ASSERT_NEAR(border.distance_mm, -0.1, 1e-9);
  }
}

TEST(MakeBlock, UnknownNamesBecomeNewSolidTissues) {
  const Tooth tooth =
      make_block({1, 1, 1}, parse_layers("enamel:0.3,lesion:0.3,gutta-percha:0.2,lesion:0.2"), 0.1);
  EXPECT_GE(tooth.tissue_id("lesion"), 5);
  EXPECT_NE(tooth.tissue_id("lesion"), tooth.tissue_id("gutta-percha"));
  EXPECT_TRUE(tooth.octree.is_solid(tooth.tissue_id("lesion")));
  EXPECT_NEAR(volume_mm3(tooth, "lesion"), 0.5, 1e-9);
}

// With a layer less than a leaf thick it would depend on the layer's place whether any leaf is its
// own.
TEST(MakeBlock, RefusesALeafLargerThanTheBlockOrALayer) {
  EXPECT_THROW((void)make_block({1, 1, 1}, parse_layers("enamel:1"), 2), Error);
  EXPECT_THROW((void)make_block({10, 1, 10}, parse_layers("enamel:10"), 2), Error);
  EXPECT_THROW((void)make_block({10, 10, 10}, parse_layers("enamel:9.96,dentin:0.04"), 0.05),
               Error);
  EXPECT_THROW((void)make_cube(1, "dentin", 1.01), Error);
  for (const double above : {0.0, 0.21, 0.2499}) {  // a layer of one leaf is there wherever it lies
    const Tooth tooth = make_block(
        {1, 1, 1}, {{"enamel", 0.25 + above}, {"dentin", 0.25}, {"enamel", 0.5 - above}}, 0.25);
    EXPECT_GT(volume_mm3(tooth, "dentin"), 0) << above;
  }
  EXPECT_NEAR(volume_mm3(make_cube(0.3, "dentin", 0.1 * 3), "dentin"), 0.027, 1e-9)
      << "rounding is no reason to refuse";
}

TEST(MakeBlock, RefusesNamesThatCannotBeShown) {
  for (const char* name : {"ena\xffmel", "ena\nmel", "\x1b[31mdentin"}) {
    EXPECT_THROW((void)parse_layers(std::string(name) + ":1"), Error);
    EXPECT_THROW((void)make_cube(1, name, 0.1), Error);
  }
  EXPECT_EQ(parse_layers("Schmelz\xc3\xa4hnlich:1")[0].tissue, "Schmelz\xc3\xa4hnlich");
}

TEST(MakeBlock, ErrorsNameTheOptionToChange) {
  const auto refused = [](double edge_mm) {
    return testing_basics::thrown_by([&] { (void)make_cube(edge_mm, "dentin", 0.05); });
  };
  EXPECT_TRUE(refused(0));
  EXPECT_EQ(testing_basics::figures_in(refused(0.01)->problem()), (std::vector<double>{0.01, 0.05}))
      << "the edge and the leaf";
}

TEST(MakeBlock, RefusesWhatCannotBeBuilt) {
  EXPECT_THROW((void)make_block({10, 10, 5}, parse_layers("enamel:1.2,dentin:2.0"), 0.05), Error);
  EXPECT_THROW((void)make_block({10, 10, -1}, parse_layers("enamel:1"), 0.05), Error);
  EXPECT_THROW((void)make_block({1, 1, 1}, parse_layers("enamel:1"), 0.0), Error);
  EXPECT_THROW((void)make_block({100, 1, 1}, parse_layers("enamel:1"), 0.05), Error);
  EXPECT_THROW((void)make_block({1e300, 1, 1}, parse_layers("enamel:1"), 0.05), Error);
  EXPECT_THROW((void)make_block({1, 1, 1}, parse_layers("air:1"), 0.05), Error);
  for (const char* text : {"", "enamel", "enamel:", "enamel:x", "enamel:1.2mm", "enamel:nan"}) {
    EXPECT_THROW((void)make_block({1, 1, 1}, parse_layers(text), 0.1), Error) << text;
  }
}

}  // namespace
}  // namespace cavum
