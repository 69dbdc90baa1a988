#include "tests/blind/simpler.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <sstream>

namespace cavum::blind {
namespace {

constexpr double k_pi = 3.141592653589793;
constexpr double k_row_s = 0.005;
using Series = std::vector<double>;

struct Data {
  std::map<std::string, Series> columns;
  double k = 0.0, c = 0.0;
  [[nodiscard]] bool has(const char* name) const { return columns.contains(name); }
  [[nodiscard]] const Series& operator[](const char* name) const { return columns.at(name); }
};

struct Column {
  std::string name;  ///< of the mechanism; empty for k and c
  Series values;
};

Data read(const std::filesystem::path& folder) {
  Data d;
  std::ifstream csv(folder / "recording.csv");
  std::string line, cell;
  std::getline(csv, line);
  std::vector<Series*> order;
  for (std::istringstream head(line); std::getline(head, cell, ',');)
    order.push_back(&d.columns[cell]);
  while (std::getline(csv, line)) {
    const char* at = line.c_str();
    for (Series* s : order) {
      char* end = nullptr;
      s->push_back(std::strtod(at, &end));
      at = *end == ',' ? end + 1 : end;
    }
  }
  std::ifstream rig(folder / "rig.toml");
  for (std::string equals, value; rig >> cell >> equals >> value;) {
    if (cell == "k_n_per_mm") d.k = std::strtod(value.c_str(), nullptr);
    if (cell == "c_n_s_per_mm") d.c = std::strtod(value.c_str(), nullptr);
  }
  return d;
}

/// Slope of a straight line through ±`half` rows, per second.
Series slope(const Series& y, int half) {
  const int n = static_cast<int>(y.size());
  Series out(y.size(), 0.0);
  double norm = 0.0;
  for (int j = -half; j <= half; ++j) norm += static_cast<double>(j) * j;
  for (int i = half; i + half < n; ++i) {
    double sum = 0.0;
    for (int j = -half; j <= half; ++j) sum += j * y[static_cast<std::size_t>(i + j)];
    out[static_cast<std::size_t>(i)] = sum / norm / k_row_s;
  }
  return out;
}

std::vector<Column> library(const Data& d, const Series& v, const Series& f_sim) {
  const Series &x = d["x_mm"], &session = d["session"], &t = d["t_s"];
  const std::size_t n = x.size();
  std::vector<Column> list;
  const auto add = [&](const char* name, const std::function<double(std::size_t)>& value) {
    Column column{name, Series(n)};
    for (std::size_t i = 0; i < n; ++i) column.values[i] = value(i);
    list.push_back(std::move(column));
  };
  const auto in = [&](std::size_t i) { return x[i] > 0.0; };
  const auto fresh = [&](std::size_t i) { return i == 0 || session[i] != session[i - 1]; };
  add("", [&](std::size_t i) { return f_sim[i] > 0.0 ? x[i] : 0.0; });
  add("", [&](std::size_t i) { return f_sim[i] > 0.0 ? v[i] : 0.0; });
  add("bias", [](std::size_t) { return 1.0; });
  add("drift", [&](std::size_t i) { return t[i]; });
  add("coulomb_friction", [&](std::size_t i) { return std::tanh(v[i] / 0.04); });
  add("stribeck_friction",
      [&](std::size_t i) { return std::tanh(v[i] / 0.04) * std::exp(-4.0 * v[i] * v[i]); });
  add("viscous_friction", [&](std::size_t i) { return v[i]; });
  const Series a = slope(v, 10), rise = slope(f_sim, 3);
  add("inertia", [&](std::size_t i) { return a[i]; });
  add("delay", [&](std::size_t i) { return -rise[i]; });
  double state = 0.0;
  add("low_pass", [&](std::size_t i) {
    return (state = fresh(i) ? f_sim[i] : state + 0.1 * (f_sim[i] - state)) - f_sim[i];
  });
  const double high = 0.85 * *std::max_element(f_sim.begin(), f_sim.end());
  add("saturation", [&](std::size_t i) { return std::min(0.0, high - f_sim[i]); });
  add("backlash", [&](std::size_t i) {
    state = fresh(i) ? x[i] : std::clamp(state, x[i] - 0.05, x[i] + 0.05);
    return in(i) ? state - x[i] : 0.0;
  });
  add("hysteresis", [&](std::size_t i) {
    return state =
               !in(i) || fresh(i) ? 0.0 : state + k_row_s * (v[i] - std::abs(v[i]) * state / 0.1);
  });
  for (const double tau : {0.45, 4.5})
    add("relaxation", [&, tau](std::size_t i) {
      return state = !in(i) || fresh(i) ? 0.0 : (state + k_row_s * v[i]) / (1.0 + k_row_s / tau);
    });
  add("series_compliance", [&](std::size_t i) {
    const double lag = 0.1 * d.c / d.k / k_row_s;
    state = !in(i) || fresh(i)
                ? 0.0
                : std::max(0.0, (d.k * x[i] + d.c * v[i] + lag * state) / (1.1 + lag));
    return state - f_sim[i];
  });
  add("nonlinear_stiffness", [&](std::size_t i) { return in(i) ? x[i] * std::log(x[i]) : 0.0; });
  add("hidden_layer", [&](std::size_t i) { return std::max(0.0, x[i] - 0.5); });
  add("graded_stiffness", [&](std::size_t i) { return in(i) ? x[i] * x[i] : 0.0; });
  add("feed_power_law",
      [&](std::size_t i) { return in(i) ? v[i] * std::log(std::abs(v[i]) + 1e-3) : 0.0; });
  for (const double one : std::set<double>(session.begin(), session.end()))
    add("contact_offset",
        [&, one](std::size_t i) { return in(i) && session[i] == one ? 1.0 : 0.0; });
  if (d.has("posture_deg"))
    add("gravity_posture",
        [&](std::size_t i) { return std::sin(d["posture_deg"][i] * k_pi / 180.0); });
  if (d.has("fy_n"))
    for (const char* side : {"fy_n", "fz_n"})
      add("cross_talk", [&, side](std::size_t i) { return d[side][i]; });
  if (d.has("approach_deg"))
    for (const double turn : {0.0, 90.0})
      add("anisotropy", [&, turn](std::size_t i) {
        return f_sim[i] * std::cos((2.0 * d["approach_deg"][i] - turn) * k_pi / 180.0);
      });
  if (d.has("spindle_rpm")) {
    const Series& rpm = d["spindle_rpm"];
    add("edge_force", [&](std::size_t i) { return in(i) && rpm[i] > 0.0 ? 1.0 : 0.0; });
    for (const double turn : {0.0, 0.5 * k_pi})
      add("run_out", [&, turn](std::size_t i) {
        return in(i) && rpm[i] > 0.0 ? std::cos(2.0 * k_pi * rpm[i] / 60.0 * t[i] - turn) : 0.0;
      });
  }
  if (d.has("removed_mm3") && d.has("bur_id")) {
    const Series &removed = d["removed_mm3"], &bur = d["bur_id"];
    add("wear", [&](std::size_t i) {
      if (i == 0 || bur[i] != bur[i - 1]) state = removed[i];
      return f_sim[i] * (removed[i] - state);
    });
  }
  if (d.has("wet")) add("coolant", [&](std::size_t i) { return f_sim[i] * d["wet"][i]; });
  if (d.has("temperature_c"))
    add("thermal_softening",
        [&](std::size_t i) { return f_sim[i] * (d["temperature_c"][i] - d["temperature_c"][0]); });
  std::erase_if(list, [](const Column& c) {
    return std::all_of(c.values.begin(), c.values.end(), [](double value) { return value == 0.0; });
  });
  return list;
}

/// Normal equations of all columns, scaled to root mean square 1, with the residual last.
struct Moments {
  std::size_t size = 0;
  std::vector<Series> product;
};

Moments moments(std::vector<Column>& list, const Series& residual) {
  const double n = static_cast<double>(residual.size());
  for (Column& c : list) {
    double square = 0.0;
    for (const double value : c.values) square += value * value;
    for (double& value : c.values) value /= std::sqrt(square / n);
  }
  Moments m{list.size(), std::vector<Series>(list.size() + 1, Series(list.size() + 1, 0.0))};
  for (std::size_t a = 0; a <= m.size; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      const Series &left = a < m.size ? list[a].values : residual,
                   &right = b < m.size ? list[b].values : residual;
      double sum = 0.0;
      for (std::size_t i = 0; i < residual.size(); ++i) sum += left[i] * right[i];
      m.product[a][b] = m.product[b][a] = sum / n;
    }
  return m;
}

struct Fit {
  Series weight;  ///< of the chosen columns, N (root mean square of their parts)
  double mean_square = 0.0;
};

/// Least squares over the chosen columns by Cholesky's factorisation, with a ridge that only keeps
/// it solvable.
Fit fit(const Moments& m, const std::vector<std::size_t>& chosen) {
  const std::size_t p = chosen.size();
  std::vector<Series> low(p, Series(p, 0.0));
  Series y(p), w(p);
  for (std::size_t i = 0; i < p; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = m.product[chosen[i]][chosen[j]] + (i == j ? 1e-9 : 0.0);
      for (std::size_t q = 0; q < j; ++q) sum -= low[i][q] * low[j][q];
      low[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / low[j][j];
    }
    double sum = m.product[chosen[i]][m.size];
    for (std::size_t q = 0; q < i; ++q) sum -= low[i][q] * y[q];
    y[i] = sum / low[i][i];
  }
  Fit out{Series(p), m.product[m.size][m.size]};
  for (std::size_t i = p; i-- > 0;) {
    double sum = y[i];
    for (std::size_t q = i + 1; q < p; ++q) sum -= low[q][i] * out.weight[q];
    out.weight[i] = sum / low[i][i];
    out.mean_square -= y[i] * y[i];
  }
  return out;
}

std::vector<std::string> names_of(const std::vector<Column>& list,
                                  const std::vector<std::size_t>& chosen) {
  std::set<std::string> names;
  for (const std::size_t i : chosen)
    if (!list[i].name.empty()) names.insert(list[i].name);
  return {names.begin(), names.end()};
}

}  // namespace

SimplerAnswers ask_simpler(const std::filesystem::path& folder) {
  const Data d = read(folder);
  const Series& x = d["x_mm"];
  const Series v = d.has("v_mm_s") ? d["v_mm_s"] : slope(x, 15);
  Series f_sim(x.size()), residual(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    f_sim[i] = x[i] > 0.0 ? std::max(0.0, d.k * x[i] + d.c * v[i]) : 0.0;
    residual[i] = d["f_n"][i] - f_sim[i];
  }
  std::vector<Column> list = library(d, v, f_sim);
  const Moments m = moments(list, residual);
  SimplerAnswers answers;

  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < list.size(); ++i) chosen.push_back(i);
  for (bool again = true;
       again;) {  // a part below 0.2 of the residual goes, and the rest is fitted again
    const Fit f = fit(m, chosen);
    const double least = 0.2 * std::sqrt(m.product[m.size][m.size]);
    std::vector<std::size_t> kept;
    for (std::size_t j = 0; j < chosen.size(); ++j)
      if (list[chosen[j]].name.empty() || std::abs(f.weight[j]) >= least) kept.push_back(chosen[j]);
    again = kept.size() < chosen.size();
    chosen = std::move(kept);
  }
  answers.thresholded = names_of(list, chosen);

  chosen.clear();
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name.empty()) chosen.push_back(i);
  const double n = static_cast<double>(x.size());
  double now = fit(m, chosen).mean_square;
  while (chosen.size() < list.size()) {
    double best = now;
    std::size_t pick = list.size();
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (std::find(chosen.begin(), chosen.end(), i) != chosen.end()) continue;
      std::vector<std::size_t> with = chosen;
      with.push_back(i);
      if (const double square = fit(m, with).mean_square; square < best) best = square, pick = i;
    }
    if (pick == list.size() || n * std::log(best / now) + std::log(n) >= 0.0) break;
    chosen.push_back(pick);
    now = best;
  }
  answers.forward_bic = names_of(list, chosen);
  return answers;
}

}  // namespace cavum::blind
