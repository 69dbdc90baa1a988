// The authoring view as an author meets it: the real program on a virtual screen, its keys pressed
// by a script. What counts is the file it leaves behind: the bytes of what was changed, and nothing
// else.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <random>
#include <thread>

#include "engine/base/error.h"
#include "scenarios/file/parse.h"
#include "tests/scenarios/test_teeth.h"
#include "tests/ui/station/author_window.h"
#include "ui/station/author_document.h"
#include "ui/station/author_worker.h"
#include "ui/station/author_zones.h"

namespace cavum::station {
namespace {

TEST_F(AuthorWindow, APointAndTheDepthMovedByKeysAreAllThatDiffersInTheFile) {
  // seen from occlusal with buccal down the picture, mesial lies to the left: the first point
  // (-1.5, 0) goes two steps to the right
  const std::string script = R"(wait author
sleep 0.3
picture 20-author
key right
key right
key pageup
wait author-busy
wait author
sleep 0.3
picture 21-author-changed
key 2
sleep 0.5
picture 22-author-from-the-side
hold ctrl
key s
release ctrl
sleep 0.3
key escape
)";
  EXPECT_EQ(run(script), 0) << said();
  const std::string before = read_text_file(k_class_1), after = read_text_file(file());
  const scenarios::Scenario s = scenarios::parse_scenario(after, file());
  EXPECT_NEAR(std::fabs(s.zones.target[0].outline.points_mm[0].x + 1.5), 0.2, 1e-9);
  EXPECT_EQ(
      after,
      replaced(replaced(before, "[-1.5, 0]",
                        "[" + scenarios::written_number(s.zones.target[0].outline.points_mm[0].x) +
                            ", 0]"),
               "depth_mm = 1.8", "depth_mm = 1.9"));
  EXPECT_EQ(
      std::system((CAVUM_BINARY " scenario check " + file() + " >" + folder_.file("out")).c_str()),
      0);
  for (const char* name : {"20-author", "21-author-changed", "22-author-from-the-side"})
    EXPECT_GT(std::filesystem::file_size(std::string(CAVUM_PICTURES) + "/" + name + ".png"), 20000u)
        << name;
}

TEST_F(AuthorWindow, TheMousePullsAPointAndTheDepth) {
  // 1280 x 800: from occlusal the points of the fissure stand 128 px apart, which are 3 mm; the
  // floor's handle is pulled from the side
  EXPECT_EQ(
      run("wait author\nmouse 539 363\nsleep 0.1\nmouse 539 363 pressed\nsleep 0.1\nmouse 550 370 pressed\nsleep 0.1\nmouse 582 406 pressed\n"
          "sleep 0.1\nmouse 582 406\nwait author-busy\nwait author\nsleep 0.2\npicture 25-author-pulled\nhold ctrl\nkey s\nrelease ctrl\n"
          "sleep 0.2\nkey escape\n"),
      0)
      << said();
  const std::string before = read_text_file(k_class_1), after = read_text_file(file());
  const scenarios::Scenario s = scenarios::parse_scenario(after, file());
  const Vec3 to = s.zones.target[0].outline.points_mm[0];
  EXPECT_NEAR(to.x, -1.5 - 3.0 * 43 / 128, 0.05);
  EXPECT_NEAR(to.y, 3.0 * 43 / 128, 0.05);
  EXPECT_EQ(after, replaced(before, "[-1.5, 0]",
                            "[" + scenarios::written_number(to.x) + ", " +
                                scenarios::written_number(to.y) + "]"));

  write_text_file(file(), before);
  EXPECT_EQ(
      run("wait author\nkey 2\nsleep 0.3\npicture 26-author-depth\nmouse 475 421\nsleep 0.1\nmouse 475 421 pressed\nsleep 0.1\n"
          "mouse 475 430 pressed\nsleep 0.1\nmouse 475 440 pressed\nsleep 0.1\nmouse 475 440\nwait author-busy\nwait author\n"
          "hold ctrl\nkey s\nrelease ctrl\nsleep 0.2\nkey escape\n"),
      0)
      << said();
  const double depth =
      scenarios::parse_scenario(read_text_file(file()), file()).zones.target[0].bottom.depth_mm;
  EXPECT_GT(depth, 2.1);
  EXPECT_LT(depth, 2.6);
  EXPECT_EQ(read_text_file(file()),
            replaced(before, "depth_mm = 1.8", "depth_mm = " + scenarios::written_number(depth)));
}

TEST_F(AuthorWindow, ChangesOfEveryKindTakenBackLeaveTheFileAsItWas) {
  on_the_block();
  const std::string
      changes =
          "wait author\nkey i\nkey left\nkey tab\nkey pageup\nkey ]\nkey pagedown\nhold ctrl\n",
      before = read_text_file(file());
  const std::string save = "key s\nrelease ctrl\nsleep 0.2\nkey escape\n";
  EXPECT_EQ(run(changes + "key z\nkey z\nkey z\nkey z\nkey z\n" + save), 0) << said();
  EXPECT_EQ(read_text_file(file()), before);
  EXPECT_EQ(run(changes + save), 0) << said();
  const scenarios::ZoneSpec zones = scenarios::parse_scenario(read_text_file(file()), file()).zones;
  EXPECT_EQ(zones.target[0].outline.points_mm.size(), 3u);
  EXPECT_NEAR(zones.leeway.bottom_mm, 0.3, 1e-9);
  EXPECT_NEAR(zones.leeway.sides_mm, 0.15, 1e-9);
}

TEST_F(AuthorWindow, AsksBeforeUnsavedChangesAreLost) {
  on_the_block();
  const std::string before = read_text_file(file());
  EXPECT_EQ(run("wait author\nkey pageup\nclose\nsleep 0.4\npicture 23-author-closing\nkey n\n"), 0)
      << said();
  EXPECT_EQ(read_text_file(file()), before) << "closed without saving";
  EXPECT_EQ(
      run("wait author\nkey pageup\nclose\nsleep 0.4\nkey escape\nsleep 0.2\nkey pageup\nkey escape\nsleep 0.4\nkey enter\n"),
      0)
      << said();
  EXPECT_EQ(read_text_file(file()), replaced(before, "depth_mm = 1.8", "depth_mm = 2"))
      << "gone back, changed more, saved on closing";
}

TEST_F(AuthorWindow, AMistakeMadeByHandIsNamedWithItsLine) {
  on_the_block();
  // the container narrower than the leeway: a mistake, not a warning
  EXPECT_EQ(
      run("wait author\nkey tab\nkey tab\nkey pagedown 3\nwait author\nsleep 0.3\npicture 24-author-mistake\nkey escape\nsleep 0.4\nkey enter\n"),
      0)
      << said();
  const auto problems = scenarios::read_scenario(read_text_file(file()), file()).problems;
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_FALSE(problems[0].warning);
  EXPECT_GT(problems[0].where.line, 0);
}

TEST_F(AuthorWindow, EndedFromOutsideKeepsWhatIsUnsavedBesideTheFile) {
  on_the_block();
  const std::string before = read_text_file(file());
  write_text_file(folder_.file("script"),
                  "wait author\nkey pageup\nsleep 0.2\npicture changed\nsleep 300\n");
  std::thread ender([this] {
    constexpr int k_patience = 3000;  // tenths of a second
    for (int i = 0; i < k_patience && !std::filesystem::exists(folder_.file("changed.png")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    ::kill(std::stoi(read_text_file(folder_.file("pid"))), SIGTERM);
  });
  const int status =
      std::system(("echo $$ >" + folder_.file("pid") + "; exec " CAVUM_BINARY " station --author " +
                   file() + " --script " + folder_.file("script") + " --pictures " +
                   folder_.file("") + " 2>" + folder_.file("err"))
                      .c_str());
  ender.join();
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_EQ(read_text_file(file()), before);
  EXPECT_EQ(read_text_file(file() + ".unsaved"),
            replaced(before, "depth_mm = 1.8", "depth_mm = 1.9"))
      << said();
}

TEST(AuthorDocument, DoesNotOverwriteWhatSomebodyElseWrote) {
  const testing_basics::Folder folder;
  const std::string path = folder.file("a.toml");
  write_text_file(path, "a = 1 # mine\n");
  AuthorDocument d(path);
  d.make(scenarios::set_number(d.text(), path, "a", 2), "");
  write_text_file(path, "a = 3 # theirs\n");
  EXPECT_THROW(d.save(), Error);
  EXPECT_EQ(read_text_file(path), "a = 3 # theirs\n");
  EXPECT_EQ(d.text(), "a = 2 # mine\n");
  d.read_again();
  EXPECT_EQ(d.text(), "a = 3 # theirs\n");
  EXPECT_FALSE(d.unsaved());
  EXPECT_TRUE(d.undo());
  EXPECT_EQ(d.text(), "a = 2 # mine\n") << "reading again loses nothing";
  d.save();
  EXPECT_EQ(read_text_file(path), "a = 2 # mine\n");
  std::filesystem::remove(path);
  EXPECT_THROW(d.save(), Error) << "gone from under it";
}

TEST(AuthorDocument, APullOfTheMouseIsTakenBackAtOnce) {
  const testing_basics::Folder folder;
  const std::string path = folder.file("a.toml");
  write_text_file(path, "a = 1\nb = 1\n");
  AuthorDocument d(path);
  for (int i = 2; i < 20; ++i) d.make(scenarios::set_number(d.text(), path, "a", i), "a");
  d.rest();
  for (int i = 2; i < 20; ++i) d.make(scenarios::set_number(d.text(), path, "a", 20 + i), "a");
  EXPECT_TRUE(d.undo());
  EXPECT_EQ(d.text(), "a = 19\nb = 1\n");
  EXPECT_TRUE(d.undo());
  EXPECT_EQ(d.text(), "a = 1\nb = 1\n");
  EXPECT_FALSE(d.undo());
  EXPECT_TRUE(d.redo());
  EXPECT_TRUE(d.redo());
  EXPECT_EQ(d.text(), "a = 39\nb = 1\n");
  EXPECT_FALSE(d.redo());
}

TEST(AuthorZones, EveryPlaceIsThatOfItsValueInEveryShippedScenario) {
  std::size_t numbers = 0, points = 0;
  for (const auto& f :
       std::filesystem::directory_iterator(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios")) {
    if (f.path().extension() != ".toml") continue;
    const std::string text = read_text_file(f.path().string());
    for (const AuthorZone& zone :
         author_zones(scenarios::read_scenario(text, "f").scenario, 3.0, {})) {
      for (const AuthorNumber& n : zone.numbers) {
        ++numbers;
        EXPECT_TRUE(n.value >= n.low && n.value <= n.high) << n.place;
        const scenarios::TextChange same = scenarios::set_number(text, "f", n.place, n.value);
        EXPECT_TRUE(same.empty() || same.removed.empty())
            << f.path() << " " << n.place << ": " << same.removed;  // there already, or not written
      }
      for (std::size_t i = 0; i < zone.points_mm.size(); ++i, ++points)
        EXPECT_TRUE(scenarios::set_point(text, "f", zone.points_place + "/" + std::to_string(i),
                                         zone.points_mm[i].x, zone.points_mm[i].y)
                        .empty());
    }
  }
  EXPECT_GT(numbers, 30u);
  EXPECT_GE(points, 4u);  // any outlines at all: most follow landmarks
}

TEST(AuthorZones, APointLiesOnTheBorderOfTheShapeItMakes) {
  // the corners of a prism's outline are on its wall wherever it leans and turns, by the shape's
  // own signed distance
  std::mt19937_64 random(testing_basics::drawn_seed("AuthorZones"));
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const Tooth tooth = cavum::testing::dentin_block(2, 2, 0.2);
  std::string text = read_text_file(std::string(CAVUM_SOURCE_DIR) + "/data/scenarios/class_2.toml");
  const std::size_t box = text.find("shape = \"proximal_box\""), end = text.find("\n\n", box);
  ASSERT_NE(box, std::string::npos);
  text.replace(
      box, end - box,
      "shape = \"prism\"\nat_mm = [0, 0, -1.5]\nheight_mm = 6\noutline = { kind = \"polygon\", points_mm = [[3.9, -1.6], [6.5, -1.6], "
      "[6.5, 1.6], [3.9, 1.6]] }");
  for (int i = 0; i < 50; ++i) {
    scenarios::Scenario s = scenarios::read_scenario(text, "f").scenario;
    scenarios::ShapeSpec& prism = s.zones.target[1];
    ASSERT_EQ(prism.kind, scenarios::ShapeSpec::Kind::prism);
    prism.at_mm = {draw(-2, 2), draw(-2, 2), draw(-3, 0)};
    prism.axis = normalized(Vec3{draw(-0.5, 0.5), draw(-0.5, 0.5), 1});
    prism.turn_deg = draw(-180, 180);
    prism.outline.centre_mm = {draw(-1, 1), draw(-1, 1), 0};
    const double opening_z_mm = prism.at_mm.z + 0.5 * prism.axis.z * prism.height_mm;
    const AuthorZone zone = author_zones(s, opening_z_mm, {})[1];
    const auto shape = scenarios::ShapeMaker(tooth, "f").make({prism});
    ASSERT_EQ(zone.points_mm.size(), 4u);
    for (const Vec3 p : zone.points_mm) EXPECT_NEAR(shape->distance_mm(zone.in_tooth(p)), 0, 1e-9);
    const Vec3 middle = (zone.points_mm[0] + zone.points_mm[2]) / 2;
    EXPECT_LT(shape->distance_mm(zone.in_tooth(middle)), -0.5) << "and within them is inside";
  }
}

TEST(AuthorWorker, LaysOutTheZonesAndSaysWhatTheCheckSays) {
  ::setenv("CAVUM_DATA", CAVUM_SOURCE_DIR "/data", 1);
  AuthorWorker worker;
  const std::string text = read_text_file(k_class_1);
  const auto findings_of = [&](std::uint64_t version, const std::string& of) {
    const auto asked = std::chrono::steady_clock::now();
    const auto so_far_s = [&] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count();
    };
    worker.look_at({version, 1, of, k_class_1, {}});
    for (;;) {
      auto f = worker.take();
      if (f && f->version == version)
        std::printf("text %d: %s after %.2f s\n", static_cast<int>(version),
                    f->checked ? "check" : "zones", so_far_s());
      if (f && f->checked && f->version == version) return f;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  };
  const auto sound = findings_of(1, text);
  EXPECT_TRUE(sound->problems.empty());
  EXPECT_TRUE(sound->expert_s.has_value());
  ASSERT_NE(sound->tooth, nullptr);
  float low = 1e9F;  // the target's surface ends where the target does, but for the smoothing
  for (const GpuVertex& v : sound->body[0].vertices) low = std::min(low, v.at_mm[2]);
  EXPECT_NEAR(low, sound->target_low_mm.z, 0.1);
  for (std::size_t i = 1; i < k_author_layers; ++i)
    EXPECT_FALSE(sound->body[i].indices.empty()) << i;
  const auto deeper = findings_of(
      4, replaced(text, "depth_mm = 1.8", "depth_mm = 2"));  // the tooth is there already
  EXPECT_LT(deeper->target_low_mm.z, sound->target_low_mm.z - 0.1);
  const auto wrong = findings_of(2, replaced(text, "depth_mm = 1.8", "depth_mm = -1"));
  ASSERT_EQ(wrong->problems.size(), 1u);
  EXPECT_EQ(wrong->problems[0].where.line, 38);
  EXPECT_TRUE(wrong->body[0].indices.empty());
  const auto none = findings_of(3, "title = [");
  EXPECT_FALSE(none->problems.empty());
}

}  // namespace
}  // namespace cavum::station
