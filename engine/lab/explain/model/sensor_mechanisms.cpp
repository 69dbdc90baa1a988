// What the measurement does to the force: weight of the handpiece, inertia, gain, cross-talk,
// delay, lag, saturation.
#include <algorithm>
#include <cmath>

#include "engine/base/order.h"
#include "engine/base/text.h"
#include "engine/lab/explain/model/lags.h"
#include "engine/lab/explain/model/mechanism.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

constexpr double k_clock_rows = 0.05;  // standard deviation of the instant to which a row belongs,
                                       // in rows: position and force are read one after the other
constexpr double k_radians = 3.14159265358979323846 / 180.0;

Grid no_shape(const Scene&) { return {{}}; }

/// From half a row to 0.3 s.
Grid lag_grid(const Scene& s) {
  const double row = s.dt_s.minCoeff() > 0 ? s.dt_s.minCoeff() : 0.005;
  Grid g;
  for (const double rows : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) g.push_back({rows * row});
  return g;
}

/// The same for a delay: the jump of c V at each contact fits within a third of a row only, so
/// parts of a row up to 8 rows.
Grid delay_grid(const Scene& s) {
  const double row = s.dt_s.minCoeff() > 0 ? s.dt_s.minCoeff() : 0.005;
  Grid g;
  for (const double rows : {0.12, 0.25}) g.push_back({rows * row});
  for (int half = 1; half <= 16; ++half) g.push_back({0.5 * half * row});
  for (const double rows : {10.0, 13.0, 18.0, 25.0, 35.0}) g.push_back({rows * row});
  return g;
}

double clock_s(const Scene& s) { return k_clock_rows * s.dt_s.mean(); }

Grid saturation_grid(const Scene& s) {
  std::vector<double> pressed;
  for (Eigen::Index i = 0; i < s.force_n.size(); ++i)
    if (s.active[i] > 0.5) pressed.push_back(s.force_n[i]);
  if (pressed.size() < 100) return {};
  std::sort(pressed.begin(), pressed.end());
  Grid g;
  for (const double part : {0.6, 0.75, 0.85, 0.92, 0.96, 0.985, 0.995, 0.998, 0.9993})
    g.push_back({quantile_of_sorted(pressed, part)});
  return g;
}

Columns saturation_columns(const Scene& s, const Shape& p) {
  const Series over = (s.force_n > p[0]).cast<double>();
  return {{over * p[0]}, -s.spring_mm * over, -s.damper_mm_s * over};
}

Mechanism gravity_posture() {
  return {
      .name = "gravity_posture",
      .equation = noop("w (sin theta - sin theta0), in air too"),
      .words = noop("the weight of the handpiece, which changes with posture"),
      .separate = noop("hold the tool in air in three postures"),
      .seen_over = "posture_deg",
      .needs = {"posture_deg"},
      .grid = no_shape,
      .columns =
          [](const Scene& s, const Shape&) {
            const Series* posture = s.recording->column("posture_deg");
            return Columns{{(*posture * k_radians).sin(), Series::Ones(posture->size())}, {}, {}};
          },
      .parameters =
          [](const Shape&, const Shape& own,
             Base) {  // beyond a right angle the zero is a bias: no posture has it
            const double sine = own[0] != 0.0 ? std::clamp(-own[1] / own[0], -1.0, 1.0) : 0.0;
            return std::vector<NamedValue>{{"weight_n", own[0]},
                                           {"theta0_deg", std::asin(sine) / k_radians}};
          },
  };
}

Mechanism inertia() {
  return {
      .name = "inertia",
      .equation = noop("m a, in air too"),
      .words = noop("the mass that is accelerated with the load cell"),
      .separate = noop("shake the tool in air at two rates"),
      .seen_over = "a_mm_s2",
      .grid = no_shape,
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{{s.motion->a_mm_s2}, {}, {}};
          },
      .parameters =
          [](const Shape&, const Shape& own, Base) {
            return std::vector<NamedValue>{{"mass_kg", own[0] * 1000.0}};
          },
      .own = k_positive,
  };
}

Mechanism gain_error() {
  return {
      .name = "gain_error",
      .equation = noop("g F_sim"),
      .words = noop("a load cell whose gain is off"),
      .separate =
          noop("hang known weights on the load cell: no recording of k and c can show its gain"),
      .seen_over = "simulated_n",
      .grid = no_shape,
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{{s.force_n}, {}, {}};
          },
      .coefficients = {"gain"},
      .in_recordings = false,
  };
}

Mechanism cross_talk() {
  return {
      .name = "cross_talk",
      .equation = noop("a Fy + b Fz"),
      .words = noop("lateral force that leaks into the feed's channel"),
      .separate = noop("press sideways in air"),
      .seen_over = "fy_n",
      .needs = {"fy_n", "fz_n"},
      .grid = no_shape,
      .columns =
          [](const Scene& s, const Shape&) {
            Columns c;
            for (const char* name : {"fy_n", "fz_n"})
              if (const Series* f = s.recording->column(name)) c.own.push_back(*f);
            return c;
          },
      .coefficients = {"a", "b"},
      .several = true,
  };
}

Mechanism delay() {
  return {
      .name = "delay",
      .equation = noop("F_sim(t - tau) - F_sim(t)"),
      .words = noop("a force channel that comes later than the position"),
      .separate = noop("press in fast ramps at two speeds, with sharp reversals"),
      .seen_over = "v_mm_s",
      .shape = {{"tau_s", 2e-4, 2.0, true, true}},
      .grid = delay_grid,
      .columns = [](const Scene& s, const Shape& p) { return delayed(s, p[0]); },
      .open = clock_s,
      .like_when_short = "low_pass",
  };
}

Mechanism low_pass() {
  return {
      .name = "low_pass",
      .equation = noop("lag(F_sim, tau) - F_sim"),
      .words = noop("a force channel that is smoothed by a filter"),
      .separate = noop("press in fast ramps at two speeds, with sharp reversals"),
      .seen_over = "v_mm_s",
      .shape = {{"tau_s", 2e-4, 2.0, true, true}},
      .grid = lag_grid,
      .columns = [](const Scene& s, const Shape& p) { return lagged(s, p[0]); },
      .open = clock_s,
      .variant_of = "delay",
      .like_when_short = "delay",
  };
}

Mechanism position_late() {
  return {
      .name = "position_late",
      .equation = noop("F_sim(t + tau) - F_sim(t)"),
      .words = noop("a position channel that comes later than the force"),
      .separate = noop(
          "press in fast ramps at two speeds with sharp reversals, and shake the tool in air: a mass shows there, a late position does not"),
      .seen_over = "v_mm_s",
      .shape = {{"tau_s", 2e-4, 2.0, true, true}},
      .grid = delay_grid,
      .columns = [](const Scene& s, const Shape& p) { return delayed(s, -p[0]); },
      .open = clock_s,
      .variant_of = "delay",
  };
}

/// Lightly damped, and slow enough for the sampling.
Grid ringing_grid(const Scene& s) {
  const double fastest = 0.4 / std::max(1e-6, s.dt_s.mean());
  Grid g;
  for (const double hz : {7.0, 9.0, 11.5, 14.5, 18.0, 23.0, 29.0, 36.0, 45.0})
    for (const double damping : {0.03, 0.12})
      if (hz < fastest) g.push_back({hz, damping});
  return g;
}

Mechanism ringing() {
  return {
      .name = "ringing",
      .equation = noop(
          "s (y - F_sim) + m y_a, y and y_a the response of a resonance at f to F_sim and to the acceleration, in air too"),
      .words = noop("a load cell or holder that swings at its own frequency after each jerk"),
      .separate = noop(
          "tap the holder in air, and press in ramps that end suddenly: the same frequency rings down after each"),
      .shape = {{"frequency_hz", 1.0, 1e4, true, true}, {"damping_ratio", 0.003, 0.7, true, true}},
      .grid = ringing_grid,
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{{resonance(s, s.force_n, p[0], p[1]) - s.force_n,
                            resonance(s, s.motion->a_mm_s2, p[0], p[1])},
                           {},
                           {}};
          },
      .parameters =
          [](const Shape& p, const Shape& own, Base) {
            return std::vector<NamedValue>{{"share", own[0]},
                                           {"frequency_hz", p[0]},
                                           {"damping_ratio", p[1]},
                                           {"mass_kg", own[1] * 1000.0}};
          },
      .plainer = "inertia",
  };
}

Mechanism saturation() {
  return {
      .name = "saturation",
      .equation = noop("min(F_sim, Fmax) - F_sim"),
      .words = noop("a force channel that saturates"),
      .separate = noop("press harder, with a load cell of a larger range"),
      .seen_over = "simulated_n",
      .shape = {{"f_max_n", 1e-4, 1e4, true, true}},
      .grid = saturation_grid,
      .columns = saturation_columns,
      .parameters =
          [](const Shape& p, const Shape& own, Base) {
            return std::vector<NamedValue>{{"f_max_n", p[0] * own[0]}};
          },
      .own = {0.8, 1.25},
  };
}

}  // namespace

std::vector<Mechanism> sensor_mechanisms() {
  return {
      gravity_posture(), inertia(),       gain_error(), cross_talk(), delay(),
      low_pass(),        position_late(), ringing(),    saturation(),
  };
}

}  // namespace cavum::explain
