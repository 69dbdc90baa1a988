// A simulated candidate: a skill, and a hand that follows a plan while it looks and feels. It sees
// the bur where the screen shows it (the proxy) and feels the force, both a reaction time late; it
// says where it wants the tip, and the hand and the device (engine/device) do the rest.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/random.h"
#include "engine/device/simulated_omni.h"
#include "engine/physics/servo/tick.h"
#include "scenarios/file/scenario.h"
#include "scenarios/operators/cut_plan.h"

namespace cavum::scenarios {

/// Stiffness of hard tissue that a practised hand reckons with.
inline constexpr double k_hard_n_per_mm = 0.8;

/// What distinguishes an expert from a novice.
struct Skill {
  std::string name;
  double press_n = 0.95;  ///< force on the bur while cutting: with the tissue it gives the speed
  double careful_press_n = 0.5;  ///< the same close to a cavity
  double reaction_s = 0.06;      ///< from seeing and feeling to acting
  double tremor_mm = 0.01;       ///< rms, below 5 Hz
  Vec3 offset_mm;                ///< constant error of aim
  double stops_short = 0.0;      ///< share of the plan's depth that is never reached
  bool perforates = false;       ///< goes on through the floor
  HandModel hand;
};

/// `expert`, `novice`, `perforator`, or `careless`, who has an expert's hand and makes the mistake
/// that the scenario names; or `student-0` (a beginner) to `student-100` (an expert), for classes.
/// The seed draws the novice's and the students' habits. Throws Error on another name.
[[nodiscard]] Skill make_skill(const std::string& name, std::uint64_t seed);

/// What the candidate wants in one tick.
struct Intent {
  Vec3 tip_mm;
  double pedal = 0;
  std::uint8_t bur = 0;  ///< of the tray
  bool done = false;     ///< nothing left to do
};

class Operator {
 public:
  /// Follows `way` (see plan_cut) with the handpiece held along `approach`, unit, out of the tooth.
  Operator(Skill skill, std::vector<Waypoint> way, Vec3 approach, std::uint64_t seed);

  [[nodiscard]] Vec3 start_mm() const noexcept {
    return way_.empty() ? Vec3{0, 0, 20} : way_.front().tip_mm;
  }
  /// `seen` is the last tick's output.
  [[nodiscard]] Intent act(const TickOutput& seen, double dt_s) noexcept;
  [[nodiscard]] const Skill& skill() const noexcept { return skill_; }
  /// From the tool's frame to the tooth's; the same all the time.
  [[nodiscard]] Quat rotation() const noexcept { return rotation_between({0, 0, 1}, approach_); }
  /// Done so far, 0..1.
  [[nodiscard]] double progress() const noexcept {
    return way_.empty() ? 1.0 : static_cast<double>(next_) / static_cast<double>(way_.size());
  }

 private:
  struct Sight {
    Vec3 proxy_mm;
    double force_n = 0;
    bool contact = false;
  };
  bool retreat(Vec3 from_mm) noexcept;
  /// `p` lifted along the approach to the height of the ways through the air.
  [[nodiscard]] Vec3 in_air(Vec3 p) const noexcept {
    return p + approach_ * dot(start_mm() - p, approach_);
  }
  [[nodiscard]] Sight delayed(const TickOutput& seen, double dt_s) noexcept;
  /// To the next waypoint, mm.
  [[nodiscard]] double left_to_goal(Vec3 proxy_mm) const noexcept;
  void watch_progress(double left_mm, double dt_s) noexcept;
  /// The way beyond the next waypoint leads on in nearly the same direction.
  [[nodiscard]] bool bends_gently() const noexcept;
  void go_on(bool through) noexcept;
  struct Aim {
    Vec3 direction, correction_mm;  // unit, towards the goal; across the way, back to it
  };
  [[nodiscard]] Aim aim_at(const Waypoint& goal, Vec3 proxy_mm) const noexcept;
  /// Until the force felt is the one aimed at; where nothing resists, at a quiet speed.
  void push(const Waypoint& goal, const Sight& felt, double slow_down, double dt_s) noexcept;
  void tremble(double dt_s) noexcept;
  void move_foot(bool cut, double dt_s) noexcept;

  Skill skill_;
  std::vector<Waypoint> way_;
  Vec3 approach_;
  Random random_;
  std::vector<Sight> memory_;  // ring of the last sights
  std::size_t now_ = 0;
  std::size_t next_ = 1;
  Vec3 from_mm_, tremor_mm_, intended_mm_;
  Vec3 towards_;  // of the push: a unit vector, shorter while it turns
  double lead_mm_ = 0, stuck_s_ = 0, best_mm_ = 1e9, pedal_ = 0;
};

/// The bur of a tray that reaches most of the target's columns at their full depth; of equals the
/// first one.
struct ChosenBur {
  std::size_t index = 0;  ///< the tray's size when none fits
  ReachMap map;           ///< of that bur
  std::size_t blunt = 0;  ///< of those that go into the target the one with the bluntest end: it
                          ///< falls in where a taper wedges itself in
  ReachMap blunt_map;     ///< of that
  std::vector<double> covers;  ///< share of the target that each bur of the tray can remove, 0..1
};
[[nodiscard]] ChosenBur choose_bur(const ZoneMap& zones, const Tooth& tooth,
                                   const std::vector<ContactTool>& tray);

/// All that a candidate does in an exam: the pilot hole, where there is an aim, then the target
/// (plan_cut).
[[nodiscard]] std::vector<Waypoint> plan_work(const ChosenBur& chosen, const Tooth& tooth,
                                              const std::vector<ContactTool>& tray,
                                              const std::vector<std::string>& aims);

/// The plan and the candidate for a scenario laid into a tooth: the pilot hole is made with the
/// bluntest bur, all else with the first one allowed that removes the target best. Throws Error
/// when no allowed bur fits into the target, or when `careless` is asked for and the scenario has
/// no [careless].
struct Candidate {
  Operator hands;
  std::uint8_t bur = 0;  ///< with which the target is cut, of the tray
};
[[nodiscard]] Candidate make_candidate(const std::string& skill, const Scenario& scenario,
                                       const ZoneMap& zones, const Tooth& tooth,
                                       const std::vector<ContactTool>& tray, std::uint64_t seed);

}  // namespace cavum::scenarios
