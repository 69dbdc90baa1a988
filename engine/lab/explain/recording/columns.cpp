#include "engine/lab/explain/recording/columns.h"

#include <fmt/core.h>

#include <algorithm>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/file_error.h"
#include "engine/base/text.h"

namespace cavum::explain {
namespace {

constexpr std::array k_roles{Role::time, Role::position, Role::speed, Role::force};
constexpr std::array k_role_words{noop("time"), noop("position"), noop("speed"), noop("force")};

Term word_of(Role role) { return {k_role_words[static_cast<std::size_t>(role)]}; }

/// Names that machines write, in plain letters, parted by blanks; those of English, German, French
/// and Spanish machines.
std::string_view names_of(Role role) {
  switch (role) {
    case Role::time:
      return " time zeit timestamp timestamps elapsed elapsedtime testtime prufzeit testzeit uhrzeit temps tiempo datetime stamp clock timeofday "
             "xvalue ";
    case Role::position:
      return " position pos displacement disp extension travel depth penetration indentation crosshead crossheadposition weg standardweg "
             "traversenweg "
             "traverse eindringtiefe tiefe stroke hub way deplacement desplazamiento z zpos zposition angle winkel jointangle jointposition ";
    case Role::speed:
      return " speed velocity vel geschwindigkeit vitesse velocidad vz zspeed zvelocity angularvelocity jointvelocity ";
    case Role::force:
      return " force load kraft standardkraft prufkraft normalkraft normalforce axialforce fz fn fx fy fuerza loadcell torque moment drehmoment "
             "jointtorque effort ";
  }
  return "";
}

/// Plain letters of a name, and of what stands behind its last point: "field.position" is a
/// position.
std::array<std::string, 2> letters_of(const HeaderName& h) {
  const std::size_t point = h.name.rfind('.');
  return {plain_letters(h.name), point == std::string::npos
                                     ? ""
                                     : plain_letters(std::string_view(h.name).substr(point + 1))};
}

/// Columns that laws know by these names (contracts.md): never one of the motion unless an option
/// says so.
bool is_known_adjacent(std::string_view name) {
  constexpr std::array<std::string_view, 11> k_beside{
      "spindle_rpm", "wet",   "posture_deg",   "approach_deg", "removed_mm3", "bur_id",
      "site",        "layer", "temperature_c", "fy_n",         "fz_n"};
  return std::find(k_beside.begin(), k_beside.end(), name) != k_beside.end();
}

using Header = std::vector<HeaderName>;

std::vector<std::string> all_names(const Header& header) {
  std::vector<std::string> out;
  for (const HeaderName& h : header) out.push_back(h.whole);
  return out;
}

/// The column whose name is nearest; empty where none is near.
std::string nearest_column(const Header& header, std::string_view wanted) {
  std::vector<std::string> names;
  for (const HeaderName& h : header) names.insert(names.end(), {h.whole, h.name});
  const auto nearest = nearest_name(names, wanted);
  if (!nearest) return {};
  for (const HeaderName& h : header)
    if (h.whole == *nearest || h.name == *nearest) return h.whole;
  return {};
}

/// The column that an option names: as it stands there, without its unit, or in plain letters.
std::optional<std::size_t> column_named(const Header& header, const std::string& wanted) {
  const auto only = [&](const auto& is_it) -> std::optional<std::size_t> {
    const auto at = std::find_if(header.begin(), header.end(), is_it);
    if (at == header.end() || std::find_if(at + 1, header.end(), is_it) != header.end())
      return std::nullopt;
    return static_cast<std::size_t>(at - header.begin());
  };
  if (const auto at = only([&](const HeaderName& h) { return h.whole == wanted; })) return at;
  if (const auto at = only([&](const HeaderName& h) { return h.name == wanted; })) return at;
  const std::string letters = plain_letters(wanted);
  if (letters.empty()) return std::nullopt;
  if (const auto at = only([&](const HeaderName& h) { return plain_letters(h.whole) == letters; }))
    return at;
  return only([&](const HeaderName& h) { return plain_letters(h.name) == letters; });
}

std::size_t require_column(const Header& header, const std::string& wanted, const std::string& at,
                           const std::string& option) {
  if (const auto found = column_named(header, wanted)) return *found;
  const std::string near = nearest_column(header, wanted);
  throw Error(FileError::missing, Name{at},
              near.empty()
                  ? msg("there is no column '{}'", one_line(wanted))
                  : msg("there is no column '{}' (did you mean '{}'?)", one_line(wanted), near),
              msg("{} names a column of the header: {}", option, list_of_names(all_names(header))));
}

/// Its unit does not say that it is something else.
bool can_be(const HeaderName& h, Role role) {
  if (h.unit.empty() || find_unit(h.unit, role)) return true;
  return h.marked && !is_unit(h.unit) &&
         !is_other_unit(h.unit);  // an unknown unit is told, not passed over
}

/// Candidates of one step of likeness: 0 our own name, 1 its letter with another unit, 2 what
/// machines write.
std::vector<std::size_t> candidates(const Header& header, const std::vector<bool>& taken, Role role,
                                    int likeness) {
  std::vector<std::size_t> out;
  const std::string_view contract = contract_name(role);
  for (std::size_t i = 0; i < header.size(); ++i) {
    const HeaderName& h = header[i];
    if (taken[i] || (likeness > 0 && !can_be(h, role))) continue;
    const std::array<std::string, 2> letters = letters_of(h);
    const bool fits = likeness == 0 ? h.whole == contract
                      : likeness == 1
                          ? letters[0] == contract.substr(0, 1)
                          : std::any_of(letters.begin(), letters.end(), [&](const std::string& l) {
                              return !l.empty() && names_of(role).find(fmt::format(" {} ", l)) !=
                                                       std::string_view::npos;
                            });
    if (fits) out.push_back(i);
  }
  return out;
}

/// x beside y or z is an axis and not the feed.
bool is_axis(const Header& header, std::size_t at) {
  return plain_letters(header[at].name) == "x" &&
         std::any_of(header.begin(), header.end(), [&](const HeaderName& h) {
           const std::string letters = plain_letters(h.name);
           return (letters == "y" || letters == "z") && can_be(h, Role::position);
         });
}

std::optional<std::size_t> find_column(const Header& header, const std::vector<bool>& taken,
                                       Role role, const std::string& at) {
  for (int likeness = 0; likeness < 3; ++likeness) {
    std::vector<std::size_t> found = candidates(header, taken, role, likeness);
    if (role == Role::position && likeness == 1 && !found.empty() && is_axis(header, found.front()))
      for (std::size_t i = 0; i < header.size(); ++i)
        if (const std::string letters = plain_letters(header[i].name);
            !taken[i] && (letters == "y" || letters == "z"))
          found.push_back(i);
    if (likeness == 2 &&
        found.size() > 1)  // fz_n and its like are lateral forces unless nothing else is there
      if (std::vector<std::size_t> rest = found;
          std::erase_if(rest, [&](std::size_t i) { return is_known_adjacent(header[i].whole); }) >
              0 &&
          !rest.empty())
        found = rest;
    if (found.size() > 1) {
      std::vector<std::string> names;
      for (const std::size_t i : found) names.push_back(header[i].whole);
      throw Error(FileError::inconsistent, Name{at},
                  msg("several columns could be the {}: {}", word_of(role), list_of_names(names)),
                  msg("say which with --column {}=NAME",
                      std::string_view(contract_name(role)).substr(0, 1)));
    }
    if (!found.empty()) return found.front();
  }
  return std::nullopt;
}

[[noreturn]] void fail_missing(const Header& header, Role role, const std::string& at) {
  const std::string contract = contract_name(role);
  std::string near = nearest_column(header, contract);
  for (const std::string_view name : {"force", "load", "time", "position", "displacement"})
    if (near.empty() && names_of(role).find(fmt::format(" {} ", name)) != std::string_view::npos)
      near = nearest_column(header, name);
  throw Error(
      FileError::missing, Name{at},
      near.empty()
          ? msg("there is no column '{}', and none that is known to be the {}", contract,
                word_of(role))
          : msg("there is no column '{}', and none that is known to be the {} (did you mean '{}'?)",
                contract, word_of(role), near),
      msg("name it with --column {}=NAME; the header has {}", contract.substr(0, 1),
          list_of_names(all_names(header))));
}

/// Role or contract name that an option gives: "f" is "f_n".
std::string contract_of(const std::string& name) {
  const auto role = role_of(name);
  return role ? contract_name(*role) : name;
}

/// The unit of a column: that of an option, of the file, or ours.
void set_unit(ColumnReading& column, const ReadingOptions& options, const std::string& at) {
  const std::string contract = contract_name(column.role);
  std::string name = column.header.unit;
  for (const auto& [of, unit] : options.units)
    if (contract_of(of) == contract || of == column.header.whole || of == column.header.name)
      name = unit;
  const auto unit = name.empty() ? std::nullopt : find_unit(name, column.role);
  if (!name.empty() && !unit)
    throw Error(
        FileError::unknown, Name{at},
        msg("unit '{}' of column '{}' is none that is known for a {}", one_line(name),
            column.header.whole, word_of(column.role)),
        msg("give --unit {}=UNIT with one of {}", contract.substr(0, 1), known_units(column.role)));
  column.declared = unit.has_value();
  column.unit = unit.value_or(Unit{column.role == Role::time       ? "s"
                                   : column.role == Role::position ? "mm"
                                   : column.role == Role::speed    ? "mm/s"
                                                                   : "N",
                                   1.0, false, false});
  if (!column.unit.on_lever) return;
  if (!options.lever_mm)
    throw Error(
        at, msg("column '{}' is in {}", column.header.whole, column.unit.shown),
        msg("give the lever with --lever-mm L: angle × L is the way in mm, torque / L the force in N"));
  column.unit = at_lever(column.unit, column.role, *options.lever_mm);
}

void check_options(const Header& header, const ReadingOptions& options, const ColumnPlan& plan,
                   const std::string& at) {
  const auto there = [&](const std::string& name) {
    const auto role = role_of(name);
    return role && plan.of(*role) != nullptr;
  };
  for (const auto& given : options.units) {
    const std::string& of = given.first;
    const bool is_header = std::any_of(plan.motion.begin(), plan.motion.end(), [&](const auto& c) {
      return c.header.whole == of || c.header.name == of;
    });
    if (!there(of) && !is_header)
      throw Error(FileError::unknown, Name{at},
                  msg("--unit {}={}: there is no such column among time, position, speed and force",
                      one_line(of), one_line(given.second)),
                  msg("name t, x, v or f; the header has {}", list_of_names(all_names(header))));
  }
  for (const std::string& name : options.negate) {
    if (const auto role = role_of(name); !role || *role == Role::time)
      throw Error(fmt::format("--negate {}", one_line(name)),
                  msg("is no column that can be counted the other way"),
                  msg("write --negate x, v or f"));
    if (!there(name))
      throw Error(at, msg("--negate {}: the recording has no such column", name),
                  msg("leave it out"));
  }
}

}  // namespace

const ColumnReading* ColumnPlan::of(Role role) const {
  const auto at = std::find_if(motion.begin(), motion.end(),
                               [role](const ColumnReading& c) { return c.role == role; });
  return at == motion.end() ? nullptr : &*at;
}

ColumnPlan plan_columns(const Header& header, const ReadingOptions& options,
                        const std::string& at) {
  ColumnPlan plan;
  plan.names = all_names(header);
  std::vector<bool> taken(header.size(), false);
  std::map<Role, std::size_t> by_option;
  for (const auto& [given, theirs] : options.names) {
    const std::string contract = contract_of(given);
    const std::size_t column = require_column(header, theirs, at, "--column");
    if (taken[column])
      throw Error(at, msg("--column names '{}' twice", header[column].whole),
                  msg("name each column once"));
    taken[column] = true;
    plan.names[column] = contract;
    if (const auto role = role_of(contract)) by_option[*role] = column;
  }
  for (const Role role : k_roles) {
    if (role == Role::position && !options.with_position) continue;
    const auto given = by_option.find(role);
    const auto found = given != by_option.end() ? std::optional(given->second)
                                                : find_column(header, taken, role, at);
    if (!found && role != Role::speed) fail_missing(header, role, at);
    if (!found) continue;
    taken[*found] = true;
    plan.names[*found] = contract_name(role);
    ColumnReading column{.role = role,
                         .at = *found,
                         .header = header[*found],
                         .unit = {},
                         .by_option = given != by_option.end()};
    column.negated = std::any_of(options.negate.begin(), options.negate.end(),
                                 [&](const std::string& name) { return role_of(name) == role; });
    set_unit(column, options, at);
    plan.motion.push_back(column);
  }
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string letters = plain_letters(header[i].whole);
    if (plan.names[i] == "session" || (!taken[i] && letters == "session" && !plan.session))
      plan.session = i, plan.names[i] = "session";
    if (!taken[i] && !plan.date && (letters == "date" || letters == "datum" || letters == "fecha"))
      plan.date = i;
  }
  check_options(header, options, plan, at);
  for (std::size_t i = 0; i < plan.names.size(); ++i)
    if (std::find(plan.names.begin(), plan.names.begin() + static_cast<std::ptrdiff_t>(i),
                  plan.names[i]) != plan.names.begin() + static_cast<std::ptrdiff_t>(i))
      throw Error(at, msg("there are two columns '{}'", plan.names[i]), msg("rename one"));
  return plan;
}

}  // namespace cavum::explain
