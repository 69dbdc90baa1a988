#include "engine/lab/explain/recording/motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/independent_runs.h"
#include "engine/base/order.h"
#include "engine/base/random.h"
#include "engine/base/statistics.h"
#include "engine/lab/explain/recording/as_recorded.h"
#include "engine/lab/explain/recording/holds.h"
#include "engine/lab/explain/recording/slopes.h"

namespace cavum::explain {
namespace {

constexpr double k_min_walk = 1e-5;  // (mm/s)²/s: a hold may creep by 3 µm/s in a second
constexpr double k_exact_mm = 3e-7;  // a position without quantum is written with about six digits
constexpr double k_shared_s = 0.4;   // a hold is pulled to the middle of its cell after this time;
                                     // of 0.15 to 1 s it gave the least error of speed
constexpr double k_slope_s = 0.015;  // on each side, for the acceleration of a coarse position; of
                                     // 5 to 40 ms it gave inertia with the least error
constexpr std::size_t k_window = 4;  // rows on each side over which the walk's variance is averaged
constexpr int k_passes_exact = 3,
              k_passes_coarse =
                  12;  // of expectation maximisation; more changed speeds by less than 1 %
// Where a coarse encoder says nothing (within a cell) the walk's variance would stay at its first
// guess: a prior towards rest, as heavy as 0.3 of what a row says. With it the stated standard
// deviations match the errors (tests/engine/lab/explain/recording/motion_test.cpp).
constexpr double k_prior_weight = 0.3, k_prior_walk = 1e-3;
constexpr double k_stale_steps = 4.0,
                 k_says_nothing = 1e6;  // steps or scatters of the position; mm²
constexpr int k_passes_noisy = 20;
constexpr double k_noisy_lasting_rows = 4.0;  // an error of a smoothed position
constexpr double k_lasting_s = 0.2;           // at most: a cell of 0.055 mm at 0.25 mm/s
constexpr std::size_t k_possible =
    6;  // motions that are drawn: their scatter is averaged over neighbouring rows
constexpr double k_noisy_window_s =
    0.05;  // on each side, over which the walk's variance is averaged where positions are noisy

struct State {
  double x = 0, v = 0, xx = 0, xv = 0, vv = 0;
};

/// Scalar observation hx·x + hv·v = z with variance r.
void observe(State& s, double hx, double hv, double z, double r) {
  const double px = s.xx * hx + s.xv * hv, pv = s.xv * hx + s.vv * hv;
  const double gain = 1.0 / (hx * px + hv * pv + r), e = (z - hx * s.x - hv * s.v) * gain;
  s.x += px * e;
  s.v += pv * e;
  s.xx -= px * px * gain;
  s.xv -= px * pv * gain;
  s.vv -= pv * pv * gain;
}

struct Session {
  Eigen::Index n = 0;
  const double *t = nullptr, *x = nullptr, *v = nullptr;
  double q = 0, r_v = 0,
         noise = 0;        // a noisy position has no q: its rows are observations of this scatter
  double shared_rows = 1;  // at most so many rows share the observation of one run
  std::vector<double> run_rows;  // length of the run that the row is in
  std::vector<double> r_x;       // variance of the row's position; 0 = none
  std::vector<double> border_z,
      border_r;               // border crossed on the way to this row; variance 0 = none
  std::vector<double> pin_z;  // border of the cell that the estimate left; NaN = none
  std::vector<double> walk;   // variance per second of the way from this row to the next
  std::vector<State> predicted, filtered, smoothed;
};

void set_observations(Session& s) {
  const auto n = static_cast<std::size_t>(s.n);
  s.r_x.assign(n, k_exact_mm * k_exact_mm + s.noise * s.noise);
  s.border_z.assign(n, 0.0);
  s.border_r.assign(n, 0.0);
  s.pin_z.assign(n, std::nan(""));
  // a reading that stands still between two that move on was not taken anew, and says nothing
  const double least = k_stale_steps * std::max({s.q, s.noise, k_exact_mm});
  for (std::size_t i = 2; i + 1 < n; ++i)
    if (s.x[i] == s.x[i - 1] && std::fabs(s.x[i - 1] - s.x[i - 2]) > least &&
        std::fabs(s.x[i + 1] - s.x[i]) > least)
      s.r_x[i] = k_says_nothing;
  if (s.q <= 0.0) return;
  std::vector<std::size_t> run_of(n);
  s.run_rows.assign(n, 1.0);
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin + 1;
    while (end < n && std::fabs(s.x[end] - s.x[begin]) < 0.5 * s.q) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      if (s.r_x[i] < k_says_nothing)
        s.r_x[i] = s.q * s.q / 12.0 * std::min(s.shared_rows, static_cast<double>(end - begin));
      run_of[i] = end - begin;
      s.run_rows[i] = static_cast<double>(end - begin);
    }
    begin = end;
  }
  for (std::size_t i = 1; i < n; ++i) {
    const double step = s.x[i] - s.x[i - 1];
    if (std::fabs(step) < 0.5 * s.q || std::fabs(step) > 1.5 * s.q) continue;
    // crossed at some instant between the two rows, at about q/run per row
    const double per_row = s.q / static_cast<double>(std::max(run_of[i], run_of[i - 1]));
    const double nearest = s.q / static_cast<double>(std::min(run_of[i], run_of[i - 1]));
    s.border_z[i] = 0.5 * (s.x[i] + s.x[i - 1]);
    s.border_r[i] = (per_row * nearest) / 12.0 + k_exact_mm * k_exact_mm;
  }
}

void filter(Session& s) {
  State now{s.x[0], 0.0, s.q * s.q + 1e-4, 0.0, 1e2};
  for (Eigen::Index row = 0; row < s.n; ++row) {
    const auto i = static_cast<std::size_t>(row);
    double dt = 0.0;
    if (row > 0) {
      dt = s.t[row] - s.t[row - 1];
      const double w = s.walk[i - 1];
      now.x += now.v * dt;
      now.xx += dt * (2 * now.xv + dt * now.vv) + w * dt * dt * dt / 3;
      now.xv += dt * now.vv + w * dt * dt / 2;
      now.vv += w * dt;
    }
    s.predicted[i] = now;
    observe(now, 1.0, 0.0, s.x[row], s.r_x[i]);
    if (s.border_r[i] > 0.0) observe(now, 1.0, -0.5 * dt, s.border_z[i], s.border_r[i]);
    if (s.v != nullptr) observe(now, 0.0, 1.0, s.v[row], s.r_v);
    if (!std::isnan(s.pin_z[i])) observe(now, 1.0, 0.0, s.pin_z[i], 0.01 * s.q * s.q);
    s.filtered[i] = now;
  }
}

/// Of a row filtered as `f` before one predicted as `p`: A = P Fᵀ, and the smoother's gain G = A
/// P'⁻¹.
struct Gain {
  double axx, axv, avx, avv, gxx, gxv, gvx, gvv;
  Gain(const State& f, const State& p, double dt)
      : axx(f.xx + dt * f.xv), axv(f.xv), avx(f.xv + dt * f.vv), avv(f.vv) {
    const double det = p.xx * p.vv - p.xv * p.xv, ixx = p.vv / det, ixv = -p.xv / det,
                 ivv = p.xx / det;
    gxx = axx * ixx + axv * ixv, gxv = axx * ixv + axv * ivv, gvx = avx * ixx + avv * ixv,
    gvv = avx * ixv + avv * ivv;
  }
};

/// Backwards; also what the walk did between rows: E[(v' − v)²] per second.
void smooth(Session& s, std::vector<double>& moved) {
  const auto n = static_cast<std::size_t>(s.n);
  s.smoothed[n - 1] = s.filtered[n - 1];
  for (std::size_t i = n - 1; i-- > 0;) {
    const double dt = s.t[i + 1] - s.t[i];
    const State &f = s.filtered[i], &p = s.predicted[i + 1], &next = s.smoothed[i + 1];
    const Gain g(f, p, dt);
    const double ex = next.x - p.x, ev = next.v - p.v;
    const double dxx = next.xx - p.xx, dxv = next.xv - p.xv, dvv = next.vv - p.vv;
    State& o = s.smoothed[i];
    o.x = f.x + g.gxx * ex + g.gxv * ev;
    o.v = f.v + g.gvx * ex + g.gvv * ev;
    o.xx = f.xx + g.gxx * (g.gxx * dxx + g.gxv * dxv) + g.gxv * (g.gxx * dxv + g.gxv * dvv);
    o.xv = f.xv + g.gvx * (g.gxx * dxx + g.gxv * dxv) + g.gvv * (g.gxx * dxv + g.gxv * dvv);
    o.vv = f.vv + g.gvx * (g.gvx * dxx + g.gvv * dxv) + g.gvv * (g.gvx * dxv + g.gvv * dvv);
    const double lag = g.gvx * next.xv + g.gvv * next.vv;  // Cov(v, v')
    const double dv = next.v - o.v;
    moved[i] = std::max(0.0, dv * dv + next.vv + o.vv - 2 * lag) / dt;
  }
}

/// Slope of a straight line through the speeds around: what the steps of an encoder do from row to
/// row is no acceleration.
double acceleration_at(const Session& s, std::size_t i, double row_s) {
  const auto half =
      (s.q > 0.0 || s.noise > 0.0) && s.v == nullptr
          ? static_cast<std::size_t>(std::clamp(std::lround(k_slope_s / row_s), 1L, 50L))
          : 1;
  const std::size_t before = i > half ? i - half : 0,
                    after = std::min(static_cast<std::size_t>(s.n) - 1, i + half);
  double mean = 0.0, moment = 0.0, square = 0.0;
  for (std::size_t j = before; j <= after; ++j)
    mean += s.t[j] / static_cast<double>(after - before + 1);
  for (std::size_t j = before; j <= after; ++j)
    moment += (s.t[j] - mean) * s.smoothed[j].v, square += (s.t[j] - mean) * (s.t[j] - mean);
  return square > 0.0 ? moment / square : 0.0;
}

void estimate(Session& s, Motion& out, Eigen::Index begin) {
  const auto n = static_cast<std::size_t>(s.n);
  set_observations(s);
  // a first guess that follows everything: the speed of the whole way may change within 50 ms
  double path = 0.0;
  for (std::size_t i = 1; i < n; ++i) path += std::fabs(s.x[i] - s.x[i - 1]);
  const double typical = path / std::max(1e-9, s.t[n - 1] - s.t[0]);
  s.walk.assign(n, std::max(k_min_walk, typical * typical / 0.05));
  s.predicted.resize(n);
  s.filtered.resize(n);
  s.smoothed.resize(n);
  std::vector<double> moved(n, 0.0), sums(n + 1, 0.0);
  const int passes = s.noise > 0.0 ? k_passes_noisy : s.q > 0.0 ? k_passes_coarse : k_passes_exact;
  const double row_s = std::max(1e-9, (s.t[n - 1] - s.t[0]) / static_cast<double>(n - 1));
  const std::size_t window =
      s.noise > 0.0 ? static_cast<std::size_t>(std::clamp(k_noisy_window_s / row_s, 2.0, 200.0))
                    : k_window;
  for (int pass = 0; pass < passes; ++pass) {
    filter(s);
    smooth(s, moved);
    if (pass + 1 == passes) break;
    for (std::size_t i = 0; i < n; ++i) sums[i + 1] = sums[i] + moved[i];
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const std::size_t from = i > window ? i - window : 0, to = std::min(n - 1, i + window + 1);
      const double seen = (sums[to] - sums[from]) / static_cast<double>(to - from);
      s.walk[i] =
          std::max(k_min_walk, s.q > 0.0 || s.noise > 0.0
                                   ? (seen + k_prior_weight * k_prior_walk) / (1.0 + k_prior_weight)
                                   : seen);
    }
    if (s.q > 0.0 && pass >= 1)
      for (std::size_t i = 0; i < n; ++i) {
        const double off = s.smoothed[i].x - s.x[i];
        if (std::fabs(off) > 0.52 * s.q && std::isnan(s.pin_z[i]))
          s.pin_z[i] = s.x[i] + (off > 0 ? 0.45 : -0.45) * s.q;
      }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Index row = begin + static_cast<Eigen::Index>(i);
    const State& o = s.smoothed[i];
    out.x_mm[row] = o.x;
    out.v_mm_s[row] = o.v;
    // in a hold the rows repeat one error: what the shared observations seem to have learned beyond
    // that is not there
    const double repeated = s.q > 0.0 && s.run_rows[i] > s.shared_rows && s.v == nullptr
                                ? s.q * s.q / 12.0 * (1.0 - s.shared_rows / s.run_rows[i])
                                : 0.0;
    out.sd_x_mm[row] = std::sqrt(std::max({0.0, o.xx, repeated}));
    out.sd_v_mm_s[row] = std::sqrt(std::max(0.0, o.vv));
    out.lasting_rows[row] = s.noise > 0.0 ? k_noisy_lasting_rows
                            : s.q > 0.0
                                ? std::clamp(s.run_rows[i], 1.0, std::max(1.0, k_lasting_s / row_s))
                                : 1.0;
    out.a_mm_s2[row] = acceleration_at(s, i, row_s);
  }
  if (s.q > 0.0 || s.noise > 0.0 || s.v != nullptr) return;
  // fine positions of a smooth motion give its speed better than a speed that walks at random would
  // let them
  const std::vector<Slope> slope = slopes({s.t, n}, {s.x, n});
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Index row = begin + static_cast<Eigen::Index>(i);
    if (slope[i].error_mm_s >= out.sd_v_mm_s[row]) continue;
    out.v_mm_s[row] = slope[i].mm_s;
    out.sd_v_mm_s[row] = std::min(out.sd_v_mm_s[row], slope[i].error_mm_s + k_exact_mm / row_s);
  }
}

/// A session as the smoother takes it. `speed`: the measured one is an observation.
Session session_of(const Recording& r, const Motion& m, const SessionRows& rows, bool speed) {
  Session s;
  s.n = rows.end - rows.begin;
  s.t = r.t_s.data() + rows.begin;
  s.x = r.x_mm.data() + rows.begin;
  s.v = speed ? r.v_mm_s.data() + rows.begin : nullptr;
  s.r_v = m.speed_sd_mm_s * m.speed_sd_mm_s;
  s.noise = m.noise_mm > 0.0 ? std::hypot(m.noise_mm, m.quantum_mm / std::sqrt(12.0)) : 0.0;
  s.q = m.quantum_mm > 1e-5 && s.noise == 0.0 ? m.quantum_mm : 0.0;
  s.shared_rows = std::max(
      8.0, k_shared_s * static_cast<double>(s.n - 1) / std::max(1e-9, s.t[s.n - 1] - s.t[0]));
  return s;
}

bool is_coarse(const Motion& m) { return m.quantum_mm > 1e-5 || m.noise_mm > 0.0; }

/// Backwards through what the filter knew: each state given the next one as it was drawn.
void draw_backwards(const Session& s, Random& random, double* x, double* v) {
  double to_x = 0.0, to_v = 0.0;
  for (auto i = static_cast<std::size_t>(s.n); i-- > 0;) {
    State at = s.filtered[i];
    if (i + 1 < static_cast<std::size_t>(s.n)) {
      const State &f = s.filtered[i], &p = s.predicted[i + 1];
      const Gain g(f, p, s.t[i + 1] - s.t[i]);
      const double ex = to_x - p.x, ev = to_v - p.v;
      at = {f.x + g.gxx * ex + g.gxv * ev, f.v + g.gvx * ex + g.gvv * ev,
            f.xx - (g.gxx * g.axx + g.gxv * g.axv), f.xv - (g.gxx * g.avx + g.gxv * g.avv),
            f.vv - (g.gvx * g.avx + g.gvv * g.avv)};
    }
    const double sx = std::sqrt(std::max(0.0, at.xx)), by = random.normal();
    const double slope = at.xx > 0.0 ? at.xv / at.xx : 0.0,
                 rest = std::sqrt(std::max(0.0, at.vv - slope * at.xv));
    to_x = at.x + sx * by;
    to_v = at.v + slope * sx * by + rest * random.normal();
    x[i] = to_x;
    v[i] = to_v;
  }
}

/// Without those that are possible as well.
Motion best_motion(const Recording& r) {
  Motion out;
  const Eigen::Index n = r.rows();
  for (Series* s : {&out.x_mm, &out.v_mm_s, &out.a_mm_s2, &out.sd_x_mm, &out.sd_v_mm_s})
    *s = Series::Zero(n);
  out.lasting_rows = Series::Ones(n);
  if (r.exact_motion) {
    out.x_mm = r.x_mm;
    out.v_mm_s = r.v_mm_s;
    for (const auto& rows : r.sessions)
      for (Eigen::Index i = rows.begin + 1; i < rows.end; ++i)
        out.a_mm_s2[i] = (r.v_mm_s[i] - r.v_mm_s[i - 1]) / (r.t_s[i] - r.t_s[i - 1]);
    return out;
  }
  out.quantum_mm = r.rig.position_quantum_mm > 0.0 ? r.rig.position_quantum_mm : seen_quantum_mm(r);
  out.noise_mm = position_noise_mm(r, out.quantum_mm);
  const bool recedes = surface_recedes(r);
  if (r.v_mm_s.size() > 0 && !recedes) {
    if (const SpeedCheck check = check_speed(r); !is_coarse(out)) {
      out.speed_note =
          Fact("speed_not_needed",
               msg("v_mm_s was not needed: the positions are fine enough to give the speed"));
    } else if (!check.of_use) {
      out.speed_note =
          check.borrowed > k_borrowed && std::fabs(check.late_s) < 2.0 * check.late_sd_s + 1e-4
              ? Fact(
                    "speed_made_of_positions",
                    msg("v_mm_s was not used: it is made from the positions and shares their errors, so the speed is taken from the positions"))
              : Fact(
                    "speed_late", {"late"},
                    msg("v_mm_s was not used: it is {} behind the positions, so the speed is taken from them",
                        as_unit(1e3 * check.late_s, cavum::Unit::ms, 1)));
    } else {
      out.speed_sd_mm_s = std::max(1e-4, speed_scatter_mm_s(r));
    }
  }
  if (recedes) out.speed_sd_mm_s = std::max(1e-4, speed_scatter_mm_s(r));
  for (const auto& rows : r.sessions) {
    Session s = session_of(r, out, rows, out.speed_sd_mm_s > 0.0 && !recedes);
    if (s.n < 2) {
      out.x_mm.segment(rows.begin, s.n) = r.x_mm.segment(rows.begin, s.n);
      continue;
    }
    estimate(s, out, rows.begin);
    if (recedes)
      for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
        const Eigen::Index a = std::max(rows.begin, i - 1), b = std::min(rows.end - 1, i + 1);
        out.v_mm_s[i] = r.v_mm_s[i];
        out.sd_v_mm_s[i] = out.speed_sd_mm_s;
        out.a_mm_s2[i] = (r.v_mm_s[b] - r.v_mm_s[a]) / (r.t_s[b] - r.t_s[a]);
      }
  }
  return out;
}

}  // namespace

bool moves_one_way(const Motion& m) {
  const double fastest = m.v_mm_s.maxCoeff();
  return fastest > 0.0 && (m.v_mm_s < -0.1 * fastest).cast<double>().mean() < 0.01;
}

Motion estimate_motion(const Recording& r) {
  Motion out = best_motion(r);
  if (r.exact_motion || (!is_coarse(out) && out.speed_sd_mm_s <= 0.0)) return out;
  std::vector<std::pair<Series, Series>> possible;
  for (Motion& m : draw_motions(r, out, {0, k_possible}, 1))
    possible.emplace_back(std::move(m.x_mm), std::move(m.v_mm_s));
  out.possible = std::move(possible);
  return out;
}

std::vector<Motion> draw_motions(const Recording& r, const Motion& m,
                                 std::pair<std::size_t, std::size_t> which, std::uint64_t seed) {
  const std::size_t count = which.second - which.first;
  std::vector<Motion> out(count, m);
  const double q = m.quantum_mm > 1e-5 && m.noise_mm == 0.0 ? m.quantum_mm : 0.0;
  const Holds holds = q > 0.0 ? find_holds(r, q) : Holds{};
  for (auto& one : out) one.sd_x_mm.setZero(), one.sd_v_mm_s.setZero();
  if (holds.repeat()) {
    for (std::size_t i = 0; i < count; ++i) {
      Random random(seed + 0x9e3779b97f4a7c15ULL * (which.first + i + 1));
      out[i].x_mm = replaced_holds(r, m.x_mm, holds, q, random);
      const Series off = out[i].x_mm - m.x_mm;
      for (const auto& rows : r.sessions)
        for (Eigen::Index row = rows.begin; row < rows.end; ++row) {
          const Eigen::Index a = std::max(rows.begin, row - 1), b = std::min(rows.end - 1, row + 1);
          if (b > a) out[i].v_mm_s[row] += (off[b] - off[a]) / (r.t_s[b] - r.t_s[a]);
        }
    }
    return out;
  }
  const bool recedes = surface_recedes(r);
  Motion scratch = m;
  for (std::size_t at = 0; at < r.sessions.size(); ++at) {
    const SessionRows& rows = r.sessions[at];
    Session s = session_of(r, m, rows, m.speed_sd_mm_s > 0.0 && !recedes);
    if (s.n < 2 || r.exact_motion) continue;
    estimate(s, scratch, rows.begin);
    independent_runs(count, [&](std::size_t i) {
      Random random(seed + 0x9e3779b97f4a7c15ULL * (which.first + i + 1) +
                    0x632be59bd9b4e019ULL * (at + 1));
      Series v = Series::Zero(s.n);
      draw_backwards(s, random, out[i].x_mm.data() + rows.begin, v.data());
      for (Eigen::Index row = 0; row < s.n && !recedes;
           ++row) {  // no further off than the estimate is said to be
        const double said = scratch.sd_v_mm_s[rows.begin + row],
                     walked =
                         std::sqrt(std::max(1e-30, s.smoothed[static_cast<std::size_t>(row)].vv));
        out[i].v_mm_s[rows.begin + row] +=
            std::min(1.0, said / walked) * (v[row] - m.v_mm_s[rows.begin + row]);
      }
    });
  }
  return out;
}

}  // namespace cavum::explain
