// Every door of the office's server, in one table: what is asked for, who may ask, and how much may be sent. A handler without a row here cannot be
// registered (site.h), and a row without a handler keeps the server from starting, so nothing is open that does not stand here.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace cavum::office {

/// What a person's account may be. Values are bits of Door::roles.
enum class Role : unsigned { officer = 1, examiner = 2, invigilator = 4, reader = 8 };
/// "officer" and so on.
[[nodiscard]] std::string_view name_of(Role role) noexcept;
/// None for another word.
[[nodiscard]] std::optional<Role> role_named(std::string_view name) noexcept;
[[nodiscard]] std::span<const Role> all_roles() noexcept;

/// Who has to be known before a door opens: nobody, a person who signed in, or an enrolled station that signed the request.
/// One who came from a learning platform has a cookie of his own; a form that a platform's page sends is let in as it is, and its handler checks it.
enum class Asks { nobody, person, station, came, form };

struct Door {
  std::string_view method;
  std::string_view path;  ///< to the letter; `*` at its end stands for 64 hexadecimal digits
  Asks asks = Asks::person;
  unsigned roles = 0;               ///< whose, where a person is asked for
  std::uint64_t largest_bytes = 0;  ///< of the body
  [[nodiscard]] bool lets(Role role) const noexcept { return (roles & static_cast<unsigned>(role)) != 0; }
  /// A person's request that changes something: it needs the token of the sign-in.
  [[nodiscard]] bool changes() const noexcept { return method != "GET"; }
};
[[nodiscard]] std::span<const Door> doors() noexcept;
/// The door of a request; null when there is none.
[[nodiscard]] const Door* door_for(std::string_view method, std::string_view path) noexcept;
/// What stands for `*` in the path of a door.
[[nodiscard]] std::string_view tail_of(const Door& door, std::string_view path) noexcept;

}  // namespace cavum::office
