#include "engine/lab/explain/recording/specimens.h"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "engine/base/text.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_min_sessions = 8;
constexpr double k_scatter = 0.2;
constexpr double k_onset = 0.02;  // of the peak force

constexpr double k_follows =
    0.5;  // correlation of force and depth below the surface: less is no pressing

struct Specimen {
  double surface_mm = 0, depth_mm = 0, peak_n = 0;
};

/// Correlation of the force with the depth below the surface.
double correlation(const Recording& r, const SessionRows& s, double surface_mm) {
  const Series depth = (r.x_mm.segment(s.begin, s.end - s.begin) - surface_mm).max(0.0),
               force = r.f_n.segment(s.begin, s.end - s.begin);
  const Series a = depth - depth.mean(), b = force - force.mean();
  return (a * b).sum() / std::sqrt(std::max(1e-300, a.square().sum() * b.square().sum()));
}

Specimen specimen_of(const Recording& r, const SessionRows& s) {
  Eigen::Index top = 0;
  Specimen out;
  out.peak_n = r.f_n.segment(s.begin, s.end - s.begin).maxCoeff(&top);
  // scatter of the force before it rises: differences of neighbours in its first tenth
  const Eigen::Index early = std::max<Eigen::Index>(2, top / 4);
  double square = 0.0;
  for (Eigen::Index i = 1; i < early; ++i)
    square += std::pow(r.f_n[s.begin + i] - r.f_n[s.begin + i - 1], 2);
  const double noise = std::sqrt(0.5 * square / static_cast<double>(early - 1));
  const double threshold = std::max(k_onset * out.peak_n, 3.0 * noise);
  Eigen::Index onset = s.begin + top;
  while (onset > s.begin && r.f_n[onset - 1] > threshold) --onset;
  out.surface_mm = r.x_mm[onset];
  out.depth_mm = r.x_mm.segment(s.begin, s.end - s.begin).maxCoeff() - out.surface_mm;
  return out;
}

}  // namespace

bool are_specimens(const Recording& r) {
  if (r.sessions.size() < k_min_sessions || r.rig.k_n_per_mm) return false;
  double sum = 0.0, square = 0.0, follows = 0.0;
  for (const auto& s : r.sessions) {
    const Specimen p = specimen_of(r, s);
    if (!(p.depth_mm > 0.0) || !(p.peak_n > 0.0)) return false;
    follows += correlation(r, s, p.surface_mm);
    const double k = p.peak_n / p.depth_mm;
    sum += k;
    square += k * k;
  }
  const double n = static_cast<double>(r.sessions.size()), mean = sum / n;
  return follows > k_follows * n &&
         std::sqrt(std::max(0.0, square / n - mean * mean)) > k_scatter * mean;
}

Recording on_common_scale(const Recording& r) {
  Recording out = r;
  double depth = 0.0, peak = 0.0;
  std::vector<Specimen> specimens;
  for (const auto& s : r.sessions) {
    specimens.push_back(specimen_of(r, s));
    depth += specimens.back().depth_mm / static_cast<double>(r.sessions.size());
    peak += specimens.back().peak_n / static_cast<double>(r.sessions.size());
  }
  for (std::size_t i = 0; i < specimens.size(); ++i) {
    const auto& s = r.sessions[i];
    const Eigen::Index n = s.end - s.begin;
    const double along = depth / specimens[i].depth_mm, force = peak / specimens[i].peak_n;
    out.x_mm.segment(s.begin, n) = (r.x_mm.segment(s.begin, n) - specimens[i].surface_mm) * along;
    out.f_n.segment(s.begin, n) *= force;
    if (r.v_mm_s.size() > 0) out.v_mm_s.segment(s.begin, n) *= along;
  }
  out.specimens = true;
  out.rig.position_quantum_mm =
      0.0;  // no longer one step for all; it was fine enough to be found again if it matters
  out.rig.force_quantum_n = 0.0;
  out.rig.force_limit_n.reset();
  out.notes.emplace_back(
      "specimens", std::vector{"sessions", "depth", "peak"},
      msg("{} sessions differ in stiffness as different specimens do: each counts from its own surface, at the mean depth of {} and the mean peak of "
          "{}; k, c and forces are on that scale",
          r.sessions.size(), as_mm(depth, 3), as_n(peak, 3)));
  return out;
}

}  // namespace cavum::explain
