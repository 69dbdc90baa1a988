#include "engine/tooth/distance.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/base/random.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

// Planes at any slope and offset, also a hair's breadth from a leaf's centre, where labels alone
// say least.
TEST(SurfaceFromField, PlanesOfAnySlopeAreWithinOneMicrometre) {
  Random random(
      testing_tooth::drawn_seed("SurfaceFromField.PlanesOfAnySlopeAreWithinOneMicrometre"));
  for (int round = 0; round < 60; ++round) {
    Vec3 n = normalized({random.normal(), random.normal(), random.normal()});
    if (round % 6 == 0) n = {0, 0, 1};
    const double offset =
        round % 12 == 0 ? 0.025 + random.uniform(-0.001, 0.001) : random.uniform(-0.05, 0.05);
    TissueGrid grid;
    grid.allocate({30, 30, 30}, 0.05, {-0.75, -0.75, -0.75});
    std::vector<float> field(grid.count());
    const auto inner = [](std::int32_t v) { return v >= 1 && v < 29; };
    for (std::int32_t z = 0; z < 30; ++z)
      for (std::int32_t y = 0; y < 30; ++y)
        for (std::int32_t x = 0; x < 30; ++x) {
          const auto i = grid.index({x, y, z});
          const double d = dot(n, grid.centre_mm({x, y, z})) - offset;
          field[i] = static_cast<float>(inner(x) && inner(y) && inner(z) ? d : std::max(d, 0.01));
          if (field[i] < 0) grid.tissue[i] = k_dentin;
        }
    set_surface_from_field(grid, standard_tissues(), field);
    for (std::int32_t z = 8; z < 22; ++z)
      for (std::int32_t y = 8; y < 22; ++y)
        for (std::int32_t x = 8; x < 22; ++x) {
          const double d = dot(n, grid.centre_mm({x, y, z})) - offset;
          if (std::fabs(d) < 0.099) {
            ASSERT_NEAR(decode_distance(grid.distance[grid.index({x, y, z})]) * 0.05, d, 0.001)
                << "round " << round;
          }
        }
  }
}

TEST(CheckLattice, RefusesWhatTheOctreeCannotHold) {
  EXPECT_NO_THROW(check_lattice({1024, 1, 1}, 0.05, "test"));
  EXPECT_THROW(check_lattice({1025, 1, 1}, 0.05, "test"), Error);
  EXPECT_THROW(check_lattice({10, 0, 1}, 0.05, "test"), Error);
  EXPECT_THROW(check_lattice({10, 10, 10}, -0.05, "test"), Error);
  EXPECT_THROW(check_lattice({1000, 1000, 100}, 0.05, "test"), Error) << "100 million leaves";
}

// Thin plates of 10 mm on top of one another: a mesh of 10 MB that took minutes.
TEST(Distance, ManyLargeTrianglesCloseTogetherAreRefused) {
  TissueGrid grid;
  grid.allocate({220, 220, 100}, 0.05, {-5.5, -5.5, -2.5});
  TriangleMesh mesh{{{-5, -5, 0}, {5, -5, 0}, {0, 5, 0}}, {{0, 1, 2}}};
  EXPECT_NO_THROW(check_triangle_work(grid, mesh, "plates.stl"));
  mesh.triangles.assign(4000, {0, 1, 2});
  EXPECT_THROW(check_triangle_work(grid, mesh, "plates.stl"), Error);
}

}  // namespace
}  // namespace cavum
