#include "engine/physics/servo/servo.h"

#include <gtest/gtest.h>

#include <set>

#include "engine/tooth/make/make_block.h"
#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

Tooth four_layers() {
  return make_block({2.4, 2.4, 3.0},
                    {{"enamel", 0.7}, {"dentin", 0.5}, {"pulp", 0.8}, {"dentin", 1.0}}, 0.05);
}

/// A wild but repeatable tick: drilling, sliding, leaving, changing the bur, losing pedal and
/// stylus.
TickInput wild(Random& random, int i, const TickInput& previous) {
  const double t = i * 1e-3;
  const Vec3 tip{
      0.5 * std::sin(2.1 * t), 0.4 * std::sin(1.3 * t),
      0.2 - 0.3 * t + 0.4 * std::max(0.0, std::sin(1.7 * t)) + random.uniform(-0.01, 0.01)};
  const Quat turned = normalized(Quat{1, 0.15 * std::sin(0.7 * t), 0.1 * std::cos(0.9 * t), 0});
  std::uint16_t flags = k_stylus_fresh | k_pedal_fresh;
  if (i % 500 > 490) flags = k_pedal_fresh;
  if (i % 700 > 690) flags = k_stylus_fresh;
  return make_tick_input({tip, turned}, i % 900 < 850 ? 1.0 : 0.0, flags,
                         static_cast<std::uint8_t>(i / 1000 % 2), previous);
}

Rig wild_rig() {
  return {four_layers(),
          {shipped_bur("round-1.0"), shipped_bur("taper-round-1.2")},
          hard_model(0.8, 1.79, 0.3),
          {0, 0, 0.3}};
}

TEST(Servo, EqualInputsGiveEqualStatesTickByTickAndACopyGoesOnAlike) {
  const std::uint64_t seed =
      drawn_seed("Servo.EqualInputsGiveEqualStatesTickByTickAndACopyGoesOnAlike");
  Random random(seed);
  std::vector<TickInput> inputs;
  for (int i = 0; i < 5000; ++i)
    inputs.push_back(wild(random, i, inputs.empty() ? TickInput{} : inputs.back()));
  Rig a = wild_rig(), b = wild_rig();
  const auto copied_at = 500 + random.below(4000);
  ServoState copy;
  long removed = 0;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (i == copied_at) copy = a.state;
    const TickOutput out = step(a.model, a.state, inputs[i]);
    removed += out.removed_count;
    const TickOutput other = step(b.model, b.state, inputs[i]);
    ASSERT_EQ(make_tick_record(out), make_tick_record(other)) << "tick " << i;
    ASSERT_EQ(state_hash(a.state), state_hash(b.state)) << "tick " << i;
    if (i >= copied_at) {
      (void)step(a.model, copy, inputs[i]);
      ASSERT_EQ(state_hash(copy), state_hash(a.state))
          << "tick " << i << ", copied at " << copied_at;
    }
  }
  EXPECT_GT(removed, 2000);
  EXPECT_EQ(copy.tooth.to_grid().tissue, b.state.tooth.to_grid().tissue);
  EXPECT_EQ(copy.tooth.to_grid().distance, b.state.tooth.to_grid().distance);
}

TEST(Servo, TheHashSeesASingleNanometreAndASinglePedalStep) {
  for (const bool pedal : {false, true}) {
    Random random(7);
    Rig a = wild_rig(), b = wild_rig();
    TickInput in;
    for (int i = 0; i < 1500; ++i) {
      in = wild(random, i, in);
      TickInput other = in;
      if (i == 700 && pedal) --other.pedal_q16;
      if (i == 700 && !pedal) ++other.tip_nm[0];
      (void)step(a.model, a.state, in);
      (void)step(b.model, b.state, other);
      if (i < 700) {
        ASSERT_EQ(state_hash(a.state), state_hash(b.state));
      }
    }
    EXPECT_NE(state_hash(a.state), state_hash(b.state)) << (pedal ? "pedal" : "tip");
  }
}

TEST(Servo, TheHashSeesTheStateOfEveryStage) {
  Rig rig = wild_rig();
  Random random(7);
  TickInput in;
  for (int i = 0; i < 1200; ++i) {
    in = wild(random, i, in);
    (void)step(rig.model, rig.state, in);
  }
  ServoState& s = rig.state;
  std::set<std::uint64_t> seen{state_hash(s)};
  const auto changed = [&](auto& part, auto by) {
    const auto before = part;
    part += by;
    EXPECT_TRUE(seen.insert(state_hash(s)).second) << "change " << seen.size();
    part = before;
  };
  changed(s.tick, 1);
  changed(s.trace_hash, 1);
  changed(s.handpiece.rpm, 1.0);
  changed(s.estimate.speed_mm_s.x, 1e-9);
  changed(s.contact.proxy_mm.z, 1e-9);
  changed(s.contact.stride_mm, 1e-9);
  changed(s.contact.last_step_mm.y, 1e-9);
  changed(s.contact.opened.turned_rad, 1e-9);
  changed(s.contact.gathered.reach_mm, 1e-9);
  changed(s.contact.coming.next_sample, 1);
  changed(s.contact.active.at[2], 1);
  changed(s.touched.means.of.damping_n_s_per_mm, 1e-9);
  changed(s.touched.means.grinding.head_share, 1e-9);
  changed(s.handpiece.load_n_mm, 1e-9);
  changed(s.estimate.travel_nm[1], 1);
  changed(s.recession.normal.z, 1e-9);
  changed(s.carving.last.rotation.row_y.x, 1e-9);
  changed(s.safety.silent_s, 1e-9);
  changed(s.recession.pending_mm, 1e-9);
  changed(s.recession.followed_edit, 1);
  changed(s.recession.head.tip_mm.y, 1e-9);
  changed(s.render.branch_n, 1e-9);
  changed(s.carving.swept_mm, 1e-9);
  changed(s.carving.last.tip_mm.x, 1e-9);
  changed(s.safety.used_budget_n_s, 1e-9);
  s.terms.count = 1;
  changed(s.terms.memory[0][0], 1e-9);
  EXPECT_EQ(seen.size(), 27u);
}

TEST(Servo, TheHandpieceSpinsUpExponentiallyWithThePedal) {
  Rig rig = wild_rig();
  for (int i = 1; i <= 600; ++i) {
    const TickOutput out = rig.tick({0, 0, 1}, 0.5);
    ASSERT_NEAR(out.rpm, 100000 * (1 - std::exp(-i * 0.001 / 0.15)), 250);
  }
  for (int i = 0; i < 2000; ++i) (void)rig.tick({0, 0, 1}, 0.0);
  EXPECT_EQ(rig.state.handpiece.rpm, 0.0);
}

TEST(Servo, ForceFallsWhenTheTipBreaksThroughIntoThePulp) {
  const Tooth tooth =
      make_block({2.4, 2.4, 3.0}, {{"enamel", 1.0}, {"pulp", 1.2}, {"dentin", 0.8}}, 0.05);
  Rig rig(tooth, {shipped_bur("round-1.0")}, shipped_model("paper"), {0, 0, 0.05});
  rig.spin_up({0, 0, 0.05});
  double before = 0, after = 1e9, worst_rise = 0, worst_model = 0, worst_rendered = 0,
         last_model = 0, last_rendered = 0, highest = 0;
  const int n = static_cast<int>(2.6 / 0.25 * 1000);
  for (int i = 1; i <= n; ++i) {
    const TickOutput out = rig.tick({0, 0, 0.05 - 0.25e-3 * i}, 1.0);
    const double rendered = length(out.rendered_force_n), tip = out.proxy_mm.z;
    if (i > 400 && tip > -1.9) {  // from full contact in the enamel until the head is in the pulp,
                                  // before it meets the floor
      worst_model = std::max(worst_model, std::fabs(out.model_force_n - last_model));
      worst_rendered = std::max(worst_rendered, std::fabs(rendered - last_rendered));
    }
    last_model = out.model_force_n, last_rendered = rendered;
    if (tip > -0.95) {
      highest = std::max(highest, out.model_force_n);
      before = out.model_force_n;
    } else if (tip > -1.4) {
      worst_rise = std::max(worst_rise, out.model_force_n - before);
    } else if (tip < -1.55 && tip > -2.1) {
      after = std::min(after, out.model_force_n);
    }
  }
  std::printf(
      "pulp: %.3f N before the tip breaks through, %.3f N with the head in the pulp; largest change in a tick: model %.4f N, rendered %.4f N\n",
      before, after, worst_model, worst_rendered);
  EXPECT_GT(before, 0.6);
  EXPECT_LT(after, 0.15 * before) << "nothing is left to press on";
  EXPECT_LE(worst_rise, 0.1 * before);
  EXPECT_LE(worst_model, 0.005);
  EXPECT_LE(worst_rendered, 0.005);
}

TEST(Servo, ForceStaysContinuousAcrossTheBorderOfTwoTissues) {
  const Tooth tooth = make_block({2.4, 2.4, 3.0}, {{"enamel", 1.0}, {"dentin", 2.0}}, 0.05);
  ForceModel force = hard_model(1.2, 0);
  force.materials.find("dentin")->second.voigt = {0.4, 0};
  Rig rig(tooth, {shipped_bur("round-1.0")}, force, {0, 0, 0.05});
  rig.spin_up({0, 0, 0.05});
  double worst = 0, last = 0, in_enamel = 0;
  TickOutput out;
  for (int i = 1; i <= 10000; ++i) {
    out = rig.tick({0, 0, 0.05 - 0.25e-3 * i}, 1.0);
    if (i > 400) worst = std::max(worst, std::fabs(out.model_force_n - last));
    last = out.model_force_n;
    if (out.proxy_mm.z > -0.85) in_enamel = out.stiffness_n_per_mm;
  }
  std::printf(
      "enamel to dentin, k 1.2 to 0.4 N/mm: largest change of the model force in a tick %.4f N\n",
      worst);
  EXPECT_NEAR(in_enamel, 1.2, 1e-9);
  EXPECT_NEAR(out.stiffness_n_per_mm, 0.4, 1e-9);
  EXPECT_LE(worst, 0.005);
}

TEST(Servo, GumIsFeltSofterThanAnyHardTissueAndANeighbourLikeTheToothItself) {
  struct Felt {
    double pressed_n, held_n;
  };
  for (const char* set : {"consistent", "paper", "clinical"}) {
    // a resting bur pressed 0.3 mm in at 1 mm/s, and held there for a second
    const auto felt = [&](const std::string& tissue) {
      Rig rig(make_block({2.4, 2.4, 2.0}, {{tissue, 2.0}}, 0.05), {shipped_bur("round-1.0")},
              shipped_model(set), {0, 0, 0.05});
      EXPECT_NEAR(length(rig.tick({0, 0, 0.05}, 0).rendered_force_n), 0, 1e-6)
          << "nothing is touched yet";
      Felt f{length(rig.travel({0, 0, 0.05}, {0, 0, -0.3}, 1.0).rendered_force_n), 0};
      for (int i = 0; i < 1000; ++i) f.held_n = length(rig.tick({0, 0, -0.3}, 0).rendered_force_n);
      return f;
    };
    const Felt gum = felt("gingiva"), lesion = felt("lesion"), dentin = felt("dentin");
    for (const auto& [name, f] :
         {std::pair("gum", gum), std::pair("softened dentin", lesion), std::pair("dentin", dentin)})
      std::printf("%s: %s, 0.3 mm in: %.3f N pressed at 1 mm/s, %.3f N held\n", set, name,
                  f.pressed_n, f.held_n);
    EXPECT_GT(gum.held_n, 0.03) << "its touch is felt";
    EXPECT_LT(gum.held_n, 0.9 * lesion.held_n);
    EXPECT_LT(gum.held_n, 0.4 * dentin.held_n);
    EXPECT_LT(gum.pressed_n, lesion.pressed_n);
    EXPECT_LT(gum.pressed_n, 0.6 * dentin.pressed_n) << "also with the paper's dampers";
    for (const char* hard : {"dentin", "enamel"})
      EXPECT_DOUBLE_EQ(felt(std::string("neighbour_") + hard).held_n, felt(hard).held_n);
  }
}

TEST(Servo, NoticesTellWhatWentWrong) {
  const Tooth tooth = four_layers();
  const auto pressed = [&] {
    Rig rig(tooth, {shipped_bur("round-1.0")}, hard_model(0.8, 0), {0, 0, 0.1});
    (void)rig.travel({0, 0, 0.1}, {0, 0, -1}, 20);
    for (int i = 0; i < 50; ++i) (void)rig.tick({0, 0, -1}, 0);
    return rig;
  };
  {
    Rig rig = pressed();
    TickOutput out = rig.tick({0, 0, -1}, 0);
    EXPECT_EQ(out.notices, 0);
    EXPECT_NEAR(length(out.rendered_force_n), 0.8, 0.02);
    for (int i = 1; i <= 5; ++i)
      EXPECT_EQ(rig.tick({0, 0, -1}, 0, {}, k_pedal_fresh).notices, 0)
          << i << " ms of silence are allowed";
    out = rig.tick({0, 0, -1}, 0, {}, k_pedal_fresh);
    EXPECT_EQ(out.notices, k_notice_stale_stylus);
    for (int i = 0; i < 4; ++i) out = rig.tick({0, 0, -1}, 0, {}, k_pedal_fresh);
    EXPECT_LE(length(out.rendered_force_n), 1e-9) << "zero 10 ms after the last fresh pose";
  }
  {
    Rig rig = pressed();
    const TickOutput out = rig.tick({0, 0, -1}, 0, {}, k_stylus_fresh);
    EXPECT_EQ(out.notices, k_notice_no_pedal);
  }
  {
    Rig rig = pressed();
    rig.input.bur = 1;
    TickOutput out;
    for (int i = 0; i < 10; ++i) out = rig.tick({0, 0, -1}, 1.0);
    EXPECT_EQ(out.notices, k_notice_bad_bur);
    EXPECT_EQ(out.rpm, 0.0);
    EXPECT_EQ(length(out.rendered_force_n), 0.0);
    EXPECT_FALSE(out.contact);
  }
  {
    Rig rig = pressed();
    std::uint16_t seen = 0;
    TickOutput out;
    for (int i = 0; i < 100; ++i) {
      out = rig.tick({0, 0, -1 - 0.05 * i}, 0);
      seen |= out.notices;
      ASSERT_LE(length(out.rendered_force_n), 3.3 + 1e-9);
    }
    EXPECT_NE(seen & k_notice_force_clamped, 0);
    EXPECT_GT(out.model_force_n, 3.3) << "the model force is recorded unclamped";
  }
}

TEST(Servo, BadReadingsBecomeFaultsAndNeverNumbers) {
  TickInput good = make_tick_input({{1, 2, 3}, {0.5, 0.5, 0.5, 0.5}}, 0.5,
                                   k_stylus_fresh | k_pedal_fresh, 0, {});
  const Pose bad[] = {{{NAN, 0, 0}, {}},           {{0, INFINITY, 0}, {}},
                      {{0, 0, 5000}, {}},          {{0, 0, 0}, {0, 0, 0, 0}},
                      {{0, 0, 0}, {NAN, 0, 0, 0}}, {{0, 0, 0}, {1, INFINITY, 0, 0}}};
  for (const auto& pose : bad) {
    const TickInput in = make_tick_input(pose, 0.5, k_stylus_fresh | k_pedal_fresh, 0, good);
    EXPECT_EQ(in.tip_nm, good.tip_nm);
    EXPECT_EQ(in.rotation_q30, good.rotation_q30);
    EXPECT_EQ(in.flags, k_stylus_fault | k_pedal_fresh);
  }
  for (const double pedal :
       {-0.01, 1.01, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    const TickInput in = make_tick_input({}, pedal, k_stylus_fresh | k_pedal_fresh, 0, good);
    EXPECT_EQ(in.flags, k_stylus_fresh);
    EXPECT_EQ(in.pedal_q16, 0);
  }
  Rig rig = wild_rig();
  Random random(drawn_seed("Servo.BadReadingsBecomeFaultsAndNeverNumbers"));
  for (int i = 0; i < 3000;
       ++i) {  // any whole numbers at all, as a damaged recording could hold them
    for (auto& v : rig.input.tip_nm)
      v = static_cast<std::int32_t>(random.next() >> (random.below(2) ? 32 : 44)) >>
          random.below(12);
    for (auto& v : rig.input.rotation_q30)
      v = random.below(10) ? static_cast<std::int32_t>(random.next()) : 0;
    rig.input.pedal_q16 = static_cast<std::uint16_t>(random.next());
    rig.input.flags = static_cast<std::uint16_t>(random.next());
    rig.input.bur = static_cast<std::uint8_t>(random.below(3));
    const TickOutput out = step(rig.model, rig.state, rig.input);
    ASSERT_TRUE(is_finite(out.rendered_force_n) && std::isfinite(out.model_force_n) &&
                std::isfinite(out.penetration_mm) && is_finite(out.proxy_mm) &&
                std::isfinite(out.rpm));
    ASSERT_LE(length(out.rendered_force_n), 3.3 + 1e-9);
  }
}

TEST(Servo, PoseSurvivesQuantisationToANanometre) {
  Random random(drawn_seed("Servo.PoseSurvivesQuantisationToANanometre"));
  for (int i = 0; i < 2000; ++i) {
    const Pose pose{{random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(-60, 60)},
                    random_rotation(random)};
    const double pedal = random.uniform();
    const TickInput in = make_tick_input(pose, pedal, k_stylus_fresh | k_pedal_fresh, 0, {});
    EXPECT_LE(length(in.pose().tip_mm - pose.tip_mm), 1e-6);
    EXPECT_NEAR(in.pose().rotation.w, pose.rotation.w, 2e-9);
    EXPECT_NEAR(in.pose().rotation.y, pose.rotation.y, 2e-9);
    EXPECT_NEAR(in.pedal(), pedal, 1e-5);
    EXPECT_EQ(in.flags, k_stylus_fresh | k_pedal_fresh);
  }
}

TEST(Servo, ConfigSurvivesItsTomlAndRefusesOddValues) {
  ServoConfig config;
  config.tick_s = 0.00025;
  config.max_rpm = 123456.789;
  config.limits.peak_n = 0.1 + 0.2;
  config.position_quantum_mm = 0.055;
  const std::string text = to_toml(config);
  const ServoConfig back = parse_servo_config(text, "c.toml");
  EXPECT_EQ(to_toml(back), text);
  EXPECT_EQ(back.limits.peak_n, config.limits.peak_n) << "to the last bit";
  EXPECT_EQ(back.position_quantum_mm, config.position_quantum_mm);
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"spin_up_s", "spin_s"},
                                 {"[limits]", "[limit]"},
                                 {"quantum_mm = ", "quantum_mm = -"},
                                 {"tick_s = ", "tick_s = -"}}) {
    std::string bad = text;
    bad.replace(bad.find(from), from.size(), to);
    EXPECT_TRUE(place_of(thrown_by([&] {
                  (void)parse_servo_config(bad, "c.toml");
                })).starts_with("c.toml:"))
        << to;
  }
}

TEST(Servo, AModelWithoutAMaterialForASolidTissueIsRefused) {
  ForceModel force = shipped_model("paper");
  force.materials.erase("dentin");
  const Tooth tooth = four_layers();
  EXPECT_TRUE(tells(
      thrown_by([&] { (void)make_servo_model(tooth, {shipped_bur("round-1.0")}, force, {}); }),
      "dentin"));
  EXPECT_THROW((void)make_servo_model(tooth, {}, shipped_model("paper"), {}), Error);
  force = hard_model(0.8, 0, 0);
  EXPECT_TRUE(tells(
      thrown_by([&] { (void)make_servo_model(tooth, {shipped_bur("round-1.0")}, force, {}); }),
      "tau_s"));
}

}  // namespace
}  // namespace cavum
