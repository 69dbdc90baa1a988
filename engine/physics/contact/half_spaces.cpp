#include "engine/physics/contact/half_spaces.h"

#include <algorithm>
#include <cmath>

#include "engine/physics/contact/tuning.h"

namespace cavum {

using namespace tuning;

namespace {

double violation(const HalfSpace& h, Vec3 s) noexcept { return -h.slack_mm - dot(h.normal, s); }

/// Nearest point to `wanted` on the planes of 1 to 3 half spaces; false when they have no corner or
/// a plane would pull.
bool on_planes(Vec3 wanted, const HalfSpace* const* set, int n, Vec3& step) noexcept {
  double l[3] = {0, 0, 0};
  const Vec3 a = set[0]->normal;
  const double va = violation(*set[0], wanted);
  if (n == 1) {
    const double d = dot(a, a);
    if (d < 1e-6) return false;
    l[0] = va / d;
  } else if (n == 2) {
    const Vec3 b = set[1]->normal, edge = cross(a, b);
    const double edge2 = dot(edge, edge);
    if (edge2 < k_parallel_rad * k_parallel_rad * dot(a, a) * dot(b, b)) return false;
    const double vb = violation(*set[1], wanted);
    const Vec3 way = (cross(b, edge) * va + cross(edge, a) * vb) / edge2;
    l[0] = dot(way, cross(b, edge)) / edge2;
    l[1] = dot(way, cross(edge, a)) / edge2;
  } else {
    const Vec3 b = set[1]->normal, c = set[2]->normal, bc = cross(b, c), ca = cross(c, a),
               ab = cross(a, b);
    const double volume = dot(a, bc),
                 least =
                     k_parallel_rad * std::sqrt(std::max({dot(ab, ab), dot(bc, bc), dot(ca, ca)}));
    if (std::fabs(volume) < least) return false;
    const Vec3 way =
        (bc * va + ca * violation(*set[1], wanted) + ab * violation(*set[2], wanted)) / volume;
    l[0] = dot(way, bc) / volume;
    l[1] = dot(way, ca) / volume;
    l[2] = dot(way, ab) / volume;
  }
  step = wanted;
  for (int i = 0; i < n; ++i) {
    if (l[i] < k_multiplier_tolerance) return false;
    step += set[i]->normal * l[i];
  }
  return true;
}

}  // namespace

HalfSpaceSolution nearest_step(Vec3 wanted, std::span<const HalfSpace> half_spaces,
                               const ActiveSet& guess) noexcept {
  const HalfSpace* active[3] = {};
  int n_active = 0;
  Vec3 step = wanted;
  if (guess.count > 0) {
    for (int i = 0; i < guess.count; ++i)
      active[i] = &half_spaces[static_cast<std::size_t>(guess.at[i])];
    if (on_planes(wanted, active, guess.count, step))
      n_active = guess.count;
    else
      step = wanted;
  }
  const auto solved = [&](bool feasible) {
    HalfSpaceSolution solution{step, feasible, {n_active, {}}};
    for (int i = 0; i < n_active; ++i)
      solution.active.at[i] = static_cast<int>(active[i] - half_spaces.data());
    return solution;
  };
  for (int round = 0; round < 64; ++round) {
    const HalfSpace* worst = nullptr;
    double worst_mm = k_enters_mm;
    for (const auto& h : half_spaces) {
      const double v = violation(h, step);
      if (v > worst_mm) {
        worst_mm = v;
        worst = &h;
      }
    }
    if (worst == nullptr) return solved(true);
    // The new basis holds the entering half space and a subset of the old ones: the first that
    // satisfies all four.
    const HalfSpace* best[3] = {};
    int n_best = 0;
    Vec3 best_step;
    const auto consider = [&](const HalfSpace* a, const HalfSpace* b) {
      if (n_best != 0) return;
      const HalfSpace* set[3] = {worst, a, b};
      const int n = 1 + (a != nullptr) + (b != nullptr);
      Vec3 s;
      if (!on_planes(wanted, set, n, s)) return;
      for (int i = 0; i < n_active; ++i)
        if (violation(*active[i], s) > k_holds_mm) return;
      for (int i = 0; i < n; ++i) best[i] = set[i];
      n_best = n;
      best_step = s;
    };
    consider(nullptr, nullptr);
    for (int i = 0; i < n_active; ++i) consider(active[i], nullptr);
    for (int i = 0; i < n_active; ++i)
      for (int j = i + 1; j < n_active; ++j) consider(active[i], active[j]);
    if (n_best == 0) return solved(false);
    for (int i = 0; i < n_best; ++i) active[i] = best[i];
    n_active = n_best;
    step = best_step;
  }
  return solved(false);
}

}  // namespace cavum
