#include "grading/perforation/known_tooth.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/physics/servo/tick.h"
#include "engine/tooth/fill.h"
#include "grading/perforation/drop.h"
#include "grading/perforation/exposure.h"
#include "scenarios/exam/exam.h"

namespace cavum::grading {
namespace {

/// Pressed straight down into the middle of the block, to `deep_mm` below its top.
std::vector<TickInput> pressed_down(const Tooth& block, double deep_mm) {
  constexpr int k_ticks = 600;
  const Octree& tree = block.octree;
  const IVec3 size = tree.size();
  const Vec3 low = tree.origin_mm(),
             top = low +
                   Vec3{size.x * 0.5, size.y * 0.5, static_cast<double>(size.z)} * tree.leaf_mm();
  std::vector<TickInput> inputs;
  TickInput before;
  for (int i = 0; i < k_ticks; ++i) {
    before = make_tick_input({top + Vec3{0, 0, 0.1 - (deep_mm + 0.1) * i / k_ticks}, {}}, 1.0,
                             k_stylus_fresh | k_pedal_fresh, 0, before);
    inputs.push_back(before);
  }
  return inputs;
}

TEST(KnownTooth, AnswersAsIfItKeptNothing) {
  const auto exam = scenarios::prepare_exam(
      std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml", {});
  const Tooth& block = exam->tooth;
  std::array<bool, 256> pulp{}, none{};
  pulp[block.tissue_id("pulp")] = true;
  const std::vector<TickInput> shallow = pressed_down(block, 0.2), deep = pressed_down(block, 0.5);
  SessionSetup setup = exam->session;
  setup.first_tip_nm = shallow[0].tip_nm;
  const Tooth filled = filled_tooth(block, pulp);
  KnownTooth known(block, block);
  std::vector<std::vector<double>> answers;
  for (const auto* inputs : {&shallow, &deep, &deep, &shallow}) {
    answers.push_back(known.filled_force_n(setup, pulp, *inputs));
    EXPECT_EQ(answers.back(), filled_force_n(setup, filled, *inputs));
  }
  EXPECT_NE(answers[0], answers[1]);
  EXPECT_EQ(answers[1], answers[2]);
  EXPECT_EQ(known.around(pulp), tissues_around(block, pulp));
  EXPECT_EQ(known.around(none), none);
}

}  // namespace
}  // namespace cavum::grading
