// Is the rendered force stable in a hand? The simulated Omni in a simulated hand presses on a block
// with the handpiece still, in closed loop through the real servo step, for many stiffnesses,
// dampings, delays, hands and loads. Beside every cell the explicit rendering F = k X + c V, which
// a 1 kHz loop cannot bear for the paper's c.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "engine/device/simulated_omni.h"
#include "engine/physics/servo/servo.h"

namespace cavum {

/// Where c comes from: eq. 5, critical damping of the stylus's mass, or nothing.
enum class DampingRule : std::uint8_t { paper, consistent, none };
[[nodiscard]] const char* damping_name(DampingRule rule) noexcept;
[[nodiscard]] double damping_n_s_per_mm(DampingRule rule, double k_n_per_mm,
                                        double mass_kg) noexcept;

/// Ours: the Maxwell branch. Explicit: k X + c V with the plain difference of two ticks, through
/// the same step, and with no slew limit but the device's own peak, as published.
enum class Rendering : std::uint8_t { ours, explicit_voigt };

struct PressCell {
  double k_n_per_mm = 0.8;
  DampingRule damping = DampingRule::paper;
  int delay_ticks = 1;
  double hand_n_per_mm = 0.3, press_n = 1.0;
};

struct PressOptions {
  std::vector<double> k_n_per_mm{0.2, 0.4, 0.8, 1.2};
  std::vector<DampingRule> damping{DampingRule::paper, DampingRule::consistent, DampingRule::none};
  std::vector<int> delay_ticks{0, 1};
  std::vector<double> hand_n_per_mm{0.1, 0.3, 1.0};
  std::vector<double> press_n{0.5, 1.0, 2.0};
  std::vector<double> contact_mm_s{5.0, 20.0, 50.0};
  double contact_press_n = 1.0;     ///< load that the hand comes down with
  double hand_mass_kg = 0.1;        ///< of the fingers (assumed)
  double hand_damping_ratio = 0.7;  ///< of the hand on its own spring (assumed)
  double hold_s = 5.0;              ///< after the hand has come down
  double limit_sd_n = 0.02;         ///< required: force sd in the last half second
  double limit_energy_mj = 0.001;  ///< required: no energy generated; less than this counts as none
  RenderingModel rendering;        ///< ours
  OmniModel omni;                  ///< its delay is the cell's
};

/// What a rendering did in a cell.
struct PressOutcome {
  double mean_n = 0, sd_n = 0;  ///< rendered force in the last half second
  double peak_n = 0;            ///< over the whole press
  double generated_mj = 0;  ///< passivity observer at the motors: the most that the wall had given
                            ///< out beyond what it had taken in
  double late_mj = 0;       ///< given out in the last half second, beyond what the spring k lost
  int encoder_steps = 0;    ///< in the last half second: the tip crept through them
  std::uint16_t notices = 0;  ///< TickNotice bits
  bool steady = false, passive = false;
};

struct PressRow {
  PressCell cell;
  PressOutcome ours, explicit_voigt;
  std::optional<PressOutcome>
      exact;  ///< ours once more with an exact encoder, where it missed a limit: is it the encoder?
};

/// Coming down on the block at a speed.
struct ContactOutcome {
  int bounces = 0;  ///< losses of contact after the first touch
  double peak_n = 0;
};
struct ContactRow {
  PressCell cell;
  double speed_mm_s = 0;
  ContactOutcome ours, explicit_voigt;
};

struct PressResult {
  PressOptions options;
  std::vector<PressRow> presses;
  std::vector<ContactRow> contacts;
  [[nodiscard]] bool within_limits()
      const noexcept;  ///< every press with our rendering, and no bounce with it
};

/// A block and the bur that presses on it with its tip.
struct PressBench {
  Tooth block;
  Bur bur;
};
[[nodiscard]] PressBench make_press_bench(const Bur& bur);

/// One press: within a second the hand comes down to where its spring and the tissue's balance at
/// `press_n`, and holds.
[[nodiscard]] PressOutcome press(const PressBench& bench, const PressCell& cell,
                                 const PressOptions& options, Rendering rendering);
/// The hand comes down at `speed_mm_s` to where it presses with `press_n`.
[[nodiscard]] ContactOutcome come_down(const PressBench& bench, const PressCell& cell,
                                       double speed_mm_s, const PressOptions& options,
                                       Rendering rendering);
/// Every combination of the options.
[[nodiscard]] PressResult run_press_rig(const PressOptions& options, const Bur& bur);

/// `every_cell`: one line for each press, not only for each k, c and delay.
[[nodiscard]] Lines to_text(const PressResult& result, bool every_cell);
[[nodiscard]] nlohmann::json to_json(const PressResult& result);

}  // namespace cavum
