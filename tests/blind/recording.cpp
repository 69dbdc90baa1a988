#include "tests/blind/recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <stdexcept>

namespace cavum::blind {
namespace {

constexpr double k_force_quantum_n = 0.0005;

/// What the file holds of each row; the rest is copied from the motion.
struct Rows {
  std::vector<std::size_t> fine;  ///< index in the motion
  std::vector<double> t_s, x_mm, v_mm_s, f_n;
};

struct Column {
  std::string name;
  const std::vector<double>* values;
  const char* format;
};

/// AR(1), scaled so that its root mean square in this recording is `rms_n`.
std::vector<double> noise(Draw& draw, const Motion& m, std::size_t rows, double rms_n, bool heavy) {
  const double keep = draw.uniform(0.3, 0.8), kick = std::sqrt(1.0 - keep * keep);
  std::vector<double> out(rows);
  double e = 0.0, square = 0.0;
  for (std::size_t r = 0; r < rows; ++r) {
    const std::size_t i = r * k_rows_per_row;
    if (r == 0 || m.session[i] != m.session[i - k_rows_per_row]) e = draw.normal();
    e = keep * e + kick * (heavy ? draw.heavy() : draw.normal());
    out[r] = e;
    square += e * e;
  }
  for (double& value : out) value *= rms_n / std::sqrt(square / static_cast<double>(rows));
  return out;
}

double rounded(double value, double quantum) {
  return quantum > 0.0 ? quantum * std::round(value / quantum) : value;
}

/// Breaks the data in the way that is asked for; returns the force limit to be declared, N, or 0.
double break_rows(Draw& draw, const std::string& fault, Rows& rows) {
  const std::size_t n = rows.t_s.size();
  if (fault == "time_base") {
    const double factor = draw.one_of(std::vector<double>{0.5, 0.8, 1.25, 2.0, 1000.0});
    for (double& t : rows.t_s) t *= factor;
  } else if (fault == "metres") {
    for (double& x : rows.x_mm) x *= 0.001;
  } else if (fault == "clipped") {
    std::vector<double> sorted = rows.f_n;
    std::sort(sorted.begin(), sorted.end());
    const double limit = rounded(
        sorted[static_cast<std::size_t>(draw.uniform(0.93, 0.985) * static_cast<double>(n))],
        k_force_quantum_n);
    for (double& f : rows.f_n) f = std::min(f, limit);
    return draw.chance(0.5) ? limit : 0.0;
  } else if (fault == "shuffled") {
    const std::size_t first = draw.below(n / 2), count = 20 + draw.below(n / 10);
    std::vector<double> part(rows.t_s.begin() + static_cast<std::ptrdiff_t>(first),
                             rows.t_s.begin() + static_cast<std::ptrdiff_t>(first + count));
    draw.shuffle(part);
    std::copy(part.begin(), part.end(), rows.t_s.begin() + static_cast<std::ptrdiff_t>(first));
  } else if (fault == "repeated") {
    const double share = draw.log_uniform(0.005, 0.2);
    for (std::size_t i = 1; i < n; ++i)
      if (draw.chance(share) && rows.t_s[i] > rows.t_s[i - 1]) rows.t_s[i] = rows.t_s[i - 1];
  } else {
    throw std::invalid_argument("no fault is called " + fault);
  }
  return 0.0;
}

/// Draws k, c and the effects and scales each to its size; fills `hidden` and the force to be
/// added. A base on which an effect cannot reach its size (a spring in series beside hardly any
/// damping) is drawn again, up to 12 times.
Base hide(const Request& request, Draw& draw, const Motion& m, Hidden& hidden,
          std::vector<double>& added_n) {
  Base base;
  for (int tries = 0; tries < 12; ++tries) {
    base = {draw.log_uniform(0.4, 1.2), draw.log_uniform(0.2, 0.8)};
    added_n.assign(m.size(), 0.0);
    hidden.truth.clear();
    hidden.reached = true;
    if (request.kind == Kind::clean || request.kind == Kind::fault) return base;
    for (const std::string& name : request.names) {
      const Effect effect = make_effect(name, draw, m, base);
      double amount = 0.0;
      if (request.kind == Kind::crosshead) {
        amount = draw.uniform(0.2, 0.8);  // N, as the 0.673 N of the paper
      } else if (name == "gain_error") {
        amount = draw.uniform(0.1, 0.3);  // no size: k and c take all of it
      } else {
        amount = amount_for(effect, m, base, request.size * hidden.noise_n);
        if (amount == 0.0) amount = 0.1 * effect.most, hidden.reached = false;
      }
      const std::vector<double> f = effect.force_n(amount);
      for (std::size_t i = 0; i < f.size(); ++i) added_n[i] += f[i];
      hidden.truth.push_back(effect.truth(amount));
      hidden.variable = effect.variable;
    }
    hidden.effect_n = beyond_k_and_c_n(m, base, added_n);
    if (hidden.reached) break;
  }
  return base;
}

bool contains(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void write_csv(const std::filesystem::path& file, const Motion& m, const Rows& rows, bool with_v,
               const std::vector<Column>& columns) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "w"),
                                                            &std::fclose);
  if (!out) throw std::runtime_error("cannot write " + file.string());
  std::fputs("session,t_s,x_mm,f_n", out.get());
  if (with_v) std::fputs(",v_mm_s", out.get());
  for (const Column& c : columns) std::fprintf(out.get(), ",%s", c.name.c_str());
  std::fputc('\n', out.get());
  for (std::size_t r = 0; r < rows.fine.size(); ++r) {
    std::fprintf(out.get(), "%d,%.4f,%.7f,%.4f", m.session[rows.fine[r]], rows.t_s[r], rows.x_mm[r],
                 rows.f_n[r]);
    if (with_v) std::fprintf(out.get(), ",%.4f", rows.v_mm_s[r]);
    for (const Column& c : columns) {
      std::fputc(',', out.get());
      std::fprintf(out.get(), "%.*f", c.format[0] - '0', (*c.values)[rows.fine[r]]);
    }
    std::fputc('\n', out.get());
  }
  if (std::ferror(out.get())) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace

const char* kind_name(Kind kind) {
  constexpr std::array names{"single", "pair", "clean", "outside", "crosshead", "fault"};
  return names[static_cast<std::size_t>(kind)];
}

const std::vector<std::string>& faults() {
  static const std::vector<std::string> names{"time_base", "metres", "clipped", "shuffled",
                                              "repeated"};
  return names;
}

std::vector<std::string> draw_pair(Draw& draw) {
  std::vector<std::string> names = mechanisms();
  // k and c hide a gain error; a second effect is drawn on top of an unsaturated sensor
  std::erase_if(names, [](const std::string& n) { return n == "gain_error" || n == "saturation"; });
  const std::vector<std::vector<std::string>> families{
      {"delay", "low_pass", "series_compliance"},
      {"coulomb_friction", "stribeck_friction"},
      {"backlash", "hysteresis"},
      {"nonlinear_stiffness", "hidden_layer", "graded_stiffness"}};
  const auto related = [&] {
    return std::any_of(families.begin(), families.end(), [&](const auto& f) {
      return std::find(f.begin(), f.end(), names[0]) != f.end() &&
             std::find(f.begin(), f.end(), names[1]) != f.end();
    });
  };
  do draw.shuffle(names);
  while (related());
  names.resize(2);
  return names;
}

Hidden write_recording(const Request& request, const std::filesystem::path& folder) {
  Draw draw(request.seed);
  Hidden hidden;
  hidden.request = request;
  hidden.noise_n = draw.uniform(0.015, 0.04);
  hidden.heavy_tails = draw.chance(0.2);
  const Motion m = request.kind == Kind::crosshead ? crosshead(draw) : six_sessions(draw);
  std::vector<double> added;
  const Base base = hide(request, draw, m, hidden, added);
  const std::vector<double> force = base_force_n(m, base);

  Rows rows;
  for (std::size_t i = 0; i < m.size(); i += k_rows_per_row) rows.fine.push_back(i);
  const std::vector<double> e =
      noise(draw, m, rows.fine.size(), hidden.noise_n, hidden.heavy_tails);
  for (std::size_t r = 0; r < rows.fine.size(); ++r) {
    const std::size_t i = rows.fine[r];
    rows.t_s.push_back(m.t_s[i]);
    rows.x_mm.push_back(rounded(m.x_mm[i], request.quantum_mm));
    rows.v_mm_s.push_back(m.v_mm_s[i] + 0.003 * draw.normal());
    rows.f_n.push_back(rounded(force[i] + added[i] + e[r], k_force_quantum_n));
  }
  hidden.has_v = draw.chance(0.5);
  double limit = 0.0;
  if (request.kind == Kind::fault) {
    if (request.names[0] == "time_base")
      hidden.has_v = true;  // without a speed there is nothing to hold the stamps against
    limit = break_rows(draw, request.names[0], rows);
  }

  const std::vector<std::string> strange{"motor_ma", "trial_v", "humidity_pct", "table_tilt_mrad",
                                         "bus_load"};
  const std::string other = draw.one_of(strange);
  if (hidden.variable == "other") hidden.variable = other;
  std::vector<Column> columns{{"spindle_rpm", &m.spindle_rpm, "0"},
                              {"posture_deg", &m.posture_deg, "2"}};
  const auto maybe = [&](const char* needed_by, std::vector<Column> more) {
    if (draw.chance(0.6) || contains(request.names, needed_by))
      columns.insert(columns.end(), more.begin(), more.end());
  };
  maybe("anisotropy", {{"approach_deg", &m.approach_deg, "1"}});
  const bool lateral = contains(request.names, "lateral_square");
  maybe(lateral ? "lateral_square" : "cross_talk",
        {{"fy_n", &m.fy_n, "4"}, {"fz_n", &m.fz_n, "4"}});
  maybe("wear", {{"removed_mm3", &m.removed_mm3, "5"}, {"bur_id", &m.bur_id, "0"}});
  maybe("coolant", {{"wet", &m.wet, "0"}});
  maybe("thermal_softening", {{"temperature_c", &m.temperature_c, "3"}});
  maybe("unnamed_column", {{other, &m.other, "4"}});
  maybe("", {{"site", &m.site, "0"}});
  std::filesystem::create_directories(folder);
  write_csv(folder / "recording.csv", m, rows, hidden.has_v, columns);

  std::ofstream rig(folder / "rig.toml");
  rig.precision(8);
  rig << "k_n_per_mm = " << base.k_n_per_mm * draw.uniform(0.97, 1.03)
      << "\nc_n_s_per_mm = " << base.c_n_s_per_mm * draw.uniform(0.97, 1.03)
      << "\nposition_quantum_mm = " << std::fixed << request.quantum_mm
      << "\nforce_quantum_n = " << k_force_quantum_n
      << "\nforce_limit_n = " << (limit > 0.0 ? limit : 50.0) << "\n";
  if (!rig.flush()) throw std::runtime_error("cannot write " + (folder / "rig.toml").string());
  return hidden;
}

}  // namespace cavum::blind
