// What the servo asks of an Inverse3 in each step neither allocates nor waits, whatever the line does. Replaces operator new in this test program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/device/inverse3_hands.h"

namespace {

thread_local bool t_counting = false;
thread_local long t_allocations = 0;

void* counted(std::size_t size) {
  if (t_counting) ++t_allocations;
  return std::malloc(size == 0 ? 1 : size);
}

// not inlined: the compiler would see free() of what came from operator new, and warn
[[gnu::noinline]] void release(void* p) noexcept { std::free(p); }

}  // namespace

void* operator new(std::size_t size) {
  void* p = counted(size);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }

namespace cavum {
namespace {

using Answer = testing_device::EmulatedInverse3::Answer;

TEST(Inverse3Servo, ReadingAndPushingNeitherAllocateNorWait) {
  testing_device::EmulatedInverse3 service;
  Inverse3Stylus stylus(testing_device::own_frame(service));
  ASSERT_TRUE(testing_device::comes_true([&] { return stylus.health().ready; }));
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
    EXPECT_LT(took.count() / k_steps, 50e-6) << "a twentieth of a tick, on a computer that has other work";
    EXPECT_TRUE(is_finite(sum));
  }
  t_counting = true;
  ::operator delete(::operator new(8));  // the counter itself counts
  t_counting = false;
  EXPECT_GE(t_allocations, 1);
}

}  // namespace
}  // namespace cavum
