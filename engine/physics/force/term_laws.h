// The force terms: their formulae, one function each, and below them a record for each term. An
// exam and the columns that `explain` fits call the same functions, so that what is found is what
// is switched on. Sources: docs/physics.md section 6. Arithmetic and det_math.h only: the same bits
// everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/det_math.h"
#include "engine/physics/force/term_kinds.h"

namespace cavum {

/// Part of a dry friction at speed `v_mm_s`, -1 … 1: tanh(V/v0), v0 > 0.
[[nodiscard]] constexpr double sliding_share(double v_mm_s, double v0_mm_s) noexcept {
  return det_tanh(v_mm_s / v0_mm_s);
}

/// Part of the static friction that is left at speed `v_mm_s`, 0 … 1: e^(−(V/vs)²), vs > 0.
[[nodiscard]] constexpr double static_share(double v_mm_s, double vs_mm_s) noexcept {
  const double u = v_mm_s / vs_mm_s;
  return det_exp(-u * u);
}

/// Depth in a layer that begins at `d0_mm`: (X − d0)₊, mm.
[[nodiscard]] constexpr double layer_mm(double x_mm, double d0_mm) noexcept {
  return std::max(0.0, x_mm - d0_mm);
}

/// −k α X², N: what is added to k X so that the stiffness is k (1 − α X).
[[nodiscard]] constexpr double graded_n(double k_n_per_mm, double alpha_per_mm,
                                        double x_mm) noexcept {
  return -k_n_per_mm * alpha_per_mm * x_mm * x_mm;
}

/// X^m − X, X >= 0 in mm.
[[nodiscard]] constexpr double power_beyond_mm(double x_mm, double m) noexcept {
  return det_pow(x_mm, m) - x_mm;
}

/// |V|^n sign V − V, V in mm/s.
[[nodiscard]] constexpr double feed_beyond_mm_s(double v_mm_s, double n) noexcept {
  const double size = det_pow(v_mm_s < 0 ? -v_mm_s : v_mm_s, n);
  return (v_mm_s < 0 ? -size : size) - v_mm_s;
}

/// X/(1 + k X/Fs) − X, mm: how far a spring that softens with the force gives way; Fs > 0, N,
/// infinite = not at all.
[[nodiscard]] constexpr double softened_mm(double x_mm, double k_n_per_mm, double fs_n) noexcept {
  const double part = k_n_per_mm * x_mm / fs_n;
  return -x_mm * (part / (1.0 + part));
}

/// Stretch of a Maxwell branch after the tip moved by `moved_mm` at constant speed within u = dt/τ:
/// z' = V − z/τ, exact for any u >= 0.
[[nodiscard]] constexpr double relaxed_mm(double z_mm, double moved_mm, double u) noexcept {
  const double kept = det_exp(-u);
  return z_mm * kept + moved_mm * (u > 0.0 ? (1.0 - kept) / u : 1.0);
}

/// First-order lag y' = (g − y)/τ after a time of u·τ in which g went straight from `from` to `to`;
/// exact for any u > 0.
[[nodiscard]] constexpr double lagged_n(double y, double from, double to, double u) noexcept {
  const double behind = (to - from) / u;
  return to - behind + (y - from + behind) * det_exp(-u);
}

/// Bouc-Wen with n = 1 after the tip moved by `moved_mm`: z' = V − ((1 − γ) |V| z + γ V |z|)/d,
/// exact for a way of any length. |z| stays below d > 0, mm. γ = 0: Dahl's model; γ = 1/2:
/// unloading is straight. 0 <= γ <= 1/2.
[[nodiscard]] constexpr double loop_mm(double z_mm, double moved_mm, double d_mm,
                                       double gamma) noexcept {
  const double sign = moved_mm < 0 ? -1.0 : 1.0;
  double way = sign * moved_mm, y = sign * z_mm;  // along the motion
  if (y < 0.0) {                                  // unloading: y' = 1 − r y
    const double r = (1.0 - 2.0 * gamma) / d_mm;
    const double to_zero = r > 0.0 ? det_log(1.0 - r * y) / r : -y;
    if (way < to_zero)
      return sign * (r > 0.0 ? 1.0 / r + (y - 1.0 / r) * det_exp(-r * way) : y + way);
    way -= to_zero;
    y = 0.0;
  }
  return sign * (d_mm + (y - d_mm) * det_exp(-way / d_mm));
}

/// Place of a tip with play: it stays where it was until the drive at `x_mm` has gone `behind_mm`
/// past it, or `ahead_mm` back over it.
[[nodiscard]] constexpr double played_mm(double tip_mm, double x_mm, double behind_mm,
                                         double ahead_mm) noexcept {
  return std::clamp(tip_mm, x_mm - behind_mm, x_mm + ahead_mm);
}

/// sin(2π·turns): a line in the spectrum, for run-out and chatter.
[[nodiscard]] constexpr double line_at(double turns) noexcept {
  return det_sincos(2 * k_pi * turns).sin;
}

/// Twice the angle of approach as cos and sin, from degrees.
[[nodiscard]] constexpr SinCos twice_angle(double deg) noexcept {
  return det_sincos(2.0 * deg * (k_pi / 180.0));
}
/// cos 2(φ − φ0), from the two of φ and of φ0.
[[nodiscard]] constexpr double turned_share(SinCos phi, SinCos phi0) noexcept {
  return phi.cos * phi0.cos + phi.sin * phi0.sin;
}

/// Force, N, that a worn bur adds to `voigt_n` for each part w per mm³: F W.
[[nodiscard]] constexpr double worn_n(double voigt_n, double removed_mm3) noexcept {
  return voigt_n * removed_mm3;
}
/// Force, N, that water adds for a fraction of 1: F wet.
[[nodiscard]] constexpr double watered_n(double voigt_n, double wet) noexcept {
  return voigt_n * wet;
}
/// Force, N, that warmth adds for a softening of 1 per K: −F ΔT.
[[nodiscard]] constexpr double warmed_n(double voigt_n, double warmer_k) noexcept {
  return -voigt_n * warmer_k;
}

/// For term_kinds(), in its order. `p`: the parameters.
[[nodiscard]] inline std::vector<TermKind> force_laws() {
  using P = const double*;
  using In = const TermInput&;
  using Memory = TermMemory&;
  constexpr double k_rigid = std::numeric_limits<double>::infinity();
  return {
      {"coulomb_friction",
       "drag Fc tanh(V/v0)",
       "standard; the HAP-DENT paper blames it for its intercept",
       "Fc 0.26 N is the Omni's ([physics.md](physics.md), section 10); at 0.5 mm/s the slope Fc/v0 is 520 N·s/m",
       {{"fc_n", 0, 100, {}}, {"v0_mm_s", 1e-6, 1000, {}}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {.drag_n = p[0] * sliding_share(in.speed_mm_s, p[1])};
       }},
      // Something elastic between handpiece and tooth (a holder, a clamp, a ligament): ks in series
      // with the tissue's k, or a spring that gives way the more the harder it is pressed, half of
      // k X lost at Fs; the damper stays on the whole motion. `whole`: the Voigt body sits on ks,
      // and F starts from 0 at each contact. Memory: F, (k X + c V)/(1 + k/ks) of the tick before,
      // both N, and 1 when in contact then.
      {"series_compliance",
       "k X/(1 + k/ks) − k X, or k X/(1 + k X/Fs) − k X; `whole`: F = k (X − F/ks) + c (V − F'/ks)",
       "springs in series",
       "`whole` is computed as a lag of c/(ks + k) behind a base softer by 1 + k/ks; F starts from 0 at each contact",
       {{"ks_n_per_mm", 1e-3, 1e6, k_rigid},
        {"softening_force_n", 1e-3, 1e6, k_rigid},
        {"whole", 0, 1, 0.0}},
       [](P p, In in, Memory memory) noexcept -> TermForce {
         const double ks = p[0], k = in.stiffness_n_per_mm;
         // k·X/(1 + k/ks) − k·X, and k·X/(1 + k·X/Fs) − k·X; a spring that is not given adds −0,
         // which changes no bit
         if (p[2] < 0.5 || !std::isfinite(ks))
           return {-k * in.penetration_mm * (k / (k + ks)) +
                       k * softened_mm(in.penetration_mm, k, p[1]),
                   0.0};
         if (!in.touching) {
           memory = {};
           return {};
         }
         // the same as a lag of c/(ks + k) behind a base that is softer by 1 + k/ks
         const double c = in.damping_n_s_per_mm, softer = 1.0 + k / ks, tau_s = c / (ks + k);
         const double stiff_n = k * in.penetration_mm + c * in.approach_mm_s, to = stiff_n / softer;
         const double from = memory[2] > 0.0 ? memory[1] : c * in.approach_mm_s / softer;
         const double force_n =
             in.dt_s <= 0.0 || tau_s <= 0.0 ? to : lagged_n(memory[0], from, to, in.dt_s / tau_s);
         memory = {std::max(0.0, force_n), to, 1.0, 0.0};
         return {memory[0] - stiff_n, 0.0};
       }},
      // turns = phase + ∫ rpm/60 dt, or by the clock, as of a spindle that keeps its rate. The true
      // rate is `rate_ratio` times the one written down. Memory: turns since the start, less the
      // whole ones.
      {"run_out",
       "(A + e k) sin(2π turns) in contact and turning",
       "a bur off its axis; e = 3.5 to 50 µm is usual (recalled)",
       "at k = 0.8 that is 3 to 40 mN; 200,000 rpm is felt at its alias, 333 Hz",
       {{"amplitude_n", 0, 100, 0.0},
        {"eccentricity_um", 0, 1000, 0.0},
        {"phase_turns", 0, 1, 0.0},
        {"by_clock", 0, 1, 0.0},
        {"rate_ratio", 0.9, 1.1, 1.0}},
       [](P p, In in, Memory memory) noexcept -> TermForce {
         double& turns = memory[0];
         turns += p[4] * in.rpm * (in.dt_s / 60.0);
         turns -= std::floor(turns);
         if (in.rpm <= 0.0) return {};
         double now = turns;
         if (p[3] >= 0.5) {
           now = p[4] * in.rpm / 60.0 * in.time_s;
           now -= std::floor(now);
         }
         return {(p[0] + p[1] * 1e-3 * in.stiffness_n_per_mm) * line_at(now + p[2]), 0.0};
       }},
      {"viscous_friction",
       "drag b V",
       "standard",
       "",
       {{"b_n_s_per_mm", 0, 100, {}}},
       [](P p, In in, Memory) noexcept -> TermForce { return {.drag_n = p[0] * in.speed_mm_s}; }},
      // Fc at speed and Fs from rest, of which 63 % of the difference are gone at vs.
      {"stribeck_friction",
       "drag (Fc + (Fs − Fc) e^(−(V/vs)²)) tanh(V/v0)",
       "Stribeck's curve",
       "",
       {{"fc_n", 0, 100, {}},
        {"fs_n", 0, 100, {}},
        {"vs_mm_s", 1e-6, 1000, {}},
        {"v0_mm_s", 1e-6, 1000, 0.01}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {.drag_n = (p[0] + (p[1] - p[0]) * static_share(in.speed_mm_s, p[2])) *
                           sliding_share(in.speed_mm_s, p[3])};
       }},
      {"hidden_layer",
       "Δk (X − d0)₊",
       "",
       "",
       {{"dk_n_per_mm", -100, 100, {}}, {"d0_mm", 0, 100, {}}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {p[0] * layer_mm(in.penetration_mm, p[1]), 0.0};
       }},
      {"graded_stiffness",
       "−k α X²",
       "",
       "",
       {{"alpha_per_mm", -100, 100, {}}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {graded_n(in.stiffness_n_per_mm, p[0], in.penetration_mm), 0.0};
       }},
      {"nonlinear_stiffness",
       "k (X^m − X)",
       "Hertz: m = 1.5",
       "X in mm",  // Hertz: m = 1.5
       {{"m", 0.1, 5, {}}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {in.stiffness_n_per_mm * power_beyond_mm(in.penetration_mm, p[0]), 0.0};
       }},
      {"feed_power_law",
       "c (|V|^n sign V − V)",
       "milling; n ≈ 0.8 inferred for bone (recalled)",
       "V in mm/s",
       {{"n", 0.05, 4, {}}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {in.damping_n_s_per_mm * feed_beyond_mm_s(in.approach_mm_s, p[0]), 0.0};
       }},
      // `exponent`: the power p of X by which the elastic force of a soft specimen grows.
      // `carried`: for one site that is pressed again before it is at rest; else each contact
      // begins at rest. Memory: stretch of the branches, mm, and X^p of the tick before.
      {"relaxation",
       "Σ k_i z_i, z_i' = d(X^p)/dt − z_i/τ_i, z = 0 in air, or with `carried` z' = −z/τ there",
       "Maxwell branches; p ≠ 1: quasi-linear viscoelasticity, Fung 1981",
       "measured on soft specimens, not on tooth",
       {{"k1_n_per_mm", -100, 100, {}},
        {"tau1_s", 1e-3, 1e4, {}},
        {"k2_n_per_mm", -100, 100, 0.0},
        {"tau2_s", 1e-3, 1e4, 1.0},
        {"exponent", 0.2, 5, 1.0},
        {"carried", 0, 1, 0.0}},
       [](P p, In in, Memory memory) noexcept -> TermForce {
         const double k_n_per_mm[] = {p[0], p[2]}, tau_s[] = {p[1], p[3]}, exponent = p[4];
         if (!in.touching) {
           const TermMemory before = memory;
           memory = {};
           for (std::size_t i = 0; i < 2 && p[5] >= 0.5; ++i)
             memory[i] = relaxed_mm(before[i], 0.0, in.dt_s / tau_s[i]);
           return {};
         }
         const double stretch =
             exponent == 1.0 ? in.penetration_mm : det_pow(in.penetration_mm, exponent);
         const double moved_mm =
             in.dt_s > 0.0 ? stretch - memory[2] : 0.0;  // begun in contact: at rest since long ago
         memory[2] = stretch;
         double force_n = 0.0;
         for (std::size_t i = 0; i < 2; ++i) {
           if (k_n_per_mm[i] == 0.0) continue;
           memory[i] = relaxed_mm(memory[i], moved_mm, in.dt_s / tau_s[i]);
           force_n += k_n_per_mm[i] * memory[i];
         }
         return {force_n, 0.0};
       }},
      {"edge_force",
       "Fe in contact and turning",
       "cutting edges",
       "",
       {{"edge_n", -100, 100, {}}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {in.touching && in.rpm > 0.0 ? p[0] : 0.0, 0.0};
       }},
      {"anisotropy",
       "(ε F + A) cos 2(φ − φ0)",
       "tubules and prisms give tissue a grain",
       "φ: angle of n from z towards x; fades by the square of n's part in that plane",
       {{"epsilon", -1, 1, 0.0}, {"amplitude_n", -100, 100, 0.0}, {"phi0_deg", -180, 180, 0.0}},
       [](P p, In in, Memory) noexcept -> TermForce {
         if (!in.touching) return {};
         return {(p[0] * in.voigt_n + p[1]) * turned_share(in.approach, twice_angle(p[2])), 0.0};
       }},
      // Forgotten in air: α d after a way of a few d, and as much less after a reversal. Memory: z
      // and X of the tick before, mm.
      {"hysteresis",
       "α z, z' = V − ((1 − γ) |V| z + γ V |z|)/d",
       "Bouc 1967, Wen 1976; γ = 0: Dahl 1968",
       "exact for a way of any length",
       {{"alpha_n_per_mm", 0, 100, {}}, {"d_mm", 1e-6, 100, {}}, {"gamma", 0, 0.5, 0.0}},
       [](P p, In in, Memory memory) noexcept -> TermForce {
         if (!in.touching) {
           memory = {};
           return {};
         }
         const double moved_mm = in.dt_s > 0.0 ? in.penetration_mm - memory[1]
                                               : 0.0;  // begun in contact: the loop is empty
         memory[1] = in.penetration_mm;
         memory[0] = loop_mm(memory[0], moved_mm, p[1], p[2]);
         return {p[0] * memory[0], 0.0};
       }},
      // Play between the drive, whose position is known, and the tip, which follows X once it is b
      // behind or `ahead_mm` (negative: b) before it. In air it is taken up anew, so that each
      // contact begins with the tip b behind. `seen`: contact is where the drive is seen to touch,
      // so that the tip may still be above the surface and its spring take from c V. Memory: place
      // of the tip, mm.
      {"backlash",
       "k (play(X) − X)",
       "",
       "the play is taken up anew at each contact",
       {{"b_mm", 0, 100, {}}, {"ahead_mm", 0, 100, -1.0}, {"seen", 0, 1, 0.0}},
       [](P p, In in, Memory memory) noexcept -> TermForce {
         if (!in.touching) {
           memory = {-p[0], 0.0, 0.0, 0.0};
           return {};
         }
         if (in.dt_s <= 0.0)
           memory[0] = in.penetration_mm;  // begun in contact: the tip is where it is seen
         memory[0] = played_mm(memory[0], in.penetration_mm, p[0], p[1] < 0.0 ? p[0] : p[1]);
         return {in.stiffness_n_per_mm *
                     ((p[2] >= 0.5 ? memory[0] : std::max(0.0, memory[0])) - in.penetration_mm),
                 0.0};
       }},
      // `carried`: W goes on over the sessions of a recording that counts anew in each; an exam is
      // one session.
      {"wear",
       "F w W",
       "W: removed volume since the bur was new",
       "a known figure is −20 % of the cutting rate by cut 20 (recalled); here the force changes, the rate does not",
       {{"per_mm3", -100, 100, {}}, {"carried", 0, 1, 0.0}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {p[0] * worn_n(in.voigt_n, p[1] >= 0.5 ? in.removed_on_mm3 : in.removed_mm3), 0.0};
       },
       true},
      {"chatter",
       "A sin(2π (f t + phase)) in contact",
       "",
       "a device of 1 kHz feels f at its alias",
       {{"amplitude_n", 0, 100, {}},
        {"frequency_hz", 0, 1e5, {}},
        {"phase_turns", 0, 1, 0.0},
        {"spinning", 0, 1, 0.0}},
       [](P p, In in, Memory) noexcept -> TermForce {
         if (!in.touching || (p[3] >= 0.5 && in.rpm <= 0.0)) return {};
         const double turns = p[1] * in.time_s;
         return {p[0] * line_at(turns - std::floor(turns) + p[2]), 0.0};
       }},
      {"coolant",
       "F w wet",
       "",
       "in an exam wet = 1 while the handpiece turns",  // below 0 water eases the cut
       {{"fraction", -1, 10, {}}},
       [](P p, In in, Memory) noexcept -> TermForce {
         return {p[0] * watered_n(in.voigt_n, in.wet), 0.0};
       }},
      // Where no temperature was measured, tissue warms in proportion to the force while the tool
      // turns in it, and cools, in air too: exact for a force that is constant within the tick. One
      // ΔT stands for the whole tooth; g and τ have no source. Memory: ΔT, K, when it is not
      // measured.
      {"thermal_softening",
       "−F h ΔT; ΔT' = g F − ΔT/τ while turning in tissue",
       "g = 1 K/(N·s) and τ = 20 s have no source",
       "one ΔT for the whole tooth; it cools in air",
       {{"per_k", -10, 10, {}}, {"heating_k_per_n_s", 0, 1e4, 1.0}, {"cooling_s", 1e-3, 1e5, 20.0}},
       [](P p, In in, Memory memory) noexcept -> TermForce {
         if (in.warmth_known) return {p[0] * warmed_n(in.voigt_n, in.warmer_k), 0.0};
         const double heated = in.touching && in.rpm > 0.0 ? p[1] * in.voigt_n * in.dt_s
                                                           : 0.0;  // K, as if nothing cooled
         memory[0] = relaxed_mm(memory[0], heated,
                                in.dt_s / p[2]);  // the same equation as a branch's stretch
         return {p[0] * warmed_n(in.voigt_n, memory[0]), 0.0};
       }},
  };
}

}  // namespace cavum
