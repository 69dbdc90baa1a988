#include "engine/tooth/import/import_meshes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "engine/base/file_error.h"
#include "engine/tooth/import/import_error.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/mesh/read_mesh.h"
#include "tests/engine/tooth/import/import_testing.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::volume_mm3;

using namespace testing_import;

/// A cap of enamel (z 0..2) on a block of dentin (z -6..0) that holds a pulp of 1 x 1 x 3 mm.
struct Blocks {
  TriangleMesh enamel = box({-3, -2.5, 0}, {3, 2.5, 2}), dentin = box({-3, -2.5, -6}, {3, 2.5, 0}),
               pulp = box({-0.5, -0.5, -4}, {0.5, 0.5, -1});
  [[nodiscard]] MeshPaths write(const fs::path& f) const {
    return {write_obj(f / "e.obj", enamel), write_obj(f / "d.obj", dentin),
            write_ascii_stl(f / "p.stl", pulp)};
  }
};

MeshImportOptions options(double leaf_mm, double periodontium_mm = 0.0) {
  MeshImportOptions o;
  o.leaf_mm = leaf_mm;
  o.periodontium_mm = periodontium_mm;
  return o;
}

TEST(ImportMeshes, BoxesGiveTheirVolumesAndNoTissueIsLostAtTheJunction) {
  const auto done = import_meshes(Blocks().write(fresh_folder()), options(0.1));
  EXPECT_NEAR(volume_mm3(done.tooth, k_enamel), 60, 0.6);
  EXPECT_NEAR(volume_mm3(done.tooth, k_pulp), 3, 0.06);
  EXPECT_NEAR(volume_mm3(done.tooth, k_dentin), 177, 1.77);
  EXPECT_NEAR(volume_mm3(done.tooth, k_enamel) + volume_mm3(done.tooth, k_dentin) +
                  volume_mm3(done.tooth, k_pulp),
              240, 0.5);
  // The frame: enamel upwards, origin at the middle of the enamel's box (z 1 of the file).
  EXPECT_EQ(done.tooth.octree.tissue_at({0, 0, 0.9}), k_enamel);
  EXPECT_EQ(done.tooth.octree.tissue_at({0, 0, -1.5}), k_dentin);
  EXPECT_EQ(done.tooth.octree.tissue_at({0, 0, -3.5}), k_pulp);
}

// The junction of enamel and dentin is no surface: solid runs through it. Every real face is exact.
TEST(ImportMeshes, DistancesAreExactOnFacesAndBlindToTheJunction) {
  const auto done = import_meshes(Blocks().write(fresh_folder()), options(0.07));
  Octree::Cursor cursor;
  for (double u = -1.9; u < 1.9; u += 0.037) {
    for (const double off : {-0.06, -0.013, 0.0, 0.031, 0.06}) {
      ASSERT_NEAR(done.tooth.octree.sample({u, 0.3, 1 + off}, cursor).distance_mm, off, 0.0012);
      ASSERT_NEAR(done.tooth.octree.sample({3 + off, u, -3 + u}, cursor).distance_mm, off, 0.0012);
      ASSERT_NEAR(done.tooth.octree.sample({u, u, -1 + off}, cursor).distance_mm, -0.14, 1e-6);
    }
    for (const double off : {-0.06, 0.0, 0.04})
      ASSERT_NEAR(done.tooth.octree.sample({0.5 + off, u / 8, -3.5 + u / 4}, cursor).distance_mm,
                  -off, 0.0012);
  }
}

TEST(ImportMeshes, GapsAndOverlapsFollowTheRule) {
  Blocks gap;
  gap.enamel =
      box({-3, -2.5, 0.15}, {3, 2.5, 2});  // 1.5 leaves of nothing between enamel and dentin
  const auto closed = import_meshes(gap.write(fresh_folder()), options(0.1));
  double sum = 0;
  for (const std::uint8_t id : {k_enamel, k_dentin, k_pulp}) sum += volume_mm3(closed.tooth, id);
  EXPECT_NEAR(sum, 240, 1.2);
  EXPECT_GT(closed.gap_leaves, 0u);
  Octree::Cursor cursor;
  EXPECT_NEAR(closed.tooth.octree.sample({0.4, 0.3, -1.0}, cursor).distance_mm, -0.2, 1e-6)
      << "no seam to feel";

  Blocks overlap;
  overlap.enamel = box({-3, -2.5, -0.2}, {3, 2.5, 2});
  const auto shared = import_meshes(overlap.write(fresh_folder()), options(0.1));
  EXPECT_NEAR(volume_mm3(shared.tooth, k_enamel), 66, 0.7) << "enamel before dentin";
  EXPECT_NEAR(volume_mm3(shared.tooth, k_dentin), 171, 1.7);
  EXPECT_GT(shared.overlap_leaves, 0u);
}

// Enamel as a shell with a cavity (two nested surfaces): OpenVDB alone would fill the cavity.
TEST(ImportMeshes, NestedBallsGiveShellsOfAnalyticVolume) {
  const auto folder = fresh_folder();
  TriangleMesh inner = ball({0, 0, 0}, 2.5, 60), hollow = ball({0, 0, -0.2}, 1.0, 40);
  turn_inside_out(inner);
  turn_inside_out(hollow);
  const MeshPaths paths{write_obj(folder / "e.obj", together(ball({0, 0, 0}, 3.0, 60), inner)),
                        write_obj(folder / "d.obj", together(ball({0, 0, 0}, 2.5, 60), hollow)),
                        write_obj(folder / "p.obj", ball({0, 0, -0.2}, 1.0, 40))};
  MeshImportOptions o = options(0.08);
  o.frame.occlusal_axis = Vec3{0, 0, 1};
  const auto done = import_meshes(paths, o);
  const auto ball_mm3 = [](double r) { return 4.0 / 3.0 * M_PI * r * r * r; };
  EXPECT_NEAR(volume_mm3(done.tooth, k_enamel), ball_mm3(3) - ball_mm3(2.5),
              0.01 * (ball_mm3(3) - ball_mm3(2.5)));
  EXPECT_NEAR(volume_mm3(done.tooth, k_dentin), ball_mm3(2.5) - ball_mm3(1),
              0.01 * (ball_mm3(2.5) - ball_mm3(1)));
  EXPECT_NEAR(volume_mm3(done.tooth, k_pulp), ball_mm3(1), 0.02 * ball_mm3(1));
}

TEST(ImportMeshes, AnOpenMeshIsAnErrorThatNamesFileAndPlace) {
  const auto folder = fresh_folder();
  Blocks blocks;
  blocks.dentin = ball({0, 0, -3}, 3, 20);
  blocks.dentin.triangles.erase(blocks.dentin.triangles.begin() + 700);
  const auto paths = blocks.write(folder);
  const auto error = thrown_by([&] { (void)import_meshes(paths, options(0.2)); });
  EXPECT_EQ(code_of(error), FileError::inconsistent);
  EXPECT_EQ(place_of(error), paths.dentin);
  EXPECT_TRUE(tells(error, 3)) << "open edges";
}

TEST(ImportMeshes, ACornerThatIsNoNumberIsNamedAndNotTakenForAHole) {
  const auto folder = fresh_folder();
  const auto name = [&](const char* file) { return (folder / file).string(); };
  write_mesh_file(ball({0, 0, 0}, 1, 6), name("good.stl"));
  EXPECT_GT(read_closed_mesh(name("good.stl")).volume_mm3, 1);
  Bytes binary = read_file(name("good.stl"));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(binary.data() + 84 + 2 * 50 + 12 + 4, &nan, sizeof nan);  // of the third facet
  write_file(name("binary.stl"), binary);
  const auto expect_malformed = [&](const char* file, int at) {
    const auto error = thrown_by([&] { (void)read_closed_mesh(name(file)); });
    EXPECT_EQ(code_of(error), FileError::malformed);
    EXPECT_EQ(place_of(error), name(file));
    EXPECT_TRUE(tells(error, at)) << at;
  };
  expect_malformed("binary.stl", 3);
  for (const char* value : {"nan", "inf", "-NaN", "x", ""}) {
    write_text_file(
        name("text.stl"),
        "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 " +
            std::string(value) + "\nendloop\nendfacet\nendsolid t\n");
    expect_malformed("text.stl", 6);
  }
}

TEST(ImportMeshes, ExchangedLayersAreAnError) {
  const auto right = Blocks().write(fresh_folder());
  const auto swapped = thrown_by([&] {
    (void)import_meshes({right.dentin, right.enamel, right.pulp}, options(0.2));
  });
  EXPECT_EQ(code_of(swapped), ImportError::layers_exchanged);
  EXPECT_NE(place_of(swapped).find("e.obj"), std::string::npos);
  EXPECT_THROW((void)import_meshes({right.enamel, right.pulp, right.dentin}, options(0.2)), Error);
  EXPECT_THROW((void)import_meshes({right.pulp, right.dentin, right.enamel}, options(0.2)), Error);
}

TEST(ImportMeshes, InwardFacesAreTurnedAndUnusedVerticesDeleted) {
  const auto folder = fresh_folder();
  Blocks blocks;
  turn_inside_out(blocks.enamel);
  blocks.enamel.vertices_mm.push_back({500, 500, 500});
  const auto paths = blocks.write(folder);
  const auto done = import_meshes(paths, options(0.2));
  EXPECT_NEAR(volume_mm3(done.tooth, k_enamel), 60, 3);
  const auto& enamel = std::get<ImportedMeshes>(done.tooth.source.at(0)).enamel;
  EXPECT_EQ(enamel.unused_vertices, 1u);
  EXPECT_TRUE(enamel.turned);
}

TEST(ImportMeshes, UnusableFilesAreErrors) {
  const auto folder = fresh_folder();
  const auto paths = Blocks().write(folder);
  std::ofstream(folder / "text.stl") << "this is no mesh";
  std::ofstream(folder / "nan.obj")
      << "v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  for (const auto& bad : {folder / "missing.stl", folder / "text.stl", folder / "nan.obj"})
    EXPECT_EQ(place_of(thrown_by([&] {
                (void)import_meshes({bad.string(), paths.dentin, paths.pulp}, options(0.2));
              })),
              bad.string());
  EXPECT_EQ(code_of([&] { (void)import_meshes(paths, options(0.001)); }), FileError::too_large);
  MeshImportOptions parallel = options(0.2);
  parallel.frame.mesial_axis = Vec3{0, 0, 1};
  EXPECT_EQ(place_of(thrown_by([&] { (void)import_meshes(paths, parallel); })), "--mesial-axis");
}

TEST(ImportMeshes, AxesAndRotationAreObeyed) {
  const auto paths = Blocks().write(fresh_folder());
  MeshImportOptions o = options(0.2);
  o.frame.mesial_axis = Vec3{0, 1, 0};
  const auto turned = import_meshes(paths, o).tooth;
  EXPECT_EQ(turned.octree.tissue_at({2.8, 0, 0}), k_air);  // the file's y reaches 2.5 mm only
  EXPECT_EQ(turned.octree.tissue_at({0, 2.8, 0}), k_enamel);
  o.frame.mesial_axis.reset();
  o.frame.rotate_deg = 90;
  EXPECT_EQ(import_meshes(paths, o).tooth.octree.to_grid().tissue, turned.octree.to_grid().tissue);
}

// Our own export, read back by OpenMesh: closed, outward, and the volume of the leaves.
TEST(SurfaceMesh, PassesTheChecksOfOpenMesh) {
  const auto folder = fresh_folder();
  MolarShape shape;
  shape.leaf_mm = 0.1;
  const Tooth molar = make_molar(shape);
  for (const char* name : {"pulp.stl", "pulp.ply"}) {
    const auto path = (folder / name).string();
    write_mesh_file(surface_mesh(molar, "pulp"), path);
    const ReadMesh read = read_closed_mesh(path);
    EXPECT_TRUE(read.unused_vertices == 0 && !read.turned);
    EXPECT_NEAR(read.volume_mm3, volume_mm3(molar, k_pulp), 0.02 * volume_mm3(molar, k_pulp));
  }
}

// The molar out through its surfaces and in again: the same tooth.
TEST(ImportMeshes, TheMolarSurvivesExportAndImport) {
  const auto folder = fresh_folder();
  MolarShape shape;
  shape.leaf_mm = 0.1;
  const Tooth molar = make_molar(shape);
  MeshPaths paths;
  for (const auto& [name, path] :
       {std::pair{"enamel", &paths.enamel}, std::pair{"dentin", &paths.dentin},
        std::pair{"pulp", &paths.pulp}}) {
    *path = (folder / (std::string(name) + ".ply")).string();
    write_mesh_file(surface_mesh(molar, name), *path);
  }
  MeshImportOptions o = options(0.1, 1.0);
  o.frame.occlusal_axis = Vec3{0, 0, 1};
  const auto again = import_meshes(paths, o);
  for (const std::uint8_t id : {k_enamel, k_dentin, k_pulp})
    EXPECT_NEAR(volume_mm3(again.tooth, id), volume_mm3(molar, id), 0.015 * volume_mm3(molar, id));
}

}  // namespace
}  // namespace cavum
