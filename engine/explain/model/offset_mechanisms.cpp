// A zero of the load cell that is off, or wanders; and a zero of the position that is.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/explain/model/mechanism.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

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

constexpr double k_farthest_mm = 0.5;       // docs/physics.md section 13
constexpr Eigen::Index k_least_rows = 20;   // in air, and in contact: with fewer of either an offset of the surface is one of the force
constexpr Eigen::Index k_looked_at = 2000;  // rows of a session that a start is found from
// a start is looked for in ever finer steps, this far to both sides of the one before; k and c are fitted in between
constexpr std::array k_steps_mm{0.005, 0.0025, 0.0005, 0.0005}, k_reach_mm{k_farthest_mm, 0.04, 0.01, 0.01};

constexpr std::array k_delta_names{"delta_1_mm", "delta_2_mm", "delta_3_mm", "delta_4_mm",  "delta_5_mm",  "delta_6_mm",
                                   "delta_7_mm", "delta_8_mm", "delta_9_mm", "delta_10_mm", "delta_11_mm", "delta_12_mm"};

/// Columns of k and c in one row, had the surface been `delta_mm` nearer to the tool.
struct Pressed {
  double spring_mm = 0, damper_mm_s = 0;
};

Pressed pressed(const Scene& s, Eigen::Index i, double delta_mm, Base base) {
  const double x = s.motion.x_mm[i] + delta_mm;
  const double spring = x * relative_at(s.recording->relative_k, i), damper = s.motion.v_mm_s[i] * relative_at(s.recording->relative_c, i);
  if (base.k_n_per_mm > 0.0 && base.k_n_per_mm * spring + base.c_n_s_per_mm * damper <= 0.0) return {};
  const double touching = touching_probability(x, s.motion.sd_x_mm[i]);
  return {touching * spring, touching * damper};
}

/// Rows that share an offset: those of a session, or all.
std::vector<SessionRows> groups_of(const Recording& r) {
  if (session_groups(r) > 1) return r.sessions;
  return {{"all", 0, r.rows()}};
}

bool crosses_the_surface(const Scene& s, const SessionRows& rows) {
  const auto x = s.motion.x_mm.segment(rows.begin, rows.end - rows.begin);
  return (x < 0.0).count() >= k_least_rows && (s.active.segment(rows.begin, rows.end - rows.begin) > 0.5).count() >= k_least_rows;
}

/// Offsets that fit what is left best, all together with k and c: a start for the search. 0 where a session cannot show one.
Shape offsets_of(const Scene& s) {
  const std::vector<SessionRows> groups = groups_of(*s.recording);
  Shape delta(k_delta_names.size(), 0.0);
  Base base = s.base;
  const auto measured_n = [&](Eigen::Index i) { return s.left_n[i] + s.base.k_n_per_mm * s.spring_mm[i] + s.base.c_n_s_per_mm * s.damper_mm_s[i]; };
  const auto each_row = [](const SessionRows& rows, const auto& visit) {
    const Eigen::Index step = std::max<Eigen::Index>(1, (rows.end - rows.begin) / k_looked_at);
    for (Eigen::Index i = rows.begin; i < rows.end; i += step) visit(i);
  };
  for (std::size_t round = 0; round < k_steps_mm.size(); ++round) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (!crosses_the_surface(s, groups[g])) continue;
      const auto misfit = [&](double d) {
        double sum = 0.0;
        each_row(groups[g], [&](Eigen::Index i) {
          const Pressed p = pressed(s, i, d, base);
          const double gap = measured_n(i) - base.k_n_per_mm * p.spring_mm - base.c_n_s_per_mm * p.damper_mm_s;
          sum += s.weight[i] * std::fabs(gap);  // not its square: one row that is wrong must not outweigh the others
        });
        return sum;
      };
      // every row that a wrong surface puts into contact, or takes out of it, is a step of c V: many narrow valleys, so all are looked into
      const double middle = delta[g], step = k_steps_mm[round], reach = k_reach_mm[round];
      double best = middle, least = misfit(middle);
      for (double d = std::max(-k_farthest_mm, middle - reach); d <= std::min(k_farthest_mm, middle + reach); d += step)
        if (const double m = misfit(d); m < least) least = m, best = d;
      delta[g] = best;
    }
    double xx = 0, xv = 0, vv = 0, xf = 0, vf = 0;
    for (std::size_t g = 0; g < groups.size(); ++g)
      each_row(groups[g], [&](Eigen::Index i) {
        const auto [x, v] = pressed(s, i, delta[g], base);
        const double w = s.weight[i], f = measured_n(i);
        xx += w * x * x, xv += w * x * v, vv += w * v * v, xf += w * x * f, vf += w * v * f;
      });
    const double det = xx * vv - xv * xv;
    if (!(det > 1e-9 * xx * vv)) break;
    base = {std::max(1e-9, (vv * xf - xv * vf) / det), std::max(0.0, (xx * vf - xv * xf) / det)};
  }
  return delta;
}

Grid contact_grid(const Scene& s) {
  if (s.left_n.size() == 0) return {};
  Shape delta = offsets_of(s);
  if (std::all_of(delta.begin(), delta.end(), [](double d) { return d == 0.0; })) return {};
  return {std::move(delta)};
}

Columns contact_columns(const Scene& s, const Shape& delta) {
  Columns c{{}, -s.spring_mm, -s.damper_mm_s};
  const std::vector<SessionRows> groups = groups_of(*s.recording);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (Eigen::Index i = groups[g].begin; i < groups[g].end; ++i) {
      const Pressed p = pressed(s, i, delta[g], s.base);
      c.spring[i] += p.spring_mm;
      c.damper[i] += p.damper_mm_s;
    }
  return c;
}

/// Contact begins between two rows.
double between_rows_mm(const Scene& s) {
  double way = 0.0, times = 0.0;
  for (const auto& rows : s.recording->sessions)
    for (Eigen::Index i = rows.begin + 1; i < rows.end; ++i)
      if ((s.motion.x_mm[i] > 0.0) != (s.motion.x_mm[i - 1] > 0.0)) way += std::fabs(s.motion.x_mm[i] - s.motion.x_mm[i - 1]), times += 1.0;
  return times > 0.0 ? way / times / std::sqrt(12.0) : 0.0;
}

std::vector<ShapeRange> contact_shape() {
  std::vector<ShapeRange> out;
  for (const char* name : k_delta_names) out.push_back({name, -k_farthest_mm, k_farthest_mm, false, true});
  return out;
}

}  // namespace

std::vector<Mechanism> offset_mechanisms() {
  std::vector<Mechanism> m;
  m.push_back({
      .name = "bias",
      .equation = "B, in air too",
      .words = "a constant offset of the load cell",
      .separate = "read the unloaded load cell before and after each session",
      .grid = [](const Scene&) { return Grid{{}}; },
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{{Series::Ones(s.force_n.size())}, {}, {}};
          },
      .parameters =
          [](const Shape&, const Shape& own, Base) {
            return std::vector<NamedValue>{{"bias_n", own[0]}};
          },
      .one_way = OneWay::is_offset,
  });

  m.push_back({
      .name = "drift",
      .equation = "R t, or A (1 - e^(-t/tau)), in air too",
      .words = "a load cell whose zero wanders with time",
      .separate = "hold the tool in air for ten minutes after switching on",
      .shape = {{"whole", 0, 1, false, false}, {"exponential", 0, 1, false, false}, {"tau_s", 0.5, 1e4, true, true}},
      .grid = drift_grid,
      .columns = drift_columns,
      .parameters =
          [](const Shape& p, const Shape& own, Base) {
            return p[1] > 0.5 ? std::vector<NamedValue>{{"amplitude_n", own[0]}, {"tau_s", p[2]}} : std::vector<NamedValue>{{"rate_n_per_s", own[0]}};
          },
      .one_way = OneWay::needs_reversal,
  });

  m.push_back({
      .name = "contact_offset",
      .equation = "F_sim(X + delta) - F_sim(X), one delta for each session",
      .words = "the place of the surface, which lies nearer or further than the recording has it",
      .separate =
          "come to the surface from air several times, on tissues of several stiffnesses: k delta grows with k, an offset of the force does not",
      .shape = contact_shape(),
      .grid = contact_grid,
      .columns = contact_columns,
      .parameters =
          [](const Shape& delta, const Shape&, Base) {
            std::vector<NamedValue> out;
            for (std::size_t g = 0; g < delta.size(); ++g)
              if (delta[g] != 0.0) out.push_back({k_delta_names[g], delta[g]});
            return out;
          },
      .open = between_rows_mm,
      .one_way = OneWay::looks_like_offset,
      .from_residual = true,
  });

  return m;
}

}  // namespace cavum::explain
