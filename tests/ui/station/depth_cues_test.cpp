// Does the picture show how far the head of the bur is from the tooth? Drawn poses of an
// instrument, each touching and 0.3, 1 and 3 mm above, are rendered; what is compared is taken from
// pixels alone. Where the instrument stands in the picture is worked out from its profile and the
// camera, the height of touching from the octree: nothing asks the renderer.
//   CAVUM_DEEP=1 station_test --gtest_filter='DepthCues*'      60 poses instead of 12
//   CAVUM_SPRAY=1 ...                                           through spray and chips
#include <epoxy/gl.h>
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

#include "engine/base/random.h"
#include "engine/tooth/make/make_molar.h"
#include "engine/tooth/octree_edit.h"
#include "tests/engine/support/engine_testing.h"
#include "tests/ui/station/virtual_screen.h"
#include "ui/station/picture_file.h"
#include "ui/station/scene.h"
#include "ui/station/window.h"

namespace cavum::station {
namespace {

constexpr int k_wide = 900, k_high = 600;
constexpr std::array<double, 4> k_above_mm{0.0, 0.3, 1.0, 3.0};
constexpr int k_kept = 12;  // poses whose pictures are kept

struct Colour {
  float r = 0, g = 0, b = 0;  ///< 0..255
};

/// A picture's colours, from below left; one that was drawn smaller is looked at as it is shown.
std::vector<Colour> colours_seen(Scene& scene, const SceneView& view) {
  glBindTexture(GL_TEXTURE_2D, scene.picture(view, k_wide, k_high));
  int wide = 0, high = 0;
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &wide);
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &high);
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high) *
                                   4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  std::vector<Colour> seen;
  for (int y = 0; y < k_high; ++y)
    for (int x = 0; x < k_wide; ++x) {
      const std::uint8_t* p = pixels.data() + static_cast<std::ptrdiff_t>(4) *
                                                  (y * high / k_high * wide + x * wide / k_wide);
      seen.push_back(
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    }
  return seen;
}

/// For a person's eyes, beside the pictures of the screens.
void keep(const std::string& name, const std::vector<Colour>& seen) {
  std::filesystem::create_directories(CAVUM_PICTURES);
  std::vector<unsigned char> bytes;
  for (const Colour& c : seen)
    for (const float v : {c.r, c.g, c.b}) bytes.push_back(static_cast<unsigned char>(v));
  write_png(std::string(CAVUM_PICTURES) + "/" + name + ".png", k_wide, k_high, bytes);
}

glm::vec2 pixel_of(const Camera& camera, Vec3 mm) {
  const glm::vec4 p = camera.projection(static_cast<float>(k_wide) / k_high) * camera.view() *
                      glm::vec4(mm.x, mm.y, mm.z, 1);
  return {(0.5F + 0.5F * p.x / p.w) * k_wide, (0.5F + 0.5F * p.y / p.w) * k_high};
}

/// Places of the instrument's surface, tool frame.
std::vector<Vec3> surface_of(const Bur& bur) {
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
  for (const auto& p : bur.profile.walk(0.05, bur.profile.length_mm())) {
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
std::vector<bool> covered(const Camera& camera, const Pose& pose,
                          const std::vector<Vec3>& surface) {
  constexpr int k_margin = 3;
  std::vector<bool> mask(static_cast<std::size_t>(k_wide) * k_high);
  for (const Vec3 p : surface) {
    const glm::vec2 at = pixel_of(camera, placed(pose, p));
    for (int dy = -k_margin; dy <= k_margin; ++dy)
      for (int dx = -k_margin; dx <= k_margin; ++dx) {
        const int x = static_cast<int>(at.x) + dx, y = static_cast<int>(at.y) + dy;
        if (x >= 0 && y >= 0 && x < k_wide && y < k_high)
          mask[static_cast<std::size_t>(y * k_wide + x)] = true;
      }
  }
  return mask;
}

/// An instrument that touches, and where.
struct Touch {
  Pose pose;
  Vec3 tool_mm;  ///< of the instrument, tool frame
};
/// The tip's height along the tool's axis at which the instrument touches and nothing of it is
/// inside.
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

/// What an eye sees of the ring below the head.
struct Cues {
  int pixels = 0;      ///< of the tooth that lost far more red than blue
  double wide_mm = 0;  ///< how far to the left or right of the tip all but a fiftieth of them
                       ///< reach, by the scale at the tip
};

Cues cues_of(const std::vector<Colour>& without, const std::vector<Colour>& with,
             const std::vector<bool>& mask, double tip_px, double px_per_mm) {
  constexpr float k_tooth = 45.0F;  // the background is darker
  constexpr float k_less_red = 0.72F;
  constexpr int k_fewest = 12;
  std::vector<double> across;
  for (int y = 0; y < k_high; ++y)
    for (int x = 0; x < k_wide; ++x) {
      const auto i = static_cast<std::size_t>(y * k_wide + x);
      const Colour &was = without[i], &is = with[i];
      if (mask[i] || 0.3F * was.r + 0.6F * was.g + 0.1F * was.b < k_tooth) continue;
      if ((is.r + 1) / (was.r + 1) < k_less_red * (is.b + 1) / (was.b + 1))
        across.push_back(std::fabs(x - tip_px));
    }
  Cues c;
  c.pixels = static_cast<int>(across.size());
  if (c.pixels < k_fewest) return c;
  std::sort(across.begin(), across.end());
  c.wide_mm = across[across.size() - 1 - across.size() / 50] / px_per_mm;
  return c;
}

/// Which of the heights one picture alone tells, by the ring's width beside the head's.
std::size_t told_alone(const Cues& cues, double head_radius_mm) {
  if (cues.pixels < 12) return 0;
  const double wider_mm = cues.wide_mm - head_radius_mm;
  return wider_mm < 0.5 ? 1 : wider_mm < 1.05 ? 2 : 3;
}

class DepthCues : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { screen_ = std::make_unique<testing_station::VirtualScreen>(); }
  static void TearDownTestSuite() { screen_.reset(); }
  void SetUp() override {
    if (!screen_->there())
      GTEST_SKIP() << "SKIPPED: no Xvfb on this computer, so no window can be opened";
  }

 private:
  static inline std::unique_ptr<testing_station::VirtualScreen> screen_;
};

TEST_F(DepthCues, TheRingTellsTouchingAndHowHighTheHeadIs) {
  const bool deep = std::getenv("CAVUM_DEEP") != nullptr;
  const int poses = deep ? 60 : 12;
  // the everyday poses are the first of the sixty of seed 5, the same every time: what held once
  // must hold again; sixty others say how often
  const char* other = deep ? std::getenv("CAVUM_TEST_SEED") : nullptr;
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
  const auto cavity = [top_mm](Vec3 mm) {
    return std::max(std::hypot(mm.x, mm.y) - 1.7, top_mm - 2.0 - mm.z);
  };
  ASSERT_TRUE(tooth.octree.carve({-2, -2, top_mm - 2.5}, {2, 2, top_mm + 3}, cavity, removed));
  std::vector<Bur> tray;
  for (const auto& name : testing_engine::bur_names())
    tray.push_back(testing_engine::shipped_bur(name));

  const Window window({"Cavum", 640, 480, {}});
  Scene scene(tooth.octree, tooth.tissues, tray, nullptr);
  int touch_right = 0, order_right = 0, right = 0, alone_right = 0;
  for (int n = 0; n < poses; ++n) {
    SceneView view;
    view.handpiece = false;
    if (std::getenv("CAVUM_SPRAY") != nullptr) view.spray = {0.37 * n, 1.0F, 1.0F, glm::vec3(0.9F)};
    view.camera.target_mm = {0, 0, static_cast<float>(top_mm) - 1.5F};
    Touch touch;
    std::vector<Vec3> surface;
    const bool in_cavity = n % 3 == 0;
    // the end of the head touches, not its side at a cusp, at a place that the eye sees
    for (bool fits = false; !fits;) {
      view.bur = static_cast<int>(random.below(static_cast<std::uint32_t>(tray.size())));
      view.camera.turn_deg = static_cast<float>(random.uniform(-180, 180));
      view.camera.rise_deg = static_cast<float>(random.uniform(40, 80));
      view.camera.distance_mm = static_cast<float>(random.uniform(24, 40));
      const double wide = in_cavity ? 0.9 : 2.8;
      const Pose pose{{random.uniform(-wide, wide), random.uniform(-wide, wide), top_mm},
                      normalized(Quat{1, random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0})};
      const Bur& drawn = tray[static_cast<std::size_t>(view.bur)];
      surface = surface_of(drawn);
      touch = touching(tooth.octree, pose, surface);
      fits = touch.tool_mm.z < 0.8 * drawn.head_radius_mm &&
             in_sight(tooth.octree, view.camera, placed(touch.pose, touch.tool_mm));
    }
    const Pose& pose = touch.pose;
    const Bur& bur = tray[static_cast<std::size_t>(view.bur)];
    const Vec3 axis = placed({{0, 0, 0}, pose.rotation}, {0, 0, 1});
    // richest and poorest of what the processor draws
    scene.fix_effects(n % 2 == 0 ? 2 : k_effects.size() - 1);
    SceneView without = view;
    without.bur = -1;
    const std::vector<Colour> bare = colours_seen(scene, without);
    std::array<Cues, k_above_mm.size()> cues;
    bool alone = true;
    for (std::size_t h = 0; h < k_above_mm.size(); ++h) {
      view.tool = {pose.tip_mm + axis * k_above_mm[h], pose.rotation};
      const glm::dvec2 tip = pixel_of(view.camera, view.tool.tip_mm);
      const double px_per_mm = glm::length(
          glm::dvec2(pixel_of(view.camera, view.tool.tip_mm + view.camera.right() * 1.0)) - tip);
      const std::vector<Colour> seen = colours_seen(scene, view);
      cues[h] = cues_of(bare, seen, covered(view.camera, view.tool, surface), tip.x, px_per_mm);
      if (n < k_kept) keep(fmt::format("depth-{}-{:.1f}", n, k_above_mm[h]), seen);
      alone = alone && told_alone(cues[h], bur.head_radius_mm) == h;
    }
    const bool touches = cues[0].pixels < cues[1].pixels / 4;
    constexpr double k_wider_mm = 0.05;
    const bool order = cues[1].wide_mm + k_wider_mm < cues[2].wide_mm &&
                       cues[2].wide_mm + k_wider_mm < cues[3].wide_mm;
    touch_right += touches ? 1 : 0;
    order_right += order ? 1 : 0;
    right += touches && order ? 1 : 0;
    alone_right += alone ? 1 : 0;
    if (!touches || !order || !alone)
      std::printf("pose %d, %s%s, rise %.0f: %d %d %d %d pixels; %.2f %.2f %.2f mm wide%s\n", n,
                  bur.name.c_str(), in_cavity ? " in the cavity" : "",
                  static_cast<double>(view.camera.rise_deg), cues[0].pixels, cues[1].pixels,
                  cues[2].pixels, cues[3].pixels, cues[1].wide_mm, cues[2].wide_mm, cues[3].wide_mm,
                  touches && order ? " (in order)" : "");
  }
  std::printf(
      "of %d poses: touching told from 0.3 mm in %d; 0.3, 1 and 3 mm in order in %d; all of it in %d; each height by its one picture in %d\n",
      poses, touch_right, order_right, right, alone_right);
  EXPECT_GE(right, poses * 95 / 100);
}

}  // namespace
}  // namespace cavum::station
