// An exam keeps the landmarks that its zones were laid by: whoever finds others later still has its
// ground.
#include <gtest/gtest.h>

#include "engine/base/file.h"
#include "engine/session/session_reader.h"
#include "engine/tooth/anatomy/landmarks_file.h"
#include "engine/tooth/make/make_premolar.h"
#include "engine/tooth/make/tooth_shapes.h"
#include "scenarios/exam/exam.h"
#include "scenarios/zones/placed.h"
#include "tests/engine/support/basics.h"
#include "tests/scenarios/test_teeth.h"

namespace cavum::scenarios {
namespace {

class KeptLandmarks : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("CAVUM_HOME", folder_.file("").c_str(), 1);
    PremolarShape shape;
    shape.leaf_mm = 0.1;
    write_file(folder_.file("tooth.cvt"), save_tooth(make_premolar(shape)));
  }
  [[nodiscard]] std::unique_ptr<ExamSetup> exam_in(const std::string& target) {
    write_text_file(folder_.file("task.toml"), testing::scenario_text(target));
    ExamOptions options;
    options.candidate = "t";
    options.tooth_file = folder_.file("tooth.cvt");
    return prepare_exam(folder_.file("task.toml"), options);
  }
  testing_basics::Folder folder_;
};

constexpr char k_along_the_fissure[] =
    "[[zones.target]]\nshape = \"column\"\noutline = { kind = \"fissure\", width_mm = 1.2, ridge_mm = 0.8 }\nbottom = { kind = \"below_surface\", "
    "depth_mm = 1.5 }\n";

TEST_F(KeptLandmarks, TheZonesOfASessionFollowThoseItKept) {
  const auto setup = exam_in(k_along_the_fissure);
  ASSERT_FALSE(setup->session.landmarks_json.empty());
  { const auto exam = Exam::start(*setup, folder_.file("s.cavum"), {0, 0, 3}); }
  SessionSetup kept = SessionReader(folder_.file("s.cavum")).setup();
  EXPECT_EQ(kept.landmarks_json, setup->session.landmarks_json);

  // another program's fissure lies 0.5 mm further to buccal: what the exam kept decides, here as in
  // a reader that would find it elsewhere
  Landmarks other = parse_landmarks(kept.landmarks_json, "kept");
  for (Vec3& p : other.central_fissure_mm) p.y += 0.5;
  kept.landmarks_json = landmarks_text(other);
  const auto moved = prepare_exam(kept);
  EXPECT_EQ(moved->zones.low().y - setup->zones.low().y, 5) << "leaves of 0.1 mm";
}

TEST_F(KeptLandmarks, AreNotKeptWhereNoZoneFollowsThem) {
  EXPECT_EQ(exam_in("[[zones.target]]\nshape = \"box\"\nat_mm = [0, 0, 0]\nsize_mm = [1, 1, 3]\n")
                ->session.landmarks_json,
            "");
}

}  // namespace
}  // namespace cavum::scenarios
