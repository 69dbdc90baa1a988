#include "engine/explain/recording/recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/base/toml_reader.h"
#include "engine/explain/recording/layers.h"

namespace cavum::explain {
namespace {

constexpr std::size_t k_max_sessions = 1000;
constexpr CsvForm k_recording{.most_fields = 200,
                              .most_rows = 5'000'000,  // 7 hours at 200 Hz; beyond that memory, not time, is the limit
                              .field_word = "cells",
                              .plain_text = false};
constexpr std::array k_required{"t_s", "x_mm", "f_n"};

/// One column while it is read: numbers, or words numbered in order of appearance.
struct Reading {
  std::string name;
  bool all_numbers = false;  // whatever else a row holds, it must be a finite number
  std::vector<double> values{};
  std::map<std::string, double, std::less<>> words{};
  std::size_t missing = 0;

  void add(std::string_view cell, const CsvReader& in) {
    const std::optional<double> number = number_in_field(cell);
    if (!number && all_numbers) in.fail(fmt::format("'{}' in column {} is no finite number", one_line(cell), name), "correct or remove the row");
    values.push_back(number ? *number : is_missing(cell) ? last_after_missing() : word(cell));
  }

 private:
  static bool is_missing(std::string_view cell) { return cell.empty() || cell == "nan" || cell == "NaN" || cell == "NA"; }
  double last_after_missing() {
    ++missing;
    return values.empty() ? 0.0 : values.back();
  }
  double word(std::string_view cell) { return words.emplace(std::string(cell), static_cast<double>(words.size())).first->second; }
};

/// A column for each field of the heading, under the name that we give it.
std::vector<Reading> columns_of(const CsvReader& heading, const ColumnNames& names) {
  std::vector<Reading> out;
  for (const std::string_view theirs : heading.fields()) {
    const auto mapped = std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == theirs; });
    const std::string name = mapped != names.end() ? mapped->first : std::string(theirs);
    if (std::any_of(out.begin(), out.end(), [&](const Reading& c) { return c.name == name; }))
      heading.fail(fmt::format("there are two columns '{}'", one_line(name)), "rename one");
    out.push_back({.name = name, .all_numbers = std::find(k_required.begin(), k_required.end(), name) != k_required.end()});
  }
  return out;
}

/// Throws Error unless the columns that --column names and those that every recording has are there.
void require_columns(const CsvReader& heading, const std::vector<Reading>& columns, const ColumnNames& names, bool with_position) {
  const auto there = [&](const std::string& name) {
    return std::any_of(columns.begin(), columns.end(), [&](const Reading& c) { return c.name == name; });
  };
  for (const auto& [contract, theirs] : names)
    if (!there(contract)) heading.fail(fmt::format("there is no column '{}'", one_line(theirs)), "name a column of the header with --column");
  for (const std::string required : k_required)
    if (!there(required) && (with_position || required != "x_mm"))
      heading.fail(fmt::format("there is no column '{}'", required), fmt::format("rename it in the file, or use --column {}=NAME", required));
}

/// The row of `in` belongs to the session of that name, which begins with it where the one before had another name.
void add_row(std::vector<SessionRows>& sessions, std::string_view name, const CsvReader& in) {
  const Eigen::Index row = sessions.empty() ? 0 : sessions.back().end;
  if (sessions.empty() || sessions.back().name != name) {
    if (std::any_of(sessions.begin(), sessions.end(), [&](const SessionRows& s) { return s.name == name; }))
      in.fail(fmt::format("session '{}' is in two places", one_line(name)), "sort the rows by session, then by time");
    if (sessions.size() == k_max_sessions)
      in.fail(fmt::format("has more than {} sessions", k_max_sessions), "give column 'session' a name for each run, not for each row");
    sessions.push_back({std::string(name), row, row});
  }
  sessions.back().end = row + 1;
}

/// Puts a column that was read where it belongs.
void keep(const Reading& column, Recording& out) {
  const std::string shown = fmt::format("column '{}'", one_line(column.name));
  if (column.missing == column.values.size()) {
    out.notes.push_back(shown + " is empty and left out");
    return;
  }
  if (column.missing > 0) out.notes.push_back(fmt::format("{}: {} missing values repeat the last one", shown, column.missing));
  Series values = Eigen::Map<const Series>(column.values.data(), static_cast<Eigen::Index>(column.values.size()));
  const std::array<std::pair<const char*, Series*>, 4> places{{{"t_s", &out.t_s}, {"x_mm", &out.x_mm}, {"f_n", &out.f_n}, {"v_mm_s", &out.v_mm_s}}};
  for (const auto& [name, place] : places)
    if (column.name == name) {
      *place = std::move(values);
      return;
    }
  out.columns.emplace_back(one_line(column.name), std::move(values));
}

}  // namespace

const Series* Recording::column(const std::string& name) const {
  for (const auto& [n, values] : columns)
    if (n == name) return &values;
  return nullptr;
}

Recording parse_recording(const std::string& csv, const std::string& where, const ColumnNames& names, bool with_position) {
  CsvReader in(csv, where, k_recording);
  if (!in.next_row()) throw Error(where, "is empty", "give a CSV with a header such as session,t_s,x_mm,f_n");
  std::vector<Reading> columns = columns_of(in, names);
  require_columns(in, columns, names, with_position);
  const auto session =
      static_cast<std::size_t>(std::find_if(columns.begin(), columns.end(), [](const Reading& c) { return c.name == "session"; }) - columns.begin());
  const bool one_session = session == columns.size();

  Recording out;
  while (in.next_row()) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (i != session) columns[i].add(in.fields()[i], in);
    add_row(out.sessions, one_session ? "1" : in.fields()[session], in);
  }
  if (out.sessions.empty()) throw Error(where, "has a header and no rows", "give a recording");
  if (one_session) out.notes.push_back("no column 'session': everything is taken for one session");
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (i != session) keep(columns[i], out);
  return out;
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
        in.fail("layer_depths_mm", "holds something that is no depth", "give millimetres below the surface");
      rig.layer_depths_mm.push_back(*depth);
    }
  in.finish();
  return rig;
}

Recording read_recording(const std::string& path, const std::string& rig_path, const ColumnNames& names) {
  namespace fs = std::filesystem;
  Recording out = parse_recording(read_text_file(path, k_largest_table), path, names);
  const std::string beside = rig_path.empty() ? (fs::path(path).parent_path() / "rig.toml").string() : rig_path;
  std::error_code ignored;
  if (!rig_path.empty() || fs::exists(beside, ignored))
    out.rig = parse_rig(read_text_file(beside), beside);
  else
    out.notes.push_back("no rig.toml beside the recording: k, c and the quanta are found from the data");
  set_layers(out);
  return out;
}

}  // namespace cavum::explain
