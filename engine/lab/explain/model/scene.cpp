#include "engine/lab/explain/model/scene.h"

#include <cmath>

#include "engine/base/statistics.h"
#include "engine/lab/explain/recording/as_recorded.h"
#include "engine/physics/force/voigt.h"

namespace cavum::explain {
namespace {

constexpr double k_summed_most = 400.0;

}  // namespace

// away from the surface this is 0 or 1; the width of 1e-5 mm stands for positions without error
double touching_probability(double x_mm, double sd_mm) noexcept {
  return normal_cdf(x_mm / (sd_mm + 1e-5));
}

void never_pull(Scene& s, const Series* pressed_n) {
  s.active =
      pressed_n == nullptr ? s.touching : Series(s.touching * (*pressed_n > 0.0).cast<double>());
  s.spring_mm = s.motion->x_mm * s.active;
  s.damper_mm_s = s.motion->v_mm_s * s.active;
  if (s.recording->relative_k.size() > 0) s.spring_mm *= s.recording->relative_k;
  if (s.recording->relative_c.size() > 0) s.damper_mm_s *= s.recording->relative_c;
}

Scene make_scene(const Recording& recording, const Shared<Motion>& motion, Base base,
                 double noise_sd_n, double rho, const Series* pressed_n,
                 const Series* uncertain_n2) {
  Scene s;
  s.recording = &recording;
  s.motion = motion;
  s.base = base;
  s.dt_s = intervals_s(recording);
  const Eigen::Index n = recording.rows();
  for (Series* a :
       {&s.touching, &s.active, &s.spring_mm, &s.damper_mm_s, &s.force_n, &s.spinning, &s.weight})
    *a = Series::Zero(n);
  // noise of correlation rho, summed over many rows, is that of independent rows times (1 + rho)/(1
  // - rho)
  const double summed = std::clamp((1.0 + rho) / std::max(1e-3, 1.0 - rho), 1.0, k_summed_most);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double lasting = motion->lasting_rows.size() > 0 ? motion->lasting_rows[i] : 1.0;
    const double noise2 = noise_sd_n * noise_sd_n * std::min(summed, lasting) / lasting;
    const double rk = relative_at(recording.relative_k, i),
                 rc = relative_at(recording.relative_c, i);
    const double k = rk * base.k_n_per_mm, c = rc * base.c_n_s_per_mm;
    const double x = motion->x_mm[i], v = motion->v_mm_s[i], sx = motion->sd_x_mm[i],
                 sv = motion->sd_v_mm_s[i];
    const double p = touching_probability(x, sx);
    s.touching[i] = p;
    const double pressed = pressed_n != nullptr ? (*pressed_n)[i] : k * x + c * v;
    const double slope = std::hypot(k * sx, c * sv);
    const double on = base.k_n_per_mm <= 0.0 || pressed > 0.0 ? 1.0 : 0.0;
    s.active[i] = p * on;
    s.spring_mm[i] = rk * x * s.active[i];
    s.damper_mm_s[i] = rc * v * s.active[i];
    s.force_n[i] = p * voigt_force_n({k, c}, std::max(x, 1e-300), v);
    // error of the base force: through X and V while in contact, and the step by c V where contact
    // itself is in doubt
    const double jump2 = p * (1.0 - p) * c * c * v * v;
    const double error2 =
        s.active[i] * slope * slope + jump2 + (uncertain_n2 != nullptr ? (*uncertain_n2)[i] : 0.0);
    s.weight[i] = noise2 > 0.0 ? noise2 / (noise2 + error2) : 1.0;
    // pressed down to zero while still in contact: whether another force would show there depends
    // on what "never pulls" includes
    if (p > 0.5 && on == 0.0) s.weight[i] *= 0.1;
  }
  if (const Series* rpm = recording.column("spindle_rpm")) s.spinning = (*rpm > 0.0).cast<double>();
  return s;
}

}  // namespace cavum::explain
