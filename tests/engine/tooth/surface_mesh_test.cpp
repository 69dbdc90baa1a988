#include "engine/tooth/surface_mesh.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "engine/tooth/distance.h"
#include "engine/tooth/make/make_block.h"
#include "engine/tooth/make/make_molar.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

TEST(SurfaceMesh, EveryTissueOfTheMolarIsClosedAndHoldsItsVolume) {
  MolarShape shape;
  shape.leaf_mm = 0.1;
  const Tooth tooth = make_molar(shape);
  for (const char* name : {"enamel", "dentin", "pulp", "periodontium", "solid"}) {
    const TriangleMesh mesh = surface_mesh(tooth, name);
    EXPECT_TRUE(testing_tooth::is_closed_and_oriented(mesh)) << name;
    const auto count = tooth.octree.count_leaves();
    const auto leaves = std::string(name) == "solid" ? count[k_enamel] + count[k_dentin]
                                                     : count[tooth.tissue_id(name)];
    const double volume = static_cast<double>(leaves) * tooth.octree.leaf_volume_mm3();
    EXPECT_NEAR(signed_volume_mm3(mesh), volume, 0.02 * volume) << name;
  }
}

// Random leaves have every awkward contact there is: edges, corners, holes.
TEST(SurfaceMesh, RandomLabelsStillGiveAClosedSurface) {
  Random random(testing_tooth::drawn_seed("SurfaceMesh.RandomLabelsStillGiveAClosedSurface"));
  for (int round = 0; round < 10; ++round) {
    Tooth tooth;
    TissueGrid grid;
    grid.allocate({14, 13, 12}, 0.1, {});
    for (std::size_t i = 0; i < grid.count(); ++i)
      grid.tissue[i] = static_cast<std::uint8_t>(random.below(5));
    for (auto& d : grid.distance)
      d = static_cast<std::int8_t>(static_cast<int>(random.below(255)) - 127);
    grid.make_consistent(tooth.tissues);
    tooth.octree = Octree(grid, tooth.tissues);
    for (const char* name : {"enamel", "dentin", "pulp", "periodontium", "solid"}) {
      const TriangleMesh mesh = surface_mesh(tooth, name);
      ASSERT_TRUE(testing_tooth::is_closed_and_oriented(mesh)) << name;
      ASSERT_GT(signed_volume_mm3(mesh), 0);
    }
  }
}

TEST(SurfaceMesh, ASphereHasItsVolumeAndPlace) {
  Tooth tooth;
  TissueGrid grid;
  grid.allocate({60, 60, 60}, 0.05, {-1.5, -1.5, -1.5});
  std::vector<float> field(grid.count());
  for (std::int32_t z = 0; z < 60; ++z)
    for (std::int32_t y = 0; y < 60; ++y)
      for (std::int32_t x = 0; x < 60; ++x) {
        const auto i = grid.index({x, y, z});
        field[i] = static_cast<float>(length(grid.centre_mm({x, y, z})) - 1.013);
        if (field[i] < 0) grid.tissue[i] = k_dentin;
      }
  set_surface_from_field(grid, tooth.tissues, field);
  tooth.octree = Octree(grid, tooth.tissues);
  const TriangleMesh mesh = surface_mesh(tooth, "solid");
  for (const Vec3 v : mesh.vertices_mm) ASSERT_NEAR(length(v), 1.013, 0.0025);
  EXPECT_NEAR(signed_volume_mm3(mesh), 4.0 / 3.0 * 3.14159265 * 1.013 * 1.013 * 1.013, 0.01);
}

TEST(SurfaceMesh, StlAndPlyHoldEveryTriangle) {
  const TriangleMesh mesh = surface_mesh(make_cube(1, "dentin", 0.1), "dentin");
  const Bytes stl = to_stl(mesh), ply = to_ply(mesh);
  std::uint32_t n = 0;
  ASSERT_EQ(stl.size(), 84 + 50 * mesh.triangles.size());
  std::memcpy(&n, stl.data() + 80, 4);
  EXPECT_EQ(n, mesh.triangles.size());
  const std::string text(ply.begin(), ply.end());
  const auto body = text.find("end_header\n") + 11;
  EXPECT_EQ(ply.size() - body, 12 * mesh.vertices_mm.size() + 13 * mesh.triangles.size());
}

TEST(SurfaceMesh, RefusesWhatIsNotThere) {
  const Tooth cube = make_cube(1, "dentin", 0.1);
  EXPECT_THROW((void)surface_mesh(cube, "bone"), Error);
  EXPECT_THROW((void)surface_mesh(cube, "pulp"), Error);
  EXPECT_THROW(write_mesh_file(surface_mesh(cube, "dentin"), "cube.fbx"), Error);
}

}  // namespace
}  // namespace cavum
