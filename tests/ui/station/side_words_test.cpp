// Words at the sides of the crown: each where its side is, whatever the camera does, and none over
// the cavity.
#include "ui/station/side_words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "engine/base/random.h"
#include "scenarios/operators/simulated_exam.h"
#include "tests/engine/support/basics.h"
#include "tests/ui/station/station_window.h"

namespace cavum::station {
namespace {

const ImVec2 k_side_picture{1030, 562};
constexpr float k_side_apart = 6.0F;
const CrownSides k_some_crown{{-6, -5, -6}, {6, 5, 1}, {-3, -1.5, -2}, {3, 1.5, 0.5}, false};

ImVec2 size_of_word(const Message&) { return {49.0F, 16.0F}; }
std::string side_of(const SideWord& w) {
  return w.towards.x > 0   ? "mesial"
         : w.towards.x < 0 ? "distal"
         : w.towards.y > 0 ? "buccal"
                           : "lingual";
}
std::map<std::string, ImVec2> words_seen(const CrownSides& sides, const Camera& camera,
                                         ImVec2 picture = k_side_picture) {
  std::map<std::string, ImVec2> at;
  for (const SideWord& w : side_words(sides, camera, 0, picture, k_side_apart, size_of_word))
    at[side_of(w)] = w.middle;
  return at;
}
ImVec2 pixel_in(const Camera& camera, Vec3 mm) {
  const glm::vec4 p = camera.projection(k_side_picture.x / k_side_picture.y) * camera.view() *
                      glm::vec4(mm.x, mm.y, mm.z, 1);
  return {k_side_picture.x * (0.5F + 0.5F * p.x / p.w),
          k_side_picture.y * (0.5F - 0.5F * p.y / p.w)};
}
Camera from_above() {
  Camera camera;
  camera.distance_mm = 36.0F;
  camera.look_from_occlusal();
  return camera;
}

TEST(SideWords, StandAtTheirSidesSeenFromAboveAndChangePlacesInTheMirror) {
  const auto seen = words_seen(k_some_crown, from_above());
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_LT(seen.at("mesial").x, pixel_in(from_above(), {6, 0, 0}).x) << "left of the crown";
  EXPECT_GT(seen.at("distal").x, pixel_in(from_above(), {-6, 0, 0}).x);
  EXPECT_GT(seen.at("buccal").y, pixel_in(from_above(), {0, 5, 0}).y) << "below it";
  EXPECT_LT(seen.at("lingual").y, pixel_in(from_above(), {0, -5, 0}).y);
  Camera mirror = from_above();
  mirror.mirror = true;
  EXPECT_GT(words_seen(k_some_crown, mirror).at("mesial").x,
            words_seen(k_some_crown, mirror).at("distal").x);
  Camera turned = from_above();
  turned.turn_deg = 180.0F;
  EXPECT_LT(words_seen(k_some_crown, turned).at("buccal").y,
            words_seen(k_some_crown, turned).at("lingual").y);
}

TEST(SideWords, FrontTeethHaveALabialSide) {
  CrownSides front = k_some_crown;
  front.anterior = true;
  const auto of = [](const CrownSides& sides) {
    return side_words(sides, from_above(), 0, k_side_picture, k_side_apart, size_of_word);
  };
  ASSERT_EQ(of(front).size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(of(front)[i].word != of(k_some_crown)[i].word, side_of(of(front)[i]) == "buccal")
        << i;
}

TEST(SideWords, OneSeenFromItsEndHasNone) {
  Camera camera;
  camera.look_from(0, 0);
  const auto seen = words_seen(k_some_crown, camera);
  EXPECT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen.count("mesial") + seen.count("distal"), 2u);
}

TEST(SideWords, AreNeverOverTheCavityAndPointTheRightWayInDrawnViews) {
  const std::uint64_t seed = testing_basics::drawn_seed("SideWords");
  Random random(seed);
  std::size_t shown = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto between = [&random](double low, double high) {
      return low + (high - low) * random.uniform();
    };
    CrownSides sides = k_some_crown;
    sides.cavity_low = {between(-6, 0), between(-5, 0), between(-5, -0.5)};
    sides.cavity_high = {between(0.5, 6), between(0.5, 5), between(0, 1)};
    Camera camera;
    camera.turn_deg = static_cast<float>(between(0, 360));
    camera.rise_deg = static_cast<float>(between(-60, 90));
    camera.roll_deg = static_cast<float>(between(0, 360));
    camera.distance_mm = static_cast<float>(between(8, 120));
    camera.mirror = random.uniform() < 0.5;
    const ImVec2 middle = pixel_in(camera, (sides.low + sides.high) * 0.5);
    for (const auto& [word, at] : words_seen(sides, camera)) {
      ++shown;
      const ImVec2 half{0.5F * size_of_word({}).x, 8.0F};
      EXPECT_TRUE(at.x >= half.x && at.y >= half.y && at.x <= k_side_picture.x - half.x &&
                  at.y <= k_side_picture.y - half.y)
          << word << ", seed " << seed;
      const Vec3 way = word == "mesial"   ? Vec3{1, 0, 0}
                       : word == "distal" ? Vec3{-1, 0, 0}
                       : word == "buccal" ? Vec3{0, 1, 0}
                                          : Vec3{0, -1, 0};
      const ImVec2 there = pixel_in(camera, (sides.low + sides.high) * 0.5 + way);
      EXPECT_GE((there.x - middle.x) * (at.x - middle.x) + (there.y - middle.y) * (at.y - middle.y),
                0.0F)
          << word << ", seed " << seed;
      for (int k = 0; k < 125; ++k) {  // places within the cavity
        const Vec3 share{k % 5 / 4.0, k / 5 % 5 / 4.0, k / 25 / 4.0},
            wide = sides.cavity_high - sides.cavity_low;
        const ImVec2 p = pixel_in(
            camera, sides.cavity_low + Vec3{share.x * wide.x, share.y * wide.y, share.z * wide.z});
        EXPECT_FALSE(std::fabs(p.x - at.x) < half.x && std::fabs(p.y - at.y) < half.y)
            << word << " over the cavity, seed " << seed;
      }
    }
  }
  EXPECT_GT(shown, 4000u);
}

TEST(SideWords, AMolarsCrownIsItsEnamelWithoutItsRoots) {
  scenarios::ExamOptions options;
  options.candidate = "t";
  const auto setup = scenarios::prepare_exam(
      std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/class_1.toml", options);
  const CrownSides sides = crown_sides(setup->tooth, setup->zones);
  EXPECT_NEAR(sides.high.x - sides.low.x, 11.0, 2.0) << "mesiodistally";
  EXPECT_LT(sides.high.z - sides.low.z, 9.0) << "no roots";
  EXPECT_GE(sides.cavity_low.z, sides.low.z);
  EXPECT_FALSE(sides.anterior);
}

using StationSides = StationWindow;
TEST_F(StationSides, AnExamNamesThemInTheReadersLanguage) {
  const std::string script =
      std::string(k_to_exam) +
      "until 1\nkey 1\nsleep 0.3\nwords sides\npicture sides\nclose\nsleep 0.5\nkey f4\nsleep 30\nfail\n";
  EXPECT_EQ(run(script, "--language de --high-contrast"), 1) << said();
  const std::string words = read_text_file(CAVUM_PICTURES "/sides.txt");
  for (const char* word : {"mesial", "distal", "bukkal", "lingual"})
    EXPECT_NE(words.find(word), std::string::npos) << word << "\n" << words;
}

}  // namespace
}  // namespace cavum::station
