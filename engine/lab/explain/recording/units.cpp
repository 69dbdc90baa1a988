#include "engine/lab/explain/recording/units.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numbers>

namespace cavum::explain {
namespace {

enum class Quantity { time, length, angle, force, torque };

struct KnownUnit {
  Quantity quantity;
  const char* shown;
  double factor;           // to s, mm, rad, N, N mm
  std::string_view names;  // parted by spaces, each with one around it
  bool mass_word = false;
};

constexpr double k_kgf_n = 9.80665, k_lbf_n = 4.4482216152605, k_in_mm = 25.4,
                 k_deg = std::numbers::pi / 180.0;

// MN is no mN, so capitals count; those that nobody means otherwise are listed. µ is written u
// here.
constexpr std::array k_known{
    KnownUnit{Quantity::time, "s", 1.0,
              " s sec secs second seconds sekunde sekunden Sekunden S Sec "},
    KnownUnit{Quantity::time, "ms", 1e-3, " ms msec millisecond milliseconds "},
    KnownUnit{Quantity::time, "µs", 1e-6, " us usec microsecond microseconds "},
    KnownUnit{Quantity::time, "min", 60.0, " min minute minutes "},
    KnownUnit{Quantity::time, "h", 3600.0, " h hour hours "},
    KnownUnit{Quantity::length, "m", 1e3, " m metre metres meter meters "},
    KnownUnit{Quantity::length, "cm", 10.0, " cm "},
    KnownUnit{Quantity::length, "mm", 1.0, " mm MM millimetre millimetres millimeter millimeters "},
    KnownUnit{Quantity::length, "µm", 1e-3,
              " um micron microns micrometre micrometres micrometer micrometers "},
    KnownUnit{Quantity::length, "nm", 1e-6, " nm "},
    KnownUnit{Quantity::length, "in", k_in_mm, " in inch inches IN \" "},
    KnownUnit{Quantity::length, "mil", 1e-3 * k_in_mm, " mil mils thou "},
    KnownUnit{Quantity::angle, "rad", 1.0, " rad radian radians "},
    KnownUnit{Quantity::angle, "mrad", 1e-3, " mrad "},
    KnownUnit{Quantity::angle, "deg", k_deg, " deg degree degrees grad Grad \xc2\xb0 \xb0 "},
    KnownUnit{Quantity::force, "N", 1.0, " N n newton newtons Newton Newtons "},
    KnownUnit{Quantity::force, "kN", 1e3, " kN kn KN "},
    KnownUnit{Quantity::force, "mN", 1e-3, " mN mn "},
    KnownUnit{Quantity::force, "gf", 1e-3 * k_kgf_n, " gf p pond "},
    KnownUnit{Quantity::force, "gf", 1e-3 * k_kgf_n, " g gram grams gr ", true},
    KnownUnit{Quantity::force, "kgf", k_kgf_n, " kgf kp "},
    KnownUnit{Quantity::force, "kgf", k_kgf_n, " kg kilogram kilograms ", true},
    KnownUnit{Quantity::force, "lbf", k_lbf_n, " lbf LBF "},
    KnownUnit{Quantity::force, "lbf", k_lbf_n, " lb lbs pound pounds ", true},
    KnownUnit{Quantity::force, "ozf", k_lbf_n / 16.0, " ozf "},
    KnownUnit{Quantity::force, "ozf", k_lbf_n / 16.0, " oz ounce ounces ", true},
    KnownUnit{Quantity::torque, "N m", 1e3, " Nm nm "},
    KnownUnit{Quantity::torque, "N mm", 1.0, " Nmm "},
    KnownUnit{Quantity::torque, "mN m", 1.0, " mNm "},
    KnownUnit{Quantity::torque, "N cm", 10.0, " Ncm "},
};
constexpr std::size_t k_longest_name = 40;

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Without blanks and signs of multiplication, µ as u, "s-1" and its like as "/s".
std::string plain_name(std::string_view given) {
  if (given.size() > k_longest_name) return "";
  std::string name(given);
  for (const char* micro : {"\xc2\xb5", "\xce\xbc", "\xb5"}) replace_all(name, micro, "u");
  for (const char* per_s : {"s\xe2\x81\xbb\xc2\xb9", "s^-1", "s-1", "s**-1"})
    replace_all(name, per_s, "/s");
  for (const char* nothing : {" ", "\xc2\xa0", "\xc2\xb7", "\xb7", "\xe2\x8b\x85", "*", "."})
    replace_all(name, nothing, "");
  replace_all(name, "//", "/");
  return name;
}

const KnownUnit* known(std::string_view name, Quantity quantity) {
  if (name.empty() || name.find(' ') != std::string_view::npos) return nullptr;
  for (const KnownUnit& unit : k_known)
    if (unit.quantity == quantity &&
        unit.names.find(fmt::format(" {} ", name)) != std::string_view::npos)
      return &unit;
  return nullptr;
}

std::optional<Unit> as_unit(const KnownUnit* unit, bool on_lever) {
  if (unit == nullptr) return std::nullopt;
  return Unit{unit->shown, unit->factor, on_lever, unit->mass_word};
}

/// "mm/min", or "mm_min" as the end of a name.
std::optional<Unit> find_speed(std::string_view name) {
  if (name == "mmps") name = "mm/s";
  const std::size_t at = name.find_first_of("/_");
  if (at == std::string_view::npos) return std::nullopt;
  const KnownUnit* per = known(name.substr(at + 1), Quantity::time);
  if (per == nullptr) return std::nullopt;
  for (const Quantity way : {Quantity::length, Quantity::angle})
    if (const KnownUnit* of = known(name.substr(0, at), way))
      return Unit{fmt::format("{}/{}", of->shown, per->shown), of->factor / per->factor,
                  way == Quantity::angle, false};
  return std::nullopt;
}

}  // namespace

std::optional<Unit> find_unit(std::string_view given, Role role) {
  const std::string name = plain_name(given);
  switch (role) {
    case Role::time:
      return as_unit(known(name, Quantity::time), false);
    case Role::position:
      if (auto length = as_unit(known(name, Quantity::length), false)) return length;
      return as_unit(known(name, Quantity::angle), true);
    case Role::force:
      if (auto force = as_unit(known(name, Quantity::force), false)) return force;
      return as_unit(known(name, Quantity::torque), true);
    case Role::speed:
      return find_speed(name);
  }
  return std::nullopt;
}

bool is_unit(std::string_view name) {
  constexpr std::array k_roles{Role::time, Role::position, Role::speed, Role::force};
  return std::any_of(k_roles.begin(), k_roles.end(),
                     [&](Role role) { return find_unit(name, role).has_value(); });
}

bool is_other_unit(std::string_view name) {
  constexpr std::array<std::string_view, 18> k_others{"rpm",
                                                      "1/min",
                                                      "U/min",
                                                      "Hz",
                                                      "kHz",
                                                      "\xc2\xb0"
                                                      "C",
                                                      "degC",
                                                      "C",
                                                      "K",
                                                      "%",
                                                      "A",
                                                      "mA",
                                                      "W",
                                                      "Pa",
                                                      "kPa",
                                                      "MPa",
                                                      "bar",
                                                      "g/s"};
  return std::find(k_others.begin(), k_others.end(), name) != k_others.end();
}

Unit at_lever(const Unit& unit, Role role, double lever_mm) {
  Unit out = unit;
  if (!unit.on_lever) return out;
  out.factor = role == Role::force ? unit.factor / lever_mm : unit.factor * lever_mm;
  out.on_lever = false;
  return out;
}

Message known_units(Role role) {
  if (role == Role::speed)
    return msg("{} (a length or an angle over a time)",
               "mm/s, mm/min, m/s, µm/s, in/s, rad/s, deg/s");
  std::vector<std::string> names;
  for (const KnownUnit& unit : k_known) {
    const bool fits = (role == Role::time && unit.quantity == Quantity::time) ||
                      (role == Role::position &&
                       (unit.quantity == Quantity::length || unit.quantity == Quantity::angle)) ||
                      (role == Role::force &&
                       (unit.quantity == Quantity::force || unit.quantity == Quantity::torque));
    if (fits && !unit.mass_word) names.emplace_back(unit.shown);
  }
  return role == Role::force ? msg("{}; g, kg, lb and oz as what they weigh", list_of(names))
                             : msg("{}", list_of(names));
}

const char* contract_name(Role role) noexcept {
  constexpr std::array k_names{"t_s", "x_mm", "v_mm_s", "f_n"};
  return k_names[static_cast<std::size_t>(role)];
}

std::optional<Role> role_of(std::string_view name) {
  for (const Role role : {Role::time, Role::position, Role::speed, Role::force})
    if (const std::string_view contract = contract_name(role);
        name == contract || name == contract.substr(0, 1))
      return role;
  return std::nullopt;
}

}  // namespace cavum::explain
