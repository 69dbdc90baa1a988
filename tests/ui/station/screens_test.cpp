// What stands behind the screens and needs no window: the check of the devices, the coach, the
// camera, the gauges' words.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <thread>

#include "engine/device/simulated_stylus.h"
#include "engine/device/with_desk.h"
#include "scenarios/operators/simulated_exam.h"
#include "tests/engine/support/basics.h"
#include "ui/station/camera.h"
#include "ui/station/coach.h"
#include "ui/station/device_check.h"
#include "ui/station/replay_moments.h"
#include "ui/station/replay_player.h"
#include "ui/station/theme.h"

namespace cavum::station {
namespace {

using testing_basics::tells;
using namespace std::chrono_literals;
using State = CheckItem::State;

/// A stylus that does what a test says.
class Scripted final : public ServoDevice {
 public:
  explicit Scripted(std::function<DeviceReading(double t_s)> at) : at_(std::move(at)) {}
  [[nodiscard]] DeviceReading read(double elapsed_s) override { return at_(t_s_ += elapsed_s); }
  void send_force(Vec3 force_n) override { most_n = std::max(most_n, length(force_n)); }
  void cut_force() noexcept override {}
  double most_n = 0.0;

 private:
  std::function<DeviceReading(double)> at_;
  double t_s_ = 0.0;
};

DeviceReading reading(Vec3 tip, double pedal, int flags = k_stylus_fresh | k_pedal_fresh) {
  return {{tip, {}}, pedal, static_cast<std::uint16_t>(flags), 0};
}

/// What the check says of a device once `enough` is true, or after 20 s.
std::array<CheckItem, 3> checked(
    ServoDevice& device,
    const std::function<bool(const std::array<CheckItem, 3>&, const DeviceSight&)>& enough) {
  DeviceCheck check(device);
  for (int i = 0; i < 2000; ++i) {
    const DeviceSight sight = check.sight();
    if (enough(check_items(sight), sight)) break;
    std::this_thread::sleep_for(10ms);
  }
  return check_items(check.sight());
}

TEST(DeviceCheck, IsContentWithAHandAtRestAndAPedalThatWentDownAndUp) {
  Scripted device([](double t) {
    return reading({0.05 * std::sin(9 * t), 0, 5}, t > 0.3 && t < 0.8 ? 1.0 : 0.0);
  });
  const auto items = checked(device, [](const auto& i, const auto&) { return all_good(i); });
  EXPECT_TRUE(all_good(items)) << items[0].detail << " / " << english_text(items[1].detail) << " / "
                               << english_text(items[2].detail);
  EXPECT_EQ(device.most_n, 0.0) << "the check must not push the hand";
}

TEST(DeviceCheck, WaitsForAPedalThatIsOnlyHeldDownOrUnknown) {
  Scripted device([](double) { return reading({0, 0, 5}, 1.0); });
  const auto items =
      checked(device, [](const auto& i, const auto&) { return i[2].state == State::good; });
  EXPECT_EQ(items[1].state, State::waiting);
  Scripted unknown([](double) { return reading({0, 0, 5}, 0.0, k_stylus_fresh); });
  const auto others =
      checked(unknown, [](const auto& i, const auto&) { return i[2].state == State::good; });
  EXPECT_EQ(others[1].state, State::waiting);
  EXPECT_NE(items[1].detail, others[1].detail) << "of one that is unknown it says something else";
}

TEST(DeviceCheck, SeesAHandThatHasNoRest) {
  Scripted device([](double t) { return reading({1.5 * std::sin(6 * t), 0, 5}, 0.0); });
  const auto items =
      checked(device, [](const auto&, const DeviceSight& s) { return s.wander_mm < 100; });
  EXPECT_EQ(items[2].state, State::waiting);
  EXPECT_FALSE(items[2].detail.empty());
}

TEST(DeviceCheck, AsksOfADeviceForItsOwnRate) {
  DeviceSight sight{.read_once = true, .rate_hz = 300, .tip_mm = {}, .rotation = {}, .error = {}};
  EXPECT_EQ(check_items(sight)[0].state, State::waiting) << "of 1000";
  sight.usual_rate_hz = 500;
  EXPECT_EQ(check_items(sight)[0].state, State::good);
}

TEST(DeviceCheck, SaysWhatAFailingDeviceSaid) {
  Scripted device([](double t) -> DeviceReading {
    if (t > 0.05) throw std::runtime_error("the cable was pulled");
    return reading({}, 0.0);
  });
  const auto items =
      checked(device, [](const auto& i, const auto&) { return i[0].state == State::bad; });
  EXPECT_EQ(items[0].state, State::bad);
  EXPECT_TRUE(tells(items[0].detail, "the cable was pulled")) << items[0].detail;
}

TEST(Desk, PutsBurSpeedAndButtonsIntoTheReading) {
  Scripted device([](double) {
    return reading({1, 2, 3}, 0.8, k_stylus_fresh | k_pedal_fresh | k_button_1);
  });
  Desk desk;
  WithDesk with(device, desk);
  EXPECT_EQ(with.read(0.001).bur, 0);
  EXPECT_EQ(with.read(0.001).pedal, 0.8);
  desk.bur = 3;
  desk.speed_share = 0.5;
  desk.buttons = k_button_2 | 16u;  // a fault cannot be pressed
  const DeviceReading r = with.read(0.001);
  EXPECT_EQ(r.bur, 3);
  EXPECT_EQ(r.pedal, 0.4);
  EXPECT_EQ(r.flags, k_stylus_fresh | k_pedal_fresh | k_button_1 | k_button_2);
  EXPECT_EQ(r.pose.tip_mm, (Vec3{1, 2, 3}));
}

TEST(ReplayMoments, HoldEventsAndLostPointsInTheOrderOfTime) {
  const std::vector<TimedEvent> events{
      {100, StepCompleted{}}, {100, Perforated{}}, {300, StylusSilent{}}};
  const std::string result =
      R"({"criteria":[{"title":"Depth","points":3.5,"max":10,"first_tick":50},{"title":"Full","points":5,"max":5,"first_tick":60},
          {"title":"Time","points":0,"max":2,"first_tick":null}]})";
  const auto moments = replay_moments(events, result, 400, true);
  ASSERT_EQ(moments.size(), 4u);
  EXPECT_NE(english_text(moments[0].what).find("Depth"), std::string::npos);
  EXPECT_NEAR(moments[0].lost.value(), 6.5, 1e-12);
  EXPECT_FALSE(moments[1].bad);
  EXPECT_TRUE(moments[2].bad);
  EXPECT_EQ(moments[3].tick, 400) << "one without a moment stands at the end";
  EXPECT_EQ(replay_moments(events, result, 400, false).size(), 2u) << "marks that are held";
  EXPECT_EQ(replay_moments(events, "", 400, true).size(), 2u);
  EXPECT_THROW(static_cast<void>(replay_moments(events, "{", 400, true)), Error);
  // by keys through all of them, also two of one tick
  std::vector<int> down, up;
  int at = -1;
  for (std::int64_t tick = 0; (at = compared_moment(moments, tick, at, 1)) >= 0;
       tick = moments[static_cast<std::size_t>(at)].tick)
    down.push_back(at);
  EXPECT_EQ(down, (std::vector<int>{0, 1, 2, 3}));
  for (std::int64_t tick = 401; (at = compared_moment(moments, tick, at, -1)) >= 0;
       tick = moments[static_cast<std::size_t>(at)].tick)
    up.push_back(at);
  EXPECT_EQ(up, (std::vector<int>{3, 2, 1, 0}));
}

class Coach : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scenarios::ExamOptions options;
    options.candidate = "t";
    setup_ = scenarios::prepare_exam(
        std::string(CAVUM_SOURCE_DIR) + "/tests/replay/block_cavity.toml", options);
    setup_->scenario.force_limit_n = 2.0;
  }
  static void TearDownTestSuite() { setup_.reset(); }
  /// Cutting at a place of the block, whose cavity is a cylinder of 1.1 mm, 1.6 mm deep below z =
  /// 0.
  static scenarios::LiveView cutting(Vec3 at) {
    scenarios::LiveView v;
    v.output.proxy_mm = at;
    v.output.contact = v.output.cutting = true;
    v.output.rpm = 200000;
    v.output.rendered_force_n = {0, 0, 1.0};
    return v;
  }
  static Message hint(const scenarios::LiveView& view) { return coaching_hint(*setup_, view); }
  static inline std::unique_ptr<scenarios::ExamSetup> setup_;
};

TEST_F(Coach, IsSilentWhileTheWorkIsGood) { EXPECT_TRUE(hint(cutting({0.3, 0, -0.6})).empty()); }

TEST_F(Coach, WarnsOfForceBeforeAnythingElse) {
  scenarios::LiveView v = cutting({3, 0, -0.6});
  v.output.rendered_force_n = {0, 0, 2.6};
  EXPECT_TRUE(tells(hint(v), Value(as_number(2.6)))) << hint(v);
}

TEST_F(Coach, TellsOfAHeadThatIsCaughtUnderAnEdge) {
  scenarios::LiveView v = cutting({0, 0, -0.6});
  v.output.cutting = false;
  v.output.rendered_force_n = {0, 0, -3.3};
  v.output.normal = normalized(Vec3{0.5, 0, -1});
  v.input.tip_nm = {0, 0, 400'000};
  const Message caught = hint(v);
  EXPECT_TRUE(!caught.empty() && caught.values().empty())
      << "nothing is said of the force of 3.3 N: " << caught;
  v.output.normal = {0, 0, 1};  // it stands on the floor
  EXPECT_TRUE(tells(hint(v), Value(as_number(3.3)))) << hint(v);
}

TEST_F(Coach, MeasuresHowFarBesideTheTargetTheTipIs) {
  EXPECT_NE(english_text(hint(cutting({1.1 + 0.7, 0, -0.6}))).find("0.7 mm"), std::string::npos);
}

TEST_F(Coach, TellsThatTheFloorIsNear) {
  EXPECT_NE(english_text(hint(cutting({0, 0, -1.4}))).find("0.2 mm"), std::string::npos);
}

TEST_F(Coach, TellsOfAHandpieceThatTurnsInTheAir) {
  scenarios::LiveView v = cutting({0, 0, 4});
  v.output.contact = v.output.cutting = false;
  EXPECT_FALSE(hint(v).empty());
  v.output.rpm = 0;
  EXPECT_TRUE(hint(v).empty());
}

/// A novice's exam in a file; with its setup.
std::unique_ptr<scenarios::ExamSetup> record_novice(const std::string& scenario,
                                                    const std::string& file) {
  scenarios::ExamOptions options;
  options.candidate = "t";
  auto setup = scenarios::prepare_exam(std::string(CAVUM_SOURCE_DIR) + scenario, options);
  auto candidate = scenarios::make_simulated_candidate(*setup, "novice", 3, OmniModel{});
  const auto exam = scenarios::Exam::start(*setup, file, candidate.start_mm());
  scenarios::run_exam(*exam, candidate);
  exam->close("{}");
  return setup;
}

/// Of this thread, s.
double thread_s() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void expect_within_a_second(const std::string& scenario) {
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("home").c_str(), 1);
  (void)record_novice(scenario, folder.file("s.cavum"));
  ReplayPlayer player(folder.file("s.cavum"));
  while (player.reached() < player.ticks())
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  double slowest_s = 0, slowest_clock_s = 0;
  for (int i = 0; i < 24; ++i) {
    const auto began = std::chrono::steady_clock::now();
    const double from_s = thread_s();
    player.seek((player.ticks() * ((i * 7) % 24) + player.ticks() / 2) /
                24);  // far from where it was, and from any snapshot
    while (!player.work(0.05)) continue;
    slowest_s = std::max(slowest_s, thread_s() - from_s);
    slowest_clock_s =
        std::max(slowest_clock_s,
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  }
  std::printf(
      "%s, %.0f s long: the slowest of 24 moments is there after %.3f s of the processor, %.3f s by the clock\n",
      scenario.c_str(), static_cast<double>(player.ticks()) * k_tick_s, slowest_s, slowest_clock_s);
  EXPECT_LT(slowest_s, 1.0);
}

TEST(ReplayPlayer, IsAtAnyMomentWithinASecondOfTheProcessor) {
  expect_within_a_second("/tests/replay/block_cavity.toml");
  if (std::getenv("CAVUM_DEEP") != nullptr)
    expect_within_a_second("/data/scenarios/molar_access.toml");
}

TEST(ReplayPlayer, ShowsTheRecordedStateWhereverItIsSent) {
  const testing_basics::Folder folder;
  ::setenv("CAVUM_HOME", folder.file("home").c_str(), 1);
  const auto setup = record_novice("/tests/replay/block_cavity.toml", folder.file("s.cavum"));
  ReplayPlayer player(folder.file("s.cavum"));
  const auto& chunks = player.session().chunks();
  ASSERT_GT(chunks.size(), 8u);
  const auto go = [&player](std::int64_t tick) {
    player.seek(tick);
    while (!player.work(0.01)) continue;
    ASSERT_EQ(player.tick(), tick);
  };
  // every second once, in an order that jumps forth and back; the recording's own hashes are what
  // to find there
  const std::uint64_t seed = testing_basics::drawn_seed("ReplayPlayer");
  Random random(seed);
  for (int i = 0; i < 12; ++i) {
    const ChunkRow& chunk = chunks[random.below(static_cast<std::uint32_t>(chunks.size()))];
    if (chunk.ticks == 0) continue;
    go(chunk.first_tick + chunk.ticks);
    EXPECT_EQ(player.hash(), chunk.state_hash)
        << "after tick " << chunk.first_tick + chunk.ticks << ", seed " << seed;
  }
  go(player.ticks());
  EXPECT_NE(player.runner().finish, Finish::running);
  EXPECT_EQ(player.instruction(player.runner()), "");
  go(0);
  EXPECT_EQ(player.runner().ticks, 0);
  EXPECT_EQ(player.tooth().count_leaves(), setup->tooth.octree.count_leaves());
  // once the snapshots reach the end, no moment is further from one than they lie apart
  const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (player.reached() < player.ticks() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_EQ(player.reached(), player.ticks());
  const std::int64_t late = player.ticks() - 1;
  player.seek(0);
  player.seek(late);
  EXPECT_GE(player.tick(), late - player.between()) << "it begins at the nearest snapshot";
  player.seek(player.ticks() + 1000);  // beyond the end is the end
  while (!player.work(0.05)) continue;
  EXPECT_EQ(player.tick(), player.ticks());
  // what stands beside the tooth stays that of the tooth that is drawn, until another is
  player.show();
  player.seek(0);
  (void)player.work(0.0);
  EXPECT_NE(player.tick(), player.ticks());
  EXPECT_EQ(player.shown().tick, player.ticks());
  EXPECT_EQ(player.shown().runner.target_shares, [&] {
    player.seek(player.ticks());
    while (!player.work(0.05)) continue;
    return player.runner().target_shares;
  }());
}

/// Where a place of the tooth frame is seen, -1..1 to the right and up.
glm::vec2 seen(const Camera& camera, glm::vec3 at, int eye = 0) {
  const glm::vec4 p = camera.projection(1.5F) * camera.view(eye) * glm::vec4(at, 1.0F);
  return {p.x / p.w, p.y / p.w};
}

TEST(Camera, FromBuccalMesialLiesLeftAndOcclusalUp) {
  Camera c;
  c.look_from(0, 0);
  EXPECT_LT(seen(c, {2, 0, 0}).x, -0.01F);
  EXPECT_GT(seen(c, {0, 0, 2}).y, 0.01F);
  EXPECT_GT(c.position_mm().y, 30.0F);
}

TEST(Camera, AMirrorTurnsLeftAndRightAndNothingElse) {
  Camera c;
  c.look_from(30, 40);
  Camera m = c;
  m.mirror = true;
  const glm::vec3 at{1.5F, -2.0F, 0.7F};
  EXPECT_NEAR(seen(m, at).x, -seen(c, at).x, 1e-5F);
  EXPECT_NEAR(seen(m, at).y, seen(c, at).y, 1e-5F);
}

TEST(Camera, BothEyesMeetAtWhatIsLookedAtAndPartBeforeIt) {
  Camera c;
  c.look_from(0, 30);
  c.eyes_apart_mm = 3.0F;
  EXPECT_NEAR(seen(c, c.target_mm, -1).x, seen(c, c.target_mm, 1).x, 1e-4F);
  const glm::vec3 nearer = c.position_mm() * 0.25F;  // towards the eyes
  EXPECT_GT(seen(c, nearer, -1).x, seen(c, nearer, 1).x + 0.002F)
      << "the left eye sees what is near further right";
}

TEST(Camera, ItsRightAndUpAreThoseOfThePicture) {
  Camera c;
  c.look_from(70, 35);
  for (const bool mirror : {false, true}) {
    c.mirror = mirror;
    const Vec3 r = c.right(), u = c.up();
    const auto at = [](Vec3 v) { return glm::vec3(v.x, v.y, v.z); };
    EXPECT_GT(seen(c, at(r)).x, 0.01F);
    EXPECT_NEAR(seen(c, at(r)).y, 0.0F, 1e-4F);
    EXPECT_GT(seen(c, at(u)).y, 0.01F);
  }
}

TEST(Theme, TellsItsSignsApartByLightnessInBothPalettes) {
  const auto lightness = [](const ImVec4& c) {
    return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
  };
  for (const bool high_contrast : {false, true}) {
    const Theme t = make_theme(high_contrast, 1.0);
    EXPECT_GT(lightness(t.text) - lightness(t.panel), high_contrast ? 0.9F : 0.7F);
    for (const ImVec4& sign : {t.good, t.warn, t.bad, t.accent, t.quiet})
      EXPECT_GT(lightness(sign) - lightness(t.panel), 0.35F);
    EXPECT_GT(lightness(t.accent) - lightness(t.on_accent), 0.45F);
  }
}

}  // namespace
}  // namespace cavum::station
