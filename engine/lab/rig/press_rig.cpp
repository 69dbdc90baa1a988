#include "engine/lab/rig/press_rig.h"

#include <algorithm>
#include <cmath>

#include "engine/base/independent_runs.h"
#include "engine/base/statistics.h"
#include "engine/lab/rig/published.h"
#include "engine/tooth/make/make_block.h"

namespace cavum {
namespace {

constexpr double k_above_mm = 0.5;   // the hand starts here
constexpr double k_descent_s = 1.0;  // of a press
constexpr double k_window_s = 0.5;   // at the end
constexpr double k_after_s = 1.0;    // watched after contact is made
constexpr double k_tau_s = 2.02;     // a servo asks for it; nothing is cut

ForceModel force_of(const PressCell& cell, const PressOptions& o, Rendering rendering) {
  ForceModel force;
  force.name = "press";
  const double c = damping_n_s_per_mm(cell.damping, cell.k_n_per_mm, o.omni.mass_kg);
  for (const char* hard : {"enamel", "dentin"})
    force.materials[hard] = {{cell.k_n_per_mm, c}, k_tau_s};
  force.rendering = o.rendering;
  if (rendering ==
      Rendering::explicit_voigt) {  // no branch, all of c on the unfiltered difference of two ticks
    force.rendering.kvc_n_per_mm = 0.0;
    force.rendering.filtered_damping_n_s_per_mm = c;
    force.rendering.speed_filter_s = 0.0;
  }
  return force;
}

/// Ours knows the steps of the encoder. The explicit law goes out as published, with nothing but
/// the peak of the device: a slew limit would tame it.
ServoConfig config_of(const PressOptions& o, Rendering rendering) {
  ServoConfig config;
  if (rendering == Rendering::ours)
    config.position_quantum_mm = o.omni.quantum_mm;
  else
    config.limits.slew_n_per_s = 1e6;
  return config;
}

/// Stylus, hand and servo in closed loop, and a passivity observer between motors and mechanics.
class Loop {
 public:
  Loop(const PressBench& bench, const PressCell& cell, const PressOptions& o, Rendering rendering)
      : model_(make_servo_model(bench.block, {bench.bur}, force_of(cell, o, rendering),
                                config_of(o, rendering))),
        omni_(o.omni),
        device_(make_omni_state({0, 0, k_above_mm})),
        state_(make_servo_state(model_, bench.block, {0, 0, k_above_mm})) {
    omni_.delay_ticks = cell.delay_ticks;
    hand_.mass_kg = o.hand_mass_kg;
    hand_.stiffness_n_per_mm = cell.hand_n_per_mm;
    hand_.damping_n_s_per_mm = 2.0 * o.hand_damping_ratio *
                               std::sqrt(1000.0 * cell.hand_n_per_mm * o.hand_mass_kg) / 1000.0;
  }
  /// One tick with the hand's intended tip at height `z_mm`.
  const TickOutput& tick(double z_mm) {
    const double dt = model_.config.tick_s;
    const Vec3 before = device_.position_mm;
    OmniState ahead =
        device_;  // which force acts in this tick: the queue's first once the command is in
    const double size = length(last_.rendered_force_n);
    ahead.queued_n[static_cast<std::size_t>(omni_.delay_ticks)] =
        size > omni_.saturation_n ? last_.rendered_force_n * (omni_.saturation_n / size)
                                  : last_.rendered_force_n;
    const Vec3 motor = ahead.queued_n[0];
    const Vec3 tip = advance_omni(omni_, hand_, device_, last_.rendered_force_n, {0, 0, z_mm}, dt);
    taken_mj_ -= dot(motor, device_.position_mm - before);
    generated_mj_ = std::max(generated_mj_, -taken_mj_);
    input_ = make_tick_input({tip, {}}, 0.0, k_stylus_fresh | k_pedal_fresh, 0, input_);
    return last_ = step(model_, state_, input_);
  }
  [[nodiscard]] double dt_s() const noexcept { return model_.config.tick_s; }
  [[nodiscard]] double height_mm() const noexcept { return device_.position_mm.z; }
  [[nodiscard]] double seen_mm() const noexcept {
    return input_.tip_nm[2] * 1e-6;
  }  ///< as the encoder told the servo
  [[nodiscard]] double taken_mj() const noexcept { return taken_mj_; }
  [[nodiscard]] double generated_mj() const noexcept { return generated_mj_; }

 private:
  ServoModel model_;
  OmniModel omni_;
  HandModel hand_;
  OmniState device_;
  ServoState state_;
  TickInput input_;
  TickOutput last_;
  double taken_mj_ = 0.0, generated_mj_ = 0.0;
};

/// Depth that the hand must want for a press: the tissue's spring and the hand's carry the same
/// load.
double wanted_depth_mm(const PressCell& cell) {
  return cell.press_n / cell.k_n_per_mm + cell.press_n / cell.hand_n_per_mm;
}

}  // namespace

const char* damping_name(DampingRule rule) noexcept {
  switch (rule) {
    case DampingRule::paper:
      return "paper";
    case DampingRule::consistent:
      return "consistent";
    case DampingRule::none:
      break;
  }
  return "none";
}

double damping_n_s_per_mm(DampingRule rule, double k_n_per_mm, double mass_kg) noexcept {
  switch (rule) {
    case DampingRule::paper:
      return paper_damping_n_s_per_mm(k_n_per_mm);
    case DampingRule::consistent:
      return consistent_damping_n_s_per_mm(k_n_per_mm, mass_kg);
    case DampingRule::none:
      break;
  }
  return 0.0;
}

PressBench make_press_bench(const Bur& bur) {
  return {make_block({6, 6, 2}, {{"dentin", 2.0}}, 0.05), bur};
}

PressOutcome press(const PressBench& bench, const PressCell& cell, const PressOptions& o,
                   Rendering rendering) {
  Loop loop(bench, cell, o, rendering);
  const auto ticks = static_cast<int>((k_descent_s + o.hold_s) / loop.dt_s() + 0.5),
             window = static_cast<int>(k_window_s / loop.dt_s() + 0.5);
  const double depth = wanted_depth_mm(cell);
  PressOutcome out;
  std::vector<double> force;
  double seen_mm = k_above_mm;
  const auto spring_mj = [&] {
    return 0.5 * cell.k_n_per_mm * std::max(0.0, -loop.height_mm()) *
           std::max(0.0, -loop.height_mm());
  };
  double taken_before = 0.0, spring_before = 0.0;
  for (int i = 1; i <= ticks; ++i) {
    if (i == ticks - window + 1) {
      taken_before = loop.taken_mj();
      spring_before = spring_mj();
    }
    const double way = std::min(1.0, i * loop.dt_s() / k_descent_s);
    const TickOutput& t = loop.tick(k_above_mm - way * (k_above_mm + depth));
    out.notices |= t.notices;
    out.peak_n = std::max(out.peak_n, length(t.rendered_force_n));
    if (i > ticks - window) {
      force.push_back(t.rendered_force_n.z);
      if (loop.seen_mm() != seen_mm) ++out.encoder_steps;
    }
    seen_mm = loop.seen_mm();
  }
  const MeanSd last = mean_sd(force);
  out.mean_n = last.mean;
  out.sd_n = last.sd;
  out.generated_mj = loop.generated_mj();
  out.late_mj = std::max(0.0, (spring_mj() - spring_before) - (loop.taken_mj() - taken_before));
  out.steady = out.sd_n <= o.limit_sd_n;
  out.passive = out.generated_mj <= o.limit_energy_mj && out.late_mj <= o.limit_energy_mj;
  return out;
}

ContactOutcome come_down(const PressBench& bench, const PressCell& cell, double speed_mm_s,
                         const PressOptions& o, Rendering rendering) {
  Loop loop(bench, cell, o, rendering);
  const double depth = wanted_depth_mm(cell);
  const double descent_s = (k_above_mm + depth) / speed_mm_s;
  const auto ticks = static_cast<int>((descent_s + k_after_s) / loop.dt_s());
  ContactOutcome out;
  bool touched = false;
  for (int i = 1; i <= ticks; ++i) {
    const TickOutput& t =
        loop.tick(k_above_mm - std::min(k_above_mm + depth, speed_mm_s * i * loop.dt_s()));
    if (touched && !t.contact) ++out.bounces;
    touched = t.contact;
    out.peak_n = std::max(out.peak_n, length(t.rendered_force_n));
  }
  return out;
}

bool PressResult::within_limits() const noexcept {
  return std::all_of(presses.begin(), presses.end(),
                     [](const PressRow& r) { return r.ours.steady && r.ours.passive; }) &&
         std::all_of(contacts.begin(), contacts.end(),
                     [](const ContactRow& r) { return r.ours.bounces == 0; });
}

PressResult run_press_rig(const PressOptions& options, const Bur& bur) {
  PressResult result;
  result.options = options;
  for (const double k : options.k_n_per_mm)
    for (const DampingRule damping : options.damping)
      for (const int delay : options.delay_ticks)
        for (const double hand : options.hand_n_per_mm) {
          for (const double load : options.press_n)
            result.presses.push_back({{k, damping, delay, hand, load}, {}, {}, {}});
          for (const double speed : options.contact_mm_s)
            result.contacts.push_back(
                {{k, damping, delay, hand, options.contact_press_n}, speed, {}, {}});
        }
  const PressBench bench = make_press_bench(bur);
  const std::size_t presses = result.presses.size();
  independent_runs(presses + result.contacts.size(), [&](std::size_t i) {
    if (i < presses) {
      PressRow& row = result.presses[i];
      row.ours = press(bench, row.cell, options, Rendering::ours);
      row.explicit_voigt = press(bench, row.cell, options, Rendering::explicit_voigt);
      if (row.ours.steady && row.ours.passive) return;
      PressOptions exact = options;
      exact.omni.quantum_mm = 0.0;
      row.exact = press(bench, row.cell, exact, Rendering::ours);
    } else {
      ContactRow& row = result.contacts[i - presses];
      row.ours = come_down(bench, row.cell, row.speed_mm_s, options, Rendering::ours);
      row.explicit_voigt =
          come_down(bench, row.cell, row.speed_mm_s, options, Rendering::explicit_voigt);
    }
  });
  return result;
}

}  // namespace cavum
