#include "engine/lab/explain/recording/conventions.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/order.h"
#include "engine/base/text.h"
#include "engine/lab/explain/recording/as_recorded.h"

namespace cavum::explain {
namespace {

constexpr Eigen::Index k_min_rows_judged = 50, k_max_rows_judged = 200'000,
                       k_max_rows_refined = 20'000;
constexpr int k_bins = 60;
constexpr double k_min_rows_of_bin = 4.0;
constexpr double k_bend_over_line = 0.3;  // squares left by the bend over those left by a straight
                                          // line: a weight on a joint is no contact
constexpr double k_bend_explains = 0.75;  // of the scatter of the means
constexpr double k_air_share = 0.05;      // of the rows on the flat side, at least
constexpr double k_air_level = 0.4;       // of the force reached: the flat side is near zero
constexpr double k_over_air_scatter = 4.0;  // the force reached over the scatter on the flat side
constexpr double k_far_mm = 0.3;            // a surface set by hand is nearer
constexpr double k_large_n = 50.0;
constexpr double k_against_speed =
    -0.5;  // correlation below which the speed is counted against the position

/// Mean force in equal steps of the position.
struct Means {
  std::vector<double> x, f, rows;
  double scatter_n = 0.0;  // root mean square within the steps
};

Means means_over_position(const Recording& r) {
  const Eigen::Index stride = std::max<Eigen::Index>(1, r.rows() / k_max_rows_judged);
  const double low = r.x_mm.minCoeff(), span = r.x_mm.maxCoeff() - low;
  std::vector<double> n(k_bins, 0.0), sum(k_bins, 0.0), sum_x(k_bins, 0.0);
  if (!(span > 0.0) || !std::isfinite(span)) return {};
  for (Eigen::Index i = 0; i < r.rows(); i += stride) {
    const auto b =
        static_cast<std::size_t>(std::clamp((r.x_mm[i] - low) / span * k_bins, 0.0, k_bins - 1.0));
    n[b] += 1.0, sum[b] += r.f_n[i], sum_x[b] += r.x_mm[i];
  }
  Means out;
  for (std::size_t b = 0; b < n.size(); ++b)
    if (n[b] >= k_min_rows_of_bin)
      out.x.push_back(sum_x[b] / n[b]), out.f.push_back(sum[b] / n[b]), out.rows.push_back(n[b]);
  return out;
}

/// f = level + slope · h(x), each step of the position as heavy as the other.
struct Fitted {
  double level = 0.0, slope = 0.0, squares = 0.0;
};

template <class Shape>
Fitted fit_shape(const Means& m, const Shape& h) {
  double s = 0, sh = 0, shh = 0, sf = 0, shf = 0;
  for (std::size_t i = 0; i < m.x.size(); ++i) {
    const double u = h(m.x[i]);
    s += 1.0, sh += u, shh += u * u, sf += m.f[i], shf += u * m.f[i];
  }
  Fitted out;
  const double d = s * shh - sh * sh;
  out.slope = d > 1e-12 * s * shh ? (s * shf - sh * sf) / d : 0.0;
  out.level = (sf - out.slope * sh) / s;
  for (std::size_t i = 0; i < m.x.size(); ++i)
    out.squares += std::pow(m.f[i] - out.level - out.slope * h(m.x[i]), 2);
  return out;
}

/// Scatter of the force on the flat side, and its share of the rows.
std::pair<double, double> flat_side(const Recording& r, double at, int towards) {
  double n = 0, s = 0, ss = 0;
  for (Eigen::Index i = 0; i < r.rows(); ++i)
    if ((r.x_mm[i] - at) * towards < 0.0) n += 1.0, s += r.f_n[i], ss += r.f_n[i] * r.f_n[i];
  if (n < 2.0) return {0.0, 0.0};
  return {std::sqrt(std::max(0.0, ss / n - s / n * (s / n))), n / static_cast<double>(r.rows())};
}

/// Force over depth and speed from one place of the surface: squares left by k and c in contact,
/// and by nothing in air.
double squares_from(const std::vector<std::array<double, 3>>& rows, double at) {
  double xx = 0, xv = 0, vv = 0, xf = 0, vf = 0;
  for (const auto& [x, v, f] : rows)
    if (const double u = x - at; u > 0.0)
      xx += u * u, xv += u * v, vv += v * v, xf += u * f, vf += v * f;
  const double d = xx * vv - xv * xv;
  const double k = d > 1e-9 * xx * vv ? (xf * vv - vf * xv) / d
                   : xx > 0.0         ? xf / xx
                                      : 0.0,
               c = d > 1e-9 * xx * vv ? (vf * xx - xf * xv) / d : 0.0;
  double out = 0.0;
  for (const auto& [x, v, f] : rows)
    out += std::pow(f - (x > at ? std::max(0.0, k * (x - at) + c * v) : 0.0), 2);
  return out;
}

/// The same place by all rows and with the damper, which makes the mean force begin earlier than
/// the contact does.
double refined_surface_mm(const Recording& r, const ContactSeen& seen) {
  const Eigen::Index stride = std::max<Eigen::Index>(1, r.rows() / k_max_rows_refined);
  const double turn = seen.towards, push = seen.reached_n < 0.0 ? -1.0 : 1.0;
  std::vector<std::array<double, 3>> rows;  // position along the feed, its speed, force
  for (const SessionRows& s : r.sessions)
    for (Eigen::Index i = s.begin + 2; i + 2 < s.end; i += stride)
      if (const double dt = r.t_s[i + 2] - r.t_s[i - 2]; dt > 0.0)
        rows.push_back({turn * r.x_mm[i], turn * (r.x_mm[i + 2] - r.x_mm[i - 2]) / dt,
                        push * (r.f_n[i] - seen.air_n)});
  double low = 1e300, high = -1e300;
  for (const auto& row : rows) low = std::min(low, row[0]), high = std::max(high, row[0]);
  double best = turn * seen.at_mm, width = 0.3 * (high - best);
  for (int round = 0; round < 4 && width > 0.0; ++round, width /= 5.0) {
    double least = 1e300;
    const double middle = best;
    for (int i = -8; i <= 8; ++i)
      if (const double at = middle + width * i / 8.0; at < high) {
        const double squares = squares_from(rows, at);
        if (squares < least) least = squares, best = at;
      }
  }
  return turn * best;
}

std::optional<ContactSeen> solve_proxy(const Recording& r) {
  const Means m = means_over_position(r);
  if (m.x.size() < 8) return std::nullopt;
  const double line = fit_shape(m, [](double x) { return x; }).squares;
  const double constant = fit_shape(m, [](double) { return 0.0; }).squares;
  Fitted best;
  double at = 0.0, least = 1e300;
  int towards = 1;
  for (const int way : {1, -1})
    for (std::size_t b = 2; b + 2 < 4 * m.x.size() - 8; ++b) {
      const double position = static_cast<double>(b) / 4.0;
      const auto whole = static_cast<std::size_t>(position);
      if (whole + 1 >= m.x.size()) continue;
      const double x0 =
          m.x[whole] + (position - static_cast<double>(whole)) * (m.x[whole + 1] - m.x[whole]);
      const Fitted bend = fit_shape(m, [&](double x) { return std::max(0.0, (x - x0) * way); });
      if (bend.squares < least) least = bend.squares, best = bend, at = x0, towards = way;
    }
  const double far = best.slope * (towards > 0 ? m.x.back() - at : at - m.x.front());
  const auto [scatter, share] = flat_side(r, at, towards);
  const bool bends = least < k_bend_over_line * line && least < (1.0 - k_bend_explains) * constant;
  if (!bends || share < k_air_share || std::fabs(best.level) > k_air_level * std::fabs(far) ||
      std::fabs(far) < k_over_air_scatter * scatter)
    return std::nullopt;
  ContactSeen seen{at, best.level, far, towards};
  seen.at_mm = refined_surface_mm(r, seen);
  return seen;
}

void judge_signs(const ContactSeen& seen, bool has_speed, double speed_agrees,
                 std::vector<Doubt>& doubts) {
  const bool force = seen.reached_n < 0.0, position = seen.towards < 0;
  if (!force && !position) return;
  const Number at = as_mm(seen.at_mm, k_as_needed),
               to = as_n(seen.air_n + seen.reached_n, k_as_needed);
  const Message where = position ? force
                                       ? msg("from x = {} downwards the force falls to {}", at, to)
                                       : msg("from x = {} downwards the force rises to {}", at, to)
                        : force ? msg("from x = {} on the force falls to {}", at, to)
                                 : msg("from x = {} on the force rises to {}", at, to);
  std::string options = force ? "--negate f" : "";
  if (position)
    options += fmt::format("{}--negate x{}", force ? " " : "",
                           has_speed && speed_agrees > 0.0 ? " --negate v" : "");
  doubts.push_back(
      {"sign", true,
       !position ? msg("compression is counted negative: {}", where)
       : force
           ? msg("compression is counted negative, and the position grows out of the material: {}",
                 where)
           : msg("the position grows out of the material: {}", where),
       options});
}

void judge_origin(const Recording& r, const ContactSeen& seen, std::vector<Doubt>& doubts) {
  const double depth =
      seen.towards > 0 ? r.x_mm.maxCoeff() - seen.at_mm : seen.at_mm - r.x_mm.minCoeff();
  const double off = std::fabs(seen.at_mm);
  if (off < k_far_mm + depth) return;
  const double before = r.reading && r.reading->surface_mm ? *r.reading->surface_mm : 0.0;
  const bool negated = r.reading && r.reading->columns.of(Role::position) != nullptr &&
                       r.reading->columns.of(Role::position)->negated;
  const double surface = negated ? before - seen.at_mm : before + seen.at_mm;
  doubts.push_back(
      {"origin", true,
       msg("contact begins at x = {} and goes {} deep: x is a machine's own position, not the penetration from the surface",
           as_mm(seen.at_mm, k_as_needed), as_mm(depth, k_as_needed)),
       fmt::format("--surface-mm {:.3f}", surface)});
}

/// A force that no hand and no small press reaches: nothing but k of a rig.toml tells it from
/// another unit.
void judge_size(const Recording& r, const ContactSeen& seen, std::vector<Doubt>& doubts) {
  const double most = std::fabs(seen.reached_n);
  if (most < k_large_n || r.rig.k_n_per_mm) return;
  const ColumnReading* column = r.reading ? r.reading->columns.of(Role::force) : nullptr;
  if (column != nullptr && column->declared && column->unit.factor != 1.0) return;
  doubts.push_back(
      {"force_unit", false,
       msg("the force reaches {}: if it is in mN or in grams, say so", as_n(most, k_as_needed)),
       "--unit f=mN or --unit f=gf"});
}

/// A speed that is counted against the position, where the position itself is not to be turned.
void judge_speed(const Conventions& c, std::vector<Doubt>& doubts) {
  const bool turned = c.contact && c.contact->towards < 0;
  if (c.speed_agrees >= k_against_speed || turned) return;
  doubts.push_back(
      {"speed_sign", true,
       msg("the speed is counted against the position (correlation {} with its change)",
           as_number(c.speed_agrees)),
       "--negate v"});
}

}  // namespace

const Doubt* Conventions::first_clear() const {
  const auto at =
      std::find_if(doubts.begin(), doubts.end(), [](const Doubt& d) { return d.clear; });
  return at == doubts.end() ? nullptr : &*at;
}

Conventions judge_conventions(const Recording& r) {
  Conventions out;
  if (r.rows() < k_min_rows_judged || r.exact_motion || r.x_mm.size() != r.rows()) return out;
  out.contact = solve_proxy(r);
  const bool has_speed = r.v_mm_s.size() == r.rows();
  if (has_speed) out.speed_agrees = position_over_speed(r).correlation;
  if (out.contact) {
    judge_signs(*out.contact, has_speed, out.speed_agrees, out.doubts);
    judge_origin(r, *out.contact, out.doubts);
    judge_size(r, *out.contact, out.doubts);
  }
  judge_speed(out, out.doubts);
  return out;
}

Facts require_conventions(const Recording& r, const std::string& where, bool as_it_is) {
  const Conventions found = judge_conventions(r);
  Facts notes;
  for (const Doubt& d : found.doubts)
    if (!d.clear || as_it_is)
      notes.push_back(
          Fact("doubt", {"what", "options"}, msg("doubt: {}; give {}", d.what, d.options))
              .with("doubt", Name{d.kind}));
  if (as_it_is || found.first_clear() == nullptr) return notes;
  List what{{}, true};
  std::string options;
  for (const Doubt& d : found.doubts)
    if (d.clear) {
      what.items.push_back(d.what);
      options += fmt::format("{}{}", options.empty() ? "" : " ", d.options);
    }
  throw Error(
      ConventionError::data_fault, Name{where}, msg("{}", what),
      msg("give {}, or --as-it-is where nothing is to be turned (a joint in air may look so); look first with --dry-run",
          options));
}

}  // namespace cavum::explain
