// What is guessed and unsure of a tooth comes back from its source, whatever later verbs add to it.
#include "engine/tooth/tooth_notes.h"

#include <gtest/gtest.h>

namespace cavum {
namespace {

using Lines = std::vector<std::string>;

TEST(ToothNotes, ComeBackInOrderWhateverStandsAroundThem) {
  Tooth tooth;
  tooth.source = "import of meshes a.stl; unit assumed mm";
  add_guess(tooth, "class molar: 3 cusps; crown 11 x 10 mm");
  note_mirror_image(tooth);
  add_warning(tooth, "mesial was not said");
  tooth.source += "; mesial lesion at [1, 2, 3] mm";
  add_warning(tooth, "confirmed (neighbours): no tooth stands there");
  const ToothNotes notes = notes_of(tooth);
  EXPECT_EQ(notes.guesses, (Lines{"class molar: 3 cusps, crown 11 x 10 mm"}));
  EXPECT_EQ(notes.warnings, (Lines{"mesial was not said", "confirmed (neighbours): no tooth stands there"}));
  EXPECT_TRUE(notes.mirror_image);
}

TEST(ToothNotes, AToothOfNoImportHasNone) {
  Tooth tooth;
  tooth.source = "make molar; a mirror image of nothing; my guess: none";
  const ToothNotes notes = notes_of(tooth);
  EXPECT_TRUE(notes.guesses.empty() && notes.warnings.empty());
  EXPECT_FALSE(notes.mirror_image);
}

}  // namespace
}  // namespace cavum
