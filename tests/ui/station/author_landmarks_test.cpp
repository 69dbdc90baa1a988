// Landmarks moved in the authoring view, from the key to the files: the tooth that is written, the
// zones that follow it, and what the command line says of both.
#include "ui/station/author_landmarks.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/tooth/make/make_molar.h"
#include "scenarios/file/parse.h"
#include "scenarios/zones/zone_map.h"
#include "tests/scenarios/test_teeth.h"
#include "tests/ui/station/author_window.h"
#include "ui/station/author_document.h"
#include "ui/station/author_sight.h"
#include "ui/station/camera.h"

namespace cavum::station {
namespace {

namespace fs = std::filesystem;

const std::string k_premolar = std::string(CAVUM_SOURCE_DIR) + "/data/teeth/upper_premolar.cvt";

Tooth coarse_molar() {
  MolarShape shape;
  shape.leaf_mm = 0.1;
  return make_molar(shape);
}

/// A class I task beside a tooth of its own; both made once.
class LandmarkWindow : public AuthorWindow {
 protected:
  void SetUp() override {
    AuthorWindow::SetUp();
    if (IsSkipped()) return;
    static const Tooth k_molar = coarse_molar();
    save_tooth_file(k_molar, tooth());
    static std::string text;
    if (text.empty()) {
      write_task(tooth());
      text = read_text_file(file());
    }
    write_text_file(file(), text);
  }
  void write_task(const std::string& on) const {
    const std::string command = CAVUM_BINARY " scenario new --tooth " + on +
                                " --task class_1 --untried --out " + file() + " >" +
                                folder_.file("out");
    fs::remove(file());
    ASSERT_EQ(std::system(command.c_str()), 0);
  }
  [[nodiscard]] std::string tooth() const { return folder_.file("own.cvt"); }
  /// As many times Tab as lead to the landmark.
  [[nodiscard]] std::string go_to(const std::string& name, const std::string& tooth_file) const {
    std::string keys = "key l\n";
    for (const NamedPoint& p : named_points(find_landmarks(load_tooth_file(tooth_file)))) {
      if (p.name == name) return keys;
      keys += "key tab\n";
    }
    ADD_FAILURE() << "no " << name;
    return "";
  }
  [[nodiscard]] nlohmann::json told_of(const std::string& tooth_file) const {
    EXPECT_EQ(std::system((CAVUM_BINARY " tooth landmarks " + tooth_file + " --json >" +
                           folder_.file("json"))
                              .c_str()),
              0);
    return nlohmann::json::parse(read_text_file(folder_.file("json")));
  }
  [[nodiscard]] int check() const {
    return std::system(
        (CAVUM_BINARY " scenario check --no-trial " + file() + " >" + folder_.file("out")).c_str());
  }
};

constexpr const char* k_save = "hold ctrl\nkey s\nrelease ctrl\nsleep 0.4\n";

Vec3 place_of(const Tooth& tooth, const std::string& name) {
  for (const NamedPoint& p : named_points(find_landmarks(tooth)))
    if (p.name == name) return p.at_mm;
  ADD_FAILURE() << "no " << name;
  return {};
}

/// Where the target ends towards mesial: its outermost leaf's x, and the middle y of its last 0.3
/// mm.
Vec3 mesial_end_mm(const scenarios::Scenario& s, const Tooth& tooth) {
  const scenarios::ZoneMap zones = scenarios::build_zones(s, tooth);
  double sum = 0, n = 0;
  const double end = zones.target_high_mm().x;
  zones.for_each_leaf([&](IVec3 leaf, scenarios::Zone zone) {
    const Vec3 p = zones.centre_mm(leaf);
    if (zone != scenarios::Zone::target || p.x < end - 0.3) return;
    sum += p.y;
    ++n;
  });
  return {end, sum / n, 0};
}

TEST_F(LandmarkWindow, AMovedPitTakesTheClassIZoneWithItIntoTheFilesAndTheCommandLineAgrees) {
  const Tooth before = load_tooth_file(tooth());
  const Vec3 pit = place_of(before, "mesial_pit");
  // seen from occlusal, buccal lies down the picture and distal to its right
  std::string keys;
  for (int i = 0; i < 18; ++i) keys += "key right\n";
  for (int i = 0; i < 4; ++i) keys += "key down\n";
  EXPECT_EQ(run("wait author\nsleep 0.3\n" + go_to("mesial_pit", tooth()) +
                "sleep 0.2\npicture 27-author-landmarks\n" + keys +
                "wait author-busy\nwait author\nsleep 0.3\n"
                "picture 28-author-pit-moved\n" +
                k_save + "key escape\n"),
            0)
      << said();
  const Tooth after = load_tooth_file(tooth());
  ASSERT_EQ(after.placed_landmarks.size(), 1u);
  const NamedPoint put = after.placed_landmarks[0];
  EXPECT_EQ(put.name, "mesial_pit");
  EXPECT_NEAR(put.at_mm.x, pit.x - 1.8, 1e-3);
  EXPECT_NEAR(put.at_mm.y, pit.y + 0.4, 1e-3);
  Octree::Cursor cursor;
  EXPECT_NEAR(after.octree.sample(put.at_mm, cursor).distance_mm, 0, 0.002)
      << "it stays on the surface";
  Tooth bare;
  bare.octree = after.octree;
  bare.tissues = after.tissues;
  EXPECT_EQ(tooth_hash(bare), tooth_hash(before)) << "and nothing else of the tooth differs";
  EXPECT_EQ(read_file(tooth() + ".before"), save_tooth(before));

  const nlohmann::json told = told_of(tooth());
  EXPECT_EQ(told["moved"], nlohmann::json({"mesial_pit"}));
  EXPECT_NEAR(told["points_mm"]["mesial_pit"][1].get<double>(), put.at_mm.y, 1e-3);
  EXPECT_EQ(check(), 0) << read_text_file(folder_.file("out"));
  const scenarios::Scenario s = scenarios::parse_scenario(read_text_file(file()), file());
  const Vec3 was = mesial_end_mm(s, before), is = mesial_end_mm(s, after);
  constexpr double k_half_width_mm = 0.7;  // of the task's stroke, whose end is round
  EXPECT_NEAR(is.x, put.at_mm.x + k_half_width_mm, 0.1) << "the cavity ends at the pit";
  EXPECT_LT(is.x, was.x - 0.2);
  EXPECT_NEAR(is.y, put.at_mm.y, 0.1);
}

TEST_F(LandmarkWindow, AToothThatShipsStaysAsItIsAndTheScenarioNamesANewOne) {
  write_task(k_premolar);
  const std::string before = read_text_file(file());
  const Bytes shipped = read_file(k_premolar);
  EXPECT_EQ(
      run("wait author\n" + go_to("distal_pit", k_premolar) + "key up\n" + k_save +
          "picture 29-author-new-tooth\nkey enter\nsleep 0.4\n" + "wait author\nkey escape\n"),
      0)
      << said();
  EXPECT_EQ(read_file(k_premolar), shipped);
  EXPECT_EQ(read_text_file(file()),
            replaced(before, "\"upper_premolar.cvt\"", "\"upper_premolar_class_1.cvt\""));
  const Tooth made = load_tooth_file(folder_.file("upper_premolar_class_1.cvt"));
  ASSERT_EQ(made.placed_landmarks.size(), 1u);
  EXPECT_NEAR(made.placed_landmarks[0].at_mm.y,
              place_of(load_tooth_file(k_premolar), "distal_pit").y - 0.1, 1e-3);
  EXPECT_EQ(check(), 0);
}

/// As the view looks at first, in a window of 1280 x 800.
AuthorSight first_sight(const scenarios::Scenario& s, const Tooth& tooth) {
  const scenarios::ZoneMap zones = scenarios::build_zones(s, tooth);
  const Vec3 middle = (zones.target_low_mm() + zones.target_high_mm()) / 2;
  Camera camera;
  camera.look_from_occlusal();
  camera.distance_mm = 30;
  camera.target_mm = {static_cast<float>(middle.x), static_cast<float>(middle.y),
                      static_cast<float>(middle.z)};
  const ImVec2 size{950, 574};
  return {camera.projection(size.x / size.y) * camera.view(), {0, 76}, size};
}

TEST_F(LandmarkWindow, TheMousePullsALandmarkOverTheSurface) {
  const Tooth before = load_tooth_file(tooth());
  const AuthorSight sight =
      first_sight(scenarios::parse_scenario(read_text_file(file()), file()), before);
  const Vec3 pit = place_of(before, "central_pit");
  const ImVec2 is = sight.pixel(pit);
  const auto mouse = [&](float across, float down, const char* button) {
    return fmt::format("mouse {:.0f} {:.0f}{}\nsleep 0.15\n", is.x + across, is.y + down, button);
  };
  // taken beside its middle; a click alone moves nothing
  const std::string click = mouse(4, 3, "") + mouse(4, 3, " pressed") + mouse(4, 3, "");
  EXPECT_EQ(run("wait author\nsleep 0.3\n" + click + "key x\n" + k_save + "key escape\n"), 0)
      << said();
  EXPECT_EQ(load_tooth_file(tooth()).placed_landmarks.size(), 0u);
  EXPECT_EQ(
      run("wait author\nsleep 0.3\n" + click + mouse(4, 3, " pressed") + mouse(14, -5, " pressed") +
          mouse(30, -20, " pressed") + mouse(44, -27, " pressed") + mouse(44, -27, "") +
          "wait author-busy\nwait author\nsleep 0.2\npicture 30-author-pit-pulled\n" + k_save +
          "key escape\n"),
      0)
      << said();
  const Tooth after = load_tooth_file(tooth());
  ASSERT_EQ(after.placed_landmarks.size(), 1u);
  EXPECT_EQ(after.placed_landmarks[0].name, "central_pit");
  const ImVec2 now = sight.pixel(after.placed_landmarks[0].at_mm);
  EXPECT_NEAR(now.x, is.x + 40, 1.5);
  EXPECT_NEAR(now.y, is.y - 30, 1.5);
  Octree::Cursor cursor;
  EXPECT_NEAR(after.octree.sample(after.placed_landmarks[0].at_mm, cursor).distance_mm, 0, 0.002);
}

TEST_F(LandmarkWindow, UndoRedoAndXTakeBackWhatWasMoved) {
  const Bytes before = read_file(tooth());
  const std::string text = read_text_file(file());
  EXPECT_EQ(
      run("wait author\n" + go_to("central_pit", tooth()) +
          "key right\nkey down\nhold ctrl\nkey z\nkey z\nkey y\nkey z\nrelease ctrl\nkey up\nkey x\nkey x\nkey f6\nsleep 0.2\n"
          "picture 31-author-landmarks-hidden\nwait author\n" +
          k_save + "key escape\n"),
      0)
      << said();
  EXPECT_EQ(read_file(tooth()), before) << "all was taken back";
  EXPECT_EQ(read_text_file(file()), text);
  EXPECT_FALSE(fs::exists(tooth() + ".before"));
  EXPECT_EQ(run("wait author\n" + go_to("central_pit", tooth()) +
                "key right\nkey down\nhold ctrl\nkey z\nkey z\nkey y\nrelease ctrl\n" + k_save +
                "key escape\n"),
            0)
      << said();
  const Tooth after = load_tooth_file(tooth());
  ASSERT_EQ(after.placed_landmarks.size(), 1u);
  const Vec3 pit = place_of(load_tooth(before, "before"), "central_pit");
  EXPECT_NEAR(after.placed_landmarks[0].at_mm.x, pit.x - 0.1, 1e-3)
      << "one of two steps: to the right, which is distal";
  EXPECT_NEAR(after.placed_landmarks[0].at_mm.y, pit.y, 1e-3);
}

/// A scenario in a folder of its own, on a tooth beside it.
class LandmarkDocument : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_.file("data/teeth"));
    ::setenv("CAVUM_DATA", folder_.file("data").c_str(), 1);
    save_tooth_file(testing::dentin_block(2, 2, 0.2), tooth());
    save_tooth_file(testing::dentin_block(2, 2, 0.2), shipped());
    write_text_file(file(), text_on("own.cvt"));
  }
  void TearDown() override { ::unsetenv("CAVUM_DATA"); }
  [[nodiscard]] std::string file() const { return folder_.file("mine.toml"); }
  [[nodiscard]] std::string tooth() const { return folder_.file("own.cvt"); }
  [[nodiscard]] std::string shipped() const { return folder_.file("data/teeth/ships.cvt"); }
  [[nodiscard]] static std::string text_on(const std::string& tooth) {
    return "# mine\n" +
           replaced(read_text_file(k_class_1), "\"lower_molar.cvt\"", "\"" + tooth + "\"");
  }
  [[nodiscard]] static std::vector<NamedPoint> pit_at(double x) {
    return {{"central_pit", {x, 0, 0}}};
  }
  [[nodiscard]] std::vector<NamedPoint> on_disk(const std::string& name) const {
    return load_tooth_file(folder_.file(name)).placed_landmarks;
  }
  testing_basics::Folder folder_;
};

TEST_F(LandmarkDocument, WritesAToothOfItsOwnAnewAndKeepsHowItWas) {
  const Bytes first = read_file(tooth());
  AuthorDocument d(file());
  d.put(pit_at(0.5), "pull");
  d.put(pit_at(1), "pull");
  EXPECT_TRUE(d.unsaved());
  EXPECT_EQ(d.new_tooth_name(), std::nullopt);
  d.save();
  EXPECT_FALSE(d.unsaved());
  EXPECT_EQ(on_disk("own.cvt"), pit_at(1));
  EXPECT_EQ(read_text_file(file()), text_on("own.cvt"));
  EXPECT_TRUE(d.undo());
  EXPECT_TRUE(d.landmarks().empty()) << "a pull is one step, and what was saved can be taken back";
  d.save();
  EXPECT_EQ(read_file(tooth()), first);
  EXPECT_TRUE(d.redo());
  d.save();
  EXPECT_EQ(on_disk("own.cvt"), pit_at(1));
  EXPECT_EQ(read_file(tooth() + ".before"), first) << "as it was before the first of all savings";
}

TEST_F(LandmarkDocument, NeverWritesAToothThatShipsOrLiesElsewhere) {
  const Bytes before = read_file(shipped());
  fs::create_symlink(shipped(), folder_.file("link.cvt"));
  fs::create_directory(folder_.file("other"));
  fs::copy(tooth(), folder_.file("other/far.cvt"));
  for (const std::string name : {"ships.cvt", "link.cvt", "other/far.cvt"}) {
    write_text_file(file(), text_on(name));
    fs::remove(folder_.file("new.cvt"));
    AuthorDocument d(file());
    d.put(pit_at(1), "");
    ASSERT_TRUE(d.new_tooth_name().has_value()) << name;
    EXPECT_THROW(d.save(), Error) << name;
    EXPECT_THROW(d.save("../new.cvt"), Error) << "a name without folders";
    EXPECT_THROW(d.save("own.cvt"), Error) << "there is one of that name";
    EXPECT_EQ(read_text_file(file()), text_on(name));
    d.save("new.cvt");
    EXPECT_EQ(read_text_file(file()), text_on("new.cvt")) << name;
    EXPECT_EQ(on_disk("new.cvt"), pit_at(1));
    EXPECT_FALSE(d.unsaved());
    d.put(pit_at(1.5), "");
    EXPECT_EQ(d.new_tooth_name(), std::nullopt) << "the new one is the scenario's own";
    d.save();
    EXPECT_EQ(on_disk("new.cvt"), pit_at(1.5));
    while (d.undo()) {
    }
    EXPECT_EQ(d.text(), text_on(name));
    d.save();
    EXPECT_EQ(read_text_file(file()), text_on(name))
        << "back on the tooth that ships, whose landmarks are as they were";
    EXPECT_EQ(on_disk("new.cvt"), pit_at(1.5));
  }
  EXPECT_EQ(read_file(shipped()), before);
  EXPECT_TRUE(on_disk("other/far.cvt").empty());
  EXPECT_TRUE(on_disk("own.cvt").empty());
}

TEST_F(LandmarkDocument, AToothInTheFolderOfTeethThatShipIsNotWrittenAnew) {
  fs::copy(tooth(), folder_.file("data/teeth/own.cvt"));
  const std::string here = folder_.file("data/teeth/mine.toml");
  write_text_file(here, text_on("own.cvt"));
  AuthorDocument d(here);
  d.put(pit_at(1), "");
  EXPECT_EQ(d.new_tooth_name(), "own_mine.cvt");
  EXPECT_THROW(d.save(), Error);
  EXPECT_TRUE(on_disk("data/teeth/own.cvt").empty());
}

TEST_F(LandmarkDocument, DoesNotOverwriteWhatSomebodyElseWroteToTheTooth) {
  AuthorDocument d(file());
  d.put(pit_at(1), "");
  Tooth theirs = load_tooth_file(tooth());
  theirs.placed_landmarks = pit_at(-1);
  save_tooth_file(theirs, tooth());
  EXPECT_THROW(d.save(), Error);
  EXPECT_EQ(on_disk("own.cvt"), pit_at(-1));
  d.read_again();
  EXPECT_EQ(d.landmarks(), pit_at(-1));
  EXPECT_FALSE(d.unsaved());
  EXPECT_TRUE(d.undo());
  EXPECT_EQ(d.landmarks(), pit_at(1)) << "reading again loses nothing";
  d.save();
  EXPECT_EQ(on_disk("own.cvt"), pit_at(1));
}

TEST_F(LandmarkDocument, WhatIsUnsavedIsKeptAsideWithItsPoints) {
  AuthorDocument d(file());
  d.put(pit_at(1), "");
  (void)d.keep_aside();
  EXPECT_TRUE(on_disk("own.cvt").empty());
  EXPECT_EQ(on_disk("mine.toml.unsaved.cvt"), pit_at(1));
}

TEST_F(LandmarkDocument, WithoutAToothThereAreNoLandmarksAndNoneAreLost) {
  Tooth with = load_tooth_file(tooth());
  with.placed_landmarks = pit_at(1);
  fs::remove(tooth());
  AuthorDocument d(file());
  EXPECT_THROW(d.put(pit_at(2), ""), Error);
  d.make(scenarios::set_number(d.text(), file(), "time_limit_s", 500), "");
  save_tooth_file(with, tooth());
  d.save();
  EXPECT_EQ(on_disk("own.cvt"), pit_at(1));
  d.read_again();
  EXPECT_EQ(d.landmarks(), pit_at(1));
  while (d.undo()) {
  }
  EXPECT_EQ(d.landmarks(), pit_at(1)) << "what was not known at first is no change";
}

TEST(AuthorLandmarks, APersonsPointStandsApartAndIsTakenBack) {
  Landmarks found;
  found.central_pit_mm = Vec3{0, 0, 1};
  found.cusps = {{"buccal", {0, 2, 2}, 1.0}};
  const std::vector<NamedPoint> put =
      with_landmark(with_landmark({}, "cusp_2", {0, -2, 2}), "central_pit", {0.10049, 0, 1});
  const std::vector<AuthorLandmark> marks = author_landmarks(found, put);
  ASSERT_EQ(marks.size(), 3u);
  EXPECT_FALSE(marks[0].by_person);
  EXPECT_TRUE(marks[1].by_person);
  EXPECT_FALSE(marks[1].found_mm.has_value());
  EXPECT_EQ(marks[2].title().english, "central pit");
  EXPECT_EQ(*marks[2].found_mm, *found.central_pit_mm);
  EXPECT_EQ(marks[2].at_mm, (Vec3{0.1, 0, 1})) << "to a thousandth";
  EXPECT_EQ(author_landmarks(found, without_landmark(put, "central_pit", found))[2].at_mm,
            *found.central_pit_mm);
  EXPECT_EQ(with_landmark(put, "cusp_2", {0, -2, 2}), put)
      << "in its place: the tooth's bytes stay";
  EXPECT_THROW((void)without_landmark(with_landmark(put, "cusp_3", {1, 1, 1}), "cusp_2", found),
               Error)
      << "cusp 3 would have no place";
}

TEST(AuthorLandmarks, ALineOfSightMeetsTheOutsideOrThePulp) {
  // a ball of dentin of 3 mm with a ball of pulp of 1 mm in it
  const Tooth ball = testing::make_tooth(
      {-4, -4, -4}, {4, 4, 4}, 0.1,
      [](Vec3 p) -> std::uint8_t {
        return length(p) < 1 ? k_pulp : length(p) < 3 ? k_dentin : k_air;
      },
      [](Vec3 p) { return std::max(length(p) - 3, 1 - length(p)); });
  const testing_basics::Folder folder;
  save_tooth_file(ball, folder.file("ball.cvt"));
  const AuthorTooth tooth = read_author_tooth(folder.file("ball.cvt"));
  const Vec3 eye{5, 12, 27}, is{0, 0.5, 0};
  for (double a = 0; a < 6; a += 0.37) {
    const Vec3 way = normalized(Vec3{0.6 * std::cos(a), 0.6 * std::sin(a), 0} - eye);
    const auto entry = [&](double radius) {
      const double along = -dot(eye, way), off2 = dot(eye, eye) - along * along;
      return eye + way * (along - std::sqrt(radius * radius - off2));
    };
    const auto pit = landmark_in_sight(tooth, "central_pit", eye, way, is),
               horn = landmark_in_sight(tooth, "pulp_horn_1", eye, way, is),
               mouth = landmark_in_sight(tooth, "canal_mouth_1", eye, way, is);
    ASSERT_TRUE(pit && horn && mouth);
    EXPECT_LT(length(*pit - entry(3)), 0.02);
    EXPECT_LT(length(*horn - entry(1)), 0.15) << "known to a leaf";
    EXPECT_NEAR(dot(*mouth - is, way), 0, 1e-9) << "as far away as it is";
  }
  EXPECT_FALSE(landmark_in_sight(tooth, "central_pit", eye, normalized(Vec3{3.2, -1, 0} - eye), is)
                   .has_value())
      << "beside the tooth";
  EXPECT_TRUE(hidden_in_tooth(tooth, {0, 0, 30}, {0, 0, -3}));
  EXPECT_FALSE(hidden_in_tooth(tooth, {0, 0, 30}, {0, 0, 3}));
}

}  // namespace
}  // namespace cavum::station
