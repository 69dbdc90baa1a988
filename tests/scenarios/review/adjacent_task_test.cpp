// What a task asks for where a tooth stands beside its own.
#include "scenarios/review/adjacent_task.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/tooth/adjacent.h"
#include "engine/tooth/make/add_adjacent.h"
#include "engine/tooth/make/make_premolar.h"
#include "scenarios/review/check.h"
#include "scenarios/review/tooth_task.h"
#include "scenarios/zones/zone_map.h"

namespace cavum::scenarios {
namespace {

const Tooth& premolar_alone() {
  static const Tooth tooth = [] {
    PremolarShape shape;
    shape.leaf_mm = 0.1;
    return make_premolar(shape);
  }();
  return tooth;
}
const Tooth& premolar_in_row() {
  static const Tooth tooth = [] {
    AdjacentSpec spec;
    spec.mesial.tooth = &premolar_alone();
    spec.gum = true;
    return add_adjacent(premolar_alone(), spec, "here").tooth;
  }();
  return tooth;
}

TEST(AdjacentTask, CriteriaFollowWhatStandsThere) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(adjacent_criteria(premolar_alone(), 1), Names{});
  EXPECT_EQ(adjacent_criteria(premolar_in_row(), 1),
            (Names{"neighbour_criterion", "clearance_criterion", "gum_criterion"}));
  EXPECT_EQ(adjacent_criteria(premolar_in_row(), -1),
            (Names{"neighbour_criterion", "gum_criterion"}));
  EXPECT_TRUE(neighbour_stands(premolar_in_row(), 1));
  EXPECT_FALSE(neighbour_stands(premolar_in_row(), -1));
}

TEST(AdjacentTask, ABoxGoesDownAndOutUntilItComesClear) {
  const Landmarks marks = find_landmarks(premolar_alone());
  const ContactBox wanted{2.2, 3.4};
  const ContactBox alone = box_beside(premolar_alone(), marks, 1, wanted, 0.8, 4.0),
                   clear = box_beside(premolar_in_row(), marks, 1, wanted, 0.8, 4.0);
  EXPECT_EQ(alone.width_mm, wanted.width_mm);
  EXPECT_FALSE(alone.shell);
  EXPECT_LT(clear.above_neck_mm, wanted.above_neck_mm);
  EXPECT_GT(clear.width_mm, wanted.width_mm);
  EXPECT_TRUE(clear.shell);
}

TEST(AdjacentTask, TheTargetHoldsNothingOfWhatStandsBeside) {
  const std::string file =
      (std::filesystem::temp_directory_path() / "cavum_beside_task.cvt").string();
  save_tooth_file(premolar_in_row(), file);
  const WrittenTask written = write_tooth_task(premolar_in_row(), find_landmarks(premolar_in_row()),
                                               file, "here.toml", "slot_mesial");
  const CheckedScenario checked = check_whole(written.text, "here.toml");
  std::filesystem::remove(file);
  ASSERT_TRUE(checked.sound());
  const ZoneMap& zones = checked.laid->zones;
  const TissueSet beside = adjacent_tissues(premolar_in_row());
  std::uint64_t in_a_zone = 0;
  zones.for_each_leaf([&](IVec3 leaf, Zone zone) {
    in_a_zone += zone != Zone::none && beside[premolar_in_row().octree.tissue(leaf)] ? 1 : 0;
  });
  EXPECT_EQ(in_a_zone, 0u);
  for (const char* text : {"combine = \"subtract\"", "neighbour_nick_depth_mm",
                           "proximal_clearance_mm", "gum_removed_mm3"})
    EXPECT_NE(written.text.find(text), written.text.npos) << text;
  EXPECT_TRUE(zones.target_is_open());
}

}  // namespace
}  // namespace cavum::scenarios
