#include "engine/lab/explain/model/curves.h"

#include <algorithm>
#include <set>

#include "engine/base/order.h"

namespace cavum::explain {
namespace {

constexpr int k_knots = 6;  // of a curve
constexpr double k_lags_s[] = {0.1, 0.3, 1.0, 3.0};
constexpr Eigen::Index k_steps_most = 36;  // instants at which a step is tried, in all

/// Piecewise linear curves over quantiles of u, the mean over `where` taken out, times `where`.
/// Empty when u is constant.
std::vector<Series> over_quantiles(const Series& u, const Series& where) {
  std::vector<double> sorted;
  const Eigen::Index stride = std::max<Eigen::Index>(1, u.size() / 5000);
  for (Eigen::Index i = 0; i < u.size(); i += stride)
    if (where[i] > 0.0) sorted.push_back(u[i]);
  if (sorted.size() < 50) return {};
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> knots;
  for (int k = 0; k < k_knots; ++k) {
    const double q = quantile_of_sorted(sorted, static_cast<double>(k) / (k_knots - 1));
    if (knots.empty() || q > knots.back() + 1e-9 * (sorted.back() - sorted.front()))
      knots.push_back(q);
  }
  if (std::vector<double> few = sorted;
      few.erase(std::unique(few.begin(), few.end()), few.end()), few.size() <= k_knots)
    knots.assign(few.begin(), few.end());
  if (knots.size() < 2) return {};
  std::vector<Series> out(knots.size() - 1, Series::Zero(u.size()));
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    if (where[i] == 0.0) continue;
    const double x = std::clamp(u[i], knots.front(), knots.back());
    const auto at = static_cast<std::size_t>(
        std::upper_bound(knots.begin() + 1, knots.end() - 1, x) - knots.begin() - 1);
    const double part = (x - knots[at]) / (knots[at + 1] - knots[at]);
    if (at > 0) out[at - 1][i] = 1.0 - part;
    out[at][i] = part;
  }
  const double weight = where.sum();
  for (auto& column : out) column = (column - (column * where).sum() / weight) * where;
  return out;
}

Series lagged_by(const Recording& r, const Series& u, double lag_s) {
  Series out(u.size());
  for (const auto& rows : r.sessions) {
    Eigen::Index j = rows.begin;
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      while (j + 1 < i && r.t_s[j + 1] <= r.t_s[i] - lag_s) ++j;
      out[i] = u[j];
    }
  }
  return out;
}

class Curves {
 public:
  Curves(const Scene& scene, const std::function<void(Curve)>& take) : scene_(scene), take_(take) {}

  void over(const std::string& variable, const Series& u, bool with_force) {
    add(variable, msg("a curve, in air too"), over_quantiles(u, Series::Ones(u.size())));
    add(variable, msg("a curve while in contact"), over_quantiles(u, scene_.active));
    if (with_force)
      add(variable, msg("a curve in proportion to the force"), over_quantiles(u, scene_.force_n));
  }
  void later(const std::string& variable, const Series& u) {
    for (const double lag : k_lags_s)
      add(variable, msg("in proportion, {} later", as_s(lag, 1)),
          {lagged_by(*scene_.recording, u, lag)});
  }
  /// A step that stays to the end of its session, or of the recording.
  void steps() {
    const Recording& r = *scene_.recording;
    const auto sessions = static_cast<Eigen::Index>(r.sessions.size());
    const Eigen::Index in_each = std::clamp<Eigen::Index>(k_steps_most / sessions, 1, 8);
    if (sessions > k_steps_most) return;
    for (const auto& s : r.sessions)
      for (Eigen::Index i = 1; i <= in_each; ++i) {
        const Eigen::Index at = s.begin + (s.end - s.begin) * i / (in_each + 1);
        for (const bool whole : {true, false}) {
          if (whole && s.end == r.rows()) continue;
          Series step = Series::Zero(r.rows());
          step.segment(at, (whole ? r.rows() : s.end) - at) = 1.0;
          add("t_s",
              whole ? msg("a step at about {} of session {}", as_s(r.t_s[at], 1), s.name)
                    : msg("a step at about {} of session {}, until its end", as_s(r.t_s[at], 1),
                          s.name),
              {std::move(step)});
        }
      }
  }

 private:
  void add(const std::string& variable, Message form, std::vector<Series> columns) {
    if (!columns.empty()) take_({variable, std::move(form), std::move(columns)});
  }
  const Scene& scene_;
  const std::function<void(Curve)>& take_;
};

}  // namespace

void each_curve(const Scene& s, const std::function<void(Curve)>& take) {
  const Recording& r = *s.recording;
  Curves curves(s, take);
  curves.over("t_s", r.t_s, false);
  curves.steps();
  curves.over("x_mm", s.motion->x_mm, false);
  curves.over("v_mm_s", s.motion->v_mm_s, false);
  for (const auto& [name, u] : r.columns) {
    if (!(u.maxCoeff() > u.minCoeff())) continue;
    curves.over(name, u, true);
    if (std::set<double> few(u.data(), u.data() + std::min<Eigen::Index>(u.size(), 2000));
        few.size() > 20)
      curves.later(name, u);
  }
}

}  // namespace cavum::explain
