#include "engine/lab/explain/report/overview_report.h"

#include <nlohmann/json.hpp>

#include "engine/base/message_json.h"
#include "engine/base/text.h"

namespace cavum::explain {
namespace {

using nlohmann::json;

constexpr std::size_t k_max_sessions_in_words = 12;

json as_json(const ColumnSeen& c) {
  json j{{"name", c.name}, {"header", c.header}, {"low", c.low}, {"high", c.high}};
  if (c.unit.empty()) return j;
  j["unit"] = c.unit;
  j["factor"] = c.factor;
  j["unit_declared"] = c.declared;
  j["negated"] = c.negated;
  return j;
}

Message line_of(const ColumnSeen& c) {
  List facts;
  if (c.header != c.name) facts.items.push_back(msg("from '{}'", c.header));
  if (!c.unit.empty())
    facts.items.push_back(c.factor == 1.0 ? Message(Name{c.unit})
                                          : msg("{} × {}", c.unit, as_number(c.factor)));
  if (!c.unit.empty() && !c.declared)
    facts.items.push_back(msg("unit not said, taken for granted"));
  if (c.negated) facts.items.push_back(msg("other way round"));
  return facts.items.empty()
             ? msg("{}: {} to {}", c.name, as_number(c.low), as_number(c.high))
             : msg("{}: {} to {} ({})", c.name, as_number(c.low), as_number(c.high), facts);
}

Message contact_words(const Conventions& c) {
  if (!c.contact)
    return msg(
        "contact: the force does not leave a level in air at one place: wholly in air, wholly in contact, or hidden by other forces");
  const Number at = as_mm(c.contact->at_mm, k_as_needed), air = as_n(c.contact->air_n, k_as_needed),
               end = as_n(c.contact->air_n + c.contact->reached_n, k_as_needed);
  return c.contact->towards > 0
             ? msg("contact: begins at x = {}, towards greater x; {} in air, {} at the far end", at,
                   air, end)
             : msg("contact: begins at x = {}, towards smaller x; {} in air, {} at the far end", at,
                   air, end);
}

Message separator_words(const std::string& name) {
  return name == "tab"         ? msg("tab")
         : name == "semicolon" ? msg("semicolon")
         : name == "comma"     ? msg("comma")
                               : msg("white space");
}

}  // namespace

json to_json(const Overview& o) {
  json j{{"dry_run", true},
         {"rows", o.rows},
         {"rate_hz", o.rate_hz},
         {"uneven", o.uneven},
         {"longest_gap_s", o.longest_gap_s}};
  j["table"] = {{"separator", o.separator},
                {"decimal", o.decimal},
                {"header_line", o.header_line},
                {"lines_before", o.lines_before},
                {"unit_line", o.unit_line}};
  j["time"] = o.time_words;
  for (const SessionSeen& s : o.sessions)
    j["sessions"].push_back({{"name", one_line(s.name)}, {"rows", s.rows}, {"lasts_s", s.lasts_s}});
  for (const ColumnSeen& c : o.columns) j["columns"].push_back(as_json(c));
  j["position_quantum_mm"] = o.position_quantum_mm;
  j["force_quantum_n"] = o.force_quantum_n;
  j["contact"] = nullptr;
  if (const auto& c = o.conventions.contact)
    j["contact"] = {{"at_mm", c->at_mm},
                    {"air_n", c->air_n},
                    {"reached_n", c->reached_n},
                    {"towards", c->towards}};
  j["doubts"] = json::array();
  for (const Doubt& d : o.conventions.doubts) {
    j["doubts"].push_back(fact_json(d.kind, d.what));
    j["doubts"].back().update({{"options", d.options}, {"clear", d.clear}});
  }
  j["data_faults"] = o.faults;
  j["notes"] = o.notes;
  j["refused"] = o.refused();
  return j;
}

Lines to_text(const Overview& o) {
  Lines out;
  out.add(msgn("{} rows, {} session", "{} rows, {} sessions",
               static_cast<std::int64_t>(o.sessions.size()), o.rows, o.sessions.size()));
  out.add(o.uneven > 0.02
              ? msg("rate: {}, stamps uneven by {}", as_unit(o.rate_hz, cavum::Unit::hz),
                    as_percent(100.0 * o.uneven, k_as_needed))
              : msg("rate: {}, stamps even", as_unit(o.rate_hz, cavum::Unit::hz)));
  out.add(msg("longest gap between rows: {}", as_s(o.longest_gap_s, k_as_needed)));
  if (o.header_line > 0) {
    out.add(msg("table: header in line {} ({} before it), cells parted by {}", o.header_line,
                o.lines_before, separator_words(o.separator)));
    out.add(o.decimal == "comma" ? msg("decimal sign: comma") : msg("decimal sign: point"), 2);
    if (o.unit_line) out.add(msg("units below the header"), 2);
  }
  out.add(msg("time: {}", o.time_words));
  out.add(msg("columns:"));
  for (const ColumnSeen& c : o.columns) out.add(line_of(c), 2);
  out.add(msg("sessions:"));
  for (std::size_t i = 0; i < o.sessions.size() && i < k_max_sessions_in_words; ++i)
    out.add(msg("{}: {} rows, {}", o.sessions[i].name, o.sessions[i].rows,
                as_s(o.sessions[i].lasts_s, k_as_needed)),
            2);
  if (o.sessions.size() > k_max_sessions_in_words)
    out.add(msg("{} more", o.sessions.size() - k_max_sessions_in_words), 2);
  out.add(msg("steps: position {}, force {} (0: none seen)",
              as_mm(o.position_quantum_mm, k_as_needed), as_n(o.force_quantum_n, k_as_needed)));
  out.add(contact_words(o.conventions));
  for (const Doubt& d : o.conventions.doubts)
    out.add(d.clear ? msg("refused: {}; give {}", d.what, d.options)
                    : msg("doubt: {}; give {}", d.what, d.options));
  for (const DataFault& fault : o.faults) out.add(msg("fault: {}", fault.what));
  for (const Fact& note : o.notes) out.add(msg("note: {}", note.what()));
  out.add(o.refused() ? msg("explain would not take it as it is") : msg("explain would take it"));
  return out;
}

}  // namespace cavum::explain
