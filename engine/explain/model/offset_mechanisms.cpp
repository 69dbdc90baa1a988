// A zero of the load cell that is off, or wanders.
#include <algorithm>
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

  return m;
}

}  // namespace cavum::explain
