// Tasks for a tooth file: what is offered, and that what is written is sound on its tooth.
#include "scenarios/review/tooth_task.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/tooth_notes.h"
#include "scenarios/review/check.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

std::string file_of(const char* tooth) { return testing_basics::data_path(std::string("teeth/") + tooth); }

TEST(ToothTask, AFrontToothAndABlockAreOfferedWhatMakesSense) {
  for (const auto& [file, least, most] : {std::tuple("lower_molar.cvt", 11, 11), std::tuple("upper_premolar.cvt", 11, 11),
                                          std::tuple("upper_incisor.cvt", 6, 6), std::tuple("block.cvt", 0, 1)}) {
    const Tooth tooth = load_tooth_file(file_of(file));
    int offered = 0;
    for (const auto& t : offered_tasks(tooth, find_landmarks(tooth))) offered += t.why_not.empty() ? 1 : 0;
    EXPECT_GE(offered, least) << file;
    EXPECT_LE(offered, most) << file;
  }
}

TEST(ToothTask, WhatIsWrittenIsSoundAndFollowsTheLandmarks) {
  for (const auto& [file, task, relation] : {std::tuple("lower_molar.cvt", "class_1", "kind = \"fissure\", width_mm = 1.4"),
                                             std::tuple("upper_premolar.cvt", "slot_mesial", "shape = \"proximal_box\"\nside"),
                                             std::tuple("upper_incisor.cvt", "access", "lean = \"lingual\""),
                                             std::tuple("lower_molar.cvt", "class_5", "shape = \"side_cavity\"\nside = \"buccal\""),
                                             std::tuple("upper_incisor.cvt", "dexterity_cross", "heights = \"level\"")}) {
    const Tooth tooth = load_tooth_file(file_of(file));
    const WrittenTask written = write_tooth_task(tooth, find_landmarks(tooth), file_of(file), "here.toml", task);
    const CheckedScenario checked = check_whole(written.text, "here.toml");
    EXPECT_TRUE(checked.sound()) << file << " " << task;
    EXPECT_GE(checked.expert.reach, 0.895) << file << " " << task;
    EXPECT_FALSE(written.chosen.empty());
    EXPECT_NE(written.text.find(relation), std::string::npos) << written.text;
  }
}

TEST(ToothTask, PitsThatAPersonPutMakeAFissureWhereNoneWasFound) {
  Tooth tooth = load_tooth_file(file_of("block.cvt"));
  EXPECT_FALSE(offered_tasks(tooth, find_landmarks(tooth))[0].why_not.empty());
  tooth.placed_landmarks = {{"mesial_pit", {1.5, 0.5, 0}}, {"distal_pit", {-1.5, -0.5, 0}}};
  const Landmarks landmarks = find_landmarks(tooth);
  ASSERT_GE(landmarks.central_fissure_mm.size(), 2u);
  for (const Vec3& p : landmarks.central_fissure_mm) EXPECT_NEAR(p.y, p.x / 3, 1e-9);
  EXPECT_TRUE(offered_tasks(tooth, landmarks)[0].why_not.empty());
}

TEST(ToothTask, WhatIsGuessedOfTheToothStandsInTheTask) {
  Tooth tooth = load_tooth_file(file_of("upper_premolar.cvt"));
  add_guess(tooth, "mesial towards +x: by three signs");
  add_warning(tooth, "whether it is tooth 15 could not be checked");
  const std::string text = write_tooth_task(tooth, find_landmarks(tooth), file_of("upper_premolar.cvt"), "here.toml", "slot_mesial").text;
  EXPECT_NE(text.find("\n# Guessed by its shape: mesial towards +x: by three signs\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n# Notice: whether it is tooth 15 could not be checked\n"), std::string::npos) << text;
}

TEST(ToothTask, WhatMakesNoSenseIsRefused) {
  const Tooth incisor = load_tooth_file(file_of("upper_incisor.cvt"));
  EXPECT_THROW(static_cast<void>(write_tooth_task(incisor, find_landmarks(incisor), "i.cvt", "here.toml", "class_1")), Error);
  EXPECT_THROW(static_cast<void>(write_tooth_task(incisor, {}, "i.cvt", "here.toml", "class_9")), Error);
}

TEST(ToothTask, ATaskThatNoPointReachesEnoughOfIsRefused) {
  PremolarShape shape;
  shape.leaf_mm = 0.2;  // margins of two leaves on either side of a groove of 1.2 mm
  const Tooth tooth = make_premolar(shape);
  const testing_basics::Folder folder;
  save_tooth_file(tooth, folder.file("p.cvt"));
  try {
    static_cast<void>(write_tooth_task(tooth, find_landmarks(tooth), folder.file("p.cvt"), "here.toml", "dexterity_groove"));
    FAIL() << "it was written";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("no point of its tray reaches more than"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace cavum::scenarios
