#include "engine/lab/explain/recording/overview.h"

#include <algorithm>
#include <cmath>

#include "engine/base/order.h"
#include "engine/lab/explain/recording/as_recorded.h"
#include "engine/lab/explain/recording/faults.h"

namespace cavum::explain {
namespace {

const Series& series_of(const Recording& r, Role role) {
  switch (role) {
    case Role::time:
      return r.t_s;
    case Role::position:
      return r.x_mm;
    case Role::speed:
      return r.v_mm_s;
    case Role::force:
      break;
  }
  return r.f_n;
}

void look_at_stamps(const Recording& r, Overview& out) {
  std::vector<double> intervals;
  double sum = 0.0, squares = 0.0;
  for (const SessionRows& s : r.sessions) {
    out.sessions.push_back({s.name, s.end - s.begin, r.t_s[s.end - 1] - r.t_s[s.begin]});
    for (Eigen::Index i = s.begin + 1; i < s.end; ++i) {
      const double d = r.t_s[i] - r.t_s[i - 1];
      intervals.push_back(d);
      sum += d, squares += d * d;
      out.longest_gap_s = std::max(out.longest_gap_s, d);
    }
  }
  if (intervals.empty()) return;
  const double n = static_cast<double>(intervals.size()), mean = sum / n,
               middle = median(std::move(intervals));
  out.rate_hz = middle > 0.0 ? 1.0 / middle : 0.0;
  out.uneven = mean > 0.0 ? std::sqrt(std::max(0.0, squares / n - mean * mean)) / mean : 0.0;
}

void look_at_columns(const Recording& r, Overview& out) {
  for (const Role role : {Role::time, Role::position, Role::speed, Role::force}) {
    const Series& values = series_of(r, role);
    const ColumnReading* column = r.reading ? r.reading->columns.of(role) : nullptr;
    if (values.size() == 0) continue;
    ColumnSeen seen{.name = contract_name(role),
                    .header = contract_name(role),
                    .unit = "",
                    .low = values.minCoeff(),
                    .high = values.maxCoeff()};
    if (column != nullptr) {
      seen.header = column->header.whole;
      seen.unit = column->unit.shown;
      seen.factor = column->unit.factor;
      seen.declared = column->declared || (role == Role::time && r.reading->stamped);
      seen.negated = column->negated;
    }
    out.columns.push_back(seen);
  }
  for (const auto& [name, values] : r.columns)
    out.columns.push_back({.name = name,
                           .header = name,
                           .unit = "",
                           .low = values.minCoeff(),
                           .high = values.maxCoeff()});
}

}  // namespace

Overview overview_of(const Recording& r) {
  Overview out;
  out.rows = r.rows();
  look_at_stamps(r, out);
  look_at_columns(r, out);
  if (r.reading) {
    const TableForm& form = r.reading->form;
    out.separator = form.separator == '\t'  ? "tab"
                    : form.separator == ' ' ? "white space"
                    : form.separator == ';' ? "semicolon"
                                            : "comma";
    out.decimal = form.decimal == Decimal::comma ? "comma" : "point";
    out.time_words = r.reading->time_words;
    out.header_line = form.header_line;
    out.lines_before = form.before.size();
    out.unit_line = form.unit_line;
  }
  out.position_quantum_mm = seen_quantum_mm(r);
  Recording force = r;  // the same search, in the force
  force.x_mm = r.f_n;
  force.rig.position_quantum_mm = 0.0;
  out.force_quantum_n = seen_quantum_mm(force);
  out.conventions = judge_conventions(r);
  if (out.conventions.first_clear() == nullptr)
    out.faults = data_faults(r);  // else they would be of another thing
  out.notes = r.notes;
  return out;
}

}  // namespace cavum::explain
