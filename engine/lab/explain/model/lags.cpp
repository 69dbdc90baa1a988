#include "engine/lab/explain/model/lags.h"

#include <algorithm>
#include <cmath>

namespace cavum::explain {
namespace {

constexpr double k_open_instant = 0.25;  // of the way from row to row

/// The way from one row to the next: where the contact acts, and the motion at both ends, times the
/// tissue's relative k and c.
struct Way {
  double x0, v0, x1, v1, dt_s;
  double on0, on1;     ///< `active` of the rows
  double jump = -1.0;  ///< part of the way at which it switches; -1: it does not, and is straight
};

Way way_to(const Scene& s, Eigen::Index i) {
  const Series &rk = s.recording->relative_k, &rc = s.recording->relative_c;
  Way w{s.motion->x_mm[i - 1] * relative_at(rk, i - 1),
        s.motion->v_mm_s[i - 1] * relative_at(rc, i - 1),
        s.motion->x_mm[i] * relative_at(rk, i),
        s.motion->v_mm_s[i] * relative_at(rc, i),
        std::max(1e-12, s.dt_s[i - 1]),
        s.active[i - 1],
        s.active[i]};
  // a position that leaves the instant of contact open has no jump: what is expected then changes
  // evenly
  if (std::fabs(w.on1 - w.on0) < 0.5 ||
      s.motion->sd_x_mm[i] > k_open_instant * std::fabs(w.x1 - w.x0))
    return w;
  const double f0 = s.base.k_n_per_mm * w.x0 + s.base.c_n_s_per_mm * w.v0,
               f1 = s.base.k_n_per_mm * w.x1 + s.base.c_n_s_per_mm * w.v1;
  const auto crossing = [](double a, double b) { return a * b < 0.0 ? a / (a - b) : 0.5; };
  w.jump = w.x0 * w.x1 < 0.0 ? crossing(w.x0, w.x1) : crossing(f0, f1);
  return w;
}

double motion_at(double from, double to, double part) { return from + part * (to - from); }

/// A column at a part of the way, 0 to 1.
double column_at(double u0, double u1, const Way& w, double part) {
  const double on = w.jump < 0.0 ? motion_at(w.on0, w.on1, part) : part < w.jump ? w.on0 : w.on1;
  return on * motion_at(u0, u1, part);
}

/// y' = (u − y)/tau over dt, u straight.
double lag(double y, double u0, double u1, double dt_s, double tau_s) {
  if (dt_s <= 0.0) return y;
  const double behind = tau_s * (u1 - u0) / dt_s;
  return u1 - behind + (y - u0 + behind) * std::exp(-dt_s / tau_s);
}

double lag_over(double y, double u0, double u1, const Way& w, double tau_s) {
  if (w.jump < 0.0) return lag(y, w.on0 * u0, w.on1 * u1, w.dt_s, tau_s);
  const double middle = motion_at(u0, u1, w.jump);
  y = lag(y, w.on0 * u0, w.on0 * middle, w.jump * w.dt_s, tau_s);
  return lag(y, w.on1 * middle, w.on1 * u1, (1.0 - w.jump) * w.dt_s, tau_s);
}

Columns nothing(const Scene& s) {
  return {{}, Series::Zero(s.force_n.size()), Series::Zero(s.force_n.size())};
}

}  // namespace

Columns delayed(const Scene& s, double tau_s) {
  Columns out = nothing(s);
  const Series& t = s.recording->t_s;
  for (const auto& rows : s.recording->sessions) {
    Eigen::Index j = rows.begin;
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      const double then = t[i] - tau_s;
      while (j + 2 < rows.end && t[j + 1] <= then) ++j;
      if (then <= t[rows.begin] ||
          then >= t[rows.end -
                    1]) {  // before and after the recording the tool stood where it begins and ends
        const Eigen::Index end = then <= t[rows.begin] ? rows.begin : rows.end - 1;
        out.spring[i] = s.spring_mm[end];
        out.damper[i] = s.damper_mm_s[end];
        continue;
      }
      const Way w = way_to(s, j + 1);
      const double part = std::clamp((then - t[j]) / w.dt_s, 0.0, 1.0);
      out.spring[i] = column_at(w.x0, w.x1, w, part);
      out.damper[i] = column_at(w.v0, w.v1, w, part);
    }
  }
  out.spring -= s.spring_mm;
  out.damper -= s.damper_mm_s;
  return out;
}

Columns lagged(const Scene& s, double tau_s) {
  Columns out = nothing(s);
  for (const auto& rows : s.recording->sessions) {
    double x = s.spring_mm[rows.begin], v = s.damper_mm_s[rows.begin];
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      if (i > rows.begin) {
        const Way w = way_to(s, i);
        x = lag_over(x, w.x0, w.x1, w, tau_s);
        v = lag_over(v, w.v0, w.v1, w, tau_s);
      }
      out.spring[i] = x;
      out.damper[i] = v;
    }
  }
  out.spring -= s.spring_mm;
  out.damper -= s.damper_mm_s;
  return out;
}

Series resonance(const Scene& s, const Series& u, double frequency_hz, double damping) {
  Series out = Series::Zero(u.size());
  const double w = 2 * 3.14159265358979323846 * frequency_hz, fade = damping * w,
               swing = w * std::sqrt(1.0 - damping * damping);
  for (const auto& rows : s.recording->sessions) {
    double y = u[rows.begin], slope = 0.0;
    out[rows.begin] = y;
    for (Eigen::Index i = rows.begin + 1; i < rows.end; ++i) {
      // exact for u straight from row to row: the response follows u, behind by 2 damping/w, and
      // what is left of before rings down
      const double dt = s.dt_s[i - 1], rate = dt > 0.0 ? (u[i] - u[i - 1]) / dt : 0.0,
                   behind = 2.0 * damping / w * rate;
      const double off = y - (u[i - 1] - behind), off_slope = slope - rate;
      const double down = std::exp(-fade * dt), c = std::cos(swing * dt), d = std::sin(swing * dt);
      const double b = (off_slope + fade * off) / swing;
      const double left = down * (off * c + b * d);
      slope = rate + down * (-fade * (off * c + b * d) + swing * (b * c - off * d));
      y = u[i] - behind + left;
      out[i] = y;
    }
  }
  return out;
}

Columns in_series(const Scene& s, double mm_per_n) {
  const double k = s.base.k_n_per_mm, c = s.base.c_n_s_per_mm, softer = 1.0 + k * mm_per_n,
               tau_s = c * mm_per_n / softer;
  Columns out = nothing(s);
  for (const auto& rows : s.recording->sessions) {
    double x = 0.0, v = 0.0;
    for (Eigen::Index i = rows.begin + 1; i < rows.end; ++i) {
      double x0 = s.motion->x_mm[i - 1], v0 = s.motion->v_mm_s[i - 1], dt_s = s.dt_s[i - 1];
      const double x1 = s.motion->x_mm[i], v1 = s.motion->v_mm_s[i];
      if (x1 <= 0.0) {
        x = v = 0.0;
        continue;
      }
      if (x0 <= 0.0) {  // the part of the row that is spent in contact
        const double part = std::clamp(x1 / std::max(1e-12, x1 - x0), 1e-3, 1.0);
        v0 = motion_at(v0, v1, 1.0 - part);
        x0 = 0.0;
        dt_s *= part;
      }
      x = lag(x, x0, x1, dt_s, tau_s);
      v = lag(v, v0, v1, dt_s, tau_s);
      if (k * x + c * v <= 0.0) x = v = 0.0;
      out.spring[i] = x / softer;
      out.damper[i] = v / softer;
    }
  }
  out.spring = out.spring * s.touching - s.spring_mm;
  out.damper = out.damper * s.touching - s.damper_mm_s;
  return out;
}

}  // namespace cavum::explain
