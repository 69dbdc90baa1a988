// A recording of force over motion, as it comes from a rig: one row per sample, several sessions,
// and whatever else was written down beside it. Every other numeric column is kept, for it may be
// the explanation.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/fact.h"
#include "engine/base/message.h"
#include "engine/lab/explain/recording/columns.h"
#include "engine/lab/explain/recording/table_form.h"

namespace cavum::explain {

/// Values of one column, shape [rows].
using Series = Eigen::ArrayXd;

/// Rows [begin, end) of one session, in order of time.
struct SessionRows {
  std::string name;
  Eigen::Index begin = 0, end = 0;
};

/// rig.toml beside the recording: what is known about the rig. Absent values are found from the
/// data.
struct Rig {
  std::optional<double> k_n_per_mm, c_n_s_per_mm;  ///< > 0; starting values, about right
  double position_quantum_mm = 0.0;                ///< step of the encoder; 0 = none
  double force_quantum_n = 0.0;                    ///< step of the load cell's converter; 0 = none
  std::optional<double> force_limit_n;             ///< what the load cell can show at most
  std::vector<double> layer_depths_mm;             ///< known borders of layers, below the surface
};

/// How a table was read.
struct Reading {
  TableForm form;
  ColumnPlan columns;
  Message time_words;    ///< "numbers × 0.001 s", "date stamps, from the first row"
  bool stamped = false;  ///< times are stamps, not numbers
  std::optional<double> surface_mm, lever_mm;
};

struct Recording {
  std::vector<SessionRows> sessions;
  Series t_s, x_mm, f_n;  ///< penetration along the feed, negative in air; force resisting positive
  Series v_mm_s;          ///< measured speed; empty when there is none
  std::vector<std::pair<std::string, Series>>
      columns;  ///< all others in the order of the file; words are numbered in order of appearance
  Rig rig;
  Series relative_k, relative_c;  ///< k and c of the tissue touched over those of the reference,
                                  ///< row by row, > 0 or 0; empty = 1 everywhere
  bool friction_by_path = false;  ///< friction is against the tip's whole motion (slide_mm_s across
                                  ///< the feed), as the engine's; false: along the feed
  bool exact_motion =
      false;  ///< x and v come from the engine itself: nothing to estimate or to check
  bool specimens =
      false;    ///< sessions are different specimens, brought to a common scale (specimens.h)
  Facts notes;  ///< what was assumed while reading
  std::shared_ptr<const Reading>
      reading;  ///< how the table was read; null for a session and for what was made

  [[nodiscard]] Eigen::Index rows() const { return t_s.size(); }
  /// nullptr when there is no such column.
  [[nodiscard]] const Series* column(const std::string& name) const;
};

/// Contract name → name in the file, for files from elsewhere: {"x_mm", "displacement"}.
using ColumnNames = std::map<std::string, std::string>;

/// Parses a table (table_form.h) and brings its motion to s, mm, mm/s and N (columns.h). Missing
/// values of optional columns repeat the last one. Throws Error(where:line, ...) when a required
/// column is missing, or a required value is no finite number. Signs and origin are those of the
/// file unless the options change them: conventions.h judges them.
[[nodiscard]] Recording parse_recording_as(const std::string& csv, const std::string& where,
                                           const ReadingOptions& options);
/// The same with names alone. `with_position` false: a force over time, which needs no x_mm.
[[nodiscard]] Recording parse_recording(const std::string& csv, const std::string& where,
                                        const ColumnNames& names = {}, bool with_position = true);
/// Throws Error(where:line:column, ...) on unknown keys or values out of range.
[[nodiscard]] Rig parse_rig(const std::string& toml, const std::string& where);
/// CSV at `path` with rig.toml in the same folder (or at `rig_path`). Without a rig.toml everything
/// is found from the data, and a note says so. Layers get their own k and c (layers.h).
[[nodiscard]] Recording read_recording(const std::string& path, const std::string& rig_path = "",
                                       const ReadingOptions& options = {});

}  // namespace cavum::explain
