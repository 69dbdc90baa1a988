// What the servo asks of an Inverse3 in each step neither allocates nor waits, whatever the line
// does. Replaces operator new in this test program.
#include <gtest/gtest.h>

#include "tests/allocation/counted_new.h"
#include "tests/device/inverse3_hands.h"

namespace cavum {
namespace {

using Answer = testing_device::EmulatedInverse3::Answer;

TEST(Inverse3Servo, ReadingAndPushingNeitherAllocateNorWait) {
  testing_device::EmulatedInverse3 service;
  Inverse3Stylus stylus(testing_device::own_frame(service));
  ASSERT_TRUE(testing_device::comes_true([&] { return !stylus.health().problem; }));
  for (const Answer answer : {Answer::state, Answer::nothing, Answer::no_json}) {
    service.answer_with(answer);
    constexpr int k_steps = 100'000;
    Vec3 sum;
    t_allocations = 0;
    const auto from = std::chrono::steady_clock::now();
    t_counting = true;
    for (int i = 0; i < k_steps; ++i) {
      sum += stylus.read(1e-3).pose.tip_mm;
      stylus.send_force({0.1, 0, 0});
    }
    t_counting = false;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
    EXPECT_EQ(t_allocations, 0);
    EXPECT_LT(took.count() / k_steps, 50e-6)
        << "a twentieth of a tick, on a computer that has other work";
    EXPECT_TRUE(is_finite(sum));
  }
  t_counting = true;
  ::operator delete(::operator new(8));  // the counter itself counts
  t_counting = false;
  EXPECT_GE(t_allocations, 1);
}

}  // namespace
}  // namespace cavum
