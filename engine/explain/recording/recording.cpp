#include "engine/explain/recording/recording.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/text.h"
#include "engine/base/toml_reader.h"
#include "engine/explain/recording/layers.h"

namespace cavum::explain {
namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t k_max_sessions = 1000, k_max_columns = 200;
constexpr std::size_t k_max_rows = 5'000'000;  // 7 hours at 200 Hz; beyond that memory, not time, is the limit

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t' || s.front() == '"')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r' || s.back() == '"')) s.remove_suffix(1);
  return s;
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t at = line.find(separator);
    out.push_back(trimmed(line.substr(0, at)));
    if (at == std::string_view::npos) return out;
    line.remove_prefix(at + 1);
  }
}

double number_in(std::string_view cell) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  double v = k_nan;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), v);
  return error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(v) ? v : k_nan;
}

/// One column while it is read: numbers, or words numbered in order of appearance.
struct Reading {
  std::string name;
  std::vector<double> values;
  std::map<std::string, double, std::less<>> words;
  std::size_t missing = 0, numbers = 0;

  void add(std::string_view cell) {
    double v = number_in(cell);
    const bool no_value = cell.empty() || cell == "nan" || cell == "NaN" || cell == "NA";
    if (std::isfinite(v)) {
      ++numbers;
    } else if (no_value) {
      ++missing;
      v = values.empty() ? 0.0 : values.back();
    } else {
      v = words.emplace(std::string(cell), static_cast<double>(words.size())).first->second;
    }
    values.push_back(v);
  }
};

Series series_of(const std::vector<double>& v) { return Eigen::Map<const Series>(v.data(), static_cast<Eigen::Index>(v.size())); }

}  // namespace

const Series* Recording::column(const std::string& name) const {
  for (const auto& [n, values] : columns)
    if (n == name) return &values;
  return nullptr;
}

Recording parse_recording(const std::string& csv, const std::string& where, const ColumnNames& names, bool with_position) {
  Recording out;
  std::map<std::string, std::string> ours;  // name in the file → name of the contract
  for (const auto& [contract, theirs] : names) ours[theirs] = contract;
  std::vector<Reading> read;
  std::vector<std::string> session_of_row;
  std::ptrdiff_t session_at = -1;
  std::size_t line_number = 0;
  char separator = ',';
  std::string_view rest = csv;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++line_number;
    const std::string_view content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    const std::string at = where + ":" + std::to_string(line_number);
    if (read.empty()) {
      for (const char c : {';', '\t'})
        if (line.find(',') == std::string_view::npos && line.find(c) != std::string_view::npos) separator = c;
      std::set<std::string> seen;
      for (const auto cell : cells_of(line, separator)) {
        const auto it = ours.find(std::string(cell));
        read.push_back({it == ours.end() ? std::string(cell) : it->second, {}, {}, 0, 0});
        if (!seen.insert(read.back().name).second) throw Error(at, "there are two columns '" + one_line(read.back().name) + "'", "rename one");
        if (read.size() > k_max_columns)
          throw Error(at, "has more than " + std::to_string(k_max_columns) + " columns", "leave out those that say nothing of the force");
        if (read.back().name == "session") session_at = static_cast<std::ptrdiff_t>(read.size()) - 1;
      }
      for (const auto& [contract, theirs] : names)
        if (!seen.contains(contract)) throw Error(at, "there is no column '" + one_line(theirs) + "'", "name a column of the header with --column");
      for (const char* required : {"t_s", "x_mm", "f_n"})
        if (!seen.contains(required) && (with_position || required != std::string_view("x_mm")))
          throw Error(at, std::string("there is no column '") + required + "'",
                      std::string("rename it in the file, or use --column ") + required + "=NAME");
      continue;
    }
    const auto cells = cells_of(line, separator);
    if (cells.size() != read.size())
      throw Error(at, "has " + std::to_string(cells.size()) + " cells, the header has " + std::to_string(read.size()), "complete the row");
    if (read.front().values.size() >= k_max_rows)
      throw Error(at, "the recording is longer than 5 million rows", "split it, or sample it more slowly");
    for (std::size_t i = 0; i < cells.size(); ++i) {
      Reading& column = read[i];
      if (column.name == "t_s" || column.name == "x_mm" || column.name == "f_n")
        if (!std::isfinite(number_in(cells[i])))
          throw Error(at, "'" + one_line(cells[i]) + "' in column " + column.name + " is no finite number", "correct or remove the row");
      column.add(cells[i]);
    }
    session_of_row.emplace_back(session_at >= 0 ? std::string(cells[static_cast<std::size_t>(session_at)]) : std::string("1"));
  }
  if (read.empty()) throw Error(where, "is empty", "give a CSV with a header such as session,t_s,x_mm,f_n");
  if (session_of_row.empty()) throw Error(where, "has a header and no rows", "give a recording");

  std::set<std::string> named;
  for (std::size_t i = 0; i < session_of_row.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (i == 0 || session_of_row[i] != session_of_row[i - 1]) {
      if (!named.insert(session_of_row[i]).second)
        throw Error(where, "session '" + one_line(session_of_row[i]) + "' is in two places", "sort the rows by session, then by time");
      if (named.size() > k_max_sessions)
        throw Error(where, "has more than " + std::to_string(k_max_sessions) + " sessions",
                    "give column 'session' a name for each run, not for each row");
      out.sessions.push_back({session_of_row[i], row, row});
    }
    out.sessions.back().end = row + 1;
  }
  if (session_at < 0) out.notes.push_back("no column 'session': everything is taken for one session");
  for (const auto& column : read) {
    if (column.name == "session") continue;
    Series values = series_of(column.values);
    if (column.missing == column.values.size()) {
      out.notes.push_back("column '" + one_line(column.name) + "' is empty and left out");
      continue;
    }
    if (column.missing > 0)
      out.notes.push_back("column '" + one_line(column.name) + "': " + std::to_string(column.missing) + " missing values repeat the last one");
    if (column.name == "t_s")
      out.t_s = std::move(values);
    else if (column.name == "x_mm")
      out.x_mm = std::move(values);
    else if (column.name == "f_n")
      out.f_n = std::move(values);
    else if (column.name == "v_mm_s")
      out.v_mm_s = std::move(values);
    else
      out.columns.emplace_back(one_line(column.name), std::move(values));
  }
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
