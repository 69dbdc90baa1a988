#include "tests/blind/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cavum::blind {
namespace {

constexpr double k_pi = 3.141592653589793;
constexpr double k_ambient_c = 23.0;

/// State of the rig during one piece of the path.
struct Setting {
  double spindle_rpm = 0.0, wet = 0.0, posture_deg = 0.0, approach_deg = 0.0, bur_id = 1.0,
         site = 1.0;
};

/// Writes pieces of constant speed; `finish` rounds their corners and integrates.
class Path {
 public:
  explicit Path(double start_mm) : start_mm_(start_mm), at_mm_(start_mm) {}

  Setting now;

  void go(double to_mm, double speed_mm_s) {
    const auto steps = std::max<std::size_t>(
        1, static_cast<std::size_t>(std::lround(std::abs(to_mm - at_mm_) / speed_mm_s / k_step_s)));
    const double v = (to_mm - at_mm_) / (static_cast<double>(steps) * k_step_s);
    for (std::size_t i = 0; i < steps; ++i) speeds_.push_back(v), settings_.push_back(now);
    at_mm_ = to_mm;
  }
  void hold(double seconds) {
    for (double t = 0.0; t < seconds; t += k_step_s)
      speeds_.push_back(0.0), settings_.push_back(now);
  }

  /// Corners of the speed become raised cosines of `ramp_s`.
  void finish(int session, double ramp_s, Motion& m) const {
    const auto width = static_cast<std::size_t>(ramp_s / k_step_s);
    std::vector<double> kernel(width);
    double sum = 0.0;
    for (std::size_t j = 0; j < width; ++j)
      sum += kernel[j] =
          1.0 - std::cos(2.0 * k_pi * (static_cast<double>(j) + 0.5) / static_cast<double>(width));
    double x = start_mm_, last = 0.0;
    for (std::size_t i = 0; i < speeds_.size(); ++i) {
      double v = 0.0;
      for (std::size_t j = 0; j < std::min(width, i + 1); ++j) v += kernel[j] * speeds_[i - j];
      v /= sum;
      x += 0.5 * (v + last) * k_step_s;
      m.session.push_back(session);
      m.t_s.push_back(static_cast<double>(i) * k_step_s);
      m.x_mm.push_back(x);
      m.v_mm_s.push_back(v);
      m.a_mm_s2.push_back((v - last) / k_step_s);
      last = v;
      const Setting& s = settings_[i];
      m.spindle_rpm.push_back(s.spindle_rpm);
      m.wet.push_back(s.wet);
      m.posture_deg.push_back(s.posture_deg);
      m.approach_deg.push_back(s.approach_deg);
      m.bur_id.push_back(s.bur_id);
      m.site.push_back(s.site);
    }
  }

 private:
  double start_mm_, at_mm_;
  std::vector<double> speeds_;
  std::vector<Setting> settings_;
};

/// A smooth random walk around 0 with the given memory; standard deviation about 1.
std::vector<double> wander(Draw& draw, std::size_t n, double memory_s) {
  const double keep = std::exp(-k_step_s / memory_s), kick = std::sqrt(1.0 - keep * keep);
  std::vector<double> out(n);
  double a = draw.normal(), b = a;
  for (double& o : out) {
    a = keep * a + kick * draw.normal();
    b += (a - b) * k_step_s / (0.1 * memory_s);
    o = b;
  }
  return out;
}

/// What follows from the path: lateral forces, removal, wear, warmth, and the quantity that nobody
/// knows.
void add_companions(Draw& draw, Motion& m) {
  const std::size_t n = m.size();
  const auto y = wander(draw, n, 0.7), z = wander(draw, n, 0.9);
  m.other = wander(draw, n, 3.0);
  const double rate = draw.uniform(0.03, 0.08), warming = draw.uniform(1.5, 3.0),
               cooling_s = draw.uniform(4.0, 8.0);
  double removed = 0.0, worn = 0.0, warm = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const bool cutting = m.touching(i) && m.spindle_rpm[i] > 0.0;
    if (i > 0 && m.bur_id[i] != m.bur_id[i - 1]) worn = 0.0;
    if (i > 0 && m.session[i] != m.session[i - 1]) warm = 0.0;
    if (cutting) removed += rate * m.x_mm[i] * k_step_s, worn += rate * m.x_mm[i] * k_step_s;
    warm += k_step_s * ((cutting ? warming * m.x_mm[i] * (m.wet[i] > 0.0 ? 0.5 : 1.0) : 0.0) -
                        warm / cooling_s);
    m.removed_mm3.push_back(removed);
    m.worn_mm3.push_back(worn);
    m.temperature_c.push_back(k_ambient_c + warm);
    m.fy_n.push_back(m.touching(i) ? m.x_mm[i] * (0.25 + 0.4 * y[i]) : 0.0);
    m.fz_n.push_back(m.touching(i) ? m.x_mm[i] * (-0.15 + 0.4 * z[i]) : 0.0);
  }
}

}  // namespace

Motion six_sessions(Draw& draw) {
  Motion m;
  const std::array<double, 4> speeds{0.25, 0.5, 1.0, 2.0};
  const double rpm =
      draw.uniform(18500.0, 23500.0);  // seen at 200 Hz as a line between 8 and 92 Hz
  const double tilt = draw.uniform(20.0, 35.0), ramp_s = draw.uniform(0.06, 0.12);
  const std::array<double, 6> postures{0.0, tilt, 2.0 * tilt, 0.0, 2.0 * tilt, tilt};
  std::vector<double> angles{0.0, 30.0, 60.0, 90.0, 120.0, 150.0};
  double site = 0.0;
  for (int session = 1; session <= 6; ++session) {
    Path path(-1.5);
    path.now.posture_deg = postures[static_cast<std::size_t>(session - 1)];
    path.now.bur_id = session <= 3 ? 1.0 : 2.0;
    path.now.site = site + 1.0;
    draw.shuffle(angles);
    path.now.approach_deg = angles[0];
    path.hold(0.5);
    std::vector<double> order(speeds.begin(), speeds.end());
    draw.shuffle(order);
    for (std::size_t i = 0; i < 4; ++i) path.go(i % 2 == 0 ? -0.4 : -1.5, order[i]);
    path.hold(0.5);
    path.now.spindle_rpm = rpm;
    path.go(-0.4, 1.0);
    path.go(-1.0, 2.0);
    path.hold(0.5);
    draw.shuffle(order);
    std::vector<double> holds{10.0, 1.5, 2.0, 1.0}, spins{0.0, 0.0, 1.0, 1.0},
        wets{0.0, 1.0, 0.0, 1.0};
    draw.shuffle(holds);
    draw.shuffle(spins);
    draw.shuffle(wets);
    for (std::size_t i = 0; i < 4; ++i) {
      const bool again = session == 6 && i == 3;  // the first site once more
      path.now.site = again ? 1.0 : ++site;
      path.now.spindle_rpm = spins[i] * rpm;
      path.now.wet = wets[i];
      path.now.approach_deg = angles[i];
      const double depth = draw.uniform(0.7, 1.2), back = draw.uniform(0.2, 0.4),
                   wiggle = speeds[1 + draw.below(2)];
      path.go(depth, order[i]);
      path.hold(0.5 * holds[i]);
      if (i == 1) path.now.spindle_rpm = rpm - path.now.spindle_rpm;
      if (i == 2) path.now.wet = 1.0 - path.now.wet;
      path.hold(0.5 * holds[i]);
      path.go(depth - back, wiggle);
      path.go(depth, wiggle);
      path.go(-0.4, speeds[1 + draw.below(3)]);
    }
    path.now.spindle_rpm = 0.0;
    path.go(-1.5, 1.0);
    path.hold(0.5);
    path.finish(session, ramp_s, m);
    m.phase_rad.push_back(draw.uniform(0.0, 2.0 * k_pi));
  }
  add_companions(draw, m);
  return m;
}

Motion crosshead(Draw& draw) {
  Motion m;
  const double depth = draw.uniform(0.8, 1.6), speed = draw.log_uniform(0.1, 0.5);
  for (int session = 1; session <= 6; ++session) {
    Path path(0.02);
    path.now.spindle_rpm = 20000.0;
    path.now.site = session;
    path.go(depth + draw.uniform(0.5, 0.6), speed);
    Motion one;
    path.finish(session, 0.08, one);
    std::size_t first =
        static_cast<std::size_t>(0.1 / k_step_s);  // the machine is at speed when recording begins
    for (std::size_t i = first; i < one.size(); ++i) {
      m.session.push_back(session);
      m.t_s.push_back(static_cast<double>(i - first) * k_step_s);
      m.x_mm.push_back(one.x_mm[i]);
      m.v_mm_s.push_back(one.v_mm_s[i]);
      m.a_mm_s2.push_back(one.a_mm_s2[i]);
      m.spindle_rpm.push_back(one.spindle_rpm[i]);
      m.wet.push_back(0.0);
      m.posture_deg.push_back(0.0);
      m.approach_deg.push_back(0.0);
      m.bur_id.push_back(1.0);
      m.site.push_back(one.site[i]);
    }
    m.phase_rad.push_back(draw.uniform(0.0, 2.0 * k_pi));
  }
  add_companions(draw, m);
  return m;
}

}  // namespace cavum::blind
