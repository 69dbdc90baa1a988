#include "engine/lab/explain/recording/standstill.h"

#include <algorithm>
#include <cmath>

#include "engine/base/order.h"
#include "engine/base/text.h"
#include "engine/lab/explain/recording/as_recorded.h"
#include "engine/lab/explain/recording/conventions.h"

namespace cavum::explain {
namespace {

constexpr Eigen::Index k_min_stuck_rows = 20;
constexpr double k_min_stuck_s = 0.2;
constexpr double k_force_due = 0.25;  // of what the force does over the position, that it should
                                      // have done while it stood still
constexpr double k_way_due = 0.05;    // of the range of the position
constexpr double k_speed_due = 0.3;   // of the usual speed: an offset of the speed is no motion
constexpr int k_steps = 60;
constexpr double k_gap_s = 0.3, k_gap_intervals = 20.0;
constexpr double k_smoother_by = 5.0;

/// Rows [begin, end) of one value.
struct Still {
  Eigen::Index begin = 0, end = 0;
  std::size_t session = 0;
};

std::vector<Still> long_runs(const Recording& r, const Series& values) {
  std::vector<Still> out;
  for (std::size_t s = 0; s < r.sessions.size(); ++s)
    for (Eigen::Index i = r.sessions[s].begin, end = i; i < r.sessions[s].end; i = end) {
      while (end < r.sessions[s].end && values[end] == values[i]) ++end;
      if (end - i >= k_min_stuck_rows && r.t_s[end - 1] - r.t_s[i] >= k_min_stuck_s)
        out.push_back({i, end, s});
    }
  return out;
}

/// Mean force of each step of the position, those rows left out that stand still.
struct ForceOver {
  double low = 0.0, span = 0.0, extent = 0.0;
  std::vector<double> mean_n, rows;
  [[nodiscard]] std::size_t step(double x) const {
    return static_cast<std::size_t>(std::clamp((x - low) / span * k_steps, 0.0, k_steps - 1.0));
  }
};

ForceOver force_over_position(const Recording& r, const std::vector<Still>& left_out) {
  ForceOver out;
  out.low = r.x_mm.minCoeff();
  out.span = std::max(1e-12, r.x_mm.maxCoeff() - out.low);
  out.mean_n.assign(k_steps, 0.0);
  out.rows.assign(k_steps, 0.0);
  auto next = left_out.begin();
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    while (next != left_out.end() && i >= next->end) ++next;
    if (next != left_out.end() && i >= next->begin) continue;
    const std::size_t b = out.step(r.x_mm[i]);
    out.mean_n[b] += r.f_n[i], out.rows[b] += 1.0;
  }
  double low = 1e300, high = -1e300;
  for (std::size_t b = 0; b < out.rows.size(); ++b) {
    if (out.rows[b] < 4.0) continue;
    out.mean_n[b] /= out.rows[b];
    low = std::min(low, out.mean_n[b]), high = std::max(high, out.mean_n[b]);
  }
  out.extent = std::max(0.0, high - low);
  return out;
}

/// How far the force of all other rows goes over the places of these.
double force_due(const Recording& r, const Still& still, const ForceOver& over) {
  double low = 1e300, high = -1e300;
  for (Eigen::Index i = still.begin; i < still.end; ++i)
    if (const std::size_t b = over.step(r.x_mm[i]); over.rows[b] >= 4.0)
      low = std::min(low, over.mean_n[b]), high = std::max(high, over.mean_n[b]);
  return std::max(0.0, high - low);
}

Message where_words(const Recording& r, const Still& s) {
  return msg("in session {} from {} to {}", r.sessions[s.session].name, as_number(r.t_s[s.begin]),
             as_s(r.t_s[s.end - 1], k_as_needed));
}

void stuck_force(const Recording& r, std::vector<DataFault>& faults) {
  const std::vector<Still> runs = long_runs(r, r.f_n);
  if (runs.empty()) return;
  const ForceOver over = force_over_position(r, runs);
  const double top = r.f_n.maxCoeff(), bottom = r.f_n.minCoeff();  // those are clipped, not stuck
  std::size_t stuck = 0;
  const Still* first = nullptr;
  for (const Still& run : runs) {
    const double value = r.f_n[run.begin];
    if (value == top || value == bottom || !(force_due(r, run, over) > k_force_due * over.extent))
      continue;
    ++stuck;
    if (first == nullptr) first = &run;
  }
  if (first != nullptr)
    faults.push_back(
        {DataFault::Kind::stuck_force,
         stuck > 1
             ? msg("stuck force: f_n stands still at {} {}, and {} times more, while x_mm moves to where it differs; leave those rows "
                   "out, or record anew",
                   as_n(r.f_n[first->begin], k_as_needed), where_words(r, *first), stuck - 1)
             : msg("stuck force: f_n stands still at {} {} while x_mm moves to where it differs; leave those rows out, or record anew",
                   as_n(r.f_n[first->begin], k_as_needed), where_words(r, *first))});
}

void stuck_position(const Recording& r, std::vector<DataFault>& faults) {
  if (r.v_mm_s.size() != r.rows()) return;
  const double range = r.x_mm.maxCoeff() - r.x_mm.minCoeff(),
               usual = std::sqrt(r.v_mm_s.square().mean());
  const double quantum = std::max(r.rig.position_quantum_mm, seen_quantum_mm(r));
  std::size_t stuck = 0;
  std::optional<Still> first;
  double gone = 0.0;
  for (const Still& run : long_runs(r, r.x_mm)) {
    double at = 0.0, low = 0.0, high = 0.0, squares = 0.0;
    for (Eigen::Index i = run.begin + 1; i < run.end; ++i) {
      at += 0.5 * (r.v_mm_s[i] + r.v_mm_s[i - 1]) * (r.t_s[i] - r.t_s[i - 1]);
      low = std::min(low, at), high = std::max(high, at);
      squares += r.v_mm_s[i] * r.v_mm_s[i];
    }
    const double speed = std::sqrt(squares / static_cast<double>(run.end - run.begin));
    if (high - low < std::max(k_way_due * range, 3.0 * quantum) || speed < k_speed_due * usual)
      continue;
    ++stuck;
    if (!first) first = run, gone = high - low;
  }
  if (first)
    faults.push_back(
        {DataFault::Kind::stuck_position,
         stuck > 1
             ? msg("stuck position: x_mm stands still at {} {}, and {} times more, while v_mm_s goes on over {}; leave those rows "
                   "out, or record anew",
                   as_mm(r.x_mm[first->begin], k_as_needed), where_words(r, *first), stuck - 1,
                   as_mm(gone, k_as_needed))
             : msg("stuck position: x_mm stands still at {} {} while v_mm_s goes on over {}; leave those rows out, or record anew",
                   as_mm(r.x_mm[first->begin], k_as_needed), where_words(r, *first),
                   as_mm(gone, k_as_needed))});
}

/// Fourth differences over the range: a motion has hardly any, a force has its noise.
double roughness(const Recording& r, const Series& values) {
  std::vector<double> d;
  for (const SessionRows& s : r.sessions)
    for (Eigen::Index i = s.begin + 2; i + 2 < s.end; ++i)
      d.push_back(std::fabs(values[i - 2] - 4.0 * values[i - 1] + 6.0 * values[i] -
                            4.0 * values[i + 1] + values[i + 2]));
  const double range = values.maxCoeff() - values.minCoeff();
  return d.empty() || !(range > 0.0) ? 0.0 : median(std::move(d)) / range;
}

/// What rows are apart as a rule.
struct Stride {
  double interval_s = 0.0, speed_mm_s = 0.0;
};

double usual_speed_mm_s(const Recording& r) {
  double squares = 0.0, n = 0.0;
  for (const SessionRows& s : r.sessions)
    for (Eigen::Index i = s.begin + 3; i < s.end; ++i)
      if (const double dt = r.t_s[i] - r.t_s[i - 3]; dt > 0.0)
        squares += std::pow((r.x_mm[i] - r.x_mm[i - 3]) / dt, 2), n += 1.0;
  return n > 0.0 ? std::sqrt(squares / n) : 0.0;
}

/// From row i - 1 to row i the tool moves as in one interval, at the speed that it has before and
/// after, and not as in the time between them.
bool goes_on(const Recording& r, Eigen::Index i, const Stride& usual) {
  const double before = (r.x_mm[i - 1] - r.x_mm[i - 4]) / (r.t_s[i - 1] - r.t_s[i - 4]),
               after = (r.x_mm[i + 3] - r.x_mm[i]) / (r.t_s[i + 3] - r.t_s[i]);
  const double speed = 0.5 * (before + after), moved = std::fabs(r.x_mm[i] - r.x_mm[i - 1]);
  if (std::fabs(speed) < k_speed_due * usual.speed_mm_s ||
      std::fabs(after - before) > 0.5 * std::fabs(speed))
    return false;
  return moved < 5.0 * std::fabs(speed) * usual.interval_s &&
         moved < 0.2 * std::fabs(speed) * (r.t_s[i] - r.t_s[i - 1]);
}

}  // namespace

std::vector<DataFault> standstill_faults(const Recording& r) {
  if (!std::isfinite(r.x_mm.maxCoeff() - r.x_mm.minCoeff())) return {};
  std::vector<DataFault> faults;
  stuck_force(r, faults);
  stuck_position(r, faults);
  return faults;
}

std::vector<DataFault> jump_faults(const Recording& r) {
  std::vector<double> intervals;
  for (const SessionRows& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) intervals.push_back(r.t_s[i] - r.t_s[i - 1]);
  if (intervals.size() < 200) return {};
  const double limit = std::max(
      k_gap_s, k_gap_intervals * in_order(intervals, quantile_index(intervals.size(), 0.99)));
  const Stride usual{median(std::move(intervals)), usual_speed_mm_s(r)};
  std::size_t jumps = 0;
  Message first;
  for (const SessionRows& s : r.sessions)
    for (Eigen::Index i = s.begin + 4; i + 3 < s.end; ++i) {
      if (r.t_s[i] - r.t_s[i - 1] <= limit || !goes_on(r, i, usual)) continue;
      if (++jumps == 1)
        first = msg("{} pass in session {} after {}", as_s(r.t_s[i] - r.t_s[i - 1], k_as_needed),
                    s.name, as_s(r.t_s[i - 1], k_as_needed));
    }
  if (jumps == 0) return {};
  return {
      {DataFault::Kind::clock_jump,
       jumps > 1
           ? msg("time stamps: {}, while the motion goes on as if from one row to the next, and {} times more; the clock jumped: take that "
                 "time off, or give what follows a session of its own",
                 first, jumps - 1)
           : msg("time stamps: {}, while the motion goes on as if from one row to the next; the clock jumped: take that time off, or give what "
                 "follows a session of its own",
                 first)}};
}

std::vector<DataFault> swap_faults(const Recording& r) {
  if (r.rows() < 50 || judge_conventions(r).contact) return {};
  Recording swapped = r;
  std::swap(swapped.x_mm, swapped.f_n);
  swapped.v_mm_s.resize(0);
  if (!judge_conventions(swapped).contact ||
      roughness(r, r.x_mm) < k_smoother_by * roughness(r, r.f_n))
    return {};
  return {
      {DataFault::Kind::columns_swapped,
       msg("columns: x_mm has the noise of a force and a flat stretch, f_n is smooth and goes both ways; they seem to be in each other's place, "
           "name them with --column")}};
}

}  // namespace cavum::explain
