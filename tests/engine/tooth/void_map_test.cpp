#include "engine/tooth/void_map.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/tooth/make/make_block.h"
#include "tests/engine/tooth/tooth_testing.h"

namespace cavum {
namespace {

using testing_tooth::drawn_seed;

TEST(VoidMap, NeverPromisesMoreRoomThanThereIs) {
  Random random(drawn_seed("VoidMap.NeverPromisesMoreRoomThanThereIs"));
  // pulp lies between 2.0 and 2.6 mm below the top of a block of 4 by 3 mm
  const Tooth tooth = make_block(
      {4, 3, 4}, {{"enamel", 1.0}, {"dentin", 1.0}, {"pulp", 0.6}, {"dentin", 1.4}}, 0.05);
  const VoidMap map(tooth.octree);
  double most = 0;
  for (int i = 0; i < 50000; ++i) {
    const Vec3 at{random.uniform(-2.5, 2.5), random.uniform(-2, 2), random.uniform(-4.5, 0.5)};
    const double dx = std::max(0.0, std::fabs(at.x) - 2), dy = std::max(0.0, std::fabs(at.y) - 1.5),
                 dz = std::max({0.0, at.z + 2.0, -2.6 - at.z});
    const double distance = std::sqrt(dx * dx + dy * dy + dz * dz);
    ASSERT_LE(map.clear_mm(at), distance + 1e-9) << at.x << ' ' << at.y << ' ' << at.z;
    most = std::max(most, map.clear_mm(at));
  }
  EXPECT_GT(most, 1.0) << "and it must promise some";
}

TEST(VoidMap, WithoutVoidTissueEverythingIsFar) {
  const VoidMap map(make_cube(2.0, "dentin", 0.1).octree);
  EXPECT_GT(map.clear_mm({0, 0, -1}), 9.0);
}

}  // namespace
}  // namespace cavum
