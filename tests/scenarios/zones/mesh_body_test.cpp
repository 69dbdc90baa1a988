// Zones from STL files: a box as triangles is the box shape leaf by leaf, whatever its pose, text
// or binary; cavities and overlaps of a mesh; what an exam keeps of it.
#include "scenarios/zones/mesh_body.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "engine/base/det_math.h"
#include "engine/base/file.h"
#include "engine/base/random.h"
#include "scenarios/file/surface_files.h"
#include "scenarios/zones/zone_map.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

using testing::dentin_block;
using testing::scenario_text;
using testing_basics::Folder;

/// The six faces of a box between two corners of a frame, looking outwards.
TriangleMesh box_mesh(Vec3 low, Vec3 high, Vec3 at = {}, Vec3 x = {1, 0, 0}, Vec3 y = {0, 1, 0},
                      Vec3 z = {0, 0, 1}) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{(i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                 (i & 4) != 0 ? high.z : low.z};
    mesh.vertices_mm.push_back(at + x * p.x + y * p.y + z * p.z);
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> k_faces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& f : k_faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

void append(TriangleMesh& mesh, const TriangleMesh& more, bool inwards = false) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.insert(mesh.vertices_mm.end(), more.vertices_mm.begin(), more.vertices_mm.end());
  for (const auto& t : more.triangles)
    mesh.triangles.push_back(
        inwards ? std::array<std::uint32_t, 3>{first + t[0], first + t[2], first + t[1]}
                : std::array<std::uint32_t, 3>{first + t[0], first + t[1], first + t[2]});
}

std::string as_text(const TriangleMesh& mesh) {
  std::ostringstream s;
  s.precision(9);
  s << "solid zone\n";
  for (const auto& t : mesh.triangles) {
    s << "facet normal 0 0 0\n outer loop\n";
    for (const auto i : t)
      s << "  vertex " << mesh.vertices_mm[i].x << ' ' << mesh.vertices_mm[i].y << ' '
        << mesh.vertices_mm[i].z << '\n';
    s << " endloop\nendfacet\n";
  }
  s << "endsolid zone\n";
  return s.str();
}

const std::string k_stl_zone = "[[zones.target]]\nshape = \"stl\"\nfile = \"zones/body.stl\"\n";

/// A scenario in a folder with zones/body.stl beside it.
class MeshZone : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder_.path() / "zones"); }
  [[nodiscard]] std::string stl() const { return folder_.file("zones/body.stl"); }
  [[nodiscard]] Scenario scenario() const {
    write_text_file(folder_.file("s.toml"), scenario_text(k_stl_zone));
    return load_scenario(folder_.file("s.toml"));
  }
  [[nodiscard]] ZoneMap zones_of(const TriangleMesh& mesh, const Tooth& tooth) const {
    write_mesh_file(mesh, stl());
    return build_zones(scenario(), tooth);
  }
  Folder folder_;
};

TEST_F(MeshZone, ABoxOfTrianglesIsTheBoxShapeAtAnyPose) {
  Random random(testing_basics::drawn_seed("MeshZone.ABoxOfTrianglesIsTheBoxShapeAtAnyPose"));
  const double leaf = 0.1;
  const Tooth block = dentin_block(3, 3, leaf);
  double worst = 0;
  for (int pose = 0; pose < 12; ++pose) {
    const Vec3 at{random.uniform(-0.8, 0.8), random.uniform(-0.8, 0.8), random.uniform(-1, 0)};
    const Vec3 size{random.uniform(0.6, 2.5), random.uniform(0.6, 2.5), random.uniform(0.6, 2.5)};
    const Vec3 axis = pose == 0 ? Vec3{0, 0, 1}
                                : normalized(Vec3{random.uniform(-1, 1), random.uniform(-1, 1),
                                                  random.uniform(0.2, 1)});
    const double turn = pose == 0 ? 0 : random.uniform(-180, 180);
    std::ostringstream shape;
    shape.precision(17);
    shape << "[[zones.target]]\nshape = \"box\"\nat_mm = [" << at.x << ", " << at.y << ", " << at.z
          << "]\nsize_mm = [" << size.x << ", " << size.y << ", " << size.z << "]\naxis = ["
          << axis.x << ", " << axis.y << ", " << axis.z << "]\nturn_deg = " << turn << "\n";
    // the frame of README.md: x of the tooth laid across the axis, then turned about it
    const Vec3 x0 = std::fabs(axis.x) < 0.9 ? normalized(Vec3{1, 0, 0} - axis * axis.x)
                                            : normalized(Vec3{0, 1, 0} - axis * axis.y);
    const Vec3 y0 = cross(axis, x0);
    const SinCos t = det_sincos(turn * k_pi / 180);
    const TriangleMesh mesh = box_mesh(size * -0.5, size * 0.5, at, x0 * t.cos + y0 * t.sin,
                                       y0 * t.cos - x0 * t.sin, axis);
    write_mesh_file(mesh, stl());
    const Scenario of_box = parse_scenario(scenario_text(shape.str()), "s.toml"),
                   of_mesh = scenario();
    ShapeMaker maker(block, "s.toml");
    const auto box = maker.make(of_box.zones.target), body = maker.make(of_mesh.zones.target);
    const ZoneMap exact = build_zones(of_box, block), ours = build_zones(of_mesh, block);
    ASSERT_EQ(exact.low(), ours.low());
    ASSERT_EQ(exact.size(), ours.size());
    exact.for_each_leaf([&](IVec3 l, Zone) {
      const double a = box->distance_mm(exact.centre_mm(l)),
                   b = body->distance_mm(exact.centre_mm(l));
      if (std::fabs(a) < (MeshBody::k_exact_leaves - 0.01) * leaf)
        worst = std::max(worst, std::fabs(a - b));
      if (std::fabs(a) <= 1e-5) return;
      EXPECT_EQ(a < 0, b < 0) << "pose " << pose;
      EXPECT_EQ(exact.zone(l) == Zone::target, ours.zone(l) == Zone::target) << "pose " << pose;
      EXPECT_NEAR(exact.distance_mm(l), ours.distance_mm(l), k_distance_bound_leaves * leaf)
          << "pose " << pose;
    });
  }
  EXPECT_LE(worst, 1e-6) << "the same surface gives the same distances, but for corners of 32 bits";
  std::printf("a box of triangles and the box shape: distances differ by %.2g mm at most\n", worst);
}

TEST_F(MeshZone, TextAndBinaryAreTheSameZone) {
  const Tooth block = dentin_block(2, 2, 0.1);
  const TriangleMesh mesh = box_mesh({-1, -0.5, -1}, {1, 0.5, 1});
  const ZoneMap binary = zones_of(mesh, block);
  write_text_file(stl(), as_text(mesh));
  const ZoneMap text = build_zones(scenario(), block);
  EXPECT_EQ(binary.counts(), text.counts());
  EXPECT_EQ(binary.count(Zone::target),
            20u * 10u * 10u);  // its lower half, whole leaves; corners and diagonals run through
                               // centres of leaves
}

TEST_F(MeshZone, LinesThroughEdgesAndCornersAreCountedOnce) {
  const Tooth block = dentin_block(2, 2, 0.1);
  // faces in planes of leaf centres and diagonals through them: every way of hitting an edge or a
  // corner
  const double c = 0.05;
  const ZoneMap zones = zones_of(box_mesh({-1 + c, -1 + c, -1}, {1 - c, 1 - c, 1}), block);
  const std::uint64_t n = zones.count(Zone::target) / 10;
  EXPECT_EQ(zones.count(Zone::target) % 10, 0u) << "every line has the same ten leaves";
  EXPECT_TRUE(n >= 18 * 18 && n <= 20 * 20) << n;
}

TEST_F(MeshZone, CavitiesAreOutsideAndOverlapsInside) {
  const Tooth block = dentin_block(3, 3, 0.1);
  TriangleMesh hollow = box_mesh({-2, -2, -2}, {2, 2, 0.5});
  append(hollow, box_mesh({-1, -1, -1.5}, {1, 1, -0.5}), true);
  EXPECT_EQ(zones_of(hollow, block).count(Zone::target), 40u * 40u * 20u - 20u * 20u * 10u);
  TriangleMesh two = box_mesh({-2, -1, -1}, {0.5, 1, 0.5});
  append(two, box_mesh({-0.5, -1, -2}, {2, 1, 0.5}));
  EXPECT_EQ(zones_of(two, block).count(Zone::target),
            25u * 20u * 10u + 25u * 20u * 20u - 10u * 20u * 10u);
}

TEST_F(MeshZone, FacesThatLookInwardsAreTurned) {
  const Tooth block = dentin_block(2, 2, 0.1);
  TriangleMesh inside_out;
  append(inside_out, box_mesh({-1, -1, -1}, {1, 1, 1}), true);
  EXPECT_EQ(zones_of(inside_out, block).count(Zone::target), 20u * 20u * 10u);
}

TEST_F(MeshZone, WhatASessionHoldsIsUsedAndAnotherFileOfTheNameRefused) {
  write_mesh_file(box_mesh({-1, -1, -1}, {1, 1, 1}), stl());
  SurfaceFiles kept;
  Scenario recorded = parse_scenario(scenario_text(k_stl_zone), folder_.file("s.toml"));
  ASSERT_TRUE(read_surfaces(recorded, kept).empty());
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].first, "zones/body.stl");
  EXPECT_EQ(kept[0].second, read_file(stl()));

  Scenario again = parse_scenario(scenario_text(k_stl_zone), "session: scenario");
  use_surfaces(again, kept);
  const Tooth block = dentin_block(2, 2, 0.1);
  EXPECT_EQ(build_zones(again, block).counts(), build_zones(recorded, block).counts());
  EXPECT_NO_THROW(require_same_surfaces(scenario(), recorded));

  write_mesh_file(box_mesh({-1, -1, -1}, {1, 1, 1.01}), stl());
  const auto refused =
      testing_basics::thrown_by([&] { require_same_surfaces(scenario(), recorded); });
  EXPECT_EQ(testing_basics::code_of(refused), Mistake::surface);
  EXPECT_TRUE(testing_basics::place_of(refused).ends_with("s.toml:22:8"));
  EXPECT_TRUE(testing_basics::tells(refused, "zones/body.stl"));
  Scenario none = parse_scenario(scenario_text(k_stl_zone), "session: scenario");
  const auto missing = testing_basics::thrown_by([&] { use_surfaces(none, {}); });
  EXPECT_EQ(testing_basics::code_of(missing), Mistake::missing);
  EXPECT_TRUE(testing_basics::tells(missing, "zones/body.stl"));
}

}  // namespace
}  // namespace cavum::scenarios
