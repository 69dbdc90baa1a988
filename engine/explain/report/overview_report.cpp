#include "engine/explain/report/overview_report.h"

#include <fmt/core.h>

#include "engine/base/print.h"
#include "engine/base/text.h"

namespace cavum::explain {
namespace {

using nlohmann::json;

constexpr std::size_t k_most_sessions_in_words = 12;

json as_json(const ColumnSeen& c) {
  json j{{"name", c.name}, {"header", c.header}, {"low", c.low}, {"high", c.high}};
  if (c.unit.empty()) return j;
  j["unit"] = c.unit;
  j["factor"] = c.factor;
  j["unit_declared"] = c.declared;
  j["negated"] = c.negated;
  return j;
}

std::string line_of(const ColumnSeen& c) {
  const std::string from = c.header == c.name ? "" : fmt::format(" from '{}'", c.header);
  const std::string unit = c.unit.empty() ? ""
                                          : fmt::format(", {}{}{}{}", c.unit, c.factor == 1.0 ? "" : fmt::format(" × {}", plain_number(c.factor)),
                                                        c.declared ? "" : " (not said, taken for granted)", c.negated ? ", other way round" : "");
  return fmt::format("  {}{}{}: {} to {}\n", c.name, from, unit, plain_number(c.low), plain_number(c.high));
}

std::string contact_words(const Conventions& c) {
  if (!c.contact)
    return "contact: the force does not leave a level in air at one place: wholly in air, wholly in contact, or hidden by other forces\n";
  return fmt::format("contact: begins at x = {} mm, towards {} x; {} N in air, {} N at the far end\n", plain_number(c.contact->at_mm),
                     c.contact->towards > 0 ? "greater" : "smaller", plain_number(c.contact->air_n),
                     plain_number(c.contact->air_n + c.contact->reached_n));
}

}  // namespace

json to_json(const Overview& o) {
  json j{{"dry_run", true}, {"rows", o.rows}, {"rate_hz", o.rate_hz}, {"uneven", o.uneven}, {"longest_gap_s", o.longest_gap_s}};
  j["table"] = {{"separator", o.separator},
                {"decimal", o.decimal},
                {"header_line", o.header_line},
                {"lines_before", o.lines_before},
                {"unit_line", o.unit_line}};
  j["time"] = o.time_words;
  for (const SessionSeen& s : o.sessions) j["sessions"].push_back({{"name", one_line(s.name)}, {"rows", s.rows}, {"lasts_s", s.lasts_s}});
  for (const ColumnSeen& c : o.columns) j["columns"].push_back(as_json(c));
  j["position_quantum_mm"] = o.position_quantum_mm;
  j["force_quantum_n"] = o.force_quantum_n;
  j["contact"] = nullptr;
  if (const auto& c = o.conventions.contact)
    j["contact"] = {{"at_mm", c->at_mm}, {"air_n", c->air_n}, {"reached_n", c->reached_n}, {"towards", c->towards}};
  j["doubts"] = json::array();
  for (const Doubt& d : o.conventions.doubts) j["doubts"].push_back({{"what", d.what}, {"options", d.options}, {"clear", d.clear}});
  j["data_faults"] = o.faults;
  j["notes"] = o.notes;
  j["refused"] = o.refused();
  return j;
}

std::string to_text(const Overview& o) {
  std::string out =
      fmt::format("{} rows, {} session{}, {} Hz{}\n", o.rows, o.sessions.size(), o.sessions.size() == 1 ? "" : "s", plain_number(o.rate_hz),
                  o.uneven > 0.02 ? fmt::format(", stamps uneven by {} %", plain_number(100.0 * o.uneven)) : ", stamps even");
  out += fmt::format("longest gap between rows: {} s\n", plain_number(o.longest_gap_s));
  if (o.header_line > 0)
    out += fmt::format("table: header in line {} ({} before it), cells parted by {}, decimal {}{}\n", o.header_line, o.lines_before, o.separator,
                       o.decimal, o.unit_line ? ", units below the header" : "");
  out += fmt::format("time: {}\ncolumns:\n", o.time_words);
  for (const ColumnSeen& c : o.columns) out += line_of(c);
  out += "sessions:\n";
  for (std::size_t i = 0; i < o.sessions.size() && i < k_most_sessions_in_words; ++i)
    out += fmt::format("  {}: {} rows, {} s\n", one_line(o.sessions[i].name), o.sessions[i].rows, plain_number(o.sessions[i].lasts_s));
  if (o.sessions.size() > k_most_sessions_in_words) out += fmt::format("  and {} more\n", o.sessions.size() - k_most_sessions_in_words);
  out += fmt::format("steps: position {} mm, force {} N (0: none seen)\n", plain_number(o.position_quantum_mm), plain_number(o.force_quantum_n));
  out += contact_words(o.conventions);
  for (const Doubt& d : o.conventions.doubts) out += wrapped(fmt::format("{}: {}; give {}", d.clear ? "refused" : "doubt", d.what, d.options));
  for (const std::string& fault : o.faults) out += wrapped("fault: " + fault);
  for (const std::string& note : o.notes) out += wrapped("note: " + note);
  out += o.refused() ? "explain would not take it as it is\n" : "explain would take it\n";
  return out;
}

}  // namespace cavum::explain
