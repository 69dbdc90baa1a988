// A table of force over stiffness at constant speed, as the paper's Fig. 6 is one: no time, no
// position, no reversal. It says less than a recording, and this says how much less.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/lines.h"
#include "engine/base/statistics.h"
#include "engine/lab/explain/inference/explain.h"

namespace cavum::explain {

/// Rows of the table, in the order of the file.
struct StiffnessTable {
  std::vector<double> k_n_per_mm,
      f_n;  ///< k >= 0 that the simulation was given; steady force, resisting positive
  std::vector<double> v_mm_s;  ///< feed, > 0
  std::string origin;          ///< the comment lines above the header, in one
};

/// F = slope·k + root·√k + intercept; what a fit leaves out is 0.
struct TableFit {
  double slope_mm = 0, root = 0, intercept_n = 0, rms_n = 0;
  double slope_error = 0, root_error = 0, intercept_error_n = 0;  ///< one standard error
  double left_out_rms_n = 0;  ///< each row predicted by the others
  [[nodiscard]] double at(double k_n_per_mm) const;
};

struct TableExplanation {
  StiffnessTable table;
  TableFit line;              ///< k and an intercept
  TableFit voigt;             ///< k and √k: k X + c V with c ∝ √k, through zero at k = 0
  TableFit all;               ///< all three
  double predicted_root = 0;  ///< N per √(N/mm): 2 V, what c = 2 √k adds at the table's speed
  TableFit of_root;  ///< the line that fits predicted_root·√k best: what c V would pretend to be
  bool exact = false;  ///< the points lie on the line to a thousandth of a newton: taken from an
                       ///< equation, or rounded
  Explanation explanation;  ///< verdict, causes, what cannot be tested, notes, next experiment
};

/// True when the heading names columns k_n_per_mm and f_n, and no t_s. Throws Error(where:line,
/// ...) on a heading that cannot be read.
[[nodiscard]] bool is_stiffness_table(const std::string& csv, const std::string& where);
/// Columns k_n_per_mm, f_n and v_mm_s. Throws Error(where:line, ...) on a missing column, a cell
/// that is no number, k < 0 or v <= 0.
[[nodiscard]] StiffnessTable parse_stiffness_table(const std::string& csv,
                                                   const std::string& where);
/// Verdict `alias` when the table needs an intercept, else `not_testable`; `data_fault` below five
/// rows or four stiffnesses.
[[nodiscard]] TableExplanation explain_table(const StiffnessTable& table);

[[nodiscard]] Lines to_text(const TableExplanation& explanation);
// The parts of it, which a page shows beside its picture.
[[nodiscard]] Message in_words(const TableExplanation& explanation);
[[nodiscard]] Lines law_rows(const TableExplanation& explanation);
/// The names of docs/contracts.md (JSON), and `table` beside it: the fits.
[[nodiscard]] nlohmann::json to_json(const TableExplanation& explanation);

}  // namespace cavum::explain
