#include "engine/explain/inference/twin.h"

#include <cmath>
#include <numbers>

#include "engine/base/random.h"
#include "engine/explain/recording/holds.h"

namespace cavum::explain {
namespace {

/// A smooth random function of the way travelled, standard deviation 1, waves of 0.7 to 6 mm: slow against the motion, so
/// that the speed changes by a few percent at most, and new at every hold that is reached anew.
class Wander {
 public:
  explicit Wander(Random& random) {
    for (auto& w : waves_) w = {2 * std::numbers::pi / (0.7 * std::exp(random.uniform(0.0, 2.15))), random.uniform(0.0, 2 * std::numbers::pi)};
  }
  [[nodiscard]] double at(double way_mm) const {
    double sum = 0.0;
    for (const auto& w : waves_) sum += std::sin(w.per_mm * way_mm + w.phase);
    return sum * std::sqrt(2.0 / k_waves);
  }

 private:
  static constexpr int k_waves = 6;
  struct Wave {
    double per_mm = 0, phase = 0;
  } waves_[k_waves];
};

double quantised(double v, double q) { return q > 0.0 ? q * std::round(v / q) : v; }

/// A motion that the encoder would have reported as it did: wandering within its step, or holds drawn anew.
Motion drawn_motion(const Recording& r, const Motion& m, Random& random) {
  Motion out = m;
  const double q = m.quantum_mm > 1e-5 ? m.quantum_mm : 0.0;
  const Holds holds = q > 0.0 ? find_holds(r, q) : Holds{};
  if (holds.repeat()) out.x_mm = replaced_holds(r, m.x_mm, holds, q, random);
  for (const auto& s : r.sessions) {
    const Wander wander(random);
    const double amplitude = q / std::sqrt(12.0);
    double way = 0.0, off = amplitude * wander.at(0.0);
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      if (q <= 0.0 || holds.repeat()) break;
      if (const double step = i > s.begin ? std::fabs(m.x_mm[i] - m.x_mm[i - 1]) : 0.0; step > 1e-7) off = amplitude * wander.at(way += step);
      out.x_mm[i] = m.x_mm[i] + off;
    }
    if (q > 0.0)
      for (Eigen::Index i = s.begin; i < s.end; ++i) {
        const Eigen::Index a = std::max(s.begin, i - 1), b = std::min(s.end - 1, i + 1);
        if (b > a) out.v_mm_s[i] = m.v_mm_s[i] + ((out.x_mm[b] - m.x_mm[b]) - (out.x_mm[a] - m.x_mm[a])) / (r.t_s[b] - r.t_s[a]);
      }
  }
  out.sd_x_mm.setZero();
  out.sd_v_mm_s.setZero();
  return out;
}

/// Innovations of the noise as they were, where the model is certain; centred, for an offset in the residual is an effect to be found and not noise.
struct Innovations {
  std::vector<double> steps;
  double scale = 0.0;  ///< to the noise's own
};

Innovations innovations_of(const View& v) {
  Innovations out;
  for (const auto& s : v.scene.recording->sessions)
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i)
      if (v.scene.weight[i] > 0.5 && v.scene.weight[i - 1] > 0.5) out.steps.push_back(v.residual_n[i] - v.noise.rho * v.residual_n[i - 1]);
  double mean = 0.0, square = 0.0;
  for (const double u : out.steps) mean += u / static_cast<double>(out.steps.size());
  for (double& u : out.steps) {
    u -= mean;
    square += u * u;
  }
  if (!out.steps.empty()) out.scale = v.noise.step_sd_n / std::max(1e-300, std::sqrt(square / static_cast<double>(out.steps.size())));
  return out;
}

}  // namespace

Recording make_twin(const View& v, std::uint64_t seed) {
  const Recording& r = *v.scene.recording;
  const Motion& m = v.sharp.x_mm.size() > 0 ? v.sharp : v.scene.motion;
  const double q = m.quantum_mm > 1e-5 ? m.quantum_mm : 0.0;
  Random random(seed);
  const Motion true_motion = drawn_motion(r, m, random);
  Scene truth = make_scene(r, true_motion, v.scene.base, v.noise.sd_n, v.noise.rho);
  truth.lines_hz = v.scene.lines_hz;
  Recording twin = r;
  // in one direction an offset hides in c: that c is not the rig's is then all that shows it, and twins, which have no offset, agree with their rig
  if (moves_one_way(m)) {
    if (r.rig.k_n_per_mm) twin.rig.k_n_per_mm = std::max(1e-9, v.base_fit.value[0]);
    if (r.rig.c_n_s_per_mm) twin.rig.c_n_s_per_mm = std::max(1e-9, v.base_fit.value[1]);
  }
  twin.f_n = force_of(truth, v.causes, v.base_fit.value) + (r.f_n - v.force_n);

  const Innovations noise = innovations_of(v);
  const auto draw = [&] {
    return noise.steps.empty() ? v.noise.step_sd_n * random.normal() : noise.scale * noise.steps[random.below(noise.steps.size())];
  };
  const double limit = r.rig.force_limit_n.value_or(1e300);
  for (const auto& s : r.sessions) {
    double e = v.noise.sd_n * random.normal();
    for (Eigen::Index i = s.begin; i < s.end; ++i) {
      e = v.noise.rho * e + draw();
      twin.f_n[i] = std::min(limit, quantised(twin.f_n[i] + e, r.rig.force_quantum_n));
      if (q > 0.0) twin.x_mm[i] = quantised(true_motion.x_mm[i], q);
      if (r.v_mm_s.size() > 0) twin.v_mm_s[i] = true_motion.v_mm_s[i] + m.speed_sd_mm_s * random.normal();
    }
  }
  return twin;
}

}  // namespace cavum::explain
