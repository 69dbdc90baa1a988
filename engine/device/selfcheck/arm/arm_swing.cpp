#include "engine/device/selfcheck/arm/arm_swing.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/base/order.h"
#include "engine/base/statistics.h"

namespace cavum {
namespace {

constexpr double k_swing_n = 0.45, k_swing_of_friction = 1.5, k_swing_mm = 8.0, k_swing_s = 6.0,
                 k_swing_begins_s = 0.7, k_calm_s = 0.3;
constexpr Eigen::Index k_unknowns = 4;  // 1/mass, and over mass: friction, weight, viscous

using SwingSolution = Eigen::Matrix<double, k_unknowns, 1>;
constexpr int k_parts = 5;  // of a swing, for its scatter

/// From one turning point to the next.
struct SwingRun {
  std::size_t from = 0, to = 0;  // samples
};

/// Turning points: the farthest place between two passages of the middle; of a flat top its middle.
std::vector<SwingRun> runs_of(std::span<const SwingSample> s, double middle_mm) {
  std::vector<std::size_t> turns;
  std::size_t passage = 0;
  bool first = true;
  for (std::size_t i = 1; i < s.size(); ++i) {
    const bool above = s[i - 1].at_mm > middle_mm;
    if ((s[i].at_mm > middle_mm) == above) continue;
    if (!first) {
      std::size_t best = passage, last = passage;
      for (std::size_t k = passage; k < i; ++k) {
        const double better = above ? s[k].at_mm - s[best].at_mm : s[best].at_mm - s[k].at_mm;
        if (better > 0.0) best = last = k;
        if (better == 0.0) last = k;
      }
      turns.push_back((best + last) / 2);
    }
    first = false;
    passage = i;
  }
  std::vector<SwingRun> runs;
  constexpr std::size_t k_min_samples = 16;
  for (std::size_t i = 1; i < turns.size(); ++i)
    if (turns[i] - turns[i - 1] >= k_min_samples) runs.push_back({turns[i - 1], turns[i]});
  return runs;
}

/// One equation: the bump (1 − ((t − middle)/half)²)³ over the samples.
struct SwingRow {
  std::array<double, k_unknowns> columns{};
  double rhs = 0.0;
};

std::optional<SwingRow> row_of(std::span<const SwingSample> s, const SwingRun& run, double middle_s,
                               double half_s, double delay_s, double way) {
  constexpr double k_longest_step_s = 0.006;
  SwingRow row;
  const auto bump = [&](double t, double& b, double& b1, double& b2) {
    const double z = (t - middle_s) / half_s, r = 1.0 - z * z;
    if (r <= 0.0) {
      b = b1 = b2 = 0.0;
      return;
    }
    b = r * r * r;
    b1 = -6.0 * z * r * r / half_s;
    b2 = (24.0 * z * z * r - 6.0 * r * r) / (half_s * half_s);
  };
  double area = 0.0;
  for (std::size_t i = run.from; i < run.to; ++i) {
    const double step = s[i + 1].t_s - s[i].t_s;
    double a0 = 0, a1 = 0, a2 = 0, b0 = 0, b1 = 0, b2 = 0;
    bump(s[i].t_s, a0, a1, a2);
    bump(s[i + 1].t_s, b0, b1, b2);
    if (a0 == 0.0 && b0 == 0.0) continue;
    if (step > k_longest_step_s || !s[i].fresh) return std::nullopt;
    row.rhs += 0.5 * step * (a2 * s[i].at_mm + b2 * s[i + 1].at_mm) * 1e-3;  // mm to m
    if constexpr (k_unknowns > 3)
      row.columns[k_unknowns - 1] += 0.5 * step * (a1 * s[i].at_mm + b1 * s[i + 1].at_mm);
    area += 0.5 * step * (a0 + b0);
  }
  // the force acts `delay_s` later than it was commanded, and stays until the next command
  std::size_t k = run.from;
  while (k > 0 && s[k].t_s + delay_s > middle_s - half_s) --k;
  for (; k + 1 < s.size() && s[k].t_s + delay_s < middle_s + half_s; ++k) {
    const double step = s[k + 1].t_s - s[k].t_s;
    double b = 0, b1 = 0, b2 = 0;
    bump(s[k].t_s + delay_s + 0.5 * step, b, b1, b2);
    row.columns[0] += s[k].force_n * b * step;
  }
  row.columns[1] = -way * area;
  row.columns[2] = -area;
  for (double& c : row.columns) c /= area;
  row.rhs /= area;
  return row;
}

struct SwingRows {
  std::vector<SwingRow> rows;
  std::vector<std::size_t> part;  // of five
};

SwingRows rows_of(std::span<const SwingSample> s, const std::vector<SwingRun>& runs,
                  double delay_s) {
  constexpr double k_margin = 0.08, k_half = 0.28;  // shares of a run
  constexpr int k_places = 6;
  SwingRows out;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const double begin = s[runs[r].from].t_s, length_s = s[runs[r].to].t_s - begin;
    const double way = s[runs[r].to].at_mm > s[runs[r].from].at_mm ? 1.0 : -1.0;
    for (int p = 0; p < k_places; ++p) {
      const double first = k_margin + k_half, last = 1.0 - first;
      const double middle = begin + length_s * (first + (last - first) * p / (k_places - 1));
      if (const auto row = row_of(s, runs[r], middle, k_half * length_s, delay_s, way)) {
        out.rows.push_back(*row);
        out.part.push_back(r * k_parts / runs.size());
      }
    }
  }
  return out;
}

/// Least squares over the parts but one; -1: over all.
bool solve(const SwingRows& rows, int without, SwingSolution& x, double& rms,
           double& scale_of_rhs) {
  Eigen::Matrix<double, k_unknowns, k_unknowns> a =
      Eigen::Matrix<double, k_unknowns, k_unknowns>::Zero();
  SwingSolution b = SwingSolution::Zero();
  double squares = 0.0;
  std::size_t n = 0;
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    if (static_cast<int>(rows.part[i]) == without) continue;
    const Eigen::Map<const SwingSolution> c(rows.rows[i].columns.data());
    a += c * c.transpose();
    b += c * rows.rows[i].rhs;
    squares += rows.rows[i].rhs * rows.rows[i].rhs;
    ++n;
  }
  constexpr std::size_t k_min_rows = 30;
  if (n < k_min_rows) return false;
  const SwingSolution scale = a.diagonal().cwiseMax(1e-30).cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, k_unknowns, k_unknowns> scaled =
      scale.asDiagonal() * a * scale.asDiagonal();
  const Eigen::LDLT<Eigen::Matrix<double, k_unknowns, k_unknowns>> ldlt(scaled);
  if (ldlt.info() != Eigen::Success || !(ldlt.rcond() > 1e-10)) return false;
  x = scale.asDiagonal() * ldlt.solve(scale.asDiagonal() * b);
  scale_of_rhs = std::sqrt(squares / static_cast<double>(n));
  rms = std::sqrt(std::max(0.0, squares - b.dot(x)) / static_cast<double>(n));
  return x.allFinite();
}

constexpr std::array<const char*, 3> k_swing_names{"x", "y", "z"};

}  // namespace

std::vector<SwingFit> fit_swings(std::span<const std::vector<SwingSample>> swings) {
  std::vector<SwingFit> fits(swings.size());
  std::vector<std::vector<SwingRun>> runs;
  for (const auto& swing : swings) {
    std::vector<double> places;
    for (const SwingSample& s : swing) places.push_back(s.at_mm);
    if (places.empty()) return fits;
    runs.push_back(runs_of(swing, 0.5 * (quantile(places, 0.02) + quantile(places, 0.98))));
  }
  // Acceleration is what is fitted: fitting the force instead, a delay up to the turning points and
  // friction as large as the force would explain it all.
  SwingSolution x;
  const auto squares_at = [&](double delay_s) {
    double sum = 0.0;
    for (std::size_t i = 0; i < swings.size(); ++i) {
      double residual = 0.0, scale = 0.0;
      if (!solve(rows_of(swings[i], runs[i], delay_s), -1, x, residual, scale)) return 1e300;
      sum += residual * residual /
             (scale * scale);  // an axis with more mass swings with less acceleration
    }
    return sum;
  };
  constexpr double k_max_delay_s = 0.010, k_delay_step_s = 0.0005;
  double best = 0.0, least = squares_at(0.0);
  for (double delay = k_delay_step_s; delay <= k_max_delay_s; delay += k_delay_step_s)
    if (const double squares = squares_at(delay); squares < least) {
      least = squares;
      best = delay;
    }
  if (least >= 1e300) return fits;
  if (best > 0.0) {  // the vertex of the parabola through three
    const double before = squares_at(best - k_delay_step_s),
                 after = squares_at(best + k_delay_step_s);
    if (const double bend = before - 2.0 * least + after; bend > 0.0)
      best += 0.5 * k_delay_step_s * (before - after) / bend;
  }
  for (std::size_t i = 0; i < swings.size(); ++i) {
    const SwingRows rows = rows_of(swings[i], runs[i], best);
    double residual = 0.0, scale = 0.0;
    if (!solve(rows, -1, x, residual, scale) || !(x(0) > 0.0)) continue;
    SwingFit& fit = fits[i];
    fit.delay_s = best;
    fit.mass_kg = 1.0 / x(0);
    fit.friction_n = x(1) * fit.mass_kg;
    fit.weight_n = x(2) * fit.mass_kg;
    fit.viscous_n_s_per_mm = k_unknowns > 3 ? x(k_unknowns - 1) * fit.mass_kg : 0.0;
    fit.residual_n = residual * fit.mass_kg;
    std::vector<double> masses;  // jackknife over the parts of the swing
    for (int part = 0; part < k_parts; ++part)
      if (SwingSolution y; solve(rows, part, y, residual, scale) && y(0) > 0.0)
        masses.push_back(1.0 / y(0));
    if (masses.size() != k_parts) continue;
    fit.mass_error =
        std::sqrt(variance(masses) * (k_parts - 1) * (k_parts - 1) / k_parts) / fit.mass_kg;
    fit.solved = true;
  }
  return fits;
}

namespace {

double swing_force_n(const ArmServo& servo, std::size_t axis, const ArmFigures& figures) {
  const double side = length(servo.lean_n() - along_axis(axis, on_axis(servo.lean_n(), axis)));
  const double room = std::sqrt(std::max(0.0, servo.most_n() * servo.most_n() - side * side)) -
                      std::abs(figures.axes[axis].weight_n);
  return std::min(k_swing_n + k_swing_of_friction * figures.axes[axis].friction_n, room);
}

}  // namespace

Message too_heavy_to_swing(const ArmServo& servo, std::size_t axis, const ArmFigures& figures) {
  constexpr double k_min_over_friction = 1.15;
  if (swing_force_n(servo, axis, figures) >= k_min_over_friction * figures.axes[axis].friction_n)
    return {};
  return msg(
      "weight and friction along {} leave too little of {} to swing it; balance it, or have its joints seen to",
      k_swing_names[axis], as_n(servo.most_n(), k_as_needed));
}

std::vector<SwingSample> swing_axis(ArmServo& servo, std::size_t axis, const ArmFigures& figures) {
  const double weight = figures.axes[axis].weight_n, home = on_axis(servo.home_mm(), axis),
               swing_n = swing_force_n(servo, axis, figures);
  // The force turns `ahead_mm` past home, on either side. From a turning point at X an arm that is
  // driven by A − c and braked by A + c comes to ahead + kept (X + ahead) on the other side, kept =
  // (A − c)/(A + c): any arm swings by k_swing_mm.
  constexpr double k_max_ahead_mm = 5.5, k_risen_mm = 0.5, k_lost_s = 0.7;
  const double friction = figures.axes[axis].friction_n,
               kept = (swing_n - friction) / (swing_n + friction);
  std::vector<SwingSample> samples;
  double ahead_mm = 0.0, way = 1.0, lowest_mm = 0.0, turned_s = servo.now_s();
  const double begin = servo.now_s();
  while (servo.now_s() - begin < k_swing_s) {
    servo.look();
    double at = (on_axis(servo.at_mm(), axis) - home) * way;
    lowest_mm = std::min(lowest_mm, at);
    ahead_mm =
        std::clamp((k_swing_mm + kept * lowest_mm) / (1.0 + kept), -k_max_ahead_mm, k_max_ahead_mm);
    if (at > ahead_mm && at - lowest_mm > k_risen_mm) {
      way = -way;
      lowest_mm = at = -at;
      turned_s = servo.now_s();
    } else if (servo.now_s() - turned_s > k_lost_s) {
      throw ArmStopped(msg(
          "it does not swing along {}: take the hand off it, and what stands in its way, and begin again",
          k_swing_names[axis]));
    }
    Vec3 force = servo.hold(servo.home_mm());
    force += along_axis(axis, weight + way * swing_n - on_axis(force, axis));
    servo.push(force);
    const ArmSample& s = servo.samples().back();
    samples.push_back({s.t_s, on_axis(s.at_mm, axis), on_axis(s.force_n, axis), s.fresh});
  }
  servo.rest(servo.home_mm(), k_calm_s, false);
  const auto from = std::find_if(samples.begin(), samples.end(), [&](const SwingSample& s) {
    return s.t_s - begin > k_swing_begins_s;
  });
  return {from, samples.end()};
}

}  // namespace cavum
