#include "engine/lab/explain/inference/stiffness_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::explain {
namespace {

constexpr double k_exact_n = 1e-3;
constexpr double k_95 = 1.96;

constexpr CsvForm k_table{
    .most_fields = 200,
    .most_rows = 5000,  // each is left out in turn, which takes the square of their number
    .plain_text = false};

/// A column that each table has, and the least of its values; with `above` they are greater than
/// that.
struct TableColumn {
  const char* name;
  std::vector<double> StiffnessTable::*values;
  double least;
  bool above;
};
constexpr std::array k_columns{TableColumn{"k_n_per_mm", &StiffnessTable::k_n_per_mm, 0.0, false},
                               TableColumn{"f_n", &StiffnessTable::f_n, -1e9, false},
                               TableColumn{"v_mm_s", &StiffnessTable::v_mm_s, 0.0, true}};

/// Where a column stands; the number of columns when there is none of that name.
std::size_t place_of(const CsvReader& heading, std::string_view name) {
  return static_cast<std::size_t>(
      std::find(heading.fields().begin(), heading.fields().end(), name) - heading.fields().begin());
}
bool holds(const CsvReader& heading, std::string_view name) {
  return place_of(heading, name) < heading.fields().size();
}

double value_in(const CsvReader& row, std::size_t place, const TableColumn& column) {
  const std::string_view cell = row.fields()[place];
  const std::optional<double> v = number_in_field(cell);
  if (!v || *v < column.least || (column.above && *v == column.least))
    row.fail(msg("'{}' in column {} is no number in range", one_line(cell), column.name),
             msg("correct the row"));
  return *v;
}

/// Least squares on the columns asked for, without row `left_out`.
TableFit fitted(const StiffnessTable& t, bool root, bool intercept, std::ptrdiff_t left_out = -1) {
  std::vector<std::vector<double>> columns(1 + root + intercept);
  std::vector<double> y;
  for (std::size_t i = 0; i < t.f_n.size(); ++i) {
    if (static_cast<std::ptrdiff_t>(i) == left_out) continue;
    std::size_t at = 0;
    columns[at++].push_back(t.k_n_per_mm[i]);
    if (root) columns[at++].push_back(std::sqrt(t.k_n_per_mm[i]));
    if (intercept) columns[at++].push_back(1.0);
    y.push_back(t.f_n[i]);
  }
  const Fit f = fit_columns(columns, y);
  TableFit out;
  out.slope_mm = f.value[0];
  out.slope_error = f.error[0];
  if (root) out.root = f.value[1], out.root_error = f.error[1];
  if (intercept) out.intercept_n = f.value[1 + root], out.intercept_error_n = f.error[1 + root];
  out.rms_n = f.rms;
  if (left_out >= 0) return out;
  double sum = 0.0;
  for (std::size_t i = 0; i < t.f_n.size(); ++i)
    sum += std::pow(
        t.f_n[i] - fitted(t, root, intercept, static_cast<std::ptrdiff_t>(i)).at(t.k_n_per_mm[i]),
        2);
  out.left_out_rms_n = std::sqrt(sum / static_cast<double>(t.f_n.size()));
  return out;
}

Interval interval(double value, double error) {
  return {value, value - k_95 * error, value + k_95 * error};
}

/// What the table says about the law, sentence by sentence.
Facts sentences(const TableExplanation& e) {
  const double v = e.table.v_mm_s.front(),
               most = *std::max_element(e.table.k_n_per_mm.begin(), e.table.k_n_per_mm.end());
  const bool one_speed = std::set<double>(e.table.v_mm_s.begin(), e.table.v_mm_s.end()).size() == 1;
  const double share =
      100.0 * std::min(1.0, e.of_root.intercept_n / std::max(1e-9, e.line.intercept_n));
  Facts out;
  out.emplace_back(
      "intercept", std::vector{"speed", "force_at_0"},
      msg("The Voigt law has no intercept: cutting steadily at V = {} it gives F = k V τ + c V, which is 0 N at k = 0 (eq. 5 makes c = 0 there "
          "too). The table has {} at k = 0, and no τ and no c can make it.",
          as_unit(v, cavum::Unit::mm_per_s), as_n(e.line.intercept_n, 3)));
  out.emplace_back(
      "offsets_alike",
      one_speed
          ? msg("Friction, bias and edge force cannot be told apart here: the crosshead goes one way, at one speed, always in contact and always "
                "cutting. "
                "Friction of the joints, a zero error of the load cell and a constant force of the cutting edges lift every row by the same amount.")
          : msg("Friction, bias and edge force cannot be told apart here: the crosshead goes one way, at speeds of one sign, always in contact and "
                "always "
                "cutting. Friction of the joints, a zero error of the load cell and a constant force of the cutting edges lift every row by the same "
                "amount."));
  out.emplace_back(
      "root_hides", std::vector{"root", "most", "at_k", "slope", "intercept", "share"},
      msg("c V with c = 2 √k adds {} √k N, {} at k = {}, and bends the row. A straight line laid through that bend alone has a slope of {} and an "
          "intercept of {}: so a line hides a √k as intercept and slope, yet it explains at most {} of the intercept here.",
          as_number(e.predicted_root, 3), as_n(e.predicted_root * std::sqrt(most), 3),
          as_number(most), as_mm(e.of_root.slope_mm, 3), as_n(e.of_root.intercept_n, 3),
          as_percent(share)));
  out.emplace_back(
      "without_intercept",
      std::vector{"root", "slope", "rms", "at_0", "root_with_all", "root_published"},
      msg("Fitted without an intercept, k X + √k takes {} √k N and a slope of {} to imitate it, and still misses by {} rms and by {} at k = 0; "
          "with all three the table asks for {} √k N, where the published c V needs {}.",
          as_number(e.voigt.root, 3), as_mm(e.voigt.slope_mm, 3), as_n(e.voigt.rms_n, 3),
          as_n(e.line.intercept_n, 3),
          Number{e.all.root, cavum::Unit::none, 3, k_95 * e.all.root_error},
          as_number(e.predicted_root, 3)));
  if (std::fabs(e.all.root - e.predicted_root) >
      std::max(k_95 * e.all.root_error, 0.1 * e.predicted_root))
    out.emplace_back(
        "straight_row", std::vector{"slope", "time_constant", "instead_of"},
        msg("A straight row speaks against a force of c V with c = 2 √k. If it were there all the same, the slope of k X would be {}, and τ {} "
            "instead of {}.",
            as_mm(e.line.slope_mm - e.of_root.slope_mm, 3),
            as_s((e.line.slope_mm - e.of_root.slope_mm) / v, 2), as_s(e.line.slope_mm / v, 2)));
  if (e.exact)
    out.emplace_back(
        "exact",
        msg("The points lie on the line to a thousandth of a newton, as points taken from an equation do: the intervals say nothing about the "
            "scatter of the measurement, and the straightness may be the equation's."));
  return out;
}

Message next_experiment() {
  return msg(
      "with the same cube and stylus: (1) read the load cell unloaded before and after: that is the bias; (2) stroke 20 mm to and fro in air at 0.25 "
      "mm/s, "
      "spindle off: what flips with the direction is friction, half the jump is its size; (3) the same at 0.05 and 1 mm/s: Stribeck or viscous "
      "friction; "
      "(4) press the k = 0 cube with the spindle off, then on: the step is the edge force; (5) repeat k = 0.2 and 1.2 at 0.1, 0.25 and 0.5 mm/s: c V "
      "grows "
      "with the speed, an intercept does not. Record time, position and force (cavum explain --protocol), not only the mean");
}

}  // namespace

double TableFit::at(double k_n_per_mm) const {
  return slope_mm * k_n_per_mm + root * std::sqrt(k_n_per_mm) + intercept_n;
}

bool is_stiffness_table(const std::string& csv, const std::string& where) {
  CsvReader in(csv, where, k_table);
  return in.next_row() && holds(in, "k_n_per_mm") && holds(in, "f_n") && !holds(in, "t_s");
}

StiffnessTable parse_stiffness_table(const std::string& csv, const std::string& where) {
  StiffnessTable out;
  CsvReader in(csv, where, k_table);
  CsvReader::Line line;
  while ((line = in.next()) == CsvReader::Line::comment)
    if (!in.comment().empty())
      out.origin += (out.origin.empty() ? "" : " ") + one_line(in.comment());

  std::array<std::size_t, k_columns.size()> places{};
  for (std::size_t i = 0; line == CsvReader::Line::row && i < places.size(); ++i) {
    if (!holds(in, k_columns[i].name))
      in.fail(msg("there is no column '{}'", k_columns[i].name),
              msg("a table has k_n_per_mm, f_n and v_mm_s"));
    places[i] = place_of(in, k_columns[i].name);
  }
  while (in.next_row())
    for (std::size_t i = 0; i < places.size(); ++i)
      (out.*k_columns[i].values).push_back(value_in(in, places[i], k_columns[i]));
  if (out.f_n.empty())
    throw Error(where, msg("has no rows"), msg("give a table of k_n_per_mm, f_n and v_mm_s"));
  return out;
}

TableExplanation explain_table(const StiffnessTable& table) {
  TableExplanation e;
  e.table = table;
  Explanation& explanation = e.explanation;
  if (table.f_n.size() < 5 ||
      std::set<double>(table.k_n_per_mm.begin(), table.k_n_per_mm.end()).size() < 4) {
    explanation.verdict = Verdict::data_fault;
    explanation.data_faults.push_back(
        {DataFault::Kind::too_few,
         msg("a line, a root and an intercept need five rows of four stiffnesses at least")});
    explanation.next_experiment = Fact("more_stiffnesses", msg("measure at more stiffnesses"));
    return e;
  }
  e.line = fitted(table, false, true);
  e.voigt = fitted(table, true, false);
  e.all = fitted(table, true, true);
  e.predicted_root = 2.0 * table.v_mm_s.front();
  StiffnessTable root = table;
  for (std::size_t i = 0; i < root.f_n.size(); ++i)
    root.f_n[i] = e.predicted_root * std::sqrt(root.k_n_per_mm[i]);
  e.of_root = fitted(root, false, true);
  e.exact = e.line.rms_n < k_exact_n;

  const double error = std::max(e.all.intercept_error_n, 1e-9), z = e.all.intercept_n / error;
  explanation.verdict = z > 2.6 ? Verdict::alias : Verdict::not_testable;
  if (explanation.verdict == Verdict::alias) {
    Cause c;
    c.term.mechanism = known_mechanism("bias");
    for (const char* other :
         {"coulomb_friction", "edge_force", "stribeck_friction", "viscous_friction"})
      c.aliases.emplace_back(other);
    c.parameters.emplace_back("bias_n", interval(e.line.intercept_n, e.line.intercept_error_n));
    c.p_value = normal_cdf(-z);
    c.effect_n = e.line.intercept_n;
    explanation.causes.push_back(c);
  }
  for (const auto& m : mechanisms()) {
    const auto in_set = [&](const Cause& c) {
      return c.term.mechanism == find_mechanism(m.name) ||
             std::find(c.aliases.begin(), c.aliases.end(), m.name) != c.aliases.end();
    };
    if (std::none_of(explanation.causes.begin(), explanation.causes.end(), in_set))
      explanation.not_testable.push_back({m.name, msg("a table of means at constant speed")});
  }
  explanation.gain.base_rmse_n = e.voigt.left_out_rms_n;
  explanation.gain.extended_rmse_n = e.line.left_out_rms_n;
  explanation.gain.noise_floor_n = e.line.rms_n;
  const double gained =
      100.0 * (1.0 - e.line.left_out_rms_n / std::max(1e-12, e.voigt.left_out_rms_n));
  explanation.gain.percent = {gained, gained, gained};
  explanation.notes = sentences(e);
  if (!table.origin.empty())
    explanation.notes.insert(
        explanation.notes.begin(),
        Fact("origin", {"says"}, msg("The table says of itself: {}", table.origin)));
  explanation.next_experiment = Fact("with_motion", next_experiment());
  return e;
}

Message in_words(const TableExplanation& e) {
  if (e.explanation.verdict == Verdict::data_fault) return in_words(e.explanation);
  return e.explanation.verdict == Verdict::alias
             ? msg("A force of {} is missing that does not depend on k: friction, a bias of the load cell or an edge force; the table cannot tell "
                   "which.",
                   as_n(e.line.intercept_n, 3))
             : msg("The table shows nothing beyond k X + c V, and could hardly show it.");
}

Lines law_rows(const TableExplanation& e) {
  Lines out;
  const auto fit = [&out](const Message& name, const TableFit& f) {
    out.row({name,
             msg("F = {} k {} √k {}", as_number(f.slope_mm, 3),
                 Number{f.root, cavum::Unit::none, 3, 0, true},
                 Number{f.intercept_n, cavum::Unit::newton, 3, 0, true}),
             msg("rms {}, row left out {}", as_n(f.rms_n, 4), as_n(f.left_out_rms_n, 4))});
  };
  fit(msg("Voigt law, k X + c V"), e.voigt);
  fit(msg("k X and an intercept"), e.line);
  fit(msg("all three"), e.all);
  return out;
}

Lines to_text(const TableExplanation& e) {
  const Explanation& explanation = e.explanation;
  if (explanation.verdict == Verdict::data_fault) return to_text(explanation);
  Lines out;
  out.add(msg("verdict: {}. {}", word_of(explanation.verdict), in_words(e)));
  for (const auto& c : explanation.causes) {
    out.gap();
    out.add(msg(
        "cause: one of bias coulomb_friction edge_force stribeck_friction viscous_friction, {} at every k",
        as_n(c.effect_n, 4)));
    out.add(
        msg("none of them alone: these data hold no reversal, no stroke in air, one speed, and no spindle at rest"),
        2);
  }
  out.gap();
  out.append(law_rows(e), 2);
  out.gap();
  for (const auto& s : explanation.notes) out.add(msg("- {}", s.what()));
  out.gap();
  out.add(msg("next experiment: {}", explanation.next_experiment.what()));
  return out;
}

nlohmann::json to_json(const TableExplanation& e) {
  nlohmann::json j = to_json(e.explanation);
  const auto fit = [](const TableFit& f) {
    return nlohmann::json{{"slope_mm", f.slope_mm},
                          {"root", f.root},
                          {"intercept_n", f.intercept_n},
                          {"rms_n", f.rms_n},
                          {"left_out_rms_n", f.left_out_rms_n}};
  };
  j["base"]["k_n_per_mm"] = nullptr;
  j["base"]["c_n_s_per_mm"] = nullptr;
  j["table"] = {{"line", fit(e.line)},
                {"voigt", fit(e.voigt)},
                {"all", fit(e.all)},
                {"predicted_root", e.predicted_root},
                {"exact", e.exact}};
  return j;
}

}  // namespace cavum::explain
