// Spray and chips: seen where effects have them and the candidate wants them, near the head, and
// never so thick that the work is hidden.
#include "ui/station/spray.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"
#include "tests/ui/station/virtual_screen.h"
#include "ui/station/picture_file.h"
#include "ui/station/scene.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

constexpr double k_rpm = 200000.0, k_picture_s = 0.05;

Spray spray_after(double s, double rpm, bool cutting, double enamel, double dentin) {
  Spray spray;
  for (double t = 0; t < s; t += k_picture_s)
    spray_on(spray, rpm, cutting, enamel, dentin, k_picture_s);
  return spray;
}

TEST(Spray, DropsStayBetweenTheHandpieceAndTheHead) {
  constexpr int k_most = 480;
  constexpr double k_head_mm = 0.5;
  for (double s = 0.2; s < 6.0; s += 0.37) {
    const auto drops = drops_of(spray_after(s, k_rpm, true, 1, 0), k_head_mm, k_most);
    ASSERT_EQ(drops.size(), static_cast<std::size_t>(k_most));
    for (const GpuDrop& d : drops) {
      ASSERT_LT(std::hypot(d.at_mm[0], d.at_mm[1]) + d.size_mm / 2, k_spray_reach_mm);
      ASSERT_GT(d.at_mm[2], -0.01F);
      ASSERT_LE(d.at_mm[2], k_jets_from_mm);
    }
  }
}

TEST(Spray, WaterRunsWhileTheBurTurnsAndChipsFlyWhileItCuts) {
  EXPECT_TRUE(drops_of(spray_after(1, 0, false, 0, 0), 0.5, 100).empty());
  const std::size_t water = drops_of(spray_after(1, k_rpm, false, 0, 0), 0.5, 160).size();
  EXPECT_GT(water, 50u);
  EXPECT_LT(water, 160u);
  EXPECT_EQ(drops_of(spray_after(1, k_rpm, true, 1, 0), 0.5, 160).size(), 160u);
  // it comes and goes within a moment, and then the clock stands: nothing is drawn anew for it
  Spray spray = spray_after(1, k_rpm, true, 1, 0);
  for (int i = 0; i < 6; ++i) spray_on(spray, 0, false, 0, 0, k_picture_s);
  const Spray stood = spray;
  spray_on(spray, 0, false, 0, 0, k_picture_s);
  EXPECT_TRUE(drops_of(spray, 0.5, 100).empty());
  EXPECT_EQ(spray, stood);
}

TEST(Spray, ChipsHaveTheColourOfWhatIsCut) {
  const auto bluer = [](double enamel, double dentin) {
    const glm::vec3 c = spray_after(1, k_rpm, true, enamel, dentin).chip_colour;
    return c.b / c.r;
  };
  EXPECT_GT(bluer(1, 0), 0.95F);
  EXPECT_LT(bluer(0, 1), 0.7F);
  EXPECT_LT(bluer(0, 0), 0.4F);  // pulp
}

class SprayPicture : public ::testing::Test {
 protected:
  static constexpr int k_px_wide = 600, k_px_high = 400;
  static std::vector<std::uint8_t> seen(Scene& scene, const SceneView& view) {
    glBindTexture(GL_TEXTURE_2D, scene.picture(view, k_px_wide, k_px_high));
    int wide = 0, high = 0;
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &wide);
    glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &high);
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(wide) *
                                     static_cast<std::size_t>(high) * 3);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
  }
};

TEST_F(SprayPicture, IsSeenWhereItIsWantedAndHidesLittleOfTheWork) {
  const testing_station::VirtualScreen screen;
  if (!screen.there())
    GTEST_SKIP() << "SKIPPED: no Xvfb on this computer, so no window can be opened";
  const Tooth block = make_block({8, 8, 5}, {{"enamel", 1.5}, {"dentin", 3.5}}, 0.1);
  const Window window({"Cavum", 640, 480, {}});
  Scene scene(block.octree, block.tissues, {testing_engine::shipped_bur("cylinder-flat-1.0")},
              nullptr);
  SceneView view;
  view.bur = 0;
  view.camera.distance_mm = 30.0F;
  view.spray = spray_after(1, k_rpm, true, 1, 0);
  SceneView dry = view;
  dry.drops = false;
  std::filesystem::create_directories(CAVUM_PICTURES);
  for (std::size_t level = 1; level < k_effects.size(); ++level) {
    scene.fix_effects(level);
    const auto with = seen(scene, view), without = seen(scene, dry);
    ASSERT_EQ(with.size(), without.size());
    int differ = 0, much = 0, looked_at = 0;
    for (std::size_t i = 0; i + 2 < with.size(); i += 3) {
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most,
                        std::abs(static_cast<int>(with[i + c]) - static_cast<int>(without[i + c])));
      ++looked_at;
      differ += most > 4 ? 1 : 0;
      much += most > 60 ? 1 : 0;
    }
    std::printf("effects %zu: %d of %d pixels differ, %d of them much\n", level, differ, looked_at,
                much);
    if (k_effects[level].drops == 0) {
      EXPECT_EQ(differ, 0) << "effects " << level;
      continue;
    }
    EXPECT_GT(differ, looked_at / 200) << "effects " << level;
    EXPECT_LT(much, looked_at / 50) << "effects " << level;
    write_png(std::string(CAVUM_PICTURES) + "/spray-" + std::to_string(level) + ".png", k_px_wide,
              k_px_high, with);
  }
}

}  // namespace
}  // namespace cavum::station
