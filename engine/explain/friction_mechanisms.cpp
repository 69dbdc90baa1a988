// What resists the motion itself: friction in joints and guides, play, rate-independent loops.
#include <algorithm>
#include <cmath>

#include "engine/explain/mechanism.h"
#include "engine/force/term_laws.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

/// Fc tanh(V/v0) at Fc = 1 by the engine's own law. Where the speed is uncertain by sd the mean over that uncertainty is
/// close to tanh(V/sqrt(v0² + sd²·pi/2)): equal slope at 0, equal ends.
Series sign_of_motion(const Scene& s, double v0_mm_s) {
  Series out(s.motion.v_mm_s.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double width = std::sqrt(v0_mm_s * v0_mm_s + 1.5708 * s.motion.sd_v_mm_s[i] * s.motion.sd_v_mm_s[i]);
    out[i] = sliding_share(s.motion.v_mm_s[i], width);
  }
  return out;
}

/// Speeds from 2 % to 60 % of the fastest tenth of the motion.
std::vector<double> speeds(const Scene& s, std::initializer_list<double> parts) {
  std::vector<double> v;
  for (Eigen::Index i = 0; i < s.motion.v_mm_s.size(); ++i) v.push_back(std::fabs(s.motion.v_mm_s[i]));
  const auto at = v.begin() + static_cast<std::ptrdiff_t>(v.size() * 9 / 10);
  std::nth_element(v.begin(), at, v.end());
  std::vector<double> out;
  for (const double p : parts) out.push_back(std::max(1e-5, p * *at));
  return out;
}

Grid as_grid(const std::vector<double>& values) {
  Grid g;
  for (const double v : values) g.push_back({v});
  return g;
}

/// Largest penetration, mm.
double deepest_mm(const Scene& s) { return std::max(1e-6, s.spring_mm.maxCoeff()); }

/// Play of radius b (variants 0: of the penetration; 1: of the position, in air too; 3: the same, with contact where the encoder shows it and not
/// the tip), or of width b behind the motion (2).
Series played(const Scene& s, int variant, double b) {
  Series out(s.force_n.size());
  for (const auto& rows : s.recording->sessions) {
    const auto input = [&](Eigen::Index i) { return variant == 1 || variant == 3 ? s.motion.x_mm[i] : std::max(0.0, s.motion.x_mm[i]); };
    double y = input(rows.begin);
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      const double x = input(i);
      y = played_mm(y, x, b, variant == 2 ? 0.0 : b);
      out[i] = y;
    }
  }
  return variant == 3 ? out : Series(out.max(0.0));
}

Grid play_grid(const Scene& s) {
  Grid g;
  for (const double variant : {0.0, 1.0, 2.0, 3.0})
    for (const double part : {0.005, 0.015, 0.04, 0.1, 0.25}) g.push_back({variant, part * deepest_mm(s)});
  return g;
}

/// Bouc-Wen with n = 1: z' = V − (beta |V| z + gamma V |z|)/d while in contact, 0 in air. Variants: 0 beta = gamma = 1/2
/// (unloads along V), 1 beta = 1 (Dahl's model), 2 the same in air too.
Series loop_mm(const Scene& s, int variant, double d) {
  Series out(s.force_n.size());
  const double gamma = variant == 0 ? 0.5 : 0.0;
  for (const auto& rows : s.recording->sessions) {
    double z = 0.0;
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      const double x = s.motion.x_mm[i], before = i > rows.begin ? s.motion.x_mm[i - 1] : x;
      z = variant < 2 && x <= 0.0 ? 0.0 : cavum::loop_mm(z, x - (variant < 2 ? std::max(0.0, before) : before), d, gamma);
      out[i] = z;
    }
  }
  return variant < 2 ? Series(out * s.touching) : out;
}

Grid loop_grid(const Scene& s) {
  Grid g;
  for (const double variant : {0.0, 1.0, 2.0})
    for (const double part : {0.03, 0.08, 0.2, 0.5}) g.push_back({variant, part * deepest_mm(s)});
  return g;
}

}  // namespace

std::vector<Mechanism> friction_mechanisms() {
  std::vector<Mechanism> m;
  m.push_back({"coulomb_friction",
               "Fc tanh(V/v0), in air too",
               "dry friction of joints or guides",
               "stroke to and fro in air: it flips with the direction",
               true,
               {{"v0_mm_s", 1e-5, 100, true, true}},
               [](const Scene& s) {
                 return as_grid(speeds(s, {0.01, 0.03, 0.1, 0.3, 0.8}));
               },
               [](const Scene& s, const Shape& p) {
                 return Columns{{sign_of_motion(s, p[0])}, {}, {}};
               },
               [](const Shape& p, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"fc_n", own[0]}, {"v0_mm_s", p[0]}};
               }});
  m.push_back({"stribeck_friction",
               "[Fc + (Fs - Fc) e^(-(V/vs)^2)] tanh(V/v0), in air too",
               "friction that falls as the motion becomes faster",
               "stroke to and fro in air at five speeds, the slowest near 0.01 mm/s",
               true,
               {{"vs_mm_s", 1e-5, 100, true, true}, {"v0_mm_s", 1e-5, 100, true, true}},
               [](const Scene& s) {
                 Grid g;
                 for (const double vs : speeds(s, {0.1, 0.25, 0.5, 1.0}))
                   for (const double part : {0.03, 0.1}) g.push_back({vs, part * vs});
                 return g;
               },
               [](const Scene& s, const Shape& p) {
                 const Series sign = sign_of_motion(s, p[1]);
                 const Series spread = 1.0 + 2.0 * (s.motion.sd_v_mm_s / p[0]).square();  // mean over the uncertainty of V
                 Series still(sign.size());
                 for (Eigen::Index i = 0; i < still.size(); ++i) still[i] = static_share(s.motion.v_mm_s[i], p[0] * std::sqrt(spread[i]));
                 return Columns{{sign, sign * still / spread.sqrt()}, {}, {}};
               },
               [](const Shape& p, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"fc_n", own[0]}, {"fs_n", own[0] + own[1]}, {"vs_mm_s", p[0]}, {"v0_mm_s", p[1]}};
               }});
  m.push_back({"viscous_friction",
               "b V, in air too",
               "friction in proportion to speed",
               "stroke in air at three speeds",
               true,
               {},
               [](const Scene&) { return Grid{{}}; },
               [](const Scene& s, const Shape&) {
                 return Columns{{s.motion.v_mm_s}, {}, {}};
               },
               [](const Shape&, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"b_n_s_per_mm", own[0]}};
               }});
  m.push_back({"backlash",
               "k (play(X, b) - X)",
               "play between the measured position and the tip",
               "reverse within contact, slowly, several times",
               true,
               {{"variant", 0, 3, false, false}, {"b_mm", 1e-5, 100, true, true}},
               play_grid,
               [](const Scene& s, const Shape& p) {
                 return Columns{{}, (played(s, static_cast<int>(p[0]), p[1]) - s.motion.x_mm.max(0.0)) * s.active, {}};
               },
               [](const Shape& p, const Shape&, Base) {
                 return std::vector<NamedValue>{{"b_mm", p[1]}};
               },
               false,
               true});
  m.push_back({"hysteresis",
               "alpha z, z' = V - (beta |V| z + gamma V |z|)/d in contact",
               "a loop that does not depend on speed",
               "reverse within contact at two speeds, with strokes of several lengths",
               true,
               {{"variant", 0, 2, false, false}, {"d_mm", 2e-3, 100, true, true}},
               loop_grid,
               [](const Scene& s, const Shape& p) {
                 return Columns{{loop_mm(s, static_cast<int>(p[0]), p[1])}, {}, {}};
               },
               [](const Shape& p, const Shape& own, Base) {
                 return std::vector<NamedValue>{{"alpha_n_per_mm", own[0]}, {"d_mm", p[1]}};
               }});
  return m;
}

}  // namespace cavum::explain
