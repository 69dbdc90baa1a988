// Tasks for a tooth file: what is offered, and that what is written is sound on its tooth.
#include "scenarios/review/tooth_task.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "engine/base/error.h"
#include "engine/tooth/make/make_premolar.h"
#include "scenarios/exam/exam.h"
#include "scenarios/review/check.h"
#include "scenarios/review/ridge_margins.h"
#include "scenarios/review/task_texts.h"
#include "tests/engine/support/basics.h"

namespace cavum::scenarios {
namespace {

std::string file_of(const char* tooth) {
  return testing_basics::data_path(std::string("teeth/") + tooth);
}

TEST(ToothTask, AFrontToothAndABlockAreOfferedWhatMakesSense) {
  for (const auto& [file, least, most] :
       {std::tuple("lower_molar.cvt", 11, 11), std::tuple("upper_premolar.cvt", 11, 11),
        std::tuple("upper_incisor.cvt", 6, 6), std::tuple("block.cvt", 0, 1)}) {
    const Tooth tooth = load_tooth_file(file_of(file));
    int offered = 0;
    for (const auto& t : offered_tasks(tooth, find_landmarks(tooth)))
      offered += t.why_not.empty() ? 1 : 0;
    EXPECT_GE(offered, least) << file;
    EXPECT_LE(offered, most) << file;
  }
}

TEST(ToothTask, EveryTaskHasItsTextsAndEveryTextItsTask) {
  std::set<std::string> files{"common"};
  for (const auto& word : tooth_task_words()) files.insert(word);
  for (const auto& word : block_task_words()) files.insert("block_" + word);
  const auto there = data_names("tasks", "");
  EXPECT_EQ(files, std::set<std::string>(there.begin(), there.end()));
}

TEST(ToothTask, WhatIsWrittenIsSoundAndFollowsTheLandmarks) {
  for (const auto& [file, task, relation] :
       {std::tuple("lower_molar.cvt", "class_1", "kind = \"fissure\", width_mm = 1.4"),
        std::tuple("upper_premolar.cvt", "slot_mesial", "shape = \"proximal_box\"\nside"),
        std::tuple("upper_incisor.cvt", "access", "lean = \"lingual\""),
        std::tuple("lower_molar.cvt", "class_5", "shape = \"side_cavity\"\nside = \"buccal\""),
        std::tuple("upper_incisor.cvt", "dexterity_cross", "heights = \"level\"")}) {
    const Tooth tooth = load_tooth_file(file_of(file));
    const WrittenTask written =
        write_tooth_task(tooth, find_landmarks(tooth), file_of(file), "here.toml", task);
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

/// A fissure along x, 8 mm long, with a ridge across each end.
Landmarks straight_fissure() {
  Landmarks l;
  l.central_fissure_mm = {{4, 0, 0}, {2, 0, 0}, {0, 0, 0}, {-2, 0, 0}, {-4, 0, 0}};
  l.mesial_ridge = {{{5, 2, 1}, {5, 0, 0.5}, {5, -2, 1}}, Vec3{5, 0, 0.5}};
  l.distal_ridge = {{{-5, 2, 1}, {-5, 0, 0.5}, {-5, -2, 1}}, Vec3{-5, 0, 0.5}};
  return l;
}

TEST(RidgeMargins, TakeInThePitsAndLeaveTheCrests) {
  Landmarks l = straight_fissure();
  auto margins = ridge_margins(l, 1.4, 0);
  ASSERT_EQ(margins.may.size(), 4u);
  EXPECT_NEAR(margins.may[0].ridge_mm, 1.6, 1e-9);
  EXPECT_NEAR(margins.may[0].left_mm, 1.6, 1e-6);
  l.mesial_pit_mm = Vec3{4.0, 0.1, 0};  // 1.0 mm from the crest: 1.2 mm of ridge would leave it
  margins = ridge_margins(l, 1.4, 0);
  ASSERT_EQ(margins.may.size(), 2u);
  EXPECT_NEAR(margins.may[0].ridge_mm, 0.9, 1e-9);
  EXPECT_EQ(margins.pits_left, (std::array{false, false}));
  EXPECT_EQ(ridge_margins(l, 1.4, 1).may.size(), 4u);  // through that ridge the pit goes, too
  l.mesial_pit_mm = Vec3{3.0, 0.9, 0};                 // beside the outline, however far it goes
  margins = ridge_margins(l, 1.4, 0);
  EXPECT_EQ(margins.may.size(), 4u);
  EXPECT_EQ(margins.pits_left, (std::array{true, false}));
}

TEST(RidgeMargins, ACrestThatRunsIntoTheFissureIsNoRidgeThatIsLeft) {
  Landmarks l = straight_fissure();
  l.mesial_ridge.crest_mm = {
      {5, 2, 1}, {5, 0, 0.5}, {3, 0.5, 0}, {2, 1.0, 0.5}};  // down a cusp, into the fossa
  const auto margins = ridge_margins(l, 1.4, 0);
  EXPECT_TRUE(margins.may.empty());
  EXPECT_EQ(testing_basics::figures_in(margins.why_none).size(), 1u) << "how near the ridge comes";
  EXPECT_FALSE(ridge_margins(l, 1.4, 1).may.empty());
}

TEST(ToothTask, WhatIsGuessedOfTheToothStandsInTheTask) {
  Tooth tooth = load_tooth_file(file_of("upper_premolar.cvt"));
  tooth.notes.push_back({ToothNote::Kind::guess, Name{"by three signs"}});
  tooth.notes.push_back({ToothNote::Kind::warning, Name{"is it tooth 15"}});
  const std::string text =
      write_tooth_task(tooth, find_landmarks(tooth), file_of("upper_premolar.cvt"), "here.toml",
                       "slot_mesial")
          .text;
  EXPECT_NE(text.find(": by three signs\n"), std::string::npos) << text;
  EXPECT_NE(text.find(": is it tooth 15\n"), std::string::npos) << text;
}

TEST(ToothTask, WhatIsWrittenHasItsWordsInAnotherLanguageToo) {
  const Tooth tooth = load_tooth_file(file_of("lower_molar.cvt"));
  const TaskLanguage shout{"qps", [](const Message& m) { return "\"" + english_text(m) + "\""; }};
  const std::string text =
      write_tooth_task(tooth, find_landmarks(tooth), file_of("lower_molar.cvt"), "here.toml",
                       "class_1", {}, shout)
          .text;
  const Scenario s = parse_scenario(text, "here.toml");
  ASSERT_EQ(s.languages.count("qps"), 1u);
  const auto& words = s.languages.at("qps");
  for (const std::string& english :
       {s.title, s.description, s.steps.at(0).instruction, s.rubric.criteria.at(0).title})
    EXPECT_EQ(words.at(english), "\"" + english + "\"");
}

TEST(ToothTask, WhatMakesNoSenseIsRefused) {
  const Tooth incisor = load_tooth_file(file_of("upper_incisor.cvt"));
  EXPECT_THROW(static_cast<void>(write_tooth_task(incisor, find_landmarks(incisor), "i.cvt",
                                                  "here.toml", "class_1")),
               Error);
  EXPECT_THROW(static_cast<void>(write_tooth_task(incisor, {}, "i.cvt", "here.toml", "class_9")),
               Error);
}

TEST(ToothTask, ATaskThatNoBurReachesEnoughOfIsRefused) {
  PremolarShape shape;
  shape.leaf_mm = 0.2;  // margins of two leaves on either side of a groove of 1.2 mm
  const Tooth tooth = make_premolar(shape);
  const testing_basics::Folder folder;
  save_tooth_file(tooth, folder.file("p.cvt"));
  EXPECT_EQ(testing_basics::code_of([&] {
              static_cast<void>(write_tooth_task(tooth, find_landmarks(tooth), folder.file("p.cvt"),
                                                 "here.toml", "dexterity_groove"));
            }),
            Mistake::unreachable);
}

}  // namespace
}  // namespace cavum::scenarios
