// Replaces operator new in this test program to see whether the step allocates.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "engine/tooth/make_block.h"
#include "tests/engine/support/engine_testing.h"

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
void operator delete(void* p) noexcept { release(p); }
void operator delete[](void* p) noexcept { release(p); }
void operator delete(void* p, std::size_t) noexcept { release(p); }
void operator delete[](void* p, std::size_t) noexcept { release(p); }

namespace cavum {
namespace {

using namespace testing_engine;

TEST(Servo, TheStepAllocatesNothingWhileDrilling) {
  const Tooth tooth = make_block({3, 3, 3}, {{"enamel", 0.8}, {"dentin", 0.7}, {"pulp", 0.5}, {"dentin", 1.0}}, 0.05);
  Rig rig(tooth, {diamond_point("round-1.0"), diamond_point("cylinder-flat-1.0"), diamond_point("pear-1.0")}, hard_model(0.8, 1.79, 0.3),
          {0, 0, 0.2});
  long removed = 0, carving_ticks = 0, before = 0;
  t_allocations = 0;
  for (int i = 0; i < 10000; ++i) {
    const double t = i * 1e-3;
    if (i % 3000 == 0) rig.input.point = static_cast<std::uint8_t>((i / 3000) % 3);
    const Vec3 tip{0.6 * std::sin(2.1 * t), 0.5 * std::sin(1.3 * t), 0.2 - 0.25 * t + 0.3 * std::max(0.0, std::sin(t))};
    const Quat turned = normalized(Quat{1, 0.1 * std::sin(0.7 * t), 0.1 * std::cos(0.9 * t), 0});
    rig.input = make_tick_input({tip, turned}, i % 4000 < 3800 ? 1.0 : 0.0, k_stylus_fresh | k_pedal_fresh, rig.input.point, rig.input);
    t_counting = true;
    const TickOutput out = step(rig.model, rig.state, rig.input);
    (void)state_hash(rig.state);
    t_counting = false;
    ASSERT_EQ(t_allocations, before) << "tick " << i;
    removed += out.removed_count;
    carving_ticks += out.removed_count > 0;
  }
  EXPECT_EQ(t_allocations, 0);
  EXPECT_GT(removed, 10000) << "it must really have drilled";
  EXPECT_GT(carving_ticks, 300);
  t_counting = true;
  ::operator delete(::operator new(8));  // the counter itself counts
  t_counting = false;
  EXPECT_GE(t_allocations, 1);
}

}  // namespace
}  // namespace cavum
