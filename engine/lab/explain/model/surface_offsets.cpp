#include "engine/lab/explain/model/surface_offsets.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "engine/lab/explain/model/mechanism.h"

namespace cavum::explain {
namespace {

constexpr Eigen::Index k_min_rows = 20;  // in air, and in contact
constexpr double k_none_mm =
    1e-9;  // an offset that is fitted, and not 0: a shape of 0 is one that is not there
constexpr double k_offset_ridge = 1e-6;     // of a column's own norm
constexpr Eigen::Index k_looked_at = 2000;  // rows of a session that an estimate is made from
// Offsets are looked for in steps, this far to both sides of those before; in between they move
// together with k and c.
constexpr std::array k_steps_mm{0.005, 0.0005, 0.0005, 0.0005},
    k_reach_mm{k_farthest_surface_mm, 0.015, 0.01, 0.005};

bool crosses_the_surface(const Scene& s, const SessionRows& rows) {
  const auto x = s.motion->x_mm.segment(rows.begin, rows.end - rows.begin);
  return (x < 0.0).count() >= k_min_rows &&
         (s.active.segment(rows.begin, rows.end - rows.begin) > 0.5).count() >= k_min_rows;
}

/// The estimate as it grows.
struct Estimate {
  const Scene& scene;
  std::vector<SessionRows> groups;  ///< of those that cross the surface
  std::vector<std::size_t> index;   ///< of each in all
  std::vector<double> delta_mm;
  Base base;

  [[nodiscard]] double measured_n(Eigen::Index i) const {
    return scene.left_n[i] + scene.base.k_n_per_mm * scene.spring_mm[i] +
           scene.base.c_n_s_per_mm * scene.damper_mm_s[i];
  }
  template <class Visit>
  void each_row(const SessionRows& rows, const Visit& visit) const {
    const Eigen::Index step = std::max<Eigen::Index>(1, (rows.end - rows.begin) / k_looked_at);
    for (Eigen::Index i = rows.begin; i < rows.end; i += step) visit(i);
  }
  /// Sum of what an offset leaves, not of its square: one row that is wrong must not outweigh the
  /// others.
  [[nodiscard]] double misfit(std::size_t g, double delta) const {
    double sum = 0.0;
    each_row(groups[g], [&](Eigen::Index i) {
      const PressedRow p = pressed_at(scene, i, delta, base);
      sum += scene.weight[i] * std::fabs(measured_n(i) - base.k_n_per_mm * p.spring_mm -
                                         base.c_n_s_per_mm * p.damper_mm_s);
    });
    return sum;
  }
  /// Each offset by itself. Every row that a wrong surface puts into contact, or takes out of it,
  /// is a step of c V: many narrow valleys, and all of them are looked into.
  void scan(double step, double reach) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const double middle = delta_mm[g];
      double best = middle, least = misfit(g, middle);
      for (double d = std::max(-k_farthest_surface_mm, middle - reach);
           d <= std::min(k_farthest_surface_mm, middle + reach); d += step)
        if (const double m = misfit(g, d); m < least) least = m, best = d;
      delta_mm[g] = best;
    }
  }
  /// All offsets, k and c at once, with contact as it is: k (X + delta) + c V is linear in k, c and
  /// k delta. At one speed c V is an offset as well: what cannot be told apart stays as it was.
  void solve() {
    const auto n = static_cast<Eigen::Index>(groups.size()) + 2;
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto own = static_cast<Eigen::Index>(g) + 2;
      each_row(groups[g], [&](Eigen::Index i) {
        const PressedRow p = pressed_at(scene, i, delta_mm[g], base);
        const Eigen::Vector3d row{p.spring_mm - delta_mm[g] * p.touching, p.damper_mm_s,
                                  p.touching};
        const double left =
            measured_n(i) - base.k_n_per_mm * p.spring_mm - base.c_n_s_per_mm * p.damper_mm_s;
        const Eigen::Index at[] = {0, 1, own};
        for (int u = 0; u < 3; ++u) {
          b[at[u]] += scene.weight[i] * row[u] * left;
          for (int v = 0; v < 3; ++v) a(at[u], at[v]) += scene.weight[i] * row[u] * row[v];
        }
      });
    }
    a.diagonal() *= 1.0 + k_offset_ridge;
    const Eigen::VectorXd by = Eigen::LDLT<Eigen::MatrixXd>(a).solve(b);
    const Base next{base.k_n_per_mm + by[0], std::max(0.0, base.c_n_s_per_mm + by[1])};
    if (!by.allFinite() || next.k_n_per_mm <= 0.0) return;
    for (std::size_t g = 0; g < groups.size(); ++g)
      delta_mm[g] = std::clamp(
          (base.k_n_per_mm * delta_mm[g] + by[static_cast<Eigen::Index>(g) + 2]) / next.k_n_per_mm,
          -k_farthest_surface_mm, k_farthest_surface_mm);
    base = next;
  }
};

}  // namespace

PressedRow pressed_at(const Scene& s, Eigen::Index i, double delta_mm, Base base) {
  const double rk = relative_at(s.recording->relative_k, i), x = s.motion->x_mm[i] + delta_mm;
  const double spring = rk * x,
               damper = s.motion->v_mm_s[i] * relative_at(s.recording->relative_c, i);
  if (base.k_n_per_mm > 0.0 && base.k_n_per_mm * spring + base.c_n_s_per_mm * damper <= 0.0)
    return {};
  const double touching = touching_probability(x, s.motion->sd_x_mm[i]);
  return {touching * spring, touching * damper, touching * rk};
}

std::vector<SessionRows> rows_of_one_surface(const Recording& r) {
  if (session_groups(r) > 1) return r.sessions;
  return {{"all", 0, r.rows()}};
}

std::vector<std::vector<double>> surface_offsets_mm(const Scene& s) {
  const std::vector<SessionRows> all = rows_of_one_surface(*s.recording);
  Estimate e{s, {}, {}, {}, s.base};
  for (std::size_t g = 0; g < all.size(); ++g)
    if (crosses_the_surface(s, all[g])) e.groups.push_back(all[g]), e.index.push_back(g);
  e.delta_mm.assign(e.groups.size(), 0.0);
  std::vector<std::vector<double>> found;
  for (std::size_t round = 0; round < k_steps_mm.size() && !e.groups.empty(); ++round) {
    if (round > 0) e.solve();
    e.scan(k_steps_mm[round], k_reach_mm[round]);
    found.emplace_back(all.size(), 0.0);
    for (std::size_t g = 0; g < e.groups.size(); ++g)
      found.back()[e.index[g]] = e.delta_mm[g] != 0.0 ? e.delta_mm[g] : k_none_mm;
  }
  return found;
}

}  // namespace cavum::explain
