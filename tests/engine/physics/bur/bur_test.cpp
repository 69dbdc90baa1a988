#include "engine/physics/bur/bur.h"

#include <gtest/gtest.h>

#include <regex>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(Bur, ExactlyTwelveShipAndAllCanBeRead) {
  const auto names = bur_names();
  EXPECT_EQ(names.size(), 12u);  // the paper's number of tip shapes
  for (const auto& name : names) {
    const Bur p = shipped_bur(name);
    EXPECT_EQ(p.name, name);
    EXPECT_FALSE(p.title.empty());
    // the name ends with the diameter; a slightly tapered shape may be a little wider at its top
    EXPECT_NEAR(2 * p.head_radius_mm, std::stod(name.substr(name.rfind('-') + 1)), 0.07) << name;
    EXPECT_DOUBLE_EQ(p.profile.radius_mm(20), 0.8) << name << ": FG shank of 1.6 mm";
    EXPECT_LT(p.cutting_length_mm, p.profile.length_mm()) << name;
  }
}

TEST(Bur, HeadsAreConvex) {
  Random random(drawn_seed("Bur.HeadsAreConvex"));
  for (const auto& name : bur_names()) {
    const Bur p = shipped_bur(name);
    const double r = p.head_radius_mm;
    const auto inside = [&] {
      for (;;) {
        const Vec3 v{random.uniform(-r, r), random.uniform(-r, r),
                     random.uniform(0, p.cutting_length_mm)};
        if (p.head_distance_mm(v) < 0) return v;
      }
    };
    for (int i = 0; i < 3000; ++i) {
      const Vec3 a = inside(), b = inside();
      ASSERT_LE(p.head_distance_mm((a + b) * 0.5), 1e-9) << name;
    }
  }
}

TEST(Bur, HeadDistanceNeverChangesFasterThanTheWay) {  // what carving asks of a shape
  Random random(drawn_seed("Bur.HeadDistanceNeverChangesFasterThanTheWay"));
  for (const auto& name : bur_names()) {
    const Bur p = shipped_bur(name);
    for (int i = 0; i < 5000; ++i) {
      const Vec3 a{random.uniform(-1, 1), random.uniform(-1, 1),
                   random.uniform(-0.5, p.cutting_length_mm + 0.5)};
      const Vec3 b = a + random_direction(random) * random.uniform(0, 0.3);
      ASSERT_LE(std::fabs(p.head_distance_mm(a) - p.head_distance_mm(b)), length(a - b) + 1e-12)
          << name;
    }
  }
}

TEST(Bur, WidestHeightsBoundWhereTheHeadNarrows) {
  for (const auto& name : bur_names()) {
    const Bur p = shipped_bur(name);
    double before = 0;
    for (double z = 0; z < p.cutting_length_mm; z += 0.001) {
      const double r = p.profile.radius_mm(z);
      if (z < p.widest_to_mm - 0.005) {
        EXPECT_GE(r, before - 1e-9) << name << ": narrows at " << z << " below widest_to";
      }
      if (z > p.widest_from_mm + 0.005) {
        EXPECT_LE(r, before + 1e-9) << name << ": widens at " << z << " above widest_from";
      }
      before = r;
    }
  }
}

TEST(Bur, BrokenFilesAreErrorsWithLineAndColumn) {
  using Broken = std::array<const char*, 3>;
  for (const auto& [what, from, to] :
       {Broken{"syntax", "profile = [", "profile = [["},
        {"missing title", "title = \"Round, 1.0 mm\"\n", ""},
        {"missing profile", "profile = [", "outline = ["},
        {"number as text", "cutting_length_mm = 0.9", "cutting_length_mm = \"0.9\""},
        {"cutting length in metres", "cutting_length_mm = 0.9", "cutting_length_mm = 0.0009"},
        {"unknown key", "cutting_length_mm = 0.9", "cutting_length_mm = 0.9\ncolour = 1"},
        {"unknown key in a piece", "{ r_mm = 0.3, z_mm = 1.2 }",
         "{ r_mm = 0.3, z_mm = 1.2, w = 1 }"},
        {"piece that is no table", "{ r_mm = 0.3, z_mm = 1.2 }", "3"},
        {"negative radius", "r_mm = 0.4, z_mm = 11", "r_mm = -0.4, z_mm = 11"},
        {"NaN", "r_mm = 0.4, z_mm = 11", "r_mm = nan, z_mm = 11"},
        {"centre with one number", "centre = [0, 0.5]", "centre = [0]"},
        {"heights fall", "z_mm = 11 }", "z_mm = 1.0 }"},
        {"arc that does not fit", "centre = [0, 0.5]", "centre = [0, 0.4]"},
        {"arc about NaN", "centre = [0, 0.5]", "centre = [nan, 0.5]"},
        {"hollow head", "cutting_length_mm = 0.9", "cutting_length_mm = 11.5"},
        {"empty profile", "profile = [", "profile = []\nrest = ["}}) {
    std::string text = bur_text("round-1.0");
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, std::string(from).size(), to);
    const std::string place = place_of(thrown_by([&] { (void)parse_bur(text, "p.toml"); }));
    EXPECT_TRUE(std::regex_match(place, std::regex("p\\.toml:[0-9]+:[0-9]+")))
        << what << ": '" << place << "'";
  }
}

TEST(Bur, MorePiecesThanTheLimitAreRefusedByIt) {
  std::string text = "name = \"many\"\ntitle = \"Many\"\ncutting_length_mm = 1\nprofile = [";
  for (int i = 0; i < 65; ++i) text += "{ r_mm = 0.3, z_mm = 1.2 }, ";
  const auto error = thrown_by([&] { static_cast<void>(parse_bur(text + "]\n", "p.toml")); });
  EXPECT_TRUE(tells(error, 65) && tells(error, 64));
}

TEST(Bur, APieceWithoutLengthIsRefusedOrHarmless) {
  std::string text = bur_text("cylinder-flat-1.0");
  const std::string piece = "{ r_mm = 0.5, z_mm = 4 },\n";
  text.insert(text.find(piece), piece);
  try {
    const ContactTool tool = make_contact_tool(parse_bur(text, "p.toml"));
    for (const auto& s : tool.samples)
      ASSERT_TRUE(is_finite(s.at_mm) && is_finite(s.normal) && std::isfinite(s.area_mm2));
  } catch (const Error&) {
  }
}

}  // namespace
}  // namespace cavum
