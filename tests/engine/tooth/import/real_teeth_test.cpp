// Human teeth, where the folder `shared/` lies beside the repository (they are not ours to ship).
#include <gtest/gtest.h>

#include "engine/tooth/import/import_error.h"
#include "engine/tooth/import/import_meshes.h"
#include "engine/tooth/import/import_volume.h"
#include "tests/engine/tooth/import/import_testing.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using namespace testing_import;

using testing_tooth::volume_mm3;

MeshPaths layers(const std::string& tooth) {
  const auto f = shared_folder() / "teeth" / "openmandible";
  const auto part = [&](const char* name) {
    return (f / ("Tooth_" + tooth + "_" + name + ".stl")).string();
  };
  return {part("Enamel"), part("Dentin"), part("Pulp")};
}

// Volumes as SOURCE.txt of the meshes states them.
TEST(RealTeeth, FirstMolarKeepsItsVolumes) {
  if (shared_folder().empty())
    GTEST_SKIP() << "no shared/ folder beside the repository: real teeth not tested";
  MeshImportOptions o;
  o.periodontium_mm = 0;
  o.frame.mesial_axis = Vec3{0, -1, 0};
  const auto done = import_meshes(layers("L6"), o);
  EXPECT_NEAR(volume_mm3(done.tooth, k_enamel), 221.8, 2.2);
  EXPECT_NEAR(volume_mm3(done.tooth, k_dentin), 647.5, 6.5);
  EXPECT_NEAR(volume_mm3(done.tooth, k_pulp), 33.6, 0.34);
  EXPECT_LE(done.tooth.octree.memory_bytes(), 8'000'000u);
}

TEST(RealTeeth, IncisorAndPremolarKeepTheirVolumes) {
  if (shared_folder().empty())
    GTEST_SKIP() << "no shared/ folder beside the repository: real teeth not tested";
  MeshImportOptions turned;
  turned.frame.mesial_axis = Vec3{-0.8, -0.6, 0};
  const auto incisor = import_meshes(layers("L1"), {}).tooth,
             premolar = import_meshes(layers("L4"), turned).tooth;
  EXPECT_NEAR(volume_mm3(incisor, k_enamel), 55.2, 0.55);
  EXPECT_NEAR(volume_mm3(incisor, k_dentin), 204.8, 2.0);
  EXPECT_NEAR(volume_mm3(incisor, k_pulp), 10.7, 0.21);
  EXPECT_NEAR(volume_mm3(premolar, k_enamel), 92.6, 0.93);
  EXPECT_NEAR(volume_mm3(premolar, k_dentin), 260.2, 2.6);
  EXPECT_NEAR(volume_mm3(premolar, k_pulp), 15.3, 0.31);
}

TEST(RealTeeth, ExchangedEnamelAndDentinAreFound) {
  if (shared_folder().empty())
    GTEST_SKIP() << "no shared/ folder beside the repository: real teeth not tested";
  MeshImportOptions o;
  o.leaf_mm = 0.2;
  for (const char* tooth : {"L1", "L4", "L6"}) {
    const auto p = layers(tooth);
    EXPECT_EQ(code_of([&] {
                (void)import_meshes({p.dentin, p.enamel, p.pulp}, o);
              }),
              ImportError::layers_exchanged)
        << tooth;
  }
}

TEST(RealTeeth, CtGivesEnamelDentinAndOnePulpWithoutHelp) {
  if (shared_folder().empty())
    GTEST_SKIP() << "no shared/ folder beside the repository: real teeth not tested";
  VolumeImportOptions o;
  o.leaf_mm = 0.1;
  const auto done =
      import_volume((shared_folder() / "teeth" / "ct_tooth_scivis" / "tooth.nhdr").string(), o);
  EXPECT_GE(done.native_pulp, 12'500u);
  EXPECT_LE(done.native_pulp, 20'000u);
  EXPECT_EQ(done.pulp_bodies, 1u);
  EXPECT_LT(done.rim_percent, 1.0);
  EXPECT_EQ(done.spacing.by, VoxelSpacing::By::assumed);
  const TissueGrid grid = done.tooth.octree.to_grid();
  EXPECT_EQ(testing_tooth::count_bodies(grid, k_pulp, 0, grid.size.z - 1), 1);
  // A second look at the rim: from above, the first tissue met over the crown is enamel.
  std::uint64_t enamel = 0, dentin = 0;
  for (double y = -2.5; y <= 2.5; y += 0.05)
    for (double x = -3; x <= 3; x += 0.05)
      for (double z = 5; z > 0; z -= 0.05) {
        const auto t = done.tooth.octree.tissue_at({x, y, z});
        enamel += t == k_enamel;
        dentin += t == k_dentin;
        if (t != k_air) break;
      }
  EXPECT_LT(dentin * 100, enamel);
}

}  // namespace
}  // namespace cavum
