// What was understood of a recording before anything is explained: rows, sessions, rate, columns
// with units and ranges, signs, where contact begins, steps of the instruments, and what would be
// refused. For `cavum explain --dry-run`.
#pragma once

#include <string>
#include <vector>

#include "engine/lab/explain/recording/conventions.h"
#include "engine/lab/explain/recording/faults.h"

namespace cavum::explain {

struct ColumnSeen {
  std::string name, header;      ///< the contract's, and the file's
  std::string unit;              ///< of the file, "" for columns beside the motion
  double factor = 1.0;           ///< ours over the file's
  double low = 0.0, high = 0.0;  ///< in our unit, after signs and origin
  bool declared = false, negated = false;
};

struct SessionSeen {
  std::string name;
  Eigen::Index rows = 0;
  double lasts_s = 0.0;
};

struct Overview {
  Eigen::Index rows = 0;
  std::vector<SessionSeen> sessions;
  double rate_hz = 0.0;  ///< of the median interval; 0 where there is none
  double uneven = 0.0;   ///< scatter of the intervals over their mean
  double longest_gap_s = 0.0;
  std::string separator, decimal;
  Message time_words;
  int header_line = 0;
  std::size_t lines_before = 0;
  bool unit_line = false;
  std::vector<ColumnSeen> columns;                          ///< the motion first
  double position_quantum_mm = 0.0, force_quantum_n = 0.0;  ///< seen in the data; 0 = none
  Conventions conventions;
  std::vector<DataFault> faults;  ///< data_faults; not looked for where a doubt is clear
  Facts notes;
  /// `explain` would refuse it, or call it a data fault.
  [[nodiscard]] bool refused() const {
    return conventions.first_clear() != nullptr || !faults.empty();
  }
};

[[nodiscard]] Overview overview_of(const Recording& recording);

}  // namespace cavum::explain
