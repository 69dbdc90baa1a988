// A zero of the load cell that is off, or wanders; and a zero of the position that is.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/text.h"
#include "engine/lab/explain/model/mechanism.h"
#include "engine/lab/explain/model/surface_offsets.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

/// Time since the start of the session (whole = 0) or of the recording (1), where sessions that
/// start anew follow one another.
Series elapsed_s(const Scene& s, bool whole) {
  const Recording& r = *s.recording;
  Series t = Series::Zero(r.rows());
  const bool restarts =
      r.sessions.size() > 1 && r.t_s[r.sessions[1].begin] < r.t_s[r.sessions[0].end - 1];
  double before = 0.0;
  for (const auto& rows : r.sessions) {
    const double start = whole && !restarts ? r.t_s[0] : r.t_s[rows.begin];
    for (Eigen::Index i = rows.begin; i < rows.end; ++i)
      t[i] = r.t_s[i] - start + (whole && restarts ? before : 0.0);
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
  for (const auto& rows : s.recording->sessions)
    length = std::max(length, s.recording->t_s[rows.end - 1] - s.recording->t_s[rows.begin]);
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

constexpr std::array k_delta_names{"delta_1_mm", "delta_2_mm",  "delta_3_mm",  "delta_4_mm",
                                   "delta_5_mm", "delta_6_mm",  "delta_7_mm",  "delta_8_mm",
                                   "delta_9_mm", "delta_10_mm", "delta_11_mm", "delta_12_mm"};

Grid contact_grid(const Scene& s) {
  if (s.left_n.size() == 0) return {};
  Grid g;
  for (auto& delta : surface_offsets_mm(s)) {
    delta.resize(k_delta_names.size(), 0.0);
    g.push_back(std::move(delta));
  }
  return g;
}

Columns contact_columns(const Scene& s, const Shape& delta) {
  Columns c{{}, -s.spring_mm, -s.damper_mm_s};
  const std::vector<SessionRows> groups = rows_of_one_surface(*s.recording);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (Eigen::Index i = groups[g].begin; i < groups[g].end; ++i) {
      const PressedRow p = pressed_at(s, i, delta[g], s.base);
      c.spring[i] += p.spring_mm;
      c.damper[i] += p.damper_mm_s;
    }
  return c;
}

/// Contact begins between two rows, each time elsewhere between them.
double between_rows_mm(const Scene& s) {
  double way = 0.0, times = 0.0;
  for (const auto& rows : s.recording->sessions)
    for (Eigen::Index i = rows.begin + 1; i < rows.end; ++i)
      if ((s.motion->x_mm[i] > 0.0) != (s.motion->x_mm[i - 1] > 0.0))
        way += std::fabs(s.motion->x_mm[i] - s.motion->x_mm[i - 1]), times += 1.0;
  return times > 0.0
             ? way / times /
                   std::sqrt(12.0 * times / static_cast<double>(s.recording->sessions.size()))
             : 0.0;
}

std::vector<ShapeRange> contact_shape() {
  std::vector<ShapeRange> out;
  for (const char* name : k_delta_names)
    out.push_back({name, -k_farthest_surface_mm, k_farthest_surface_mm, false, true});
  return out;
}

Mechanism bias() {
  return {
      .name = "bias",
      .equation = noop("B, in air too"),
      .words = noop("a constant offset of the load cell"),
      .separate = noop("read the unloaded load cell before and after each session"),
      .seen_over = "t_s",
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{{Series::Ones(s.force_n.size())}, {}, {}};
          },
      .coefficients = {"bias_n"},
      .one_way = OneWay::is_offset,
  };
}

Mechanism drift() {
  return {
      .name = "drift",
      .equation = noop("R t, or A (1 - e^(-t/tau)), in air too"),
      .words = noop("a load cell whose zero wanders with time"),
      .separate = noop("hold the tool in air for ten minutes after switching on"),
      .seen_over = "t_s",
      .shape = {{"whole", 0, 1, false, false},
                {"exponential", 0, 1, false, false},
                {"tau_s", 0.5, 1e4, true, true}},
      .grid = drift_grid,
      .columns = drift_columns,
      .parameters =
          [](const Shape& p, const Shape& own, Base) {
            return p[1] > 0.5 ? std::vector<NamedValue>{{"amplitude_n", own[0]}, {"tau_s", p[2]}}
                              : std::vector<NamedValue>{{"rate_n_per_s", own[0]}};
          },
      .one_way = OneWay::needs_reversal,
  };
}

Mechanism contact_offset() {
  return {
      .name = "contact_offset",
      .equation = noop("F_sim(X + delta) - F_sim(X), one delta for each session"),
      .words =
          noop("the place of the surface, which lies nearer or further than the recording has it"),
      .separate = noop(
          "come to the surface from air several times, on tissues of several stiffnesses: k delta grows with k, an offset of the force does not"),
      .seen_over = "x_mm",
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
  };
}

}  // namespace

std::vector<Mechanism> offset_mechanisms() {
  return {
      bias(),
      drift(),
      contact_offset(),
  };
}

}  // namespace cavum::explain
