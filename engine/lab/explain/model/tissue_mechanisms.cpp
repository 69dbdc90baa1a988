// What the tissue does beyond k X + c V: stiffness that is no constant, relaxation, direction,
// other laws of speed.
#include <algorithm>
#include <cmath>

#include "engine/base/order.h"
#include "engine/base/text.h"
#include "engine/lab/explain/model/lags.h"
#include "engine/lab/explain/model/mechanism.h"
#include "engine/physics/force/term_laws.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

constexpr double k_radian = k_pi / 180.0;
constexpr double k_rest_mm_s =
    1e-4;  // speeds below are taken for rest: |V|^n is infinitely steep there when n < 1

Grid points(std::initializer_list<double> values, double unit = 1.0) {
  Grid g;
  for (const double v : values) g.push_back({v * unit});
  return g;
}

/// `law` of each value, by the engine.
template <class Law>
Series each(const Series& values, const Law& law) {
  return values.unaryExpr([&](double v) { return law(v); });
}

/// z' = d(X^m)/dt − z/tau while in contact, felt in contact only; exact for a constant rate within
/// a row. m = 1: z' = V − z/tau. `carried`: in air z goes on fading, so that a place pressed again
/// too soon still remembers; else each contact begins anew.
Series relaxing_mm(const Scene& s, double tau_s, double m, bool carried) {
  const auto stretch = [m](double x_mm) { return m == 1.0 ? x_mm : det_pow(x_mm, m); };
  Series out(s.force_n.size());
  for (const auto& rows : s.recording->sessions) {
    double z = 0.0;
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      const double x = s.motion->x_mm[i];
      if (x <= 0.0) {
        z = carried && i > rows.begin ? relaxed_mm(z, 0.0, s.dt_s[i - 1] / tau_s) : 0.0;
      } else if (i > rows.begin) {
        z = relaxed_mm(z, stretch(x) - stretch(std::max(0.0, s.motion->x_mm[i - 1])),
                       s.dt_s[i - 1] / tau_s);
      }
      out[i] = z;
    }
  }
  return out * s.active;
}

constexpr double k_rows_of_decay =
    2.0;  // what decays within fewer rows is damping, or a reading that stands still

double shortest_decay_s(const Scene& s) {
  return k_rows_of_decay * median(std::vector<double>(s.dt_s.begin(), s.dt_s.end()));
}

/// True when some session leaves the tissue and comes back to it.
bool comes_back(const Scene& s) {
  return std::any_of(
      s.recording->sessions.begin(), s.recording->sessions.end(), [&](const SessionRows& rows) {
        int begun = 0;
        for (Eigen::Index i = rows.begin; i < rows.end; ++i)
          begun += s.motion->x_mm[i] > 0.0 && (i == rows.begin || s.motion->x_mm[i - 1] <= 0.0);
        return begun > 1;
      });
}

/// Shape {tau1, tau2, m, carried}; tau2 = 0 for one exponential. Soft specimens, whose elastic
/// force is a power of the depth, relax in proportion to that (quasi-linear viscoelasticity, Fung
/// 1981): m > 1 is tried for them only.
Grid relaxation_grid(const Scene& s) {
  double longest = 0.0;
  for (const auto& rows : s.recording->sessions)
    longest = std::max(longest, s.recording->t_s[rows.end - 1] - s.recording->t_s[rows.begin]);
  Grid g;
  std::vector<double> taus;
  for (const double tau : {0.05, 0.13, 0.33, 0.85, 2.2, 5.5, 14.0})
    if (tau < longest && tau > shortest_decay_s(s)) taus.push_back(tau);
  for (const double carried :
       comes_back(s) ? std::vector<double>{0.0, 1.0} : std::vector<double>{0.0}) {
    for (const double tau : taus) g.push_back({tau, 0.0, 1.0, carried});
    for (std::size_t i = 0; i < taus.size(); ++i)
      for (std::size_t j = i + 2; j < taus.size(); j += 2)
        for (const double m : s.recording->specimens ? std::vector<double>{1.0, 1.5, 2.0, 3.0}
                                                     : std::vector<double>{1.0})
          g.push_back({taus[i], taus[j], m, carried});
  }
  return g;
}

/// Shape {variant}: the part that turns is 0 the whole base force, 1 a force of its own while in
/// contact.
Columns anisotropy_columns(const Scene& s, const Shape& p) {
  const Series& angle = *s.recording->column("approach_deg");
  const Series what = p[0] < 0.5 ? s.force_n : s.active;
  return {{what * each(angle, [](double deg) { return twice_angle(deg).cos; }),
           what * each(angle, [](double deg) { return twice_angle(deg).sin; })},
          {},
          {}};
}

Mechanism series_compliance() {
  return {
      .name = "series_compliance",
      .equation = noop("k (X - F/ks) + c (V - F'/ks), or softening k X/(1 + k X/Fs)"),
      .words = noop("something elastic between the tool and the tooth"),
      .separate = noop("press a block of steel in the same holder"),
      .seen_over = "simulated_n",
      .shape = {{"softening_force_n", 1e-3, 1e6, true, true}, {"mm_per_n", 1e-3, 50.0, true, true}},
      .grid =
          [](const Scene& s) {  // either of the two: 0 = not that one
            Grid g;
            for (const double part : {0.5, 1.5, 5.0, 20.0})
              g.push_back({part * std::max(1e-6, s.force_n.maxCoeff()), 0.0});
            if (s.base.k_n_per_mm > 0.0 && s.base.c_n_s_per_mm > 1e-3 * s.base.k_n_per_mm)
              for (const double softer : {0.03, 0.08, 0.2, 0.5, 1.2})
                g.push_back({0.0, softer / s.base.k_n_per_mm});
            return g;
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            if (p[1] > 0.0) return in_series(s, p[1]);
            return Columns{{},
                           each(s.spring_mm,
                                [&](double x) { return softened_mm(x, s.base.k_n_per_mm, p[0]); }),
                           {}};
          },
      .parameters =
          [](const Shape& p, const Shape&, Base) {
            return std::vector<NamedValue>{p[1] > 0.0 ? NamedValue{"ks_n_per_mm", 1.0 / p[1]}
                                                      : NamedValue{"softening_force_n", p[0]}};
          },
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        if (std::isfinite(value("ks_n_per_mm"))) return std::nullopt;
        return Numbers{{value("softening_force_n"), 0.0}, {}};
      },
      .shape_in_term =
          [](const Shape& shape, TermParameters& out) {
            if (shape[1] > 0.0) out.emplace_back("whole", 1.0);
            return true;
          },
      .variant_of = "nonlinear_stiffness",
      .inside = true,
  };
}

Mechanism nonlinear_stiffness() {
  return {
      .name = "nonlinear_stiffness",
      .equation = noop("k (X^m - X), X in mm"),
      .words = noop("a stiffness that grows or falls as a power of the depth"),
      .separate = noop("press slowly to twice the depth"),
      .seen_over = "x_mm",
      .shape = {{"m", 0.1, 5.0, false, true}},
      .grid =
          [](const Scene&) {
            return points({0.5, 0.7, 0.85, 0.95, 1.05, 1.2, 1.5, 2.0, 2.7, 3.5});
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{
                {}, each(s.spring_mm, [&](double x) { return power_beyond_mm(x, p[0]); }), {}};
          },
      .inside = true,
  };
}

Mechanism hidden_layer() {
  return {
      .name = "hidden_layer",
      .equation = noop("dk (X - d0)+"),
      .words = noop("a layer below the surface with another stiffness"),
      .separate = noop("press slowly through the depth of the kink, at two sites"),
      .seen_over = "x_mm",
      .shape = {{"d0_mm", 1e-4, 100, false, true}},
      .grid =
          [](const Scene& s) {
            Grid g = points({0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}, deepest_mm(s));
            for (const double known : s.recording->rig.layer_depths_mm)
              if (known > 0.0 && known < deepest_mm(s)) g.push_back({known});
            return g;
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{
                {each(s.motion->x_mm, [&](double x) { return layer_mm(x, p[0]); }) * s.active},
                {},
                {}};
          },
      .coefficients = {"dk_n_per_mm"},
      .inside = true,
  };
}

Mechanism graded_stiffness() {
  return {
      .name = "graded_stiffness",
      .equation = noop("-k alpha X^2"),
      .words = noop("a stiffness that changes evenly with depth"),
      .separate = noop("press slowly to twice the depth"),
      .seen_over = "x_mm",
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{
                {each(s.spring_mm, [](double x) { return graded_n(1.0, -1.0, x); })}, {}, {}};
          },
      .parameters =
          [](const Shape&, const Shape& own, Base b) {
            return std::vector<NamedValue>{{"alpha_per_mm", -own[0] / b.k_n_per_mm}};
          },
      .from_term = [](const TermReader& value, Base base) -> std::optional<Numbers> {
        return Numbers{{}, {-value("alpha_per_mm") * base.k_n_per_mm}};
      },
      .variant_of = "nonlinear_stiffness",
      .inside = true,
  };
}

Mechanism anisotropy() {
  return {
      .name = "anisotropy",
      .equation = noop("F_sim e cos 2(phi - phi0)"),
      .words = noop("a stiffness that depends on the angle of approach"),
      .separate = noop("approach one site at 0, 45, 90 and 135 degrees"),
      .seen_over = "approach_deg",
      .needs = {"approach_deg"},
      .shape = {{"variant", 0, 1, false, false}},
      .grid =
          [](const Scene&) {
            return points({0.0, 1.0});
          },
      .columns = anisotropy_columns,
      .parameters =
          [](const Shape& p, const Shape& own, Base) {
            return std::vector<NamedValue>{
                {p[0] < 0.5 ? "epsilon" : "amplitude_n", std::hypot(own[0], own[1])},
                {"phi0_deg", 0.5 * std::atan2(own[1], own[0]) / k_radian}};
          },
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        if (value("epsilon") != 0.0 && value("amplitude_n") != 0.0) return std::nullopt;
        const double size = value("epsilon") != 0.0 ? value("epsilon") : value("amplitude_n");
        const SinCos to = twice_angle(value("phi0_deg"));
        return Numbers{{value("epsilon") != 0.0 ? 0.0 : 1.0}, {size * to.cos, size * to.sin}};
      },
  };
}

Mechanism relaxation() {
  return {
      .name = "relaxation",
      .equation = noop("sum k_i integral of e^(-(t-s)/tau_i) V ds in contact"),
      .words = noop("a force that decays while the tool is held still"),
      .separate = noop("hold for ten seconds at constant depth, three depths"),
      .seen_over = "t_s",
      .shape = {{"tau1_s", 5e-3, 1e3, true, true},
                {"tau2_s", 5e-3, 1e3, true, true},
                {"exponent", 0.2, 5, false, false},
                {"carried", 0, 1, false, false}},
      .ends = [](const Scene& s) { return std::pair(shortest_decay_s(s), 1e9); },
      .grid = relaxation_grid,
      .columns =
          [](const Scene& s, const Shape& p) {
            const bool carried = p[3] > 0.5;
            Columns c{{relaxing_mm(s, p[0], p[2], carried)}, {}, {}};
            if (p[1] > 0.0) c.own.push_back(relaxing_mm(s, p[1], p[2], carried));
            return c;
          },
      .parameters =
          [](const Shape& p, const Shape& own, Base) {
            if (p[1] <= 0.0)
              return std::vector<NamedValue>{{"k1_n_per_mm", own[0]}, {"tau1_s", p[0]}};
            const std::size_t a = p[0] <= p[1] ? 0 : 1, b = 1 - a;
            return std::vector<NamedValue>{{"k1_n_per_mm", own[a]},
                                           {"tau1_s", p[a]},
                                           {"k2_n_per_mm", own[b]},
                                           {"tau2_s", p[b]}};
          },
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        return Numbers{{value("tau1_s"), value("k2_n_per_mm") != 0.0 ? value("tau2_s") : 0.0,
                        value("exponent"), value("carried") < 0.5 ? 0.0 : 1.0},
                       {value("k1_n_per_mm"), value("k2_n_per_mm")}};
      },
      .shape_in_term =
          [](const Shape& shape, TermParameters& out) {
            out.emplace_back("exponent", shape[2]);
            out.emplace_back("carried", shape[3]);
            return true;
          },
      .own = k_positive,
      .simpler =
          [](const Shape& p) {
            return p[1] > 0.0 ? Shape{std::sqrt(p[0] * p[1]), 0.0, p[2], p[3]} : Shape{};
          },
      .inside = true,
  };
}

Mechanism feed_power_law() {
  return {
      .name = "feed_power_law",
      .equation = noop("c (|V|^n sign V - V), V in mm/s"),
      .words = noop("a force that grows with another power of the speed"),
      .separate = noop("press at five speeds over two decades"),
      .seen_over = "v_mm_s",
      .shape = {{"n", 0.05, 4.0, false, true}},
      .grid =
          [](const Scene&) {
            return points({0.15, 0.35, 0.55, 0.75, 0.9, 1.15, 1.5, 2.0});
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{{}, {}, each(s.motion->v_mm_s, [&](double v) {
                                     const double size = std::hypot(v, k_rest_mm_s);
                                     return v / size * feed_beyond_mm_s(size, p[0]);
                                   }) * s.active};
          },
      .inside = true,
  };
}

}  // namespace

std::vector<Mechanism> tissue_mechanisms() {
  return {
      series_compliance(), nonlinear_stiffness(), hidden_layer(),   graded_stiffness(),
      anisotropy(),        relaxation(),          feed_power_law(),
  };
}

}  // namespace cavum::explain
