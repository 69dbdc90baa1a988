// Rims, caps and averaged noise of a scan's surface, and a tooth's printable one, on bodies of
// known shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/det_math.h"
#include "engine/lab/scan/holes.h"
#include "engine/lab/scan/printable.h"
#include "engine/lab/scan/smoothed.h"
#include "engine/tooth/make/make_incisor.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/support/basics.h"

namespace cavum {
namespace {

using testing_basics::drawn_seed;

/// Two plates of 4 x 4 mm that meet at a right angle along y, the solid below and behind: z = 0 for
/// x < 0, x = 0 for z < 0. Corners every 0.1 mm.
TriangleMesh edge_of_plates() {
  TriangleMesh mesh;
  constexpr std::uint32_t k_rows = 41, k_columns = 81;
  for (std::uint32_t i = 0; i < k_columns; ++i)
    for (std::uint32_t j = 0; j < k_rows; ++j) {
      const double along = 0.1 * i - 4.0, y = 0.1 * j - 2.0;
      mesh.vertices_mm.push_back(along < 0 ? Vec3{along, y, 0} : Vec3{0, y, -along});
    }
  for (std::uint32_t i = 0; i + 1 < k_columns; ++i)
    for (std::uint32_t j = 0; j + 1 < k_rows; ++j) {
      const std::uint32_t a = i * k_rows + j, b = a + k_rows;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

double off_plates_mm(Vec3 p) { return p.x > p.z ? std::fabs(p.x) : std::fabs(p.z); }

TEST(ScanSurface, RimsAreFoundAndCapsCloseThem) {
  const TriangleMesh plates = edge_of_plates();
  const auto rims = rims_of(plates);
  ASSERT_EQ(rims.size(), 1u);
  EXPECT_NEAR(rims[0].length_mm, 2 * 4.0 + 2 * 8.0, 1e-9);
  TriangleMesh both = plates;
  const TriangleMesh caps = caps_over(plates, rims);
  // joined by place, the two have no edge that is run only one way
  std::map<std::array<double, 3>, std::uint32_t> number;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const TriangleMesh* m : {static_cast<const TriangleMesh*>(&both), &caps})
    for (const auto& t : m->triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto of = [&](std::uint32_t c) {
          const Vec3 p = m->vertices_mm[c];
          return number
              .emplace(std::array<double, 3>{p.x, p.y, p.z},
                       static_cast<std::uint32_t>(number.size()))
              .first->second;
        };
        const std::uint32_t from = of(t[i]), to = of(t[(i + 1) % 3]);
        ++runs[{from, to}];
        --runs[{to, from}];
      }
  EXPECT_TRUE(std::all_of(runs.begin(), runs.end(), [](const auto& r) { return r.second == 0; }));
}

TEST(ScanSurface, NoiseIsAveragedAndTheEdgeStays) {
  Random random(drawn_seed("ScanSurface.NoiseIsAveraged"));
  TriangleMesh mesh = edge_of_plates();
  for (Vec3& v : mesh.vertices_mm)
    v += Vec3{random.normal(), random.normal(), random.normal()} * 0.02;
  const auto points = surface_points(mesh, 0.12, "plates");
  const TriangleMesh even =
      smoothed(mesh, points, std::vector<std::uint8_t>(mesh.vertices_mm.size(), 1), 0.3);
  double before = 0, after = 0, at_edge = 0;
  int flat = 0, edge = 0;
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    const Vec3 p = mesh.vertices_mm[i];
    if (std::fabs(p.y) > 1.5 || p.x < -3.5 || p.z < -3.5) continue;
    const double d = off_plates_mm(even.vertices_mm[i]);
    if (p.x < -0.4 || p.z < -0.4) {
      before += off_plates_mm(p) * off_plates_mm(p);
      after += d * d;
      ++flat;
    } else {
      at_edge = std::max(at_edge, d);
      ++edge;
    }
  }
  EXPECT_NEAR(std::sqrt(before / flat), 0.02, 0.003);
  EXPECT_LT(std::sqrt(after / flat), 0.010);  // half of what came in
  ASSERT_GT(edge, 50);
  EXPECT_LT(at_edge, 0.07);  // weighted alike, an edge of 90 degrees would sink in by a third of
                             // the radius: 0.1 mm
}

TEST(ScanSurface, APrintableToothIsOneClosedBodyWithItsCavityAndItsPulpFilled) {
  Tooth tooth = make_incisor({.leaf_mm = 0.2});
  const auto around = tissues_around_tooth(tooth);
  EXPECT_TRUE(around[k_periodontium]);
  EXPECT_FALSE(around[k_pulp]);
  const auto closed = [](const TriangleMesh& m) { return rims_of(m).empty(); };
  const Printable whole = printable_surface(tooth, around);
  EXPECT_TRUE(closed(whole.mesh));
  double leaves = 0;
  const auto counts = tooth.octree.count_leaves();
  for (const auto id : {k_enamel, k_dentin, k_pulp})
    leaves += static_cast<double>(counts[id]) * tooth.octree.leaf_volume_mm3();
  EXPECT_NEAR(whole.volume_mm3, leaves, 0.02 * leaves);

  // a hollow ball of 1 mm inside is left out
  const Vec3 middle{0, 0, 0};
  std::vector<RemovedLeaf> removed;
  removed.reserve(100000);
  tooth.octree.reserve_edits(10000);
  ASSERT_TRUE(tooth.octree.carve(
      {-1, -1, -1}, {1, 1, 1}, [&](Vec3 p) { return length(p - middle) - 0.5; }, removed));
  const Printable hollow = printable_surface(tooth, around);
  EXPECT_TRUE(closed(hollow.mesh));
  EXPECT_EQ(hollow.left_out, 1u);
  EXPECT_NEAR(hollow.left_out_mm3, 4.0 / 3 * k_pi * 0.125, 0.08);
  EXPECT_NEAR(hollow.volume_mm3, whole.volume_mm3, 1e-9);

  // a hole of 1 mm through the tooth: 16 leaves lie in its section, which has pi/4 mm2
  ASSERT_TRUE(tooth.octree.carve(
      {-1, -6, -1}, {1, 6, 1},
      [&](Vec3 p) { return std::max(std::sqrt(p.x * p.x + p.z * p.z) - 0.5, p.y - 6.0); },
      removed));
  const Printable drilled = printable_surface(tooth, around);
  EXPECT_TRUE(closed(drilled.mesh));
  EXPECT_EQ(drilled.left_out, 0u);
  const double long_mm = static_cast<double>(removed.size()) * 0.2 / 16;
  EXPECT_NEAR(whole.volume_mm3 - drilled.volume_mm3, k_pi / 4 * long_mm, 0.06 * k_pi / 4 * long_mm);
}

}  // namespace
}  // namespace cavum
