// Units that rigs write: N, lbf, grams; mm, inches, degrees on a lever; s, ms. Each by its factor
// to ours (N, mm, mm/s, s).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "engine/base/message.h"

namespace cavum::explain {

/// What a column of the motion is: one of the four that a recording is made of.
enum class Role { time, position, speed, force };

/// A unit as it applies to one role.
struct Unit {
  std::string shown;      ///< as we write it: "mN", "µm", "mm/min"
  double factor = 1.0;    ///< ours over theirs: value in s, mm, mm/s or N = factor × value
  bool on_lever = false;  ///< an angle or a torque: the factor holds at a lever of 1 mm
  bool mass_word =
      false;  ///< grams, kilograms, pounds or ounces: taken for the force that they weigh
};

/// The unit of that name, for that role; µ as U+00B5, U+03BC or the Latin-1 byte; none when it is
/// unknown or belongs to another quantity.
[[nodiscard]] std::optional<Unit> find_unit(std::string_view name, Role role);
/// True for a unit of any role: "mm", "N", "deg/s".
[[nodiscard]] bool is_unit(std::string_view name);
/// True for units of what is no time, way, speed or force: rpm, Hz, °C, %, A, MPa.
[[nodiscard]] bool is_other_unit(std::string_view name);
/// The same at a lever of `lever_mm` > 0: angle × lever, torque / lever.
[[nodiscard]] Unit at_lever(const Unit& unit, Role role, double lever_mm);
/// All that `find_unit` knows for a role, parted by commas.
[[nodiscard]] Message known_units(Role role);
/// "t_s", "x_mm", "v_mm_s", "f_n".
[[nodiscard]] const char* contract_name(Role role) noexcept;
/// The role of a short name (t, x, v, f) or of a contract's name; none for others.
[[nodiscard]] std::optional<Role> role_of(std::string_view name);

}  // namespace cavum::explain
