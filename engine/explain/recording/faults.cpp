#include "engine/explain/recording/faults.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/base/text.h"
#include "engine/explain/recording/motion.h"

namespace cavum::explain {
namespace {

constexpr double k_time_tolerance = 0.02;  // of the slope of x over the integral of v: a clock is far better, a quantised position not much
constexpr double k_unit_band = 3.0;        // a unit taken for another is off by 1000; no calibration is off by 300
constexpr double k_against = 0.5;          // correlation of force and penetration, about zero, below which the force pulls
constexpr double k_clipped_share = 0.002;  // of all rows at the limit

void time_stamps(const Recording& r, std::vector<std::string>& faults) {
  Eigen::Index backwards = 0, repeated = 0;
  std::string first;
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) {
      const double d = r.t_s[i] - r.t_s[i - 1];
      if (d > 0.0) continue;
      ++(d < 0.0 ? backwards : repeated);
      if (first.empty()) first = "session " + one_line(s.name) + " after " + plain_number(r.t_s[i - 1]) + " s";
    }
  if (backwards > 0)
    faults.push_back("time stamps: " + std::to_string(backwards) + " run backwards, first in " + first +
                     "; sort the rows by time or find out why they are mixed");
  if (repeated > 0)
    faults.push_back("time stamps: " + std::to_string(repeated) + " are repeated, first in " + first +
                     "; give each row the time at which it was sampled");
}

void speed_against_position(const Recording& r, std::vector<std::string>& faults) {
  const Agreement agreement = position_over_speed(r);
  const double slope = agreement.slope, agree = agreement.correlation;
  if (slope == 0.0 && agree == 0.0) return;
  const double thousand = slope * 1000.0, thousandth = slope / 1000.0;
  for (const double unit : {thousand, thousandth})
    if (unit > 1.0 / k_unit_band && unit < k_unit_band) {
      faults.push_back("units: x_mm moves " + plain_number(slope) +
                       " times as far as v_mm_s says; one of x, v and t is in metres or milliseconds, convert it");
      return;
    }
  if (agree < 0.7 * agreement.expected_correlation) {
    faults.push_back("time base: x_mm and the integral of v_mm_s have little in common (correlation " + plain_number(agree) +
                     "); check that both belong to the same run");
    return;
  }
  if (std::fabs(slope - 1.0) > k_time_tolerance + 4.0 * agreement.slope_sd)
    faults.push_back("time base: x_mm moves " + plain_number(slope) +
                     " times as far as the integral of v_mm_s over t_s says; correct the sampling rate");
}

void units(const Recording& r, std::vector<std::string>& faults) {
  const double pressed = r.f_n.maxCoeff();
  double xf = 0.0, xx = 0.0, ff = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    if (r.x_mm[i] > 0.0) xf += r.x_mm[i] * r.f_n[i], xx += r.x_mm[i] * r.x_mm[i], ff += r.f_n[i] * r.f_n[i];
  if (!(xx > 0.0)) {
    faults.push_back("x_mm is never positive, so the tool never touches; check the sign and the zero of the position");
    return;
  }
  if (xf < -k_against * std::sqrt(xx * ff)) {
    faults.push_back("sign: f_n falls below zero as the tool presses deeper (" + plain_number(xf / xx) +
                     " N/mm); a force that resists is positive, multiply f_n by -1");
    return;
  }
  if (r.rig.k_n_per_mm) {
    const double ratio = xf / xx / *r.rig.k_n_per_mm;
    if (ratio > 50.0 || (ratio > 0.0 && ratio < 0.02))
      faults.push_back("units: force over penetration is " + plain_number(ratio) +
                       " times k_n_per_mm of rig.toml; is x in metres or micrometres, or f in grams?");
  }
  const double range = r.x_mm.maxCoeff() - r.x_mm.minCoeff();
  if (range < 0.02 && pressed > 0.1)
    faults.push_back("units: all motion is within " + plain_number(range) + " mm and yet " + plain_number(pressed) +
                     " N are reached; is x_mm in metres?");
  if (range > 1000.0) faults.push_back("units: x_mm spans " + plain_number(range) + " mm; is it in micrometres?");
  double length = 0.0, rows = 0.0;
  for (const auto& s : r.sessions) length += r.t_s[s.end - 1] - r.t_s[s.begin], rows += static_cast<double>(s.end - s.begin - 1);
  const double dt = rows > 0.0 ? length / rows : 0.0;
  if (dt > 0.7) faults.push_back("time base: a row every " + plain_number(dt) + " s; is t_s in milliseconds?");
  if (dt > 0.0 && dt < 1e-5) faults.push_back("time base: a row every " + plain_number(dt) + " s; is t_s in hours or minutes?");
}

void clipping(const Recording& r, std::vector<std::string>& faults) {
  const double n = static_cast<double>(r.rows());
  if (r.rig.force_limit_n) {
    const double limit = *r.rig.force_limit_n - std::max(r.rig.force_quantum_n, 1e-6 * *r.rig.force_limit_n);
    const double at = (r.f_n.abs() >= limit).cast<double>().sum();
    if (at > 2.0 && at > 1e-4 * n) {
      faults.push_back("clipped force: " + plain_number(at) + " rows are at force_limit_n = " + plain_number(*r.rig.force_limit_n) +
                       " N; use a larger range");
      return;
    }
  }
  // a plateau without noise at the largest value: many rows in a run, all the same
  const double top = r.f_n.maxCoeff();
  Eigen::Index at_top = 0, in_runs = 0;
  for (Eigen::Index i = 0; i < r.rows(); ++i) {
    if (r.f_n[i] < top) continue;
    ++at_top;
    if (i > 0 && r.f_n[i - 1] == top) ++in_runs;
  }
  if (static_cast<double>(at_top) > std::max(10.0, k_clipped_share * n) && in_runs * 2 > at_top)
    faults.push_back("clipped force: " + std::to_string(at_top) + " rows show exactly the largest value, " + plain_number(top) +
                     " N; use a larger range");
}

}  // namespace

std::vector<std::string> data_faults(const Recording& r) {
  std::vector<std::string> faults;
  time_stamps(r, faults);
  if (!faults.empty()) return faults;  // everything else would be measured against wrong times
  if (!r.exact_motion) speed_against_position(r, faults);
  units(r, faults);
  clipping(r, faults);
  if (r.rows() < 200) faults.push_back("only " + std::to_string(r.rows()) + " rows; record for at least a minute");
  return faults;
}

}  // namespace cavum::explain
