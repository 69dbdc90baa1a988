// What resists the motion itself: friction in joints and guides.
#include <algorithm>
#include <cmath>

#include "engine/base/order.h"
#include "engine/base/text.h"
#include "engine/lab/explain/model/mechanism.h"
#include "engine/physics/force/term_laws.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

/// Fc tanh(V/v0) at Fc = 1 by the engine's own law. Where the speed is uncertain by sd the mean
/// over that uncertainty is close to tanh(V/sqrt(v0² + sd²·pi/2)): equal slope at 0, equal ends.
Series sign_of_motion(const Scene& s, double v0_mm_s) {
  const Series& v = s.motion->v_mm_s;
  const Series* slide = s.recording->friction_by_path ? s.recording->column("slide_mm_s") : nullptr;
  Series out(v.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double width =
        std::sqrt(v0_mm_s * v0_mm_s + 1.5708 * s.motion->sd_v_mm_s[i] * s.motion->sd_v_mm_s[i]);
    const double whole =
        slide != nullptr ? std::hypot(v[i], (*slide)[i])
                         : 0.0;  // friction is against the tip's motion, whichever way that goes
    out[i] = whole > 0.0 ? sliding_share(whole, width) * v[i] / whole : sliding_share(v[i], width);
  }
  return out;
}

/// These parts of the speed that the fastest tenth of the motion exceeds.
std::vector<double> speeds(const Scene& s, std::initializer_list<double> parts) {
  std::vector<double> v;
  for (Eigen::Index i = 0; i < s.motion->v_mm_s.size(); ++i)
    v.push_back(std::fabs(s.motion->v_mm_s[i]));
  const double fast_mm_s = quantile(std::move(v), 0.9);
  std::vector<double> out;
  for (const double p : parts) out.push_back(std::max(1e-5, p * fast_mm_s));
  return out;
}

double fastest_mm_s(const Scene& s) { return std::max(1e-5, s.motion->v_mm_s.abs().maxCoeff()); }

Grid as_grid(const std::vector<double>& values) {
  Grid g;
  for (const double v : values) g.push_back({v});
  return g;
}

Mechanism coulomb_friction() {
  return {
      .name = "coulomb_friction",
      .equation = noop("Fc tanh(V/v0), in air too"),
      .words = noop("dry friction of joints or guides"),
      .separate = noop("stroke to and fro in air: it flips with the direction"),
      .seen_over = "v_mm_s",
      .shape = {{"v0_mm_s", 1e-5, 1000, true, true}},
      .ends =
          [](const Scene& s) {
            return std::pair(0.0, fastest_mm_s(s));
          },  // a tanh wider than the motion is fast is friction in proportion to speed
      .grid =
          [](const Scene& s) {
            return as_grid(speeds(s, {0.001, 0.01, 0.03, 0.1, 0.3, 0.8}));
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{{sign_of_motion(s, p[0])}, {}, {}};
          },
      .coefficients = {"fc_n"},
      .own = k_positive,
      .one_way = OneWay::looks_like_offset,
  };
}

Mechanism stribeck_friction() {
  return {
      .name = "stribeck_friction",
      .equation = noop("[Fc + (Fs - Fc) e^(-(V/vs)^2)] tanh(V/v0), in air too"),
      .words = noop("friction that falls as the motion becomes faster"),
      .separate = noop("stroke to and fro in air at five speeds, the slowest near 0.01 mm/s"),
      .seen_over = "v_mm_s",
      .shape = {{"vs_mm_s", 1e-5, 100, true, true}, {"v0_mm_s", 1e-5, 100, true, true}},
      .grid =
          [](const Scene& s) {
            Grid g;
            for (const double vs : speeds(s, {0.1, 0.25, 0.5, 1.0}))
              for (const double part : {0.03, 0.1}) g.push_back({vs, part * vs});
            return g;
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            const Series sign = sign_of_motion(s, p[1]);
            const Series spread =
                1.0 +
                2.0 * (s.motion->sd_v_mm_s / p[0]).square();  // mean over the uncertainty of V
            Series still(sign.size());
            for (Eigen::Index i = 0; i < still.size(); ++i)
              still[i] = static_share(s.motion->v_mm_s[i], p[0] * std::sqrt(spread[i]));
            return Columns{{sign, sign * still / spread.sqrt()}, {}, {}};
          },
      .parameters =
          [](const Shape& p, const Shape& own, Base) {
            return std::vector<NamedValue>{
                {"fc_n", own[0]}, {"fs_n", own[0] + own[1]}, {"vs_mm_s", p[0]}, {"v0_mm_s", p[1]}};
          },
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        return Numbers{{value("vs_mm_s"), value("v0_mm_s")},
                       {value("fc_n"), value("fs_n") - value("fc_n")}};
      },
      .own = k_positive,
      .variant_of = "coulomb_friction",
      .plainer = "coulomb_friction",
      .must_exceed = {"fs_n", "fc_n"},
      .one_way = OneWay::needs_reversal,
  };
}

Mechanism viscous_friction() {
  return {
      .name = "viscous_friction",
      .equation = noop("b V, in air too"),
      .words = noop("friction in proportion to speed"),
      .separate = noop("stroke in air at three speeds"),
      .seen_over = "v_mm_s",
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{{s.motion->v_mm_s}, {}, {}};
          },
      .coefficients = {"b_n_s_per_mm"},
      .own = k_positive,
      .one_way = OneWay::needs_reversal,
  };
}

}  // namespace

std::vector<Mechanism> friction_mechanisms() {
  return {
      coulomb_friction(),
      stribeck_friction(),
      viscous_friction(),
  };
}

}  // namespace cavum::explain
