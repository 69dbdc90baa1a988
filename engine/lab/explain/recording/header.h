// The names in the first line of a table: what stands for a name and what for a unit, and which of
// them somebody meant who wrote another.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/message.h"

namespace cavum::explain {

/// "Fz [N]" is the name Fz with the unit N, and so are "Fz (N)", "Fz/N", "Fz, N" and, less surely,
/// "Fz_N".
struct HeaderName {
  std::string whole;    ///< as it stands there, UTF-8 on one line
  std::string name;     ///< without its unit
  std::string unit;     ///< "" where there is none
  bool marked = false;  ///< the unit is in brackets, or behind / or a comma: it is meant as one,
                        ///< whether it is known or not
};

/// `line_unit`: what stands below it on a line of units; it goes before one in the name.
[[nodiscard]] HeaderName read_header_name(std::string_view cell, std::string_view line_unit = "");
/// Lower case letters and digits of a name, those of Latin-1 without their marks: "Prüf-Kraft" is
/// "prufkraft".
[[nodiscard]] std::string plain_letters(std::string_view name);
/// UTF-8 of text that may be Latin-1; control characters become blanks.
[[nodiscard]] std::string header_text(std::string_view bytes);
/// That of `names` which takes the fewest letters put in, left out, replaced or exchanged with a
/// neighbour; none where it would be more than a third of the longer one.
[[nodiscard]] std::optional<std::string> nearest_name(const std::vector<std::string>& names,
                                                      std::string_view wanted);
/// "'a', 'b' and 12 more".
[[nodiscard]] Message list_of_names(const std::vector<std::string>& names);

}  // namespace cavum::explain
