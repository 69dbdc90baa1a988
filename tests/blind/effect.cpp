#include "tests/blind/effect.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace cavum::blind {
namespace {

constexpr double k_pi = 3.141592653589793;
using Forces = std::vector<double>;

Forces each_row(const Motion& m, const std::function<double(std::size_t)>& f) {
  Forces out(m.size());
  for (std::size_t i = 0; i < m.size(); ++i) out[i] = f(i);
  return out;
}

/// What changes when the law inside the contact is `law(i)` and not k X + c V: neither of them
/// pulls.
Forces other_law(const Motion& m, const Base& b, const std::function<double(std::size_t)>& law) {
  return each_row(m, [&](std::size_t i) {
    if (!m.touching(i)) return 0.0;
    return std::max(0.0, law(i)) -
           std::max(0.0, b.k_n_per_mm * m.x_mm[i] + b.c_n_s_per_mm * m.v_mm_s[i]);
  });
}

bool new_session(const Motion& m, std::size_t i) {
  return i == 0 || m.session[i] != m.session[i - 1];
}
double sine_deg(double deg) { return std::sin(deg * k_pi / 180.0); }

Forces stribeck(const Motion& m, double fc, double fs, double vs, double v0) {
  return each_row(m, [&](std::size_t i) {
    const double v = m.v_mm_s[i];
    return std::tanh(v / v0) * (fc + (fs - fc) * std::exp(-(v / vs) * (v / vs)));
  });
}

Forces delayed(const Motion& m, const Forces& base, double tau_s) {
  return each_row(m, [&](std::size_t i) {
    const double steps = tau_s / k_step_s;
    const auto whole = static_cast<std::size_t>(steps);
    const double part = steps - static_cast<double>(whole);
    if (i < whole + 1 || m.session[i - whole - 1] != m.session[i]) return 0.0;
    return (1.0 - part) * base[i - whole] + part * base[i - whole - 1] - base[i];
  });
}

/// First-order lag, exact for a force that is straight between two fine steps.
Forces low_passed(const Motion& m, const Forces& base, double tau_s) {
  Forces out(m.size());
  const double keep = std::exp(-k_step_s / tau_s);
  double y = 0.0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (new_session(m, i)) {
      y = base[i];
    } else {
      const double behind = tau_s * (base[i] - base[i - 1]) / k_step_s;
      y = base[i] - behind + (y - base[i - 1] + behind) * keep;
    }
    out[i] = y - base[i];
  }
  return out;
}

/// Play of full width `gap_mm` between the encoder and the tip.
Forces with_play(const Motion& m, const Base& b, double gap_mm) {
  std::vector<double> tip(m.size());
  for (std::size_t i = 0; i < m.size(); ++i) {
    const double half = 0.5 * gap_mm, before = new_session(m, i) ? m.x_mm[i] : tip[i - 1];
    tip[i] = std::clamp(before, m.x_mm[i] - half, m.x_mm[i] + half);
  }
  return other_law(
      m, b, [&](std::size_t i) { return b.k_n_per_mm * tip[i] + b.c_n_s_per_mm * m.v_mm_s[i]; });
}

/// Bouc-Wen with n = 1 in contact: z' = V − |V| z / z0, force α z; z0 in mm.
Forces bouc_wen(const Motion& m, double z0_mm, double alpha_n_per_mm) {
  double z = 0.0;
  return each_row(m, [&](std::size_t i) {
    z = !m.touching(i) || new_session(m, i)
            ? 0.0
            : z + k_step_s * (m.v_mm_s[i] - std::abs(m.v_mm_s[i]) * z / z0_mm);
    return alpha_n_per_mm * z;
  });
}

/// A spring of 1/compliance behind the Voigt body: F = k (X − F/ks) + c (V − F'/ks), stepped
/// implicitly.
Forces in_series(const Motion& m, const Base& b, double mm_per_n) {
  double f = 0.0;
  Forces total = each_row(m, [&](std::size_t i) {
    if (!m.touching(i) || new_session(m, i)) return f = 0.0;
    const double lag = b.c_n_s_per_mm * mm_per_n / k_step_s;
    return f = std::max(0.0, (b.k_n_per_mm * m.x_mm[i] + b.c_n_s_per_mm * m.v_mm_s[i] + lag * f) /
                                 (1.0 + b.k_n_per_mm * mm_per_n + lag));
  });
  const Forces base = base_force_n(m, b);
  for (std::size_t i = 0; i < total.size(); ++i) total[i] -= base[i];
  return total;
}

/// ∫ e^(−(t−s)/τ) V ds since contact, mm.
Forces fading_depth(const Motion& m, double tau_s) {
  double z = 0.0;
  return each_row(m, [&](std::size_t i) {
    if (!m.touching(i) || new_session(m, i)) return z = 0.0;
    return z = (z + k_step_s * m.v_mm_s[i]) / (1.0 + k_step_s / tau_s);
  });
}

Forces line(const Motion& m, const std::function<double(std::size_t)>& hz) {
  return each_row(m, [&](std::size_t i) {
    if (!m.touching(i) || m.spindle_rpm[i] <= 0.0) return 0.0;
    return std::sin(2.0 * k_pi * hz(i) * m.t_s[i] +
                    m.phase_rad[static_cast<std::size_t>(m.session[i] - 1)]);
  });
}

}  // namespace

const std::vector<std::string>& mechanisms() {
  static const std::vector<std::string> names{"bias",
                                              "drift",
                                              "coulomb_friction",
                                              "stribeck_friction",
                                              "viscous_friction",
                                              "gravity_posture",
                                              "inertia",
                                              "gain_error",
                                              "cross_talk",
                                              "delay",
                                              "low_pass",
                                              "saturation",
                                              "backlash",
                                              "hysteresis",
                                              "series_compliance",
                                              "nonlinear_stiffness",
                                              "hidden_layer",
                                              "graded_stiffness",
                                              "anisotropy",
                                              "relaxation",
                                              "feed_power_law",
                                              "edge_force",
                                              "wear",
                                              "run_out",
                                              "chatter",
                                              "coolant",
                                              "thermal_softening",
                                              "contact_offset"};
  return names;
}

const std::vector<std::string>& outsiders() {
  static const std::vector<std::string> names{"ripple", "rezeroed", "unnamed_column",
                                              "lateral_square"};
  return names;
}

std::vector<double> base_force_n(const Motion& motion, const Base& base) {
  return each_row(motion, [&](std::size_t i) {
    return motion.touching(i) ? std::max(0.0, base.k_n_per_mm * motion.x_mm[i] +
                                                  base.c_n_s_per_mm * motion.v_mm_s[i])
                              : 0.0;
  });
}

Effect make_effect(const std::string& name, Draw& draw, const Motion& m, const Base& b) {
  const double k = b.k_n_per_mm, c = b.c_n_s_per_mm;
  Effect e;
  e.name = name;
  // force = amount · unit
  const auto scaled = [&](Forces unit, std::function<std::vector<Parameter>(double)> truth) {
    e.force_n = [unit = std::move(unit)](double amount) {
      Forces f = unit;
      for (double& v : f) v *= amount;
      return f;
    };
    e.truth = std::move(truth);
  };
  const auto curved = [&](double most, std::function<Forces(double)> force,
                          std::function<std::vector<Parameter>(double)> truth) {
    e.linear = false;
    e.most = most;
    e.force_n = std::move(force);
    e.truth = std::move(truth);
  };
  const auto just = [](std::string names) {
    return [names = std::move(names)](double amount) {
      return std::vector<Parameter>{{names, amount}};
    };
  };
  const double sign = draw.sign();
  const auto signed_just = [&](std::string names) {
    return [names = std::move(names), sign](double amount) {
      return std::vector<Parameter>{{names, sign * amount}};
    };
  };
  const auto base = [&] { return base_force_n(m, b); };

  if (name == "bias") {
    scaled(each_row(m, [&](std::size_t) { return sign; }), signed_just("bias_n|b_n|force_n"));
  } else if (name == "drift") {
    const double tau = draw.chance(0.5) ? 0.0 : draw.uniform(8.0, 20.0);
    scaled(each_row(m,
                    [&](std::size_t i) {
                      return sign * (tau > 0.0 ? 1.0 - std::exp(-m.t_s[i] / tau) : m.t_s[i]);
                    }),
           [=](double amount) {
             return tau > 0.0
                        ? std::vector<Parameter>{{"drift_n|amplitude_n|settled_n", sign * amount},
                                                 {"tau_s", tau}}
                        : std::vector<Parameter>{
                              {"rate_n_per_s|drift_n_per_s|slope_n_per_s", sign * amount}};
           });
  } else if (name == "coulomb_friction") {
    const double v0 = draw.uniform(0.02, 0.06);
    scaled(each_row(m, [&](std::size_t i) { return std::tanh(m.v_mm_s[i] / v0); }), just("fc_n"));
  } else if (name == "stribeck_friction") {
    const double v0 = draw.uniform(0.02, 0.05), vs = draw.uniform(0.3, 0.7),
                 ratio = draw.uniform(2.0, 3.5);
    scaled(stribeck(m, 1.0, ratio, vs, v0), [=](double amount) {
      return std::vector<Parameter>{{"fc_n", amount}, {"fs_n", amount * ratio}, {"vs_mm_s", vs}};
    });
  } else if (name == "viscous_friction") {
    scaled(m.v_mm_s, just("b_n_s_per_mm"));
  } else if (name == "gravity_posture") {
    scaled(each_row(m, [&](std::size_t i) { return sign * sine_deg(m.posture_deg[i]); }),
           signed_just("mg_n|weight_n|m_g_n"));
  } else if (name == "inertia") {
    scaled(m.a_mm_s2, [](double mass) {
      return std::vector<Parameter>{{"mass_n_s2_per_mm", mass}, {"mass_kg", 1000.0 * mass}};
    });
  } else if (name == "gain_error") {
    scaled(base(), signed_just("g|gain|fraction"));
  } else if (name == "cross_talk") {
    const double turn = draw.uniform(0.0, 2.0 * k_pi);
    scaled(each_row(m,
                    [&](std::size_t i) {
                      return std::cos(turn) * m.fy_n[i] + std::sin(turn) * m.fz_n[i];
                    }),
           [=](double amount) {
             return std::vector<Parameter>{{"a|ay|a_y", amount * std::cos(turn)},
                                           {"b|az|a_z", amount * std::sin(turn)}};
           });
  } else if (name == "delay") {
    curved(
        0.25, [&m, f = base()](double tau) { return delayed(m, f, tau); }, just("tau_s|delay_s"));
  } else if (name == "low_pass") {
    curved(
        0.5, [&m, f = base()](double tau) { return low_passed(m, f, tau); }, just("tau_s"));
  } else if (name == "saturation") {
    Forces f = base();
    const double highest = *std::max_element(f.begin(), f.end());
    curved(
        0.95 * highest,
        [&m, f, highest](double lost) {
          return each_row(m, [&](std::size_t i) { return std::min(0.0, highest - lost - f[i]); });
        },
        [=](double lost) {
          return std::vector<Parameter>{{"fmax_n|f_max_n|limit_n", highest - lost}};
        });
  } else if (name == "backlash") {
    curved(
        0.5, [&m, b](double gap) { return with_play(m, b, gap); },
        [](double gap) {
          return std::vector<Parameter>{{"b_mm", 0.5 * gap}, {"gap_mm|width_mm", gap}};
        });
  } else if (name == "hysteresis") {
    const double z0 = draw.log_uniform(0.05, 0.2);
    scaled(bouc_wen(m, z0, 1.0), [=](double alpha) {
      return std::vector<Parameter>{
          {"alpha_n_per_mm", alpha}, {"z0_mm|d_mm", z0}, {"fh_n|force_n", alpha * z0}};
    });
  } else if (name == "series_compliance") {
    curved(
        3.0, [&m, b](double mm_per_n) { return in_series(m, b, mm_per_n); },
        [](double mm_per_n) {
          return std::vector<Parameter>{{"ks_n_per_mm", 1.0 / mm_per_n},
                                        {"compliance_mm_per_n", mm_per_n}};
        });
  } else if (name == "nonlinear_stiffness") {
    const double way = draw.chance(0.7) ? 1.0 : -1.0;
    curved(
        way > 0.0 ? 1.5 : 0.6,
        [&m, b, k, c, way](double d) {
          return other_law(m, b, [&](std::size_t i) {
            return k * std::pow(m.x_mm[i], 1.0 + way * d) + c * m.v_mm_s[i];
          });
        },
        [=](double d) {
          return std::vector<Parameter>{{"m|exponent", 1.0 + way * d}};
        });
  } else if (name == "hidden_layer") {
    const double d0 = draw.uniform(0.3, 0.7);
    curved(
        3.0,
        [&m, b, k, c, d0](double dk) {
          return other_law(m, b, [&](std::size_t i) {
            return k * m.x_mm[i] + c * m.v_mm_s[i] + dk * std::max(0.0, m.x_mm[i] - d0);
          });
        },
        [=](double dk) {
          return std::vector<Parameter>{{"dk_n_per_mm", dk}, {"d0_mm", d0}};
        });
  } else if (name == "graded_stiffness") {
    curved(
        0.7,
        [&m, b, k, c, sign](double a) {
          return other_law(m, b, [&](std::size_t i) {
            return k * m.x_mm[i] * (1.0 - sign * a * m.x_mm[i]) + c * m.v_mm_s[i];
          });
        },
        signed_just("alpha_per_mm|alpha_1_per_mm"));
  } else if (name == "anisotropy") {
    const double phi0 = draw.uniform(0.0, 180.0);
    scaled(each_row(m,
                    [&, f = base()](std::size_t i) {
                      return f[i] * std::cos(2.0 * (m.approach_deg[i] - phi0) * k_pi / 180.0);
                    }),
           [=](double a) {
             return std::vector<Parameter>{{"epsilon|a|amplitude", a}, {"phi0_deg", phi0}};
           });
  } else if (name == "relaxation") {
    const bool two = draw.chance(0.33);
    const double tau1 = two ? draw.uniform(0.35, 0.6) : draw.log_uniform(0.4, 5.0),
                 tau2 = draw.uniform(4.0, 5.0);
    const Forces fast = fading_depth(m, tau1), slow = fading_depth(m, tau2);
    curved(
        5.0,
        [&m, b, k, c, two, fast, slow](double k1) {
          return other_law(m, b, [&](std::size_t i) {
            return k * m.x_mm[i] + c * m.v_mm_s[i] + k1 * (fast[i] + (two ? slow[i] : 0.0));
          });
        },
        [=](double k1) {
          std::vector<Parameter> p{{"k1_n_per_mm", k1}, {"tau1_s|tau_s", tau1}};
          if (two) p.push_back({"k2_n_per_mm", k1}), p.push_back({"tau2_s", tau2});
          return p;
        });
  } else if (name == "feed_power_law") {
    const double way = draw.chance(0.7) ? -1.0 : 1.0;
    curved(
        0.8,
        [&m, b, k, c, way](double d) {
          return other_law(m, b, [&](std::size_t i) {
            return k * m.x_mm[i] +
                   std::copysign(c * std::pow(std::abs(m.v_mm_s[i]), 1.0 + way * d), m.v_mm_s[i]);
          });
        },
        [=](double d) {
          return std::vector<Parameter>{{"n|exponent", 1.0 + way * d}};
        });
  } else if (name == "edge_force") {
    scaled(
        each_row(
            m, [&](std::size_t i) { return m.touching(i) && m.spindle_rpm[i] > 0.0 ? 1.0 : 0.0; }),
        just("fe_n|edge_n|force_n"));
  } else if (name == "wear") {
    scaled(each_row(m, [&, f = base()](std::size_t i) { return f[i] * m.worn_mm3[i]; }),
           just("w_per_mm3|per_mm3|wear_per_mm3|rate_per_mm3"));
  } else if (name == "run_out") {
    scaled(line(m, [&](std::size_t i) { return m.spindle_rpm[i] / 60.0; }), just("amplitude_n"));
  } else if (name == "chatter") {
    const double spindle_hz = *std::max_element(m.spindle_rpm.begin(), m.spindle_rpm.end()) / 60.0;
    const double alias_hz = std::abs(spindle_hz - 200.0 * std::round(spindle_hz / 200.0));
    double hz = alias_hz;
    while (std::abs(hz - alias_hz) < 4.0) hz = draw.uniform(15.0, 90.0);
    scaled(line(m, [&](std::size_t) { return hz; }), [=](double a) {
      return std::vector<Parameter>{{"amplitude_n", a}, {"frequency_hz|f_hz", hz}};
    });
  } else if (name == "coolant") {
    scaled(each_row(m, [&, f = base()](std::size_t i) { return sign * f[i] * m.wet[i]; }),
           signed_just("fraction|g"));
  } else if (name == "thermal_softening") {
    scaled(each_row(m,
                    [&, f = base()](std::size_t i) {
                      return -f[i] * (m.temperature_c[i] - m.temperature_c[0]);
                    }),
           just("per_k|a_per_k|per_c|a_per_c"));
  } else if (name == "contact_offset") {
    std::vector<double> part(
        static_cast<std::size_t>(*std::max_element(m.session.begin(), m.session.end())));
    for (double& p : part) p = draw.sign() * draw.uniform(0.3, 1.0);
    curved(
        0.4,
        [&m, b, k, c, part](double farthest) {
          const Forces believed = base_force_n(m, b);
          return each_row(m, [&](std::size_t i) {
            const double x =
                m.x_mm[i] + farthest * part[static_cast<std::size_t>(m.session[i] - 1)];
            return (x > 0.0 ? std::max(0.0, k * x + c * m.v_mm_s[i]) : 0.0) - believed[i];
          });
        },
        [=](double farthest) {
          std::vector<Parameter> p;
          for (std::size_t s = 0; s < part.size(); ++s)
            p.push_back({"delta_" + std::to_string(s + 1) + "_mm", farthest * part[s]});
          return p;
        });
  } else if (name == "ripple") {
    const double period = draw.uniform(0.25, 0.5), phase = draw.uniform(0.0, 2.0 * k_pi);
    e.variable = "x_mm";
    scaled(each_row(
               m, [&](std::size_t i) { return std::sin(2.0 * k_pi * m.x_mm[i] / period + phase); }),
           just(""));
  } else if (name == "rezeroed") {
    const auto at =
        static_cast<std::size_t>(draw.uniform(0.25, 0.75) * static_cast<double>(m.size()));
    e.variable = "t_s|session";
    scaled(each_row(m, [&](std::size_t i) { return i < at ? 0.0 : sign; }), just(""));
  } else if (name == "unnamed_column") {
    e.variable = "other";  // the file gives it another name
    scaled(m.other, just(""));
  } else if (name == "lateral_square") {
    e.variable = "fy_n";
    scaled(each_row(m, [&](std::size_t i) { return sign * m.fy_n[i] * m.fy_n[i]; }), just(""));
  } else {
    throw std::invalid_argument("no effect is called " + name);
  }
  return e;
}

double beyond_k_and_c_n(const Motion& m, const Base& b, const std::vector<double>& force_n) {
  double xx = 0.0, xv = 0.0, vv = 0.0, xf = 0.0, vf = 0.0, ff = 0.0;
  std::size_t rows = 0;
  for (std::size_t i = 0; i < m.size(); i += k_rows_per_row, ++rows) {
    const double f = force_n[i], x = m.x_mm[i], v = m.v_mm_s[i];
    ff += f * f;
    if (!m.touching(i) || b.k_n_per_mm * x + b.c_n_s_per_mm * v <= 0.0) continue;
    xx += x * x, xv += x * v, vv += v * v, xf += x * f, vf += v * f;
  }
  const double det = xx * vv - xv * xv;
  const double a = det > 0.0 ? (vv * xf - xv * vf) / det : 0.0,
               c = det > 0.0 ? (xx * vf - xv * xf) / det : 0.0;
  return std::sqrt(std::max(0.0, ff - a * xf - c * vf) / static_cast<double>(rows));
}

double amount_for(const Effect& effect, const Motion& motion, const Base& base, double target_n) {
  const auto size = [&](double amount) {
    return beyond_k_and_c_n(motion, base, effect.force_n(amount));
  };
  if (effect.linear) {
    const double one = size(1.0);
    return one > 0.0 ? target_n / one : 0.0;
  }
  // the first amount that is large enough: a spring in series becomes a softer k again when it is
  // very soft
  constexpr int k_scan = 24;
  double low = 0.0, high = 0.0;
  for (int step = 1; step <= k_scan && high == 0.0; ++step) {
    const double amount = effect.most * std::pow(1e-3, 1.0 - static_cast<double>(step) / k_scan);
    (size(amount) < target_n ? low : high) = amount;
  }
  if (high == 0.0) return 0.0;
  for (int step = 0; step < 16; ++step) {
    const double middle = 0.5 * (low + high);
    (size(middle) < target_n ? low : high) = middle;
  }
  return high;
}

}  // namespace cavum::blind
