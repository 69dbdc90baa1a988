#include "engine/physics/contact/contact_tool.h"

#include <gtest/gtest.h>

#include "engine/base/det_math.h"
#include "engine/physics/contact/tuning.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(ContactTool, SamplesLieOnTheOutlineOrOnTheFilletOfAnEdge) {
  for (const auto& name : bur_names()) {
    const ContactTool tool = make_contact_tool(shipped_bur(name));
    const Profile& outline = tool.bur.profile;
    int on_edges = 0;
    for (const auto& s : tool.samples) {
      EXPECT_NEAR(length(s.normal), 1.0, 1e-9) << name;
      const double d = outline.distance_mm(s.at_mm);
      if (std::fabs(d) < 1e-6) {
        if (s.at_mm.z == 0 || outline.distance_mm(s.at_mm - s.normal * 0.01) > -0.009)
          continue;  // beside a corner
        EXPECT_NEAR(outline.distance_mm(s.at_mm + s.normal * 0.001), 0.001, 2e-5)
            << name << " at height " << s.at_mm.z;
        continue;
      }
      // a ball of the edge's radius behind the sample touches both sides of the edge from within
      // (where a side is an arc, nearly)
      ++on_edges;
      EXPECT_LT(d, 1e-4) << name << " at height " << s.at_mm.z;
      EXPECT_NEAR(outline.distance_mm(s.at_mm - s.normal * tuning::k_edge_radius_mm),
                  -tuning::k_edge_radius_mm, 1e-4)
          << name << " at height " << s.at_mm.z;
    }
    if (name == "cylinder-flat-1.0") {
      EXPECT_GT(on_edges, 3);
    }
    if (name == "round-1.0") {
      EXPECT_LT(on_edges, 10);
    }
  }
}

/// Area, mm², and its mean height of the outline between two heights, by fine strips of the
/// description.
std::pair<double, double> area_and_height(const Profile& profile, double low, double high) {
  double area = 0, moment = 0;
  ProfilePoint a;
  for (const auto& s : profile.segments()) {
    constexpr int n = 20000;
    ProfilePoint before = a;
    for (int i = 1; i <= n; ++i) {
      ProfilePoint p{a.r_mm + (s.end.r_mm - a.r_mm) * i / n,
                     a.z_mm + (s.end.z_mm - a.z_mm) * i / n};
      if (s.arc) {
        const double radius = std::hypot(a.r_mm - s.centre.r_mm, a.z_mm - s.centre.z_mm);
        const double k = radius / std::hypot(p.r_mm - s.centre.r_mm, p.z_mm - s.centre.z_mm);
        p = {s.centre.r_mm + (p.r_mm - s.centre.r_mm) * k,
             s.centre.z_mm + (p.z_mm - s.centre.z_mm) * k};
      }
      const double z = 0.5 * (p.z_mm + before.z_mm);
      if (z >= low && z <= high) {
        const double strip =
            k_pi * (p.r_mm + before.r_mm) * std::hypot(p.r_mm - before.r_mm, p.z_mm - before.z_mm);
        area += strip;
        moment += strip * z;
      }
      before = p;
    }
    a = s.end;
  }
  return {area, moment / area};
}

TEST(ContactTool, TheFurthestPlaceLiesOnTheHeadAndNoSampleLiesFurther) {
  Random random(drawn_seed("ContactTool.TheFurthestPlaceLiesOnTheHeadAndNoSampleLiesFurther"));
  for (const auto& name : bur_names()) {
    const ContactTool tool = make_contact_tool(shipped_bur(name));
    const std::uint32_t head = tool.patches[tool.head_patches - 1].last;
    double most = 0;
    for (int i = 0; i < 3000; ++i) {
      Vec3 way = random_direction(random);
      way.z = -std::fabs(way.z);  // towards the tooth; upwards the head ends in its neck
      const Vec3 at = tool.furthest_along(way);
      EXPECT_LE(tool.bur.profile.distance_mm(at), 1e-4)
          << name << ": outside the head, at height " << at.z;
      double samples = -1e9;
      for (std::uint32_t s = 0; s < head; ++s)
        samples = std::max(samples, dot(tool.samples[s].at_mm, way));
      ASSERT_GE(dot(at, way), samples - 5e-5)
          << name << ": samples lie on the outline to 50 nm, where pieces of it meet";
      most = std::max(most, dot(at, way) - samples);
    }
    EXPECT_LT(most, 0.06) << name << ": no more than lies between samples 0.18 mm apart";
  }
}

TEST(ContactTool, AreasOfTheSamplesAddUpToTheHead) {
  for (const auto& name : bur_names()) {
    const ContactTool tool = make_contact_tool(shipped_bur(name));
    const auto [area, height] = area_and_height(tool.bur.profile, 0, tool.bur.cutting_length_mm);
    double sum = 0, moment = 0, across_x = 0, across_y = 0;
    for (std::size_t i = 0; i < tool.patches[tool.head_patches - 1].last; ++i) {
      const auto& s = tool.samples[i];
      sum += s.area_mm2;
      moment += s.area_mm2 * s.at_mm.z;
      across_x += s.area_mm2 * s.at_mm.x;
      across_y += s.area_mm2 * s.at_mm.y;
    }
    EXPECT_NEAR(sum / area, 1.0, 0.01) << name;
    EXPECT_NEAR(moment / sum, height, 0.01 * tool.bur.cutting_length_mm) << name;
    EXPECT_LT(std::hypot(across_x, across_y) / sum, 0.02 * tool.bur.head_radius_mm)
        << name << ": more samples on one side";
  }
  // once by hand: a ball cap of height 0.9 on radius 0.5 has 2 pi R h
  const auto round = area_and_height(shipped_bur("round-1.0").profile, 0, 0.9);
  EXPECT_NEAR(round.first, 2 * k_pi * 0.5 * 0.9, 1e-4);
}

TEST(ContactTool, PatchesHoldEverySampleOnceWithinTheirBall) {
  for (const auto& name : bur_names()) {
    const ContactTool tool = make_contact_tool(shipped_bur(name));
    std::uint32_t next = 0;
    for (std::size_t p = 0; p < tool.patches.size(); ++p) {
      const auto& patch = tool.patches[p];
      ASSERT_EQ(patch.first, next) << name;
      ASSERT_LT(patch.first, patch.last) << name;
      next = patch.last;
      for (std::size_t i = patch.first; i < patch.last; ++i) {
        EXPECT_LE(length(tool.samples[i].at_mm - patch.centre_mm), patch.radius_mm + 1e-12) << name;
        EXPECT_LE(length(tool.samples[i].at_mm), tool.reach_mm + 1e-12) << name;
        if (p < tool.head_patches) {
          EXPECT_LE(tool.samples[i].at_mm.z, tool.bur.cutting_length_mm + 1e-9) << name;
        } else {
          EXPECT_GE(tool.samples[i].at_mm.z, tool.bur.cutting_length_mm - tuning::k_edge_radius_mm)
              << name;
        }
      }
    }
    EXPECT_EQ(next, tool.samples.size()) << name;
  }
}

}  // namespace
}  // namespace cavum
