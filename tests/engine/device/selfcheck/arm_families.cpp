#include "tests/engine/device/selfcheck/arm_families.h"

#include <stdexcept>

#include "engine/device/selfcheck/arm/arm_check.h"
#include "engine/device/selfcheck/check_rule.h"

namespace cavum::testing_selfcheck {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed * 0x9e3779b97f4a7c15U + 12345) {}
  double between(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>()(random_);
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  bool chance(double p) { return std::uniform_real_distribution<double>()(random_) < p; }

 private:
  std::mt19937_64 random_;
};

struct Range {
  double low, high;
};
/// What a family draws from.
struct Family {
  Range mass_kg, coulomb_n, stribeck, stribeck_mm_s, viscous, ripple_n, weight_n, spring,
      backlash_mm, quantum_mm, rate_hz, jitter;
  int most_delay;
};

Family family_of(const std::string& name) {
  if (name == "light")
    return {{.03, .08}, {.05, .25}, {0, .2},    {2, 15},     {0, 2e-4}, {0, .02}, {0, .1},
            {0, .005},  {0, .05},   {.02, .06}, {900, 1100}, {0, .3},   2};
  if (name == "delta")
    return {{.09, .25}, {.06, .2}, {0, .3},    {2, 15},     {0, 4e-4}, {0, .03}, {.05, .3},
            {0, .005},  {0, .05},  {.02, .06}, {800, 1100}, {0, .3},   2};
  if (name == "heavy")
    return {{.2, .5}, {.02, .12}, {0, .3},     {2, 15},      {0, 1e-3}, {0, .02}, {0, .15},
            {0, .01}, {0, .02},   {.005, .02}, {1000, 4000}, {0, .2},   3};
  if (name == "worn")
    return {{.06, .2}, {.08, .2},  {.2, .6},   {2, 25},     {0, 5e-4}, {.02, .06}, {0, .2},
            {0, .01},  {.03, .15}, {.02, .06}, {500, 1100}, {0, .3},   2};
  throw std::invalid_argument("no such family: " + name);
}

}  // namespace

const std::vector<std::string>& arm_families() {
  static const std::vector<std::string> names{"light", "delta", "heavy", "worn"};
  return names;
}

ArmModel draw_arm(const std::string& family, std::uint64_t seed) {
  Draw d(seed * 31 + family.size() * 7 + static_cast<std::uint64_t>(family[0]));
  const Family f = family_of(family);
  const auto of = [&](Range r) { return d.between(r.low, r.high); };
  ArmModel m;
  const double mass = of(f.mass_kg), coulomb = of(f.coulomb_n);
  for (std::size_t i = 0; i < 3; ++i) {
    m.mass_kg[i] = mass * d.between(0.75, 1.3);
    m.coulomb_n[i] = coulomb * d.between(0.7, 1.3);
  }
  m.stribeck = of(f.stribeck);
  m.stribeck_mm_s = of(f.stribeck_mm_s);
  m.viscous_n_s_per_mm = of(f.viscous);
  m.ripple_n = of(f.ripple_n);
  m.ripple_mm = d.between(1.5, 8.0);
  m.weight_n = {0.0, d.between(-0.03, 0.03), of(f.weight_n)};
  m.spring_n_per_mm = of(f.spring);
  m.backlash_mm = of(f.backlash_mm);
  m.quantum_mm = of(f.quantum_mm);
  m.joint_encoders = d.chance(0.5);
  m.rate_hz = of(f.rate_hz);
  m.jitter = of(f.jitter);
  m.delay = 1 + static_cast<int>(d.between(0.0, f.most_delay));
  m.skew_rad = d.between(0.0, 0.6);
  m.one_friction = d.chance(0.25);
  return m;
}

ArmDays draw_days(std::uint64_t seed) {
  Draw d(seed * 17 + 5);
  return {d.between(0.002, 0.01), d.between(0.01, 0.08), d.between(0.0, 0.01)};
}

ArmHand draw_hand(std::uint64_t seed) {
  Draw d(seed * 29 + 3);
  return {d.between(0.03, 0.2), d.between(0.03, 1.5), d.between(0.0005, 0.05), d.between(0.05, 0.6),
          d.between(7.0, 12.0)};
}

ArmModel on_a_day(const ArmModel& arm, const ArmDays& days, std::uint64_t seed) {
  Draw d(seed * 101 + 77);
  ArmModel m = arm;
  m.gain *= 1.0 + days.gain * d.normal();
  const double friction = std::max(0.2, 1.0 + days.friction * d.normal());
  for (double& c : m.coulomb_n) c *= friction;
  m.viscous_n_s_per_mm *= std::max(0.2, 1.0 + 2.0 * days.friction * d.normal());
  m.weight_n += Vec3{0, 0, days.weight_n * d.normal()};
  return m;
}

ArmFigures check_free_arm(FreeArm& arm, std::uint64_t seed, double uneven) {
  constexpr double k_late_share = 0.0005, k_late_ns = 4e6, k_tick_ns = 1e6;
  Draw d(seed);
  std::int64_t now = 1;
  ArmCheckOptions o;
  o.clock = [&] {
    const double late = uneven > 0.0 && d.chance(k_late_share) ? k_late_ns : 0.0;
    return now +=
           static_cast<std::int64_t>(k_tick_ns * (1.0 + uneven * d.between(-0.5, 0.5)) + late);
  };
  return check_arm(arm, o);
}

StationTrial try_station(const std::string& family, std::uint64_t seed, int checks, int unchanged) {
  const ArmModel arm = draw_arm(family, seed);
  const ArmDays days = draw_days(seed);
  StationTrial t;
  std::uint64_t day = seed * 1000;
  const auto check = [&](const ArmModel& m) {
    ++day;
    FreeArm today(on_a_day(m, days, day), {3, -2, 1}, day * 3 + 1);
    const ArmFigures f = check_free_arm(today, day * 7 + 2);
    t.longest_s = std::max(t.longest_s, f.seconds);
    return f;
  };
  std::vector<ArmFigures> learnt;
  for (int i = 0; i < 2 * checks && static_cast<int>(learnt.size()) < checks; ++i) {
    const ArmFigures f = check(arm);
    if (f.doubt.empty())
      learnt.push_back(f);
    else
      ++t.doubtful;
  }
  t.learnt = static_cast<int>(learnt.size());
  for (int i = 0; i < unchanged; ++i) {
    const CheckVerdict v = judge_check(check(arm), learnt);
    ++t.unchanged_checks;
    t.doubtful += v.outcome == CheckOutcome::doubtful ? 1 : 0;
    if (v.outcome != CheckOutcome::changed) continue;
    ++t.false_alarms;
    t.false_alarm = v.changes[0].quantity + " " + v.changes[0].axis;
  }
  constexpr double k_more_friction_n = 0.1, k_less_gain = 0.9;
  ArmModel stiffer = arm, weaker = arm;
  for (double& c : stiffer.coulomb_n) c += k_more_friction_n;
  weaker.gain = k_less_gain;
  const auto of_gain = [](const CheckChange& c) {
    return c.quantity == "gain" || c.quantity == "mass" || c.quantity == "gain or mass";
  };
  const CheckVerdict friction = judge_check(check(stiffer), learnt),
                     gain = judge_check(check(weaker), learnt);
  t.friction_doubtful = friction.outcome == CheckOutcome::doubtful;
  t.gain_doubtful = gain.outcome == CheckOutcome::doubtful;
  for (const CheckChange& c : friction.changes) {
    t.friction_found = t.friction_found || (c.quantity == "friction" && c.change > 0.0);
    t.gain_named_too = t.gain_named_too || of_gain(c);
  }
  for (const CheckChange& c : gain.changes) {
    t.friction_named_too = t.friction_named_too || c.quantity == "friction";
    if (!of_gain(c)) continue;
    t.gain_cause = c.quantity;
    t.gain_found = t.gain_found || (c.quantity != "mass" && c.change < 0.0);
  }
  ++day;
  FreeArm held(on_a_day(arm, days, day), {3, -2, 1}, day * 3 + 1);
  held.set_hand(draw_hand(seed));
  t.hand_unseen =
      judge_check(check_free_arm(held, day * 7 + 2), learnt).outcome == CheckOutcome::unchanged;
  return t;
}

}  // namespace cavum::testing_selfcheck
