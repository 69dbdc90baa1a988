#include "engine/lab/explain/recording/as_recorded.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/order.h"
#include "engine/base/statistics.h"

namespace cavum::explain {
namespace {

constexpr double k_steps_of_span =
    4.0;  // of the encoder, for its position to be held against a measured speed
constexpr double k_min_noise_mm = 2e-4;  // below, positions count as exact
constexpr double k_flicker =
    0.1;  // of an encoder's steps that go back at once: then the position is noisy
constexpr double k_more_than_rounding = 1.5;  // scatter over that of a fine rounding
constexpr Eigen::Index k_check_rows =
    200;  // of a stretch in which the integral of the speed is held against the position
constexpr double k_late_rows = 0.1;  // of a row, that a measured speed may be late

}  // namespace

double speed_scatter_mm_s(const Recording& r) {
  std::vector<double> d;
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 3; i < s.end; ++i)
      d.push_back(
          std::fabs(r.v_mm_s[i] - 3 * r.v_mm_s[i - 1] + 3 * r.v_mm_s[i - 2] - r.v_mm_s[i - 3]));
  return d.empty() ? 0.0 : 1.4826 * median(std::move(d)) / std::sqrt(20.0);
}

Series intervals_s(const Recording& r) {
  Series dt = Series::Zero(r.rows());
  for (const auto& s : r.sessions) {
    for (Eigen::Index i = s.begin; i + 1 < s.end; ++i) dt[i] = r.t_s[i + 1] - r.t_s[i];
    if (s.end - s.begin > 1) dt[s.end - 1] = dt[s.end - 2];
  }
  return dt;
}

double seen_quantum_mm(const Recording& r) {
  std::vector<double> steps;
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) {
      const double d = std::fabs(r.x_mm[i] - r.x_mm[i - 1]);
      if (d > 1e-9) steps.push_back(d);
    }
  if (steps.size() < 50) return 0.0;  // too few to tell a lattice from chance
  const double q = *std::min_element(steps.begin(), steps.end());
  const double range = r.x_mm.maxCoeff() - r.x_mm.minCoeff();
  if (q < 1e-5 * range) return 0.0;
  for (const double d : steps)
    if (std::fabs(d / q - std::round(d / q)) > 0.01 * std::max(1.0, d / q)) return 0.0;
  // one step in most rows would be a constant speed, not a lattice
  return std::count_if(steps.begin(), steps.end(), [&](double d) { return d < 1.5 * q; }) <
                 static_cast<std::ptrdiff_t>(r.rows()) * 9 / 10
             ? q
             : 0.0;
}

double position_noise_mm(const Recording& r, double quantum_mm) {
  constexpr Eigen::Index k_stretch = 40;
  std::vector<double> scatter;
  double steps = 0.0, back = 0.0;
  for (const auto& s : r.sessions) {
    for (Eigen::Index from = s.begin; from + k_stretch + 4 <= s.end; from += k_stretch) {
      std::vector<double> d;
      for (Eigen::Index i = from; i < from + k_stretch; ++i)
        d.push_back(std::fabs(r.x_mm[i] - 4 * r.x_mm[i + 1] + 6 * r.x_mm[i + 2] -
                              4 * r.x_mm[i + 3] + r.x_mm[i + 4]));
      scatter.push_back(1.4826 * median(std::move(d)) / std::sqrt(70.0));
    }
    double last = 0.0;
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) {
      const double step = r.x_mm[i] - r.x_mm[i - 1];
      if (std::fabs(step) > 0.5 * quantum_mm && quantum_mm > 0.0) {
        steps += 1.0;
        if (last * step < 0.0) back += 1.0;
        last = step;
      } else {
        last = 0.0;
      }
    }
  }
  if (scatter.empty()) return 0.0;
  const double seen = quantile(std::move(scatter), 0.3);
  if (quantum_mm > 1e-5) {
    const double rounding = quantum_mm / std::sqrt(12.0),
                 beside = std::sqrt(std::max(0.0, seen * seen - rounding * rounding));
    if (back >= k_flicker * steps) return std::max(0.3 * quantum_mm, beside);
    return seen > k_more_than_rounding * rounding ? beside : 0.0;
  }
  return seen > k_min_noise_mm ? seen : 0.0;
}

SpeedCheck check_speed(const Recording& r) {
  constexpr Eigen::Index k_near = 4;  // rows on each side that make the fine structure
  std::vector<double> over_v, square_v, borrowed;
  for (const auto& s : r.sessions) {
    double ev = 0.0, vv = 0.0, odd = 0.0, ww = 0.0, dd = 0.0;
    for (Eigen::Index from = s.begin; from + k_check_rows <= s.end; from += k_check_rows) {
      const Eigen::Index n = k_check_rows;
      const Series t = r.t_s.segment(from, n) - r.t_s[from], v = r.v_mm_s.segment(from, n),
                   line = t - t.mean();
      Series e = r.x_mm.segment(
          from,
          n);  // less the integral of v: how late v is, times v, and the error of the position
      double way = 0.0;
      const auto slope = [&](Eigen::Index i) {
        const Eigen::Index a = std::max<Eigen::Index>(0, i - 1), b = std::min(n - 1, i + 1);
        return (v[b] - v[a]) / (t[b] - t[a]);
      };
      for (Eigen::Index i = 1; i < n; ++i) {  // trapezoids, and what bends between their ends
        const double dt = t[i] - t[i - 1];
        e[i] -= way += 0.5 * (v[i] + v[i - 1]) * dt - dt * dt / 12.0 * (slope(i) - slope(i - 1));
      }
      const auto straightened = [&](Series u) {
        u -= u.mean();
        return Series(u - line * ((line * u).sum() / std::max(1e-300, line.square().sum())));
      };
      e = straightened(e);
      const Series u = straightened(v);
      ev += (e * u).sum();
      vv += u.square().sum();
      // a speed made from positions has their errors in it, those after with one sign and those
      // before with the other
      for (Eigen::Index i = k_near; i + k_near < n; ++i) {
        const double w = v[i] - v.segment(i - k_near, 2 * k_near + 1).mean();
        const double d = e.segment(i + 1, k_near).mean() - e.segment(i - k_near, k_near).mean();
        odd += w * d;
        ww += w * w;
        dd += d * d;
      }
    }
    if (vv > 0.0) over_v.push_back(ev), square_v.push_back(vv);
    if (ww > 0.0 && dd > 0.0) borrowed.push_back(odd / std::sqrt(ww * dd));
  }
  SpeedCheck out;
  const std::size_t n = over_v.size();
  if (n < 2 || borrowed.size() < 2) return out;
  double all_ev = 0.0, all_vv = 0.0;
  for (std::size_t i = 0; i < n; ++i) all_ev += over_v[i], all_vv += square_v[i];
  out.late_s = all_ev / all_vv;
  double square = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double without =
        (all_ev - over_v[i]) / std::max(1e-300, all_vv - square_v[i]) - out.late_s;
    square += without * without;
  }
  out.late_sd_s = std::sqrt(square * static_cast<double>(n - 1) / static_cast<double>(n));
  const MeanSd fine = mean_sd(borrowed);
  out.borrowed = fine.mean;
  const double row_s = intervals_s(r).mean();
  const bool late = std::fabs(out.late_s) > std::max(k_late_rows * row_s, 3.0 * out.late_sd_s) ||
                    out.late_sd_s > 0.3 * row_s;
  const bool made =
      fine.mean >
      std::max(k_borrowed, 3.0 * fine.sd / std::sqrt(static_cast<double>(borrowed.size())));
  out.of_use = !late && !made;
  return out;
}

Agreement position_over_speed(const Recording& r) {
  if (r.v_mm_s.size() == 0) return {};
  const Series* rpm = r.column("spindle_rpm");
  double xy[2] = {0, 0}, xx[2] = {0, 0}, yy[2] = {0, 0}, spans = 0.0;
  const double q = r.rig.position_quantum_mm > 0.0 ? r.rig.position_quantum_mm : seen_quantum_mm(r);
  for (const auto& s : r.sessions) {
    // long enough for several steps of the encoder, and eight spans at least
    double path = 0.0;
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) path += std::fabs(r.x_mm[i] - r.x_mm[i - 1]);
    const double rows = static_cast<double>(s.end - s.begin),
                 steps = path > 0.0 ? k_steps_of_span * q / path * rows : 0.0;
    const auto span =
        static_cast<Eigen::Index>(std::max({2.0, rows / 200, std::min(steps, rows / 8)}));
    for (Eigen::Index a = s.begin; a + span < s.end; a += span) {
      double way = 0.0;
      for (Eigen::Index i = a; i < a + span; ++i)
        way += 0.5 * (r.v_mm_s[i] + r.v_mm_s[i + 1]) * (r.t_s[i + 1] - r.t_s[i]);
      const double moved = r.x_mm[a + span] - r.x_mm[a];
      const int cutting = rpm != nullptr && ((*rpm)[a] > 0.0 || (*rpm)[a + span] > 0.0) &&
                          std::max(r.x_mm[a], r.x_mm[a + span]) > 0.0;
      xy[cutting] += way * moved;
      xx[cutting] += way * way;
      yy[cutting] += moved * moved;
      spans += cutting == 0 ? 1.0 : 0.0;
    }
  }
  Agreement out;
  if (xx[0] > 0.0 && yy[0] > 0.0)
    out = {xy[0] / xx[0], xy[0] / std::sqrt(xx[0] * yy[0]), 0.0, 0.0, 1.0};
  if (const double noise2 = q * q / 6.0; xx[0] > 0.0) {  // both ends of a span are rounded
    out.slope_sd = std::sqrt(noise2 / xx[0]);
    out.expected_correlation = std::sqrt(xx[0] / (xx[0] + spans * noise2));
  }
  if (xx[1] > 0.0) out.cutting_slope = xy[1] / xx[1];
  return out;
}

bool surface_recedes(const Recording& r) {
  const Agreement a = position_over_speed(r);
  return a.slope > 0.9 && a.slope < 1.1 && a.correlation > 0.9 && a.cutting_slope != 0.0 &&
         a.cutting_slope < 0.9;
}

}  // namespace cavum::explain
