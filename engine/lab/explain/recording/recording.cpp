#include "engine/lab/explain/recording/recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"
#include "engine/base/toml_reader.h"
#include "engine/lab/explain/recording/date_time.h"
#include "engine/lab/explain/recording/layers.h"
#include "engine/lab/explain/recording/table_rows.h"

namespace cavum::explain {
namespace {

/// One column beside the motion while it is read: numbers, or words numbered in order of
/// appearance.
struct ColumnValues {
  std::vector<double> values{};
  std::map<std::string, double, std::less<>> words{};
  std::size_t missing = 0;

  void add(std::string_view cell, Decimal decimal) {
    const std::optional<double> number = number_in(cell, decimal);
    values.push_back(number ? *number : is_missing(cell) ? last_after_missing() : word(cell));
  }

 private:
  double last_after_missing() {
    ++missing;
    return values.empty() ? 0.0 : values.back();
  }
  double word(std::string_view cell) {
    return words.emplace(std::string(cell), static_cast<double>(words.size())).first->second;
  }
};

Series as_series(const std::vector<double>& values) {
  return Eigen::Map<const Series>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// The row of `in` belongs to the session of that name, which begins with it where the one before
/// had another name.
void add_row(std::vector<SessionRows>& sessions, std::string_view name, const RowReader& in) {
  const Eigen::Index row = sessions.empty() ? 0 : sessions.back().end;
  if (sessions.empty() || sessions.back().name != name) {
    if (std::any_of(sessions.begin(), sessions.end(),
                    [&](const SessionRows& s) { return s.name == name; }))
      in.fail(FileError::inconsistent, msg("session '{}' is in two places", one_line(name)),
              msg("sort the rows by session, then by time"));
    if (sessions.size() == k_max_sessions)
      in.fail(FileError::too_large, msg("has more than {} sessions", k_max_sessions),
              msg("give column 'session' a name for each run, not for each row"));
    sessions.push_back({std::string(name), row, row});
  }
  sessions.back().end = row + 1;
}

/// Puts a column beside the motion where it belongs.
void keep(const std::string& name, const ColumnValues& column, Recording& out) {
  if (column.missing == column.values.size()) {
    out.notes.emplace_back("column_empty", std::vector{"column"},
                           msg("column '{}' is empty and left out", name));
    return;
  }
  if (column.missing > 0)
    out.notes.emplace_back(
        "values_missing", std::vector{"column", "values"},
        msg("column '{}': {} missing values repeat the last one", name, column.missing));
  out.columns.emplace_back(one_line(name), as_series(column.values));
}

Series* place_of(Role role, Recording& r) {
  const std::array places{&r.t_s, &r.x_mm, &r.v_mm_s, &r.f_n};
  return places[static_cast<std::size_t>(role)];
}

/// The number of one cell of the motion, in our unit, with the sign and the origin that were asked
/// for.
double motion_value(std::string_view cell, const ColumnReading& column, const Reading& reading,
                    const RowReader& in) {
  const std::optional<double> number = number_in(cell, reading.form.decimal);
  const double sign = column.negated ? -1.0 : 1.0;
  const double value = number ? *number * column.unit.factor : 0.0;
  if (!number || !std::isfinite(value))
    in.fail(
        FileError::malformed,
        msg("'{}' in column {} is no finite number", one_line(cell), contract_name(column.role)),
        msg("correct or remove the row"));
  return sign * (column.role == Role::position ? value - reading.surface_mm.value_or(0.0) : value);
}

/// Reads stamps, with the day before them where the day has a column of its own.
double stamp_s(const RowReader& in, const ColumnReading& column, const ColumnPlan& plan,
               StampReader& stamps) {
  const std::string_view cell = in.cells()[column.at];
  const bool joined = plan.date && !cell.empty() && cell.find(':') != std::string_view::npos &&
                      cell.find_first_of("-/T") == std::string_view::npos;
  const auto seconds = joined ? stamps.seconds(fmt::format("{} {}", in.cells()[*plan.date], cell))
                              : stamps.seconds(cell);
  if (seconds && std::isfinite(*seconds)) return *seconds;
  if (stamps.ambiguous())
    in.fail(FileError::inconsistent,
            msg("'{}' in column {} may mean two days: the day first, or the month first",
                one_line(cell), column.header.whole),
            msg("write the date as 2026-11-24, which is the same everywhere"));
  in.fail(FileError::malformed,
          msg("'{}' in column t_s is no finite number and no time stamp", one_line(cell)),
          msg("correct or remove the row"));
}

/// What was taken for granted, in words.
void note_reading(const Reading& reading, const StampReader& stamps, Recording& out) {
  for (const ColumnReading& c : reading.columns.motion) {
    if (c.role == Role::time) {
      if (stamps.kind() != StampReader::Kind::seconds)
        out.notes.emplace_back("time_stamps", std::vector{"column", "holds"},
                               msg("time: column '{}' holds {}", c.header.whole, stamps.words()));
      if (stamps.kind() != StampReader::Kind::seconds || c.unit.factor == 1.0) continue;
    }
    if (c.unit.mass_word)
      out.notes.emplace_back(
          "unit_of_mass", std::vector{"column", "unit", "one_weighs"},
          msg("UNIT: column '{}' is in {}, a mass: taken as the force that it weighs ({} for 1)",
              c.header.whole, c.header.unit, as_n(c.unit.factor, k_as_needed)));
    else if (c.unit.factor != 1.0)
      out.notes.emplace_back("unit_converted", std::vector{"column", "unit", "factor", "as"},
                             msg("unit: column '{}' is in {}: times {} for {}", c.header.whole,
                                 c.unit.shown, as_number(c.unit.factor), contract_name(c.role)));
    else if (!c.declared)
      out.notes.emplace_back("unit_assumed", std::vector{"column", "unit"},
                             msg("unit: column '{}' does not say its unit: taken as {}",
                                 c.header.whole, c.unit.shown));
    if (c.negated)
      out.notes.emplace_back(
          "negated", std::vector{"column"},
          msg("sign: column '{}' was counted the other way (--negate)", c.header.whole));
  }
}

}  // namespace

const Series* Recording::column(const std::string& name) const {
  for (const auto& [n, values] : columns)
    if (n == name) return &values;
  return nullptr;
}

Recording parse_recording_as(const std::string& csv, const std::string& where,
                             const ReadingOptions& options) {
  auto reading = std::make_shared<Reading>();
  reading->form = find_table_form(csv, where);
  reading->surface_mm = options.surface_mm;
  reading->lever_mm = options.lever_mm;
  RowReader in(csv, where, reading->form);
  std::vector<HeaderName> header;
  for (std::size_t i = 0; i < in.header().size(); ++i)
    header.push_back(read_header_name(in.header()[i], in.units()[i]));
  for (std::size_t i = 0; i < header.size(); ++i)
    if (header[i].whole.empty()) header[i].whole = fmt::format("column {}", i + 1);
  reading->columns = plan_columns(header, options, in.at());
  const ColumnPlan& plan = reading->columns;

  Recording out;
  const ColumnReading& time = *plan.of(Role::time);
  StampReader stamps(reading->form.decimal, time.unit.factor, time.declared);
  std::vector<std::vector<double>> motion(plan.motion.size());
  std::vector<ColumnValues> beside(header.size());
  std::vector<bool> is_beside(header.size(), true);
  for (const ColumnReading& c : plan.motion) is_beside[c.at] = false;
  for (const auto& other : {plan.session, plan.date})
    if (other) is_beside[*other] = false;
  while (in.next()) {
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const ColumnReading& c = plan.motion[i];
      motion[i].push_back(c.role == Role::time ? stamp_s(in, c, plan, stamps)
                                               : motion_value(in.cells()[c.at], c, *reading, in));
    }
    for (std::size_t i = 0; i < header.size(); ++i)
      if (is_beside[i]) beside[i].add(in.cells()[i], reading->form.decimal);
    add_row(out.sessions, plan.session ? in.cells()[*plan.session] : "1", in);
  }
  if (out.sessions.empty())
    throw Error(where, msg("has a header and no rows"), msg("give a recording"));
  if (!plan.session)
    out.notes.emplace_back("one_session",
                           msg("no column 'session': everything is taken for one session"));
  note_reading(*reading, stamps, out);
  for (std::size_t i = 0; i < motion.size(); ++i)
    *place_of(plan.motion[i].role, out) = as_series(motion[i]);
  for (std::size_t i = 0; i < header.size(); ++i)
    if (is_beside[i]) keep(plan.names[i], beside[i], out);
  reading->time_words = stamps.words();
  reading->stamped = stamps.kind() != StampReader::Kind::seconds;
  out.reading = std::move(reading);
  return out;
}

Recording parse_recording(const std::string& csv, const std::string& where,
                          const ColumnNames& names, bool with_position) {
  ReadingOptions options;
  options.names = names;
  options.with_position = with_position;
  return parse_recording_as(csv, where, options);
}

Rig parse_rig(const std::string& toml_text, const std::string& where) {
  const toml::table document = parse_toml(toml_text, where);
  TomlReader in(document, where);
  Rig rig;
  if (in.has("k_n_per_mm")) rig.k_n_per_mm = in.number("k_n_per_mm", 1e-6, 1e6);
  if (in.has("c_n_s_per_mm")) rig.c_n_s_per_mm = in.number("c_n_s_per_mm", 0, 1e6);
  rig.position_quantum_mm = in.number_or("position_quantum_mm", 0, 10, 0.0);
  rig.force_quantum_n = in.number_or("force_quantum_n", 0, 100, 0.0);
  if (in.has("force_limit_n")) rig.force_limit_n = in.number("force_limit_n", 1e-6, 1e9);
  if (const auto* depths = in.array("layer_depths_mm"))
    for (const auto& node : *depths) {
      const auto depth = node.value<double>();
      if (!depth || !(*depth >= 0.0 && *depth < 1e3))
        in.fail("layer_depths_mm", msg("holds something that is no depth"),
                msg("give millimetres below the surface"));
      rig.layer_depths_mm.push_back(*depth);
    }
  in.finish();
  return rig;
}

Recording read_recording(const std::string& path, const std::string& rig_path,
                         const ReadingOptions& options) {
  namespace fs = std::filesystem;
  Recording out = parse_recording_as(read_text_file(path, k_largest_table), path, options);
  const std::string beside =
      rig_path.empty() ? (fs::path(path).parent_path() / "rig.toml").string() : rig_path;
  std::error_code ignored;
  if (!rig_path.empty() || fs::exists(beside, ignored))
    out.rig = parse_rig(read_text_file(beside), beside);
  else
    out.notes.emplace_back(
        "no_rig",
        msg("no rig.toml beside the recording: k, c and the quanta are found from the data"));
  set_layers(out);
  return out;
}

}  // namespace cavum::explain
