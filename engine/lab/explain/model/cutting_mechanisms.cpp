// What cutting adds: a constant edge force, wear of the bur, lines from the spindle or from
// chatter, water, heat.
#include <cmath>

#include "engine/base/text.h"
#include "engine/lab/explain/model/mechanism.h"
#include "engine/physics/force/term_laws.h"

namespace cavum::explain {
namespace {

using Shape = std::vector<double>;
using Grid = std::vector<Shape>;

constexpr double k_slip = 2.5e-5;
constexpr double k_turn = 2.0 * k_pi;

bool has(const Scene& s, const char* column) { return s.recording->column(column) != nullptr; }

/// Volume removed since the bur was new. `removed_mm3` may count up, or hold what each row removed
/// (then it goes up and down all the time). Variants: 0 as counted, 1 carried on over resets at the
/// start of a session.
Series worn_mm3(const Scene& s, bool carried) {
  const Series& removed = *s.recording->column("removed_mm3");
  const Series* bur = s.recording->column("bur_id");
  Eigen::Index falls = 0, rises = 0;
  for (Eigen::Index i = 1; i < removed.size(); ++i) {
    falls += removed[i] < removed[i - 1];
    rises += removed[i] > removed[i - 1];
  }
  const bool counts_up = falls * 20 < rises;
  Series out(removed.size());
  double total = 0.0, new_at = counts_up ? removed[0] : 0.0;
  for (Eigen::Index i = 0; i < removed.size(); ++i) {
    if (bur != nullptr && i > 0 && (*bur)[i] != (*bur)[i - 1]) {
      total = 0.0;
      new_at = removed[i];
    } else if (counts_up && i > 0 && removed[i] < removed[i - 1]) {  // counted anew
      if (carried) total += removed[i - 1] - new_at;
      new_at = removed[i];
    }
    if (!counts_up) total += removed[i];
    out[i] = counts_up ? total + removed[i] - new_at : total;
  }
  return out;
}

/// Sine and cosine of `turns` times `where`, a pair for each session, for a spindle starts at any
/// angle.
Columns line(const Scene& s, const Series& turns, const Series& where) {
  Series sine = Series::Zero(turns.size()), cosine = Series::Zero(turns.size());
  for (Eigen::Index i = 0; i < turns.size(); ++i) {
    if (where[i] <= 0.0) continue;
    sine[i] = line_at(turns[i]) * where[i];
    cosine[i] = line_at(turns[i] + 0.25) * where[i];
  }
  if (session_groups(*s.recording) == 1) return {{sine, cosine}, {}, {}};
  Columns c;
  for (const auto& rows : s.recording->sessions)
    for (const Series* part : {&sine, &cosine}) {
      c.own.push_back(Series::Zero(turns.size()));
      c.own.back().segment(rows.begin, rows.end - rows.begin) =
          part->segment(rows.begin, rows.end - rows.begin);
    }
  return c;
}

/// Of all sessions that show the line: their mean amplitude, each with its own phase.
double amplitude_of(const Shape& own) {
  double sum = 0.0, n = 0.0;
  for (std::size_t i = 0; i + 1 < own.size(); i += 2)
    if (const double a = std::hypot(own[i], own[i + 1]); a > 0.0) sum += a, n += 1.0;
  return n > 0.0 ? sum / n : 0.0;
}

/// Turns of the spindle, less whole ones. Variants: 0 rpm/60 · t (a spindle that keeps its rate), 1
/// the integral of rpm. `ratio`: true rate over rpm.
Series spindle_turns(const Scene& s, int variant, double ratio) {
  const Series& rpm = *s.recording->column("spindle_rpm");
  Series out(rpm.size());
  for (const auto& rows : s.recording->sessions) {
    double turns = 0.0;
    for (Eigen::Index i = rows.begin; i < rows.end; ++i) {
      if (variant == 1 && i > rows.begin) turns += ratio * rpm[i] / 60.0 * s.dt_s[i - 1];
      const double t = variant == 0 ? ratio * rpm[i] / 60.0 * s.recording->t_s[i] : turns;
      out[i] = t - std::floor(t);
    }
  }
  return out;
}

/// Shape {hz, spinning only}: lines that were found in the residual.
Columns chatter_columns(const Scene& s, const Shape& p) {
  const Series turns = s.recording->t_s * p[0];
  return line(s, turns - turns.floor(), p[1] > 0.5 ? Series(s.touching * s.spinning) : s.touching);
}

std::vector<NamedValue> line_parameters(const Shape& p, const Shape& own, Base) {
  std::vector<NamedValue> named{{"amplitude_n", amplitude_of(own)}, {"frequency_hz", p[0]}};
  if (own.size() == 2) named.push_back({"phase_turns", std::atan2(own[1], own[0]) / k_turn});
  return named;
}

Mechanism edge_force() {
  return {
      .name = "edge_force",
      .equation = noop("Fe while in contact and spinning"),
      .words = noop("a constant force of the cutting edges"),
      .separate = noop("press the same site with the spindle off and on"),
      .seen_over = "spindle_rpm",
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{
                {has(s, "spindle_rpm") ? Series(s.touching * s.spinning) : s.touching}, {}, {}};
          },
      .coefficients = {"edge_n"},
      .own = k_positive,
      .one_way = OneWay::looks_like_offset,
  };
}

Mechanism wear() {
  return {
      .name = "wear",
      .equation = noop("F_sim w W, W removed volume since the bur was new"),
      .words = noop("a bur that wears"),
      .separate = noop("cut the first site again last, with the worn and with a new bur"),
      .seen_over = "removed_mm3",
      .needs = {"removed_mm3"},
      .shape = {{"variant", 0, 1, false, false}},
      .grid =
          [](const Scene& s) {
            return s.recording->sessions.size() > 1 ? Grid{{0.0}, {1.0}} : Grid{{0.0}};
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            return Columns{{s.force_n.binaryExpr(worn_mm3(s, p[0] > 0.5), &worn_n)}, {}, {}};
          },
      .coefficients = {"per_mm3"},
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        return Numbers{{value("carried") < 0.5 ? 0.0 : 1.0}, {value("per_mm3")}};
      },
      .shape_in_term =
          [](const Shape& shape, TermParameters& out) {
            out.emplace_back("carried", shape[0] < 0.5 ? 0.0 : 1.0);
            return true;
          },
  };
}

Mechanism run_out() {
  return {
      .name = "run_out",
      .equation = noop("A sin(2 pi turns + phase) in contact and spinning"),
      .words = noop("a bur that turns off its axis"),
      .separate = noop("record the force at more than twice the spindle's rate"),
      .needs = {"spindle_rpm"},
      .shape = {{"variant", 0, 1, false, false}, {"rate_ratio", 0.999, 1.001, false, true}},
      .grid =
          [](const Scene&
                 s) {  // a rate that is written in whole turns per minute is off by up to 3e-5
            return s.spinning.maxCoeff() > 0.0
                       ? Grid{{0.0, 1.0}, {0.0, 1.0 - k_slip}, {0.0, 1.0 + k_slip}, {1.0, 1.0}}
                       : Grid{};
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            return line(s, spindle_turns(s, static_cast<int>(p[0]), p[1]), s.touching * s.spinning);
          },
      .parameters =
          [](const Shape&, const Shape& own, Base) {
            std::vector<NamedValue> p{{"amplitude_n", amplitude_of(own)}};
            if (own.size() == 2) p.push_back({"phase_turns", std::atan2(own[1], own[0]) / k_turn});
            return p;
          },
      .from_term = [](const TermReader& value, Base) -> std::optional<Numbers> {
        if (value("eccentricity_um") != 0.0 || value("rate_ratio") != 1.0) return std::nullopt;
        const SinCos phase = det_sincos(2 * k_pi * value("phase_turns"));
        const double amplitude = value("amplitude_n");
        return Numbers{{value("by_clock") < 0.5 ? 1.0 : 0.0, 1.0},
                       {amplitude * phase.cos, amplitude * phase.sin}};
      },
      .shape_in_term =
          [](const Shape& shape, TermParameters& out) {
            out.emplace_back("rate_ratio", shape[1]);
            out.emplace_back("by_clock", shape[0] < 0.5 ? 1.0 : 0.0);
            return true;
          },
      .by_session = true,
  };
}

Mechanism chatter() {
  return {
      .name = "chatter",
      .equation = noop("A sin(2 pi f t + phase) in contact"),
      .words = noop("a vibration at a rate that is not the spindle's"),
      .separate = noop("press at two depths and two spindle speeds: chatter keeps its rate"),
      .shape = {{"frequency_hz", 0.1, 1e5, false, true}, {"spinning", 0, 1, false, false}},
      .grid =
          [](const Scene& s) {
            Grid g;
            for (const double hz : s.lines_hz) {
              g.push_back({hz, 0.0});
              if (s.spinning.maxCoeff() > 0.0) g.push_back({hz, 1.0});
            }
            return g;
          },
      .columns = chatter_columns,
      .parameters = line_parameters,
      .shape_in_term =
          [](const Shape& shape, TermParameters& out) {
            out.emplace_back("spinning", shape[1]);
            return true;
          },
      .from_residual = true,
      .by_session = true,
  };
}

Mechanism interference() {
  return {
      .name = "interference",
      .equation = noop("A sin(2 pi f t + phase), in air too"),
      .words = noop(
          "a pick-up of a fixed frequency, as from the mains; the frequency is the one that the sampling shows"),
      .separate = noop(
          "record in air, the drive at rest: interference stays; at another sampling rate, an alias moves"),
      .shape = {{"frequency_hz", 0.1, 1e5, false, true}},
      .grid =
          [](const Scene& s) {
            Grid g;
            for (const double hz : s.lines_in_air_hz) g.push_back({hz});
            return g;
          },
      .columns =
          [](const Scene& s, const Shape& p) {
            const Series turns = s.recording->t_s * p[0];
            return line(s, turns - turns.floor(), Series::Ones(turns.size()));
          },
      .parameters = line_parameters,
      .from_residual = true,
      .by_session = true,
  };
}

Mechanism coolant() {
  return {
      .name = "coolant",
      .equation = noop("F_sim w wet"),
      .words = noop("water, which changes the cutting force"),
      .separate = noop("press one site dry, wet, and dry again"),
      .seen_over = "wet",
      .needs = {"wet"},
      .columns =
          [](const Scene& s, const Shape&) {
            return Columns{{s.force_n.binaryExpr(*s.recording->column("wet"), &watered_n)}, {}, {}};
          },
      .coefficients = {"fraction"},
  };
}

Mechanism thermal_softening() {
  return {
      .name = "thermal_softening",
      .equation = noop("-F_sim h (T - T0), T0 of the first row"),
      .words = noop("tissue that softens as it warms"),
      .separate = noop("cut for a minute, rest for a minute, cut again"),
      .seen_over = "temperature_c",
      .needs = {"temperature_c"},
      .columns =
          [](const Scene& s, const Shape&) {
            const Series& t = *s.recording->column("temperature_c");
            return Columns{{s.force_n.binaryExpr(t - t[0], &warmed_n)}, {}, {}};
          },
      .coefficients = {"per_k"},
      .own = k_positive,
  };
}

}  // namespace

Series removed_since_new_mm3(const Scene& scene, bool carried) { return worn_mm3(scene, carried); }

std::vector<Mechanism> cutting_mechanisms() {
  return {
      edge_force(), wear(), run_out(), chatter(), interference(), coolant(), thermal_softening(),
  };
}

}  // namespace cavum::explain
