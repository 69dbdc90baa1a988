#include "tests/blind/score.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "engine/base/order.h"

namespace cavum::blind {
namespace {

bool among(const std::string& item, const std::string& list) {
  return ("|" + list + "|").find("|" + item + "|") != std::string::npos;
}
bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}
bool same(double a, double b) { return std::abs(a - b) < 1e-9; }

void compare_parameters(const std::vector<Parameter>& truth, const Cause& cause, Mark& m) {
  for (const auto& [name, estimate] : cause.parameters)
    for (const Parameter& p : truth)
      if (among(name, p.names)) {
        const bool angle = name == "phi0_deg";  // of period 180
        const double turn = angle ? 180.0 * std::round((estimate.value - p.value) / 180.0) : 0.0;
        m.errors.push_back(std::abs(estimate.value - turn - p.value) /
                           (angle ? 90.0 : std::abs(p.value)));
        m.covered.push_back(estimate.low - turn <= p.value && p.value <= estimate.high - turn);
      }
}

/// Of held-out error, in percent: what the generating model gains over the base when it sees the
/// motion that was recorded. With exact positions, or a measured speed and a quantum up to 0.01 mm,
/// nothing but the noise is left to it; else the base's error without the effect.
double possible_gain_percent(const Hidden& h, const Verdict& v) {
  const double base = v.base_rmse_n, noise2 = h.noise_n * h.noise_n;
  const double left2 = h.request.quantum_mm == 0.0 || (h.has_v && h.request.quantum_mm <= 0.01)
                           ? noise2
                           : std::max(noise2, base * base - h.effect_n * h.effect_n);
  return base > 0.0 ? 100.0 * std::max(0.0, 1.0 - std::sqrt(left2) / base) : 0.0;
}

std::string set_of(const Cause& c) {
  std::string text = c.mechanism;
  for (const std::string& a : c.aliases) text += "/" + a;
  return text;
}

std::string said(const Verdict& v) {
  if (!v.answered) return v.trouble.empty() ? "not asked" : "NO ANSWER " + v.trouble;
  std::string text = v.verdict;
  for (const Cause& c : v.causes) text += " " + set_of(c);
  if (!v.unexplained.empty()) text += " ?" + v.unexplained;
  for (const std::string& f : v.data_faults) text += " !" + f.substr(0, 70);
  return text;
}

}  // namespace

Mark mark(const Outcome& o) {
  Mark m;
  const Hidden& h = o.hidden;
  const Verdict& v = o.verdict;
  if (!v.answered) return m;
  const auto& names = h.request.names;
  m.causes = static_cast<int>(v.causes.size());
  for (const Cause& c : v.causes)
    m.true_causes +=
        std::any_of(names.begin(), names.end(), [&](const std::string& n) { return c.holds(n); });
  const auto held = [&](const std::string& n) {
    return std::any_of(v.causes.begin(), v.causes.end(),
                       [&](const Cause& c) { return c.holds(n); });
  };

  switch (h.request.kind) {
    case Kind::single:
    case Kind::pair:
      m.found = std::all_of(names.begin(), names.end(), held);
      for (std::size_t n = 0; n < names.size(); ++n)
        for (const Cause& c : v.causes)
          if (c.mechanism == names[n])
            compare_parameters(h.truth[n], c, m),
                m.exact = h.request.kind == Kind::single && c.aliases.empty();
      if (names[0] == "gain_error" && names.size() == 1) {
        const bool alone = std::any_of(v.causes.begin(), v.causes.end(), [](const Cause& c) {
          return c.mechanism == "gain_error" && c.aliases.empty();
        });
        m.found = !alone && (contains(v.not_testable, "gain_error") || held("gain_error"));
      } else if (const double possible = possible_gain_percent(h, v); possible > 0.0) {
        m.gain_ratio = v.gain_percent / possible;
      }
      break;
    case Kind::clean:
      m.found = v.causes.empty() && v.verdict != "data_fault";
      break;
    case Kind::outside:
      m.found = v.verdict == "unexplained" && among(v.unexplained, h.variable);
      break;
    case Kind::crosshead:
      m.found =
          (v.verdict == "alias" || v.verdict == "not_testable") && !v.next_experiment.empty() &&
          std::all_of(v.causes.begin(), v.causes.end(),
                      [](const Cause& c) { return !c.aliases.empty(); }) &&
          (v.causes.empty() || std::any_of(v.causes.begin(), v.causes.end(), [&](const Cause& c) {
             return c.mechanism == names[0] || contains(c.aliases, names[0]);
           }));
      break;
    case Kind::fault:
      m.found = v.verdict == "data_fault" && !v.data_faults.empty();
      break;
  }
  return m;
}

std::vector<Rate> rates(const std::vector<Outcome>& outcomes) {
  enum {
    full,
    exact,
    small,
    coarse,
    precise,
    within,
    covers,
    pair,
    clean0,
    clean1,
    clean2,
    outside,
    cross,
    fault,
    gain,
    untestable
  };
  std::vector<Rate> r{{"recall, size 1.0", 0.97},
                      {"exact name, size 1.0", 0.9},
                      {"recall, size 0.35, quantum 0 and 0.01", 0.9},
                      {"recall, size 0.35, quantum 0.055", 0.75},
                      {"precision, sizes 1.0 and 0.35", 0.95},
                      {"parameter within 10 %, size 1.0 (median)", 0.5},
                      {"interval covers, size 1.0", 0.9},
                      {"pairs at 0.6, both", 0.85},
                      {"clean, quantum 0: no cause", 0.95},
                      {"clean, quantum 0.01: no cause", 0.95},
                      {"clean, quantum 0.055: no cause", 0.95},
                      {"outside the library, right variable", 0.8},
                      {"crosshead: none or a set with the truth", 1.0},
                      {"fault recognised", 0.95},
                      {"gain at least 0.9 of the possible (median)", 0.5},
                      {"gain_error never named alone", 1.0}};
  for (const Outcome& o : outcomes) {
    const Request& q = o.hidden.request;
    const Mark m = mark(o);
    switch (q.kind) {
      case Kind::single:
        if (q.names[0] == "gain_error") {
          r[untestable].count(m.found);
          break;
        }
        if (same(q.size, 1.0)) {
          r[full].count(m.found), r[exact].count(m.exact);
          for (const double e : m.errors) r[within].count(e <= 0.1);
          for (const bool c : m.covered) r[covers].count(c);
        } else if (same(q.size, 0.35)) {
          r[same(q.quantum_mm, 0.055) ? coarse : small].count(m.found);
        }
        for (int c = 0; c < m.causes; ++c) r[precise].count(c < m.true_causes);
        if (m.gain_ratio != 0.0) r[gain].count(m.gain_ratio >= 0.9);
        break;
      case Kind::pair:
        r[pair].count(m.found);
        break;
      case Kind::clean:
        r[same(q.quantum_mm, 0.0)    ? clean0
          : same(q.quantum_mm, 0.01) ? clean1
                                     : clean2]
            .count(m.found);
        break;
      case Kind::outside:
        r[outside].count(m.found);
        break;
      case Kind::crosshead:
        r[cross].count(m.found);
        break;
      case Kind::fault:
        r[fault].count(m.found);
        break;
    }
  }
  return r;
}

void print_table(const std::vector<Outcome>& outcomes) {
  struct Cell {
    int n = 0, found = 0, exact = 0;
  };
  struct Row {
    std::map<std::pair<double, double>, Cell> cells;  // by size, largest first, and quantum
    std::vector<double> errors, gains;
    int covered = 0, intervals = 0;
    std::map<std::string, int> otherwise;
  };
  std::map<std::pair<int, std::string>, Row> rows;
  for (const Outcome& o : outcomes) {
    const Request& q = o.hidden.request;
    const Mark m = mark(o);
    Row& row = rows[{static_cast<int>(q.kind), q.kind == Kind::pair ? "pairs"
                                               : q.names.empty()    ? "nothing"
                                                                    : q.names[0]}];
    Cell& cell = row.cells[{-q.size, q.quantum_mm}];
    ++cell.n, cell.found += m.found, cell.exact += m.exact;
    row.errors.insert(row.errors.end(), m.errors.begin(), m.errors.end());
    for (const bool c : m.covered) row.covered += c, ++row.intervals;
    if (m.gain_ratio != 0.0) row.gains.push_back(m.gain_ratio);
    if (!m.found) ++row.otherwise[said(o.verdict)];
  }
  std::printf(
      "\nfound/draws (exact name), by size @ quantum mm; error: median of parameters; cover: intervals that hold the truth; gain: median share of "
      "the possible\n");
  for (const auto& [key, row] : rows) {
    std::printf("%-10s %-20s", kind_name(static_cast<Kind>(key.first)), key.second.c_str());
    for (const auto& [at, cell] : row.cells) {
      if (at.first == 0.0)
        std::printf("  @%-5g %d/%d", at.second, cell.found, cell.n);
      else
        std::printf("  %g@%-5g %d/%d (%d)", -at.first, at.second, cell.found, cell.n, cell.exact);
    }
    if (!row.errors.empty()) std::printf("  error %.0f %%", 100.0 * cavum::median(row.errors));
    if (row.intervals > 0) std::printf("  cover %d/%d", row.covered, row.intervals);
    if (!row.gains.empty()) std::printf("  gain %.2f", cavum::median(row.gains));
    std::printf("\n");
    for (const auto& [text, count] : row.otherwise)
      std::printf("%34s %d x %s\n", "instead", count, text.c_str());
  }
}

void print_simpler(const std::vector<Outcome>& outcomes) {
  struct Tally {
    int recordings = 0, found = 0, named = 0, named_true = 0;
  };
  std::map<std::pair<std::string, std::string>, Tally> tallies;  // by what was hidden, and method
  for (const Outcome& o : outcomes) {
    const Request& q = o.hidden.request;
    if ((q.kind != Kind::single && q.kind != Kind::clean) ||
        (q.kind == Kind::single && q.names[0] == "gain_error"))
      continue;
    std::ostringstream group;
    group << (q.kind == Kind::clean ? "nothing hidden" : "one hidden, size ");
    if (q.kind == Kind::single) group << q.size;
    group << ", quantum " << q.quantum_mm << " mm";
    const auto count = [&](const char* method, int found, int named, int named_true) {
      Tally& t = tallies[{group.str(), method}];
      ++t.recordings, t.found += found, t.named += named, t.named_true += named_true;
    };
    const auto count_list = [&](const char* method, const std::vector<std::string>& names) {
      const bool found = q.kind == Kind::clean ? names.empty() : contains(names, q.names[0]);
      count(method, found, static_cast<int>(names.size()), q.kind == Kind::single && found);
    };
    const Mark m = mark(o);
    if (o.verdict.answered) count("explain", m.found, m.causes, m.true_causes);
    if (o.plain.answered) {
      const Mark plain = mark({o.hidden, o.plain, {}, {}});
      count("explain without surrogates", plain.found, plain.causes, plain.true_causes);
    }
    count_list("thresholded least squares", o.simpler.thresholded);
    count_list("forward BIC", o.simpler.forward_bic);
  }
  std::printf(
      "\nbeside simpler methods: recordings with the right answer (the truth named; nothing named where nothing is hidden), and causes named per "
      "recording\n");
  for (const auto& [key, t] : tallies) {
    std::printf("%-42s %-26s %4d/%-4d  %5.1f named", key.first.c_str(), key.second.c_str(), t.found,
                t.recordings, static_cast<double>(t.named) / t.recordings);
    if (t.named > 0) std::printf(", %3.0f %% of them true", 100.0 * t.named_true / t.named);
    std::printf("\n");
  }
}

std::string line_of(const Outcome& o) {
  const Request& q = o.hidden.request;
  const Mark m = mark(o);
  std::ostringstream text;
  text << (m.found ? "ok   " : "MISS ") << kind_name(q.kind);
  for (const std::string& n : q.names) text << " " << n;
  text << " size " << q.size << " quantum " << q.quantum_mm << (o.hidden.has_v ? " v" : "")
       << (o.hidden.heavy_tails ? " heavy" : "") << (o.hidden.reached ? "" : " SIZE-NOT-REACHED")
       << " | " << said(o.verdict);
  for (std::size_t n = 0; n < o.hidden.truth.size(); ++n)
    for (const Cause& c : o.verdict.causes) {
      if (c.mechanism != q.names[n]) continue;
      for (const Parameter& p : o.hidden.truth[n]) text << " | true " << p.names << " " << p.value;
      for (const auto& [name, e] : c.parameters)
        text << " | said " << name << " " << e.value << " [" << e.low << ", " << e.high << "]";
    }
  char tail[120];
  std::snprintf(tail, sizeof tail, " | gain %.1f %% (%.2f of possible) | %.0f s | case %llu",
                o.verdict.gain_percent, m.gain_ratio, o.verdict.seconds,
                static_cast<unsigned long long>(q.seed));
  text << tail;
  return text.str();
}

}  // namespace cavum::blind
