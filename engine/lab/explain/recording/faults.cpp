#include "engine/lab/explain/recording/faults.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/message_json.h"
#include "engine/base/order.h"
#include "engine/base/text.h"
#include "engine/lab/explain/recording/as_recorded.h"
#include "engine/lab/explain/recording/standstill.h"

namespace cavum::explain {
namespace {

constexpr double k_time_tolerance = 0.02;  // of the slope of x over the integral of v: a clock is
                                           // far better, a quantised position not much
constexpr double k_of_one_run =
    0.3;  // correlation of x with the integral of v, below which they are not of one run
constexpr double k_clock_alone =
    0.3;  // of what the slope is off by, that may be left when a clock is all that is wrong
constexpr double k_unit_band =
    3.0;  // a unit taken for another is off by 1000; no calibration is off by 300
constexpr double k_against =
    0.5;  // correlation of force and penetration, about zero, below which the force pulls
constexpr double k_clipped_share = 0.002;  // of all rows at the limit

void time_stamps(const Recording& r, std::vector<DataFault>& faults) {
  Eigen::Index backwards = 0, repeated = 0;
  Message first;
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) {
      const double d = r.t_s[i] - r.t_s[i - 1];
      if (d > 0.0) continue;
      ++(d < 0.0 ? backwards : repeated);
      if (first.empty())
        first = msg("session {} after {}", one_line(s.name), as_s(r.t_s[i - 1], k_as_needed));
    }
  if (backwards > 0)
    faults.push_back(
        {DataFault::Kind::time_stamps,
         msg("time stamps: {} run backwards, first in {}; sort the rows by time or find out why they are mixed",
             backwards, first)});
  if (repeated > 0)
    faults.push_back(
        {DataFault::Kind::time_stamps,
         msg("time stamps: {} are repeated, first in {}; give each row the time at which it was sampled",
             repeated, first)});
}

void speed_against_position(const Recording& r, std::vector<DataFault>& faults) {
  const Agreement agreement = position_over_speed(r);
  const double slope = agreement.slope, agree = agreement.correlation;
  if (slope == 0.0 && agree == 0.0) return;
  const double thousand = slope * 1000.0, thousandth = slope / 1000.0;
  for (const double unit : {thousand, thousandth})
    if (unit > 1.0 / k_unit_band && unit < k_unit_band) {
      faults.push_back(
          {DataFault::Kind::units,
           msg("units: x_mm moves {} times as far as v_mm_s says; one of x, v and t is in metres or milliseconds, convert it",
               as_number(slope))});
      return;
    }
  if (agree < k_of_one_run) {
    faults.push_back(
        {DataFault::Kind::time_base,
         msg("time base: x_mm and the integral of v_mm_s have little in common (correlation {}); check that both belong to the same run",
             as_number(agree))});
    return;
  }
  // a wrong clock changes the slope and nothing else; a speed that was filtered changes the rest as
  // well, and is not used (motion.h)
  const double rest =
      std::sqrt(std::max(0.0, 1.0 - std::pow(agree / agreement.expected_correlation, 2)));
  if (std::fabs(slope - 1.0) > k_time_tolerance + 4.0 * agreement.slope_sd &&
      rest < k_clock_alone * std::fabs(slope - 1.0))
    faults.push_back(
        {DataFault::Kind::time_base,
         msg("time base: x_mm moves {} times as far as the integral of v_mm_s over t_s says; correct the sampling rate",
             as_number(slope))});
}

/// The unit that would make a force over penetration of `ratio` times the rig's right.
Message unit_words(double ratio) {
  constexpr double k_near = 1.35;  // k of rig.toml is about right
  constexpr std::array<std::pair<const char*, double>, 4> k_forces{
      {{"mN", 1000.0}, {"gf", 101.97}, {"kN", 1e-3}, {"kgf", 0.10197}}};
  constexpr std::array<std::pair<const char*, double>, 3> k_lengths{
      {{"m", 1000.0}, {"um", 1e-3}, {"in", 25.4}}};
  List options;
  const auto propose = [&](char column, const auto& units) {
    for (const auto& [name, factor] : units)
      if (ratio < k_near * factor && ratio > factor / k_near)
        options.items.push_back(msg("{}", fmt::format("--unit {}={}", column, name)));
  };
  propose('f', k_forces);
  propose('x', k_lengths);
  return options.items.empty()
             ? msg("is x in metres or micrometres, or f in grams? Say so with --unit")
             : msg("try one of: {}", options);
}

void units(const Recording& r, std::vector<DataFault>& faults) {
  const double pressed = r.f_n.maxCoeff();
  double xf = 0.0, xx = 0.0, ff = 0.0;
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    if (r.x_mm[i] > 0.0)
      xf += r.x_mm[i] * r.f_n[i], xx += r.x_mm[i] * r.x_mm[i], ff += r.f_n[i] * r.f_n[i];
  if (xx > 0.0 && xf < -k_against * std::sqrt(xx * ff)) {
    faults.push_back(
        {DataFault::Kind::sign,
         msg("sign: f_n falls below zero as the tool presses deeper ({}); a force that resists is positive, give --negate f",
             as_unit(xf / xx, cavum::Unit::n_per_mm, k_as_needed))});
    return;
  }
  if (r.rig.k_n_per_mm && xx > 0.0) {
    const double ratio = xf / xx / *r.rig.k_n_per_mm;
    if (ratio > 50.0 || (ratio > 0.0 && ratio < 0.02))
      faults.push_back({DataFault::Kind::units,
                        msg("units: force over penetration is {} times k_n_per_mm of rig.toml; {}",
                            as_number(ratio), unit_words(ratio))});
  }
  const double range = r.x_mm.maxCoeff() - r.x_mm.minCoeff();
  if (range < 0.02 && pressed > 0.1 && xx > 0.0)
    faults.push_back(
        {DataFault::Kind::units,
         msg("units: all motion is within {} and yet {} are reached; is x_mm in metres?",
             as_mm(range, k_as_needed), as_n(pressed, k_as_needed))});
  // in air a joint at a lever, or a drive, may go far
  if (const double deepest = std::min(range, r.x_mm.maxCoeff()); deepest > 1000.0)
    faults.push_back({DataFault::Kind::units, msg("units: x_mm goes {} deep; is it in micrometres?",
                                                  as_mm(deepest, k_as_needed))});
  std::vector<double>
      steps;  // a hold may be written in wide steps: it is the closest rows that tell the unit
  for (const auto& s : r.sessions)
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) steps.push_back(r.t_s[i] - r.t_s[i - 1]);
  if (steps.empty()) return;
  const double close = quantile(steps, 0.1),
               dt = quantile(std::move(steps),
                             0.9);  // and packets that come together say nothing of hours
  if (close > 0.7)
    faults.push_back(
        {DataFault::Kind::time_base,
         msg("time base: a row every {}; is t_s in milliseconds?", as_s(close, k_as_needed))});
  if (dt > 0.0 && dt < 1e-5)
    faults.push_back(
        {DataFault::Kind::time_base,
         msg("time base: a row every {}; is t_s in hours or minutes?", as_s(dt, k_as_needed))});
}

void clipping(const Recording& r, std::vector<DataFault>& faults) {
  const double n = static_cast<double>(r.rows());
  if (r.rig.force_limit_n) {
    const double limit =
        *r.rig.force_limit_n - std::max(r.rig.force_quantum_n, 1e-6 * *r.rig.force_limit_n);
    const double at = (r.f_n.abs() >= limit).cast<double>().sum();
    if (at > 2.0 && at > 1e-4 * n) {
      faults.push_back({DataFault::Kind::clipped,
                        msg("clipped force: {} rows are at force_limit_n = {}; use a larger range",
                            as_number(at), as_n(*r.rig.force_limit_n, k_as_needed))});
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
    faults.push_back(
        {DataFault::Kind::clipped,
         msg("clipped force: {} rows show exactly the largest value, {}; use a larger range",
             at_top, as_n(top, k_as_needed))});
}

}  // namespace

std::vector<DataFault> data_faults(const Recording& r) {
  std::vector<DataFault> faults;
  time_stamps(r, faults);
  if (!faults.empty()) return faults;  // everything else would be measured against wrong times
  const auto also = [&faults](std::vector<DataFault> found) {
    std::move(found.begin(), found.end(), std::back_inserter(faults));
  };
  if (!r.exact_motion) {
    also(swap_faults(r));
    also(jump_faults(r));
    also(standstill_faults(r));
    speed_against_position(r, faults);
  }
  units(r, faults);
  clipping(r, faults);
  if (r.rows() < 200)
    faults.push_back(
        {DataFault::Kind::too_few, msg("only {} rows; record for at least a minute", r.rows())});
  return faults;
}

void to_json(nlohmann::json& json, const DataFault& fault) {
  json = fact_json(name_in(fault.kind), fault.what);
}

std::vector<Message> texts_of(const std::vector<DataFault>& faults) {
  std::vector<Message> texts;
  for (const DataFault& f : faults) texts.push_back(f.what);
  return texts;
}

}  // namespace cavum::explain
