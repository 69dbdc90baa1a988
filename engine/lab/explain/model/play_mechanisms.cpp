// What depends on where the motion came from: play, and loops that no rate changes.
#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "engine/lab/explain/model/mechanism.h"
#include "engine/physics/force/term_laws.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

/// Play of radius b (variants 0: of the penetration; 1: of the position, in air too; 3: the same,
/// with contact where the encoder shows it and not the tip; 4: of the position, the surface being
/// where the tip met it on the way in), or of width b behind the motion (2).
Series played(const Scene& s, int variant, double b) {
  Series out(s.force_n.size());
  for (const auto& rows : s.recording->sessions) {
    const auto input = [&](Eigen::Index i) {
      return variant == 1 || variant >= 3 ? s.motion->x_mm[i] : std::max(0.0, s.motion->x_mm[i]);
    };
    double y = input(rows.begin);
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      const double x = input(i);
      y = played_mm(y, x, b, variant == 2 ? 0.0 : b);
      out[i] = variant == 4 ? y + b : y;
    }
  }
  return variant == 3 ? out : Series(out.max(0.0));
}

Grid play_grid(const Scene& s) {
  Grid g;
  for (const double variant : {0.0, 1.0, 2.0, 3.0, 4.0})
    for (const double part : {0.005, 0.015, 0.04, 0.1, 0.25})
      g.push_back({variant, part * deepest_mm(s)});
  return g;
}

/// Bouc-Wen with n = 1: z' = V − (beta |V| z + gamma V |z|)/d while in contact, 0 in air. Variants:
/// 0 beta = gamma = 1/2 (unloads along V), 1 beta = 1 (Dahl's model), 2 the same in air too.
Series loop_mm(const Scene& s, int variant, double d) {
  Series out(s.force_n.size());
  const double gamma = variant == 0 ? 0.5 : 0.0;
  for (const auto& rows : s.recording->sessions) {
    double z = 0.0;
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      const double x = s.motion->x_mm[i], before = i > rows.begin ? s.motion->x_mm[i - 1] : x;
      z = variant < 2 && x <= 0.0
              ? 0.0
              : cavum::loop_mm(z, x - (variant < 2 ? std::max(0.0, before) : before), d, gamma);
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

Mechanism backlash() {
  return {
      .name = "backlash",
      .equation = noop("k (play(X, b) - X), b half of the whole play"),
      .words = noop("play between the measured position and the tip"),
      .separate = noop("reverse within contact, slowly, several times"),
      .shape = {{"variant", 0, 4, false, false}, {"b_mm", 1e-5, 100, true, true}},
      .grid = play_grid,
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{
                {},
                (played(s, static_cast<int>(p[0]), p[1]) - s.motion->x_mm.max(0.0)) * s.active,
                {}};
          },
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        if (value("ahead_mm") > 0.0 || value("seen") >= 0.5) return std::nullopt;
        return Numbers{{value("ahead_mm") < 0.0 ? 1.0 : 2.0, value("b_mm")}, {}};
      },
      .shape_in_term =
          [](const Shape& shape, TermParameters& out) {
            if (shape[0] < 0.5 || shape[0] > 3.5)
              return false;  // a play that keeps its place in air, or whose surface was found by
                             // touch
            if (shape[0] == 2.0) out.emplace_back("ahead_mm", 0.0);
            if (shape[0] == 3.0) out.emplace_back("seen", 1.0);
            return true;
          },
      .one_way = OneWay::needs_reversal,
      .way = "b_mm",
      .inside = true,
  };
}

Mechanism hysteresis() {
  return {
      .name = "hysteresis",
      .equation = noop("alpha z, z' = V - (beta |V| z + gamma V |z|)/d in contact"),
      .words = noop("a loop that does not depend on speed"),
      .separate = noop("reverse within contact at two speeds, with strokes of several lengths"),
      .shape = {{"variant", 0, 2, false, false}, {"d_mm", 2e-3, 100, true, true}},
      .grid = loop_grid,
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{{loop_mm(s, static_cast<int>(p[0]), p[1])}, {}, {}};
          },
      .coefficients = {"alpha_n_per_mm"},
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        if (value("gamma") != 0.0 && value("gamma") != 0.5) return std::nullopt;
        return Numbers{{value("gamma") == 0.0 ? 1.0 : 0.0, value("d_mm")},
                       {value("alpha_n_per_mm")}};
      },
      .shape_in_term =
          [](const Shape& shape, TermParameters& out) {
            if (shape[0] > 1.5)
              return false;  // in air too: a friction whose direction an exam's tip does not have
            out.emplace_back("gamma", shape[0] < 0.5 ? 0.5 : 0.0);
            return true;
          },
      .own = k_positive,
      .one_way = OneWay::needs_reversal,
      .way = "d_mm",
      .same_as =
          [](const Shape& shape) {
            return shape[0] > 1.5 ? "coulomb_friction" : nullptr;
          },  // in air too: friction that gives before it slides
  };
}

}  // namespace

std::vector<Mechanism> play_mechanisms() {
  return {
      backlash(),
      hysteresis(),
  };
}

}  // namespace cavum::explain
