#include "engine/contact/half_spaces.h"

#include <cmath>

namespace cavum {
namespace {

constexpr double k_tolerance_mm = 1e-9;
constexpr double k_multiplier_tolerance = -1e-9;

double violation(const HalfSpace& h, Vec3 s) noexcept { return -h.slack_mm - dot(h.normal, s); }

/// Nearest point to `wanted` on the planes of 1 to 3 half spaces; false when singular or a plane would pull.
bool on_planes(Vec3 wanted, const HalfSpace* const* set, int n, Vec3& step) noexcept {
  double b[3];
  for (int i = 0; i < n; ++i) b[i] = violation(*set[i], wanted);
  double l[3] = {0, 0, 0};
  const auto g = [&](int i, int j) { return dot(set[i]->normal, set[j]->normal); };
  if (n == 1) {
    const double d = g(0, 0);
    if (d < 1e-6) return false;
    l[0] = b[0] / d;
  } else if (n == 2) {
    const double a = g(0, 0), c = g(0, 1), d = g(1, 1), det = a * d - c * c;
    if (det < 1e-7 * a * d) return false;
    l[0] = (b[0] * d - b[1] * c) / det;
    l[1] = (b[1] * a - b[0] * c) / det;
  } else {
    const double a = g(0, 0), e = g(0, 1), f = g(0, 2), d = g(1, 1), h = g(1, 2), k = g(2, 2);
    const double c0 = d * k - h * h, c1 = f * h - e * k, c2 = e * h - d * f;
    const double det = a * c0 + e * c1 + f * c2;
    if (det < 1e-9 * a * d * k) return false;
    l[0] = (c0 * b[0] + c1 * b[1] + c2 * b[2]) / det;
    l[1] = (c1 * b[0] + (a * k - f * f) * b[1] + (e * f - a * h) * b[2]) / det;
    l[2] = (c2 * b[0] + (e * f - a * h) * b[1] + (a * d - e * e) * b[2]) / det;
  }
  step = wanted;
  for (int i = 0; i < n; ++i) {
    if (l[i] < k_multiplier_tolerance) return false;
    step += set[i]->normal * l[i];
  }
  return true;
}

}  // namespace

HalfSpaceSolution nearest_step(Vec3 wanted, std::span<const HalfSpace> half_spaces, const ActiveSet& guess) noexcept {
  const HalfSpace* active[3] = {};
  int n_active = 0;
  Vec3 step = wanted;
  if (guess.count > 0) {
    for (int i = 0; i < guess.count; ++i) active[i] = &half_spaces[static_cast<std::size_t>(guess.at[i])];
    if (on_planes(wanted, active, guess.count, step))
      n_active = guess.count;
    else
      step = wanted;
  }
  const auto solved = [&](bool feasible) {
    HalfSpaceSolution solution{step, feasible, {n_active, {}}};
    for (int i = 0; i < n_active; ++i) solution.active.at[i] = static_cast<int>(active[i] - half_spaces.data());
    return solution;
  };
  for (int round = 0; round < 64; ++round) {
    const HalfSpace* worst = nullptr;
    double worst_mm = k_tolerance_mm;
    for (const auto& h : half_spaces) {
      const double v = violation(h, step);
      if (v > worst_mm) {
        worst_mm = v;
        worst = &h;
      }
    }
    if (worst == nullptr) return solved(true);
    // The new basis holds the entering half space and a subset of the old ones: the first that satisfies all four.
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
        if (violation(*active[i], s) > 10 * k_tolerance_mm) return;
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
