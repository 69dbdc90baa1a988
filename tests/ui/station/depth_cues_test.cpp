// Does the picture show how far the head of the point is from the tooth? Drawn poses of an instrument, each touching and 0.3, 1 and 3 mm above, are
// rendered; what is compared is taken from pixels alone. Where the instrument stands in the picture is worked out from its profile and the camera,
// the height of touching from the octree: nothing asks the renderer.
//   CAVUM_DEEP=1 station_test --gtest_filter='DepthCues*'      60 poses instead of 12
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <numbers>

#include "engine/base/random.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/support/engine_testing.h"
#include "tests/ui/station/virtual_screen.h"
#include "ui/station/scene.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

constexpr int k_wide = 900, k_high = 600;
constexpr std::array<double, 4> k_above_mm{0.0, 0.3, 1.0, 3.0};

/// A picture's brightness, 0..255, from below left; one that was drawn smaller is looked at as it is shown.
std::vector<float> brightness(Scene& scene, const SceneView& view) {
  glBindTexture(GL_TEXTURE_2D, scene.picture(view, k_wide, k_high));
  int wide = 0, high = 0;
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &wide);
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &high);
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high) * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  std::vector<float> grey;
  for (int y = 0; y < k_high; ++y)
    for (int x = 0; x < k_wide; ++x) {
      const std::uint8_t* p = pixels.data() + static_cast<std::ptrdiff_t>(4) * (y * high / k_high * wide + x * wide / k_wide);
      grey.push_back(0.3F * p[0] + 0.6F * p[1] + 0.1F * p[2]);
    }
  return grey;
}

glm::vec2 pixel_of(const Camera& camera, Vec3 mm) {
  const glm::vec4 p = camera.projection(static_cast<float>(k_wide) / k_high) * camera.view() * glm::vec4(mm.x, mm.y, mm.z, 1);
  return {(0.5F + 0.5F * p.x / p.w) * k_wide, (0.5F + 0.5F * p.y / p.w) * k_high};
}

/// Places of the instrument's surface, tool frame.
std::vector<Vec3> surface_of(const DiamondPoint& point) {
  constexpr int k_around = 40;
  constexpr double k_longest_mm = 13.0;
  std::vector<Vec3> all;
  const auto ring = [&all](double r, double z) {
    for (int i = 0; i < k_around; ++i) {
      const double a = 2 * std::numbers::pi * i / k_around;
      all.push_back({r * std::cos(a), r * std::sin(a), z});
    }
  };
  double last_r = 0, last_z = 0;
  for (const auto& p : point.profile.walk(0.05, point.profile.length_mm())) {
    ring(p.at.r_mm, p.at.z_mm);
    last_r = p.at.r_mm;
    last_z = p.at.z_mm;
  }
  for (double z = last_z; z < k_longest_mm; z += 0.05) ring(last_r, z);
  return all;
}

Vec3 placed(const Pose& pose, Vec3 tool_mm) {
  const Mat3 r = rotation(pose.rotation);
  return pose.tip_mm + Vec3{dot(r.row_x, tool_mm), dot(r.row_y, tool_mm), dot(r.row_z, tool_mm)};
}

/// Pixels that the instrument may cover, and two around them.
std::vector<bool> covered(const Camera& camera, const Pose& pose, const std::vector<Vec3>& surface) {
  constexpr int k_margin = 3;
  std::vector<bool> mask(static_cast<std::size_t>(k_wide) * k_high);
  for (const Vec3 p : surface) {
    const glm::vec2 at = pixel_of(camera, placed(pose, p));
    for (int dy = -k_margin; dy <= k_margin; ++dy)
      for (int dx = -k_margin; dx <= k_margin; ++dx) {
        const int x = static_cast<int>(at.x) + dx, y = static_cast<int>(at.y) + dy;
        if (x >= 0 && y >= 0 && x < k_wide && y < k_high) mask[static_cast<std::size_t>(y * k_wide + x)] = true;
      }
  }
  return mask;
}

/// An instrument that touches, and where.
struct Touch {
  Pose pose;
  Vec3 tool_mm;  ///< of the instrument, tool frame
};
/// The tip's height along the tool's axis at which the instrument touches and nothing of it is inside.
Touch touching(const Octree& tooth, Pose pose, const std::vector<Vec3>& surface) {
  Octree::Cursor cursor;
  const Vec3 axis = placed({{0, 0, 0}, pose.rotation}, {0, 0, 1});
  Vec3 nearest;
  const auto nearest_mm = [&](double up) {
    const Pose at{pose.tip_mm + axis * up, pose.rotation};
    double least = 1e9;
    for (const Vec3 p : surface)
      if (const double mm = tooth.sample(placed(at, p), cursor).distance_mm; mm < least) {
        least = mm;
        nearest = p;
      }
    return least;
  };
  constexpr double k_step_mm = 0.1;
  double up = 5.0;
  while (up > -6.0 && nearest_mm(up - k_step_mm) > 0) up -= k_step_mm;
  double inside = up - k_step_mm;
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (inside + up);
    (nearest_mm(middle) > 0 ? up : inside) = middle;
  }
  static_cast<void>(nearest_mm(up));
  pose.tip_mm = pose.tip_mm + axis * up;
  return {pose, nearest};
}

/// The eye sees this place of the tooth's surface, if no instrument is in the way.
bool in_sight(const Octree& tooth, const Camera& camera, Vec3 place) {
  Octree::Cursor cursor;
  const glm::vec3 eye = camera.position_mm();
  const Vec3 way = normalized(Vec3{eye.x, eye.y, eye.z} - place);
  for (double far = 0.35; far < 12.0; far += 0.05)
    if (tooth.sample(place + way * far, cursor).distance_mm <= 0) return false;
  return true;
}

/// What an eye compares.
struct Cues {
  double shadow_px = 0;  ///< from the tip to the nearest part of the shadow: mean of its nearest quarter of a square millimetre
  int ring_px = 0;       ///< pixels beside the head that are much darker than they would be
};

/// `place`: of the tooth, where it touches or would; within `head_px` of it the ring is looked for.
Cues cues_of(const std::vector<float>& without, const std::vector<float>& with, const std::vector<bool>& mask, glm::dvec2 tip, glm::dvec2 place,
             double head_px, double px_per_mm) {
  constexpr float k_tooth = 45.0F;  // the background is darker
  constexpr float k_shadow = 0.15F, k_ring = 0.48F;
  Cues c;
  std::vector<double> far_px;
  for (int y = 0; y < k_high; ++y)
    for (int x = 0; x < k_wide; ++x) {
      const auto i = static_cast<std::size_t>(y * k_wide + x);
      if (mask[i] || without[i] < k_tooth) continue;
      const float darker = 1.0F - with[i] / without[i];
      if (darker > k_shadow) far_px.push_back(glm::length(glm::dvec2(x, y) - tip));
      if (darker > k_ring && glm::length(glm::dvec2(x, y) - place) < head_px) ++c.ring_px;
    }
  const auto nearest = std::min(far_px.size(), static_cast<std::size_t>(0.25 * px_per_mm * px_per_mm));
  std::sort(far_px.begin(), far_px.end());
  for (std::size_t i = 0; i < nearest; ++i) c.shadow_px += far_px[i] / static_cast<double>(nearest);
  if (nearest == 0) c.shadow_px = k_wide;  // it fell beside the tooth
  return c;
}

class DepthCues : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { screen_ = std::make_unique<testing_station::VirtualScreen>(); }
  static void TearDownTestSuite() { screen_.reset(); }
  void SetUp() override {
    if (!screen_->there()) GTEST_SKIP() << "SKIPPED: no Xvfb on this computer, so no window can be opened";
  }

 private:
  static inline std::unique_ptr<testing_station::VirtualScreen> screen_;
};

TEST_F(DepthCues, TheRingTellsTouchingFromAThirdOfAMillimetreAndTheShadowFromThree) {
  const int poses = std::getenv("CAVUM_DEEP") != nullptr ? 60 : 12;
  // the everyday poses are the first of the sixty, the same every time: a picture is looked at by pixels, and what held once must hold again
  const char* other = std::getenv("CAVUM_TEST_SEED");
  Random random(other != nullptr ? std::strtoull(other, nullptr, 10) : 5);
  MolarShape shape;
  shape.leaf_mm = 0.1;
  Tooth tooth = make_molar(shape);
  tooth.octree.reserve_edits(20000);
  const double top_mm = [&] {
    double z = 6;
    while (tooth.octree.tissue_at({0, 0, z}) == k_air) z -= 0.1;
    return z;
  }();
  // a cavity two millimetres deep in the middle; one pose in three stands over it
  std::vector<RemovedLeaf> removed;
  removed.reserve(1 << 17);
  const auto cavity = [top_mm](Vec3 mm) { return std::max(std::hypot(mm.x, mm.y) - 1.7, top_mm - 2.0 - mm.z); };
  ASSERT_TRUE(tooth.octree.carve({-2, -2, top_mm - 2.5}, {2, 2, top_mm + 3}, cavity, removed));
  std::vector<DiamondPoint> tray;
  for (const auto& name : testing_engine::point_names()) tray.push_back(testing_engine::diamond_point(name));

  const Window window({"Cavum", 640, 480, {}});
  Scene scene(tooth.octree, tooth.tissues, tray, nullptr);
  int right = 0, ring_right = 0, shadow_right = 0, lifted_right = 0;
  for (int n = 0; n < poses; ++n) {
    SceneView view;
    view.handpiece = false;
    view.camera.target_mm = {0, 0, static_cast<float>(top_mm) - 1.5F};
    Touch touch;
    std::vector<Vec3> surface;
    const bool in_cavity = n % 3 == 0;
    // the end of the head touches, not its side at a cusp, at a place that the eye sees
    for (bool fits = false; !fits;) {
      view.point = static_cast<int>(random.below(static_cast<std::uint32_t>(tray.size())));
      view.camera.turn_deg = static_cast<float>(random.uniform(-180, 180));
      view.camera.rise_deg = static_cast<float>(random.uniform(40, 80));
      view.camera.distance_mm = static_cast<float>(random.uniform(24, 40));
      const double wide = in_cavity ? 0.9 : 2.8;
      const Pose pose{{random.uniform(-wide, wide), random.uniform(-wide, wide), top_mm},
                      normalized(Quat{1, random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0})};
      const DiamondPoint& drawn = tray[static_cast<std::size_t>(view.point)];
      surface = surface_of(drawn);
      touch = touching(tooth.octree, pose, surface);
      fits = touch.tool_mm.z < 0.8 * drawn.head_radius_mm && in_sight(tooth.octree, view.camera, placed(touch.pose, touch.tool_mm));
    }
    const Pose& pose = touch.pose;
    const DiamondPoint& point = tray[static_cast<std::size_t>(view.point)];
    const Vec3 axis = placed({{0, 0, 0}, pose.rotation}, {0, 0, 1});
    // richest and poorest of what the processor draws
    scene.fix_effects(n % 2 == 0 ? 2 : k_effects.size() - 1);
    SceneView without = view;
    without.point = -1;
    const std::vector<float> bare = brightness(scene, without);
    std::array<Cues, k_above_mm.size()> cues;
    for (std::size_t h = 0; h < k_above_mm.size(); ++h) {
      view.tool = {pose.tip_mm + axis * k_above_mm[h], pose.rotation};
      const glm::dvec2 tip = pixel_of(view.camera, view.tool.tip_mm), place = pixel_of(view.camera, placed(pose, touch.tool_mm));
      const double px_per_mm = glm::length(glm::dvec2(pixel_of(view.camera, view.tool.tip_mm + view.camera.right() * 1.0)) - tip);
      constexpr double k_ring_mm = 0.6;
      cues[h] = cues_of(bare, brightness(scene, view), covered(view.camera, view.tool, surface), tip, place,
                        (point.head_radius_mm + k_ring_mm) * px_per_mm, px_per_mm);
    }
    const bool ring = cues[0].ring_px > cues[1].ring_px + 2;
    const bool shadow = cues[1].shadow_px + 1.0 < cues[2].shadow_px && cues[2].shadow_px + 1.0 < cues[3].shadow_px;
    ring_right += ring ? 1 : 0;
    shadow_right += shadow ? 1 : 0;
    lifted_right += cues[0].shadow_px + 1.0 < cues[3].shadow_px ? 1 : 0;
    right += ring && shadow ? 1 : 0;
    if (!ring || !shadow)
      std::printf("pose %d, %s%s, rise %.0f: ring %d %d %d %d px; shadow %.1f %.1f %.1f %.1f px from the tip\n", n, point.name.c_str(),
                  in_cavity ? " in the cavity" : "", static_cast<double>(view.camera.rise_deg), cues[0].ring_px, cues[1].ring_px, cues[2].ring_px,
                  cues[3].ring_px, cues[0].shadow_px, cues[1].shadow_px, cues[2].shadow_px, cues[3].shadow_px);
  }
  std::printf(
      "of %d poses: ring tells touching from 0.3 mm in %d; shadow 3 mm from touching in %d, 0.3, 1 and 3 mm from each other in %d; all of it in %d\n",
      poses, ring_right, lifted_right, shadow_right, right);
  // A regression check, on the seed that lamp, ring and measures were chosen on: 10 and 12 of 12 there, and two more may tip over by another
  // machine's rounding. docs/station.md says what is missing to the whole order.
  EXPECT_GE(ring_right, poses * 2 / 3);
  EXPECT_GE(lifted_right, poses * 5 / 6);
}

}  // namespace
}  // namespace cavum::station
