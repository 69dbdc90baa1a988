#include "engine/device/selfcheck/check_rule.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>

#include "engine/base/statistics.h"

namespace cavum {
namespace {

constexpr std::array<const char*, 4> k_outcomes{"learning", "unchanged", "changed", "doubtful"};
constexpr std::array<const char*, 3> k_axes{"x", "y", "z"};

double t_quantile(double below, std::size_t freedom) {
  return boost::math::quantile(
      boost::math::students_t_distribution<double>(static_cast<double>(freedom)), below);
}

/// One quantity of a check against the same of earlier ones.
struct Comparison {
  double before = 0.0, now = 0.0, change = 0.0;
  double scatter = 0.0;  ///< of one more check about their mean
  std::size_t freedom = 1;

  [[nodiscard]] double limit(double alarms) const {
    return t_quantile(1.0 - 0.5 * alarms, freedom) * scatter;
  }
  [[nodiscard]] double uncertain() const { return t_quantile(0.975, freedom) * scatter; }
  [[nodiscard]] double found_from(double alarms) const {
    return limit(alarms) + t_quantile(0.95, freedom) * scatter;
  }
};

using Quantity = std::function<double(const ArmFigures&)>;

/// `own_error`: standard error that a check gives of itself; no history scatters less than that.
Comparison compare(const ArmFigures& now, std::span<const ArmFigures> earlier, const Quantity& of,
                   const Quantity& own_error = {}) {
  std::vector<double> values;
  double least_sd = 0.0;
  for (const ArmFigures& f : earlier) {
    values.push_back(of(f));
    if (own_error) least_sd += own_error(f) / static_cast<double>(earlier.size());
  }
  const MeanSd known = mean_sd(values);
  const auto n = static_cast<double>(values.size());
  Comparison c;
  c.before = known.mean;
  c.now = of(now);
  c.change = c.now - c.before;
  c.scatter = std::max(known.sd, least_sd) * std::sqrt(1.0 + 1.0 / n);
  c.freedom = values.size() - 1;
  return c;
}

double log_mass(const ArmAxis& a) { return std::log(std::max(1e-9, a.mass_kg)); }
double mean_log_mass(const ArmFigures& f) {
  return (log_mass(f.axes[0]) + log_mass(f.axes[1]) + log_mass(f.axes[2])) / 3.0;
}
double mean_mass_error(const ArmFigures& f) {
  return std::sqrt(f.axes[0].mass_error * f.axes[0].mass_error +
                   f.axes[1].mass_error * f.axes[1].mass_error +
                   f.axes[2].mass_error * f.axes[2].mass_error) /
         3.0;
}
double mean_friction_error(const ArmFigures& f) {
  return std::sqrt(f.axes[0].friction_error_n * f.axes[0].friction_error_n +
                   f.axes[1].friction_error_n * f.axes[1].friction_error_n +
                   f.axes[2].friction_error_n * f.axes[2].friction_error_n) /
         3.0;
}
std::array<double, 3> weight_of(const ArmFigures& f) {
  return {f.axes[0].weight_n, f.axes[1].weight_n, f.axes[2].weight_n};
}

/// A motor that gives less makes mass and weight seem larger by the same share; something that is
/// fixed to the stylus adds 9.81 N of weight to each kg.
std::string gain_or_mass(const ArmFigures& now, std::span<const ArmFigures> earlier,
                         double log_change) {
  constexpr double k_earth_m_s2 = 9.81, k_clear = 3.0;
  double mass_before = 0.0, mass_now = 0.0, by_gain2 = 0.0, seen2 = 0.0, scatter2 = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Comparison m =
        compare(now, earlier, [i](const ArmFigures& f) { return f.axes[i].mass_kg; });
    mass_before += m.before / 3.0;
    mass_now += m.now / 3.0;
    const Comparison w =
        compare(now, earlier, [i](const ArmFigures& f) { return weight_of(f)[i]; });
    const double off = w.change - w.before * std::expm1(log_change);
    by_gain2 += off * off;
    seen2 += w.change * w.change;
    scatter2 += w.scatter * w.scatter;
  }
  constexpr double k_min_weight_scatter_n = 0.01;
  const double by_gain = std::sqrt(by_gain2),
               by_mass =
                   std::abs(std::sqrt(seen2) - k_earth_m_s2 * std::abs(mass_now - mass_before));
  const double clear = k_clear * std::max(std::sqrt(scatter2), k_min_weight_scatter_n);
  if (by_gain + clear < by_mass) return "gain";
  if (by_mass + clear < by_gain) return "mass";
  return "gain or mass";
}

struct Found {
  CheckChange change;
  double sigmas = 0.0;
};

void add_gain(std::vector<Found>& found, const ArmFigures& now, std::span<const ArmFigures> earlier,
              double friction_change_n) {
  // at another friction the arm swings otherwise; measured on simulated arms: up to 0.085 in ln
  // mass for 0.1 N
  constexpr double k_by_friction_per_n = 0.4;
  const double floor = k_min_gain + k_by_friction_per_n * std::abs(friction_change_n);
  const auto judge = [&](const Comparison& c, double alarms, const char* axis) {
    if (std::abs(c.change) < std::max(floor, c.limit(alarms))) return;
    const std::string cause = gain_or_mass(now, earlier, c.change);
    const double share = cause == "mass" ? std::expm1(c.change) : std::expm1(-c.change);
    found.push_back({{cause, axis, std::exp(c.before), std::exp(c.now), share, c.uncertain()},
                     std::abs(c.change) / std::max(1e-9, c.scatter)});
  };
  judge(compare(now, earlier, mean_log_mass, mean_mass_error), k_mean_alarms, "");
  if (!found.empty()) return;  // the mean says it all
  for (std::size_t i = 0; i < 3; ++i)
    judge(compare(
              now, earlier, [i](const ArmFigures& f) { return log_mass(f.axes[i]); },
              [i](const ArmFigures& f) { return f.axes[i].mass_error; }),
          k_axis_alarms, k_axes[i]);
}

/// `gain`: by which the friction commanded must be multiplied to be that of the joints.
void add_friction(std::vector<Found>& found, const ArmFigures& now,
                  std::span<const ArmFigures> earlier, double gain) {
  const auto judge = [&](Comparison c, double alarms, const char* axis) {
    c.now *= gain;
    c.change = c.now - c.before;
    if (std::abs(c.change) < std::max(k_min_friction_n, c.limit(alarms))) return false;
    found.push_back({{"friction", axis, c.before, c.now, c.change, c.uncertain()},
                     std::abs(c.change) / std::max(1e-9, c.scatter)});
    return true;
  };
  if (judge(compare(
                now, earlier, [](const ArmFigures& f) { return f.friction_n(); },
                mean_friction_error),
            k_mean_alarms, ""))
    return;
  for (std::size_t i = 0; i < 3; ++i)
    judge(compare(
              now, earlier, [i](const ArmFigures& f) { return f.axes[i].friction_n; },
              [i](const ArmFigures& f) { return f.axes[i].friction_error_n; }),
          k_axis_alarms, k_axes[i]);
}

void add_share(std::vector<Found>& found, const ArmFigures& now,
               std::span<const ArmFigures> earlier, const Quantity& of, const char* name,
               double alarms, double least) {
  const Comparison c = compare(now, earlier, of);
  if (!(c.before > 0.0) || std::abs(c.change) < std::max(least * c.before, c.limit(alarms))) return;
  found.push_back({{name, "", c.before, c.now, c.change / c.before, c.uncertain() / c.before},
                   std::abs(c.change) / std::max(1e-9 * c.before, c.scatter)});
}

Message words_of(const CheckChange& c) {
  const Number share{100 * c.change, Unit::percent, 0, 100 * c.uncertain, true};
  const auto of = [&](const Message& mean, const Message& along) {
    return c.axis.empty() ? mean : along;
  };
  if (c.quantity == "friction") {
    const Number change{c.change, Unit::newton, 2, c.uncertain, true};
    return of(
        msg("friction is {} from what it was ({}): clean and oil the joints, look for a cable that rubs",
            change, as_n(c.before)),
        msg("friction along {} is {} from what it was ({}): clean and oil the joints, look for a cable that rubs",
            c.axis, change, as_n(c.before)));
  }
  if (c.quantity == "gain")
    return of(
        msg("force given is {} from what it was: look at power supply, plugs and cable tension",
            share),
        msg("force given along {} is {} from what it was: look at power supply, plugs and cable tension",
            c.axis, share));
  if (c.quantity == "mass")
    return of(
        msg("moved mass is {} from what it was: something was put on the stylus, or taken off",
            share),
        msg("moved mass along {} is {} from what it was: something was put on the stylus, or taken off",
            c.axis, share));
  if (c.quantity == "gain or mass")
    return msg(
        "force given for a moved mass is {} from what it was; whether the motors changed or the mass, these figures do not tell: look whether "
        "something was put on the stylus, then at power supply, plugs and cable tension",
        share);
  const Number from{100 * c.change, Unit::percent, 0, 0, true};
  if (c.quantity == "step")
    return msg(
        "the step of its places is {} from what it was ({}): an encoder or its driver's setting changed",
        from, as_mm(c.before, 4));
  return msg(
      "its rate is {} from what it was ({}): look at what else the computer does, and at the USB port",
      from, as_unit(c.before, Unit::hz, 0));
}

}  // namespace

const char* outcome_name(CheckOutcome outcome) noexcept {
  return k_outcomes[static_cast<std::size_t>(outcome)];
}

Message word_of(CheckOutcome outcome) {
  switch (outcome) {
    case CheckOutcome::learning:
      return msg("learning");
    case CheckOutcome::unchanged:
      return msg("unchanged");
    case CheckOutcome::changed:
      return msg("changed");
    case CheckOutcome::doubtful:
      break;
  }
  return msg("doubtful");
}

CheckVerdict judge_check(const ArmFigures& now, std::span<const ArmFigures> earlier) {
  CheckVerdict v;
  const auto compared = earlier.first(std::min(earlier.size(), k_checks_compared));
  v.compared = compared.size();
  const bool learnt = compared.size() >= k_checks_to_learn;
  std::vector<Found> found;
  const auto conclude = [&](CheckOutcome otherwise) {
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& a, const Found& b) { return a.sigmas > b.sigmas; });
    for (Found& f : found) v.changes.push_back(std::move(f.change));
    v.outcome = v.changes.empty() ? otherwise : CheckOutcome::changed;
    return v;
  };
  if (!now.doubt.empty()) {
    v.doubt = now.doubt;
    if (now.dragged && learnt)
      add_friction(found, now, compared, 1.0);  // so stiff that it does not swing
    return conclude(CheckOutcome::doubtful);
  }
  if (!learnt) return v;
  const Comparison friction = compare(
      now, compared, [](const ArmFigures& f) { return f.friction_n(); }, mean_friction_error);
  const Comparison mass = compare(now, compared, mean_log_mass, mean_mass_error);
  v.finds_friction_n = std::max(k_min_friction_n, friction.found_from(k_mean_alarms));
  v.finds_gain = -std::expm1(-std::max(k_min_gain, mass.found_from(k_mean_alarms)));
  add_gain(found, now, compared, friction.change);
  const bool gain_fell =
      !found.empty() && found[0].change.quantity != "mass" && found[0].change.axis.empty();
  add_friction(found, now, compared, gain_fell ? 1.0 + found[0].change.change : 1.0);
  add_share(
      found, now, compared, [](const ArmFigures& f) { return f.quantum_mm; }, "step", k_step_alarms,
      k_min_step);
  add_share(
      found, now, compared, [](const ArmFigures& f) { return f.rate_hz; }, "rate", k_rate_alarms,
      k_min_rate);
  return conclude(CheckOutcome::unchanged);
}

Message in_words(const CheckVerdict& v) {
  switch (v.outcome) {
    case CheckOutcome::doubtful:
      return msg("the check says nothing: {}", v.doubt);
    case CheckOutcome::learning:
      return msg("{} of {} checks that it learns from are there; nothing is claimed yet",
                 v.compared, k_checks_to_learn);
    case CheckOutcome::unchanged:
      return msg(
          "as in its {} earlier checks; a change is found in 95 % from {} of friction and {} of force on",
          v.compared, as_n(v.finds_friction_n), as_percent(100.0 * v.finds_gain));
    case CheckOutcome::changed:
      break;
  }
  List changes{{}, true};
  for (const CheckChange& c : v.changes) changes.items.push_back(words_of(c));
  return v.doubt.empty() ? msg("{}", changes)
                         : msg("{}; of the rest it says nothing: {}", changes, v.doubt);
}

}  // namespace cavum
