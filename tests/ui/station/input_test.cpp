// What keyboard and mouse come to, without any window: nothing is lost at any rate of pictures, and
// held keys go by time. The tutorial, the gauge's words, and what a locked station knows of
// keyboards, codes and second starts.
#include "ui/station/input_queue.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/random.h"
#include "tests/engine/support/basics.h"
#include "ui/station/colour_key.h"
#include "ui/station/exam_lock.h"
#include "ui/station/gauges.h"
#include "ui/station/pointer_hand.h"
#include "ui/station/tutorial.h"

namespace cavum::station {
namespace {

InputEvent key_event(int key, bool down, double t_s) {
  return {.kind = InputEvent::Kind::key, .code = key, .down = down, .t_s = t_s};
}

/// Where a hand that did this has brought the tip, at so many pictures a second; `late_s`: how much
/// later than due each picture comes, in turn.
Vec3 brought_to(const std::vector<InputEvent>& did, double rate_hz, double until_s = 3.0) {
  InputQueue queue;
  PointerView view;
  Vec3 tip;
  Quat rotation;
  std::size_t next = 0;
  for (int picture = 0; picture / rate_hz < until_s; ++picture) {
    const double now_s = picture / rate_hz;
    for (; next < did.size() && did[next].t_s <= now_s; ++next) queue.push(did[next]);
    queue.play(now_s);
    move_by_pointer(queue, view, tip, rotation);
  }
  EXPECT_FALSE(queue.waiting());
  return tip;
}

TEST(InputQueue, ATapOf12MsCountsAt10PicturesASecondAsAt60) {
  for (const double rate_hz : {10.0, 60.0})
    for (const double at_s : {0.301, 0.35, 0.397, 0.4449}) {
      InputQueue queue;
      int pressed = 0, released = 0, seen_down = 0;
      bool pushed = false;
      for (double now_s = 0; now_s < 1.0; now_s += 1.0 / rate_hz) {
        if (!pushed && now_s >= at_s + 0.012) {
          queue.push(key_event(GLFW_KEY_F, true, at_s));
          queue.push(key_event(GLFW_KEY_F, false, at_s + 0.012));
          pushed = true;
        }
        for (const InputEvent& e : queue.play(now_s)) ++(e.down ? pressed : released);
        seen_down += queue.down(GLFW_KEY_F) ? 1 : 0;
      }
      EXPECT_EQ(pressed, 1);
      EXPECT_EQ(released, 1);
      EXPECT_EQ(seen_down, 1) << "down in one picture, up in the next";
    }
}

TEST(InputQueue, TwentyTapsInOnePictureAreTwentyTapsInTheirOrder) {
  InputQueue queue;
  std::vector<int> pressed;
  for (int i = 0; i < 20; ++i) {
    queue.push(key_event(i % 3 == 0 ? GLFW_KEY_A : GLFW_KEY_B, true, 0.01 * i));
    queue.push(key_event(i % 3 == 0 ? GLFW_KEY_A : GLFW_KEY_B, false, 0.01 * i + 0.005));
  }
  for (int picture = 0; picture < 100; ++picture)
    for (const InputEvent& e : queue.play(0.3 + 0.1 * picture))
      if (e.down) pressed.push_back(e.code);
  ASSERT_EQ(pressed.size(), 20u);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(pressed[static_cast<std::size_t>(i)], i % 3 == 0 ? GLFW_KEY_A : GLFW_KEY_B) << i;
}

TEST(InputQueue, AModifierWhoseReleaseSomebodyElseTookIsLetGoOfWithTheNextKey) {
  InputQueue queue;
  queue.push_key(key_event(GLFW_KEY_LEFT_ALT, true, 0.1), 0);
  queue.push_key(key_event(GLFW_KEY_RIGHT_CONTROL, true, 0.2), GLFW_MOD_ALT);
  queue.play(0.5);
  ASSERT_TRUE(queue.down(GLFW_KEY_LEFT_ALT));
  queue.push_key(key_event(GLFW_KEY_ESCAPE, true, 1.0), GLFW_MOD_CONTROL);
  std::vector<int> keys;
  for (const InputEvent& e : queue.play(1.1)) keys.push_back(e.down ? e.code : -e.code);
  EXPECT_EQ(keys, (std::vector<int>{-GLFW_KEY_LEFT_ALT, GLFW_KEY_ESCAPE}));
  EXPECT_FALSE(queue.down(GLFW_KEY_LEFT_ALT));
  EXPECT_TRUE(queue.down(GLFW_KEY_RIGHT_CONTROL));
}

TEST(InputQueue, LettersAndWheelKeepTheirPlaceBetweenKeys) {
  InputQueue queue;
  queue.push({.kind = InputEvent::Kind::text, .code = 'a', .t_s = 0.1});
  queue.push(key_event(GLFW_KEY_BACKSPACE, true, 0.11));
  queue.push(key_event(GLFW_KEY_BACKSPACE, false, 0.12));
  queue.push({.kind = InputEvent::Kind::text, .code = 'b', .t_s = 0.13});
  std::string order;
  for (const double now_s : {0.2, 0.3})
    for (const InputEvent& e : queue.play(now_s))
      order += e.kind == InputEvent::Kind::text ? static_cast<char>(e.code) : e.down ? '<' : '>';
  EXPECT_EQ(order, "a<>b");
}

TEST(PointerHand, AHeldKeyBringsTheTipAsFarAt10PicturesASecondAsAt60) {
  const std::uint64_t seed = testing_basics::drawn_seed("PointerHand");
  Random random(seed);
  for (int i = 0; i < 50; ++i) {
    const double from_s = 0.2 + random.uniform(), held_s = 0.012 + 1.2 * random.uniform();
    const std::vector<InputEvent> did{key_event(GLFW_KEY_RIGHT, true, from_s),
                                      key_event(GLFW_KEY_RIGHT, false, from_s + held_s)};
    const double expected =
        k_pointer_step_mm + k_pointer_mm_s * std::max(0.0, held_s - HeldKeyLaw{}.wait_s);
    for (const double rate_hz : {10.0, 23.0, 60.0, 144.0})
      EXPECT_NEAR(brought_to(did, rate_hz).x, expected, 1e-9)
          << rate_hz << " pictures a second, held " << held_s << " s, seed " << seed;
  }
}

TEST(PointerHand, ATapIsOneStepAndShiftMakesItFiner) {
  const std::vector<InputEvent> tap{key_event(GLFW_KEY_PAGE_DOWN, true, 0.3),
                                    key_event(GLFW_KEY_PAGE_DOWN, false, 0.312)};
  for (const double rate_hz : {10.0, 60.0})
    EXPECT_NEAR(brought_to(tap, rate_hz).z, -k_pointer_step_mm, 1e-12);
  const std::vector<InputEvent> fine{
      key_event(GLFW_KEY_LEFT_SHIFT, true, 0.1), key_event(GLFW_KEY_PAGE_DOWN, true, 0.3),
      key_event(GLFW_KEY_PAGE_DOWN, false, 0.312), key_event(GLFW_KEY_LEFT_SHIFT, false, 0.9)};
  for (const double rate_hz : {10.0, 60.0})
    EXPECT_NEAR(brought_to(fine, rate_hz).z, -k_pointer_fine * k_pointer_step_mm, 1e-12);
}

TEST(PointerHand, AWindowThatStoodStillPlungesNoTip) {
  const std::vector<InputEvent> did{key_event(GLFW_KEY_PAGE_DOWN, true, 0.5),
                                    key_event(GLFW_KEY_PAGE_DOWN, false, 2.5)};
  EXPECT_GT(brought_to(did, 0.4, 10.0).z,
            -k_pointer_step_mm - k_pointer_mm_s * 2.0 * InputQueue::k_longest_picture_s);
}

TEST(PointerHand, StaysNearTheTooth) {
  const Vec3 low{-5, -5, -20}, high{5, 5, 1}, start{0, 0, 9};
  EXPECT_EQ(near_tooth(low, high, start, {1, 2, -3}), (Vec3{1, 2, -3}));
  EXPECT_EQ(near_tooth(low, high, start, {40, -40, -99}),
            (Vec3{5 + k_pointer_room_mm, -5 - k_pointer_room_mm, -20 - k_pointer_room_mm}));
  EXPECT_EQ(near_tooth(low, high, start, {0, 0, 99}), (Vec3{0, 0, start.z}))
      << "where it began belongs to it";
}

/// From a place back above a tooth; how far it went.
double came_back(const ReturnPath& way, Vec3 tip, double step_mm) {
  double gone = 0;
  for (int i = 0; i < 20000 && !(tip == way.goal); ++i) {
    const Vec3 next = next_on_return_path(way, tip, step_mm);
    EXPECT_LE(length(next - tip), step_mm + 1e-9) << "it travels";
    EXPECT_FALSE(way.in_tissue(next)) << next.x << " " << next.y << " " << next.z;
    gone += length(next - tip);
    tip = next;
  }
  EXPECT_EQ(tip, way.goal);
  return gone;
}

TEST(PointerHand, ComesBackAboveTheToothFromBesideItBelowItsBulgeAndFromACavity) {
  // a ball of a crown over a thin root, with a hole from above
  const auto tissue = [](Vec3 p) {
    const bool crown = length(p) < 5.0, root = std::hypot(p.x, p.y) < 2.0 && p.z < 0 && p.z > -18;
    return (crown || root) && !(std::hypot(p.x, p.y) < 0.7 && p.z > 2.0);
  };
  const ReturnPath way{{0, 0, 9}, {0, 0, 1}, tissue};
  for (const double step_mm : {0.02, 0.3}) {
    EXPECT_NEAR(came_back(way, {0.2, 0, 2.5}, step_mm), 6.5 + 0.2, 1e-6)
        << "straight out of the hole";
    EXPECT_LT(came_back(way, {2.3, 0, -14}, step_mm), 23 + 2 * 7.0)
        << "from beside the root, below the crown";
    EXPECT_LT(came_back(way, {-6, 4, -20}, step_mm), 29 + 9.0) << "out of all tissue";
    EXPECT_LT(came_back(way, {5.05, 0, 0.1}, step_mm), 9 + 9.0) << "leaning on the crown";
  }
  const ReturnPath lingual{{0, -6, 3}, normalized(Vec3{0, -1, 0.5}), tissue};
  EXPECT_LT(came_back(lingual, {0, 5.5, 0}, 0.1), 40.0) << "from the other side of the tooth";
}

TEST(PointerHand, TheMouseGoesOnWithoutAnEdgeAndCtrlTiltsAsFarAsItMay) {
  InputQueue queue;
  PointerView view;
  Vec3 tip;
  Quat rotation_of_hand;
  for (int i = 0; i < 500; ++i) {  // 25,000 pixels: further than any screen
    queue.push({.kind = InputEvent::Kind::motion, .t_s = 0.01 * i, .x = 50.0F});
    queue.play(0.01 * i);
    move_by_pointer(queue, view, tip, rotation_of_hand);
  }
  EXPECT_NEAR(tip.x, 25000 * view.mm_per_px, 1e-6);
  queue.push(key_event(GLFW_KEY_LEFT_CONTROL, true, 6.0));
  for (int i = 0; i < 200; ++i)
    queue.push({.kind = InputEvent::Kind::motion, .t_s = 6.0 + 0.001 * i, .x = 50.0F});
  queue.play(7.0);
  move_by_pointer(queue, view, tip, rotation_of_hand);
  EXPECT_NEAR(tip.x, 25000 * view.mm_per_px, 1e-6) << "it tilts, and does not move";
  const Vec3 handle = rotation(rotation_of_hand) * Vec3{0, 0, 1};
  EXPECT_GT(handle.x, 0.5);
  EXPECT_NEAR(handle.z, std::cos(k_pointer_tilt_deg * 3.14159265358979 / 180.0), 1e-6);
}

TEST(PointerHand, PressesNoDeeperThanItReachesAndStaysFreeToLift) {
  const PointerView view;
  Vec3 wanted{1, 2, -9};
  keep_in_reach(view, {1, 2, -0.5}, wanted);
  EXPECT_EQ(wanted, (Vec3{1, 2, -0.5 - k_pointer_reach_mm}));
  for (const double z : {-1.0, 0.0, 7.0}) {
    Vec3 free{4, 2, z};
    keep_in_reach(view, {1, 2, -0.5}, free);
    EXPECT_EQ(free, (Vec3{4, 2, z}));
  }
}

TEST(DepthGauge, Shows0AtTheSurfaceAlone) {
  for (const auto& [mm, shown] :
       {std::pair{0.0, "0.0 mm"}, {1.24, "1.2 mm"}, {-0.7, "0.7 mm"}, {-4.0, "4.0 mm"}})
    EXPECT_NE(english_text(depth_text(mm)).find(shown), std::string::npos) << mm;
  EXPECT_NE(depth_text(0.7), depth_text(-0.7)) << "above is not below";
  for (double mm = -9.0; mm < 9.0; mm += 0.037) {
    const bool zero = english_text(depth_text(mm)).find("0.0 mm") != std::string::npos;
    EXPECT_EQ(zero, mm > -0.05 && mm < 0.05) << mm;
  }
}

TEST(ColourKey, NamesTheTargetAndEachTissueOnce) {
  const std::vector<Tissue> tissues{{k_enamel, "enamel", true},
                                    {k_dentin, "dentin", true},
                                    {k_pulp, "pulp", false},
                                    {9, "lesion", true}};
  for (const bool high_contrast : {false, true}) {
    const auto key = colour_key(tissues, high_contrast);
    ASSERT_EQ(key.size(), 5u) << "what is to be removed, and the tissues";
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NE(english_text(key[i + 1].word).find(tissues[i].name), std::string::npos);
    EXPECT_EQ(english_text(key[4].word).find("lesion"), std::string::npos)
        << "it is called what candidates call it";
  }
}

TEST(Tutorial, GoesOnByWhatThePersonDidAndEndsInAHole) {
  Tutorial t(true);
  TutorialSight s;
  s.tip_mm = {0, 0, 4};
  const auto see = [&t, &s](int step) {
    for (int i = 0; i < 5; ++i) t.see(s);
    EXPECT_EQ(t.step(), step) << english_text(t.text());
  };
  see(0);  // watching alone does nothing
  s.tip_mm.x = 2.5;
  see(1);
  s.turn_deg = 15;
  see(1);
  s.turn_deg = 25;
  see(2);
  s.rise_deg = 90;
  see(3);
  s.handle = normalized(Vec3{0.3, 0, 1});
  see(3);  // not upright again
  s.handle = normalized(Vec3{0.05, 0, 1});
  see(4);
  s.cutting = true;  // in the air
  see(4);
  s.contact = true;
  s.cutting = false;
  s.tip_mm = {0, 0, 1};
  see(5);
  s.tip_mm.z = 0.2;  // pressed in, not drilled
  see(5);
  s.cutting = true;
  s.rpm = 200000;
  s.tip_mm.z = 0.6;
  see(5);
  for (const char* mm : {"0.4", "0.5 mm"})
    EXPECT_NE(english_text(t.text()).find(mm), std::string::npos) << english_text(t.text());
  s.tip_mm.z = 0.45;
  see(6);
  s.contact = s.cutting = false;
  s.tip_mm.z = 2;
  see(6);
  EXPECT_FALSE(t.done()) << "the handpiece still turns";
  s.rpm = 0;
  see(7);
  EXPECT_TRUE(t.done());
  EXPECT_NEAR(t.hole_mm(), 0.55, 1e-9);
}

TEST(KeyboardWatch, SeesAKeyboardThatIsPluggedInAndNoMouse) {
  const testing_basics::Folder folder;
  const std::string mouse =
      "I: Bus=0003\nN: Name=\"A Mouse\"\nP: Phys=usb-1/input0\nB: EV=17\nB: KEY=ff0000 0 0 0 0\n\n";
  const auto keyboard = [](const std::string& name) {
    return "I: Bus=0003\nN: Name=\"" + name +
           "\"\nP: Phys=usb-2/input0\nB: EV=120013\nB: KEY=1000000000007 ff9f207ac14057ff febeffdfffefffff fffffffffffffffe\n\n";
  };
  const std::string button =
      "I: Bus=0019\nN: Name=\"Power Button\"\nP: Phys=PNP0C0C/button/input0\nB: EV=3\nB: KEY=10000000000000 0\n\n";
  EXPECT_EQ(keyboards_in(mouse + button).size(), 0u);
  write_text_file(folder.file("devices"), mouse + keyboard("First"));
  KeyboardWatch watch(folder.file("devices"));
  EXPECT_TRUE(watch.added().empty());
  write_text_file(folder.file("devices"), mouse + keyboard("First") + button + keyboard("Second"));
  EXPECT_EQ(watch.added(), std::vector<std::string>{"Second at usb-2/input0"});
  EXPECT_TRUE(watch.added().empty()) << "told once";
  EXPECT_TRUE(KeyboardWatch(folder.file("nowhere")).added().empty());
}

TEST(SupervisorCode, IsKeptAsASaltedHashAlone) {
  const testing_basics::Folder folder;
  const std::string one = folder.file("one"), two = folder.file("two");
  set_supervisor_code("over the lake", one);
  set_supervisor_code("over the lake", two);
  EXPECT_EQ(read_text_file(one).find("lake"), std::string::npos);
  EXPECT_NE(read_text_file(one), read_text_file(two)) << "each has a salt of its own";
  EXPECT_TRUE(is_supervisor_code(read_supervisor_code(one), "over the lake"));
  EXPECT_FALSE(is_supervisor_code(read_supervisor_code(one), "over the Lake"));
  EXPECT_FALSE(is_supervisor_code(read_supervisor_code(one), ""));
  EXPECT_EQ(std::filesystem::status(one).permissions() & std::filesystem::perms::all,
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  EXPECT_THROW(set_supervisor_code("12345", one), Error);
  EXPECT_THROW(static_cast<void>(read_supervisor_code(folder.file("none"))), Error);
  write_text_file(two, "12345678\n");
  EXPECT_THROW(static_cast<void>(read_supervisor_code(two)), Error);
}

TEST(StationDoor, ASecondStartIsRefusedAndHeard) {
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("home").c_str(), 1);
  StationDoor::pass();
  {
    StationDoor door;
    EXPECT_EQ(door.knocks(), 0);
    EXPECT_THROW(StationDoor::pass(), Error);
    EXPECT_THROW(StationDoor::pass(), Error);
    EXPECT_THROW(StationDoor(), Error);
    EXPECT_EQ(door.knocks(), 2);
    EXPECT_EQ(door.knocks(), 0);
    ::setenv("CAVUM_HOME", folder.file("another").c_str(), 1);
    StationDoor::pass();  // another station
    ::setenv("CAVUM_HOME", folder.file("home").c_str(), 1);
  }
  StationDoor::pass();
}

}  // namespace
}  // namespace cavum::station
