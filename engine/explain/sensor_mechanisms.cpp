// What the measurement does to the force: zero error, drift, weight of the handpiece, inertia, gain, cross-talk, delay,
// lag, saturation.
#include <algorithm>
#include <cmath>
#include <set>

#include "engine/explain/lags.h"
#include "engine/explain/mechanism.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

constexpr double k_radians = 3.14159265358979323846 / 180.0;

Grid no_shape(const Scene&) { return {{}}; }

/// Time since the start of the session (whole = 0) or of the recording (1), where sessions that start anew follow one another.
Series elapsed_s(const Scene& s, bool whole) {
  const Recording& r = *s.recording;
  Series t = Series::Zero(r.rows());
  const bool restarts = r.sessions.size() > 1 && r.t_s[r.sessions[1].begin] < r.t_s[r.sessions[0].end - 1];
  double before = 0.0;
  for (const auto& rows : r.sessions) {
    const double start = whole && !restarts ? r.t_s[0] : r.t_s[rows.begin];
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) t[i] = r.t_s[i] - start + (whole && restarts ? before : 0.0);
    before += r.t_s[rows.end - 1] - r.t_s[rows.begin];
  }
  return t;
}

/// Shape: {whole, exponential, tau}. Tau is 0 for the straight line.
Grid drift_grid(const Scene& s) {
  Grid g{{0, 0, 0}};
  const bool several = s.recording->sessions.size() > 1;
  if (several) g.push_back({1, 0, 0});
  double length = 0.0;
  for (const auto& rows : s.recording->sessions) length = std::max(length, s.recording->t_s[rows.end - 1] - s.recording->t_s[rows.begin]);
  for (const double part : {0.05, 0.15, 0.4}) g.push_back({0, 1, part * length});
  if (several)
    for (const double part : {0.15, 0.4}) g.push_back({1, 1, part * elapsed_s(s, true).maxCoeff()});
  return g;
}

Columns drift_columns(const Scene& s, const Shape& p) {
  Series t = elapsed_s(s, p[0] > 0.5);
  if (p[1] > 0.5) t = 1.0 - (-t / p[2]).exp();
  return {{t}, {}, {}};
}

Grid posture_grid(const Scene& s) {
  const Series* posture = s.recording->column("posture_deg");
  if (posture == nullptr) return {};
  std::set<double> zero{0.0};  // the posture in which the load cell was zeroed: level, or one that was recorded
  for (Eigen::Index i = 0; i < posture->size() && zero.size() < 6; ++i) zero.insert(std::round((*posture)[i] * 10.0) / 10.0);
  Grid g;
  for (const double z : zero) g.push_back({z});
  return g;
}

/// From half a row to 0.3 s.
Grid lag_grid(const Scene& s) {
  const double row = s.dt_s.minCoeff() > 0 ? s.dt_s.minCoeff() : 0.005;
  Grid g;
  for (const double rows : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) g.push_back({rows * row});
  return g;
}

/// The same for a delay: the jump of c V at each contact fits within a third of a row only, so half rows up to 8 rows.
Grid delay_grid(const Scene& s) {
  const double row = s.dt_s.minCoeff() > 0 ? s.dt_s.minCoeff() : 0.005;
  Grid g;
  for (int half = 1; half <= 16; ++half) g.push_back({0.5 * half * row});
  for (const double rows : {10.0, 13.0, 18.0, 25.0, 35.0}) g.push_back({rows * row});
  return g;
}

Grid saturation_grid(const Scene& s) {
  std::vector<double> pressed;
  for (Eigen::Index i = 0; i < s.force_n.size(); ++i)
    if (s.active[i] > 0.5) pressed.push_back(s.force_n[i]);
  if (pressed.size() < 100) return {};
  std::sort(pressed.begin(), pressed.end());
  Grid g;
  for (const double part : {0.6, 0.75, 0.85, 0.92, 0.96, 0.985, 0.995})
    g.push_back({pressed[static_cast<std::size_t>(part * static_cast<double>(pressed.size() - 1))]});
  return g;
}

Columns saturation_columns(const Scene& s, const Shape& p) {
  const Series over = (s.force_n > p[0]).cast<double>();
  return {{over * p[0]}, -s.spring_mm * over, -s.damper_mm_s * over};
}

}  // namespace

std::vector<Mechanism> sensor_mechanisms() {
  std::vector<Mechanism> m;
  m.push_back({"bias",
               "B, in air too",
               "a constant offset of the load cell",
               "read the unloaded load cell before and after each session",
               false,
               {},
               no_shape,
               [](const Scene& s, const Shape&) {
                 return Columns{{Series::Ones(s.force_n.size())}, {}, {}};
               },
               [](const Shape&, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"bias_n", own[0]}};
               }});
  m.push_back(
      {"drift",
       "R t, or A (1 - e^(-t/tau)), in air too",
       "a load cell whose zero wanders with time",
       "hold the tool in air for ten minutes after switching on",
       false,
       {{"whole", 0, 1, false, false}, {"exponential", 0, 1, false, false}, {"tau_s", 0.5, 1e4, true, true}},
       drift_grid,
       drift_columns,
       [](const Shape& p, const Shape& own, Base) {
         return p[1] > 0.5 ? std::vector<NamedValue>{{"amplitude_n", own[0]}, {"tau_s", p[2]}} : std::vector<NamedValue>{{"rate_n_per_s", own[0]}};
       }});
  m.push_back({"gravity_posture",
               "w (sin theta - sin theta0), in air too",
               "the weight of the handpiece, which changes with posture",
               "hold the tool in air in three postures",
               false,
               {{"theta0_deg", -180, 180, false, false}},
               posture_grid,
               [](const Scene& s, const Shape& p) {
                 const Series* posture = s.recording->column("posture_deg");
                 return Columns{{(*posture * k_radians).sin() - std::sin(p[0] * k_radians)}, {}, {}};
               },
               [](const Shape& p, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"weight_n", own[0]}, {"theta0_deg", p[0]}};
               }});
  m.push_back({"inertia",
               "m a, in air too",
               "the mass that is accelerated with the load cell",
               "shake the tool in air at two rates",
               false,
               {},
               no_shape,
               [](const Scene& s, const Shape&) {
                 return Columns{{s.motion.a_mm_s2}, {}, {}};
               },
               [](const Shape&, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"mass_kg", own[0] * 1000.0}};
               }});
  m.push_back({"gain_error",
               "g F_sim",
               "a load cell whose gain is off",
               "hang known weights on the load cell: no recording of k and c can show its gain",
               false,
               {},
               no_shape,
               [](const Scene& s, const Shape&) {
                 return Columns{{s.force_n}, {}, {}};
               },
               [](const Shape&, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"gain", own[0]}};
               }});
  m.push_back({"cross_talk",
               "a Fy + b Fz",
               "lateral force that leaks into the feed's channel",
               "press sideways in air",
               false,
               {},
               [](const Scene& s) { return s.recording->column("fy_n") != nullptr || s.recording->column("fz_n") != nullptr ? Grid{{}} : Grid{}; },
               [](const Scene& s, const Shape&) {
                 Columns c;
                 for (const char* name : {"fy_n", "fz_n"})
                   if (const Series* f = s.recording->column(name)) c.own.push_back(*f);
                 return c;
               },
               [](const Shape&, const Shape& own, Base) {
                 std::vector<NamedValue> p{{"a", own[0]}};
                 if (own.size() > 1) p.push_back({"b", own[1]});
                 return p;
               }});
  m.push_back({"delay",
               "F_sim(t - tau) - F_sim(t)",
               "a force channel that comes later than the position",
               "press in fast ramps at two speeds, with sharp reversals",
               false,
               {{"tau_s", 2e-4, 2.0, true, true}},
               delay_grid,
               [](const Scene& s, const Shape& p) { return delayed(s, p[0]); },
               [](const Shape& p, const Shape&, Base) {
                 return std::vector<NamedValue>{{"tau_s", p[0]}};
               }});
  m.push_back({"low_pass",
               "lag(F_sim, tau) - F_sim",
               "a force channel that is smoothed by a filter",
               "press in fast ramps at two speeds, with sharp reversals",
               false,
               {{"tau_s", 2e-4, 2.0, true, true}},
               lag_grid,
               [](const Scene& s, const Shape& p) { return lagged(s, p[0]); },
               [](const Shape& p, const Shape&, Base) {
                 return std::vector<NamedValue>{{"tau_s", p[0]}};
               }});
  m.push_back({"saturation",
               "min(F_sim, Fmax) - F_sim",
               "a force channel that saturates",
               "press harder, with a load cell of a larger range",
               false,
               {{"f_max_n", 1e-4, 1e4, true, true}},
               saturation_grid,
               saturation_columns,
               [](const Shape& p, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"f_max_n", p[0] * own[0]}};
               }});
  return m;
}

}  // namespace cavum::explain
