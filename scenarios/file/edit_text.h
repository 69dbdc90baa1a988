// Single values of a scenario's text put in place of others, with every other byte left as the
// author wrote it: comments, order, spacing, line ends. An edit is a small change that can be taken
// back exactly; what it makes is read again before it is handed out, and holds what was wanted.
#pragma once

#include <cstddef>
#include <string>

namespace cavum::scenarios {

/// So many bytes of a text by others.
struct TextChange {
  std::size_t at = 0;             ///< of the first byte
  std::string removed, inserted;  ///< what stood there, what stands there afterwards
  [[nodiscard]] bool empty() const noexcept { return removed == inserted; }
};
/// `text` with the change made. It must hold `removed` at that place: throws Error.
[[nodiscard]] std::string with_change(const std::string& text, const TextChange& change);
[[nodiscard]] TextChange inverse(const TextChange& change);

/// As a number is written: at most 3 decimals, the shortest form of them ("1.8", "-0.05", "2").
[[nodiscard]] std::string written_number(double value);

// Places name a value from the top of the file, its tables and lists parted by '/':
// "zones/target/0/bottom/depth_mm", the first point of an outline
// "zones/target/0/outline/points_mm/0". `path` names the file in errors. All throw Error when the
// text is no TOML, when the place is of another kind than asked for, or (where nothing is added) is
// not there.

/// Puts a number where one stands, or adds the key at the end of its table, which must be there.
[[nodiscard]] TextChange set_number(const std::string& text, const std::string& path,
                                    const std::string& place, double value);
/// Puts a text in quotes where one stands. Throws Error for one that TOML cannot hold in plain
/// quotes: with a line's end or a control character.
[[nodiscard]] TextChange set_text(const std::string& text, const std::string& path,
                                  const std::string& place, const std::string& value);
/// The same as set_number for the first two numbers of a list (x and y); a third stays as it is.
[[nodiscard]] TextChange set_point(const std::string& text, const std::string& path,
                                   const std::string& place, double x_mm, double y_mm);
/// A new point of the list at `place`, before its point `index`, 0 up to as many as there are. The
/// list must hold a point already.
[[nodiscard]] TextChange insert_point(const std::string& text, const std::string& path,
                                      const std::string& place, std::size_t index, double x_mm,
                                      double y_mm);
/// Takes a point out of the list at `place`, with its comma; comments beside it stay. The last one
/// stays.
[[nodiscard]] TextChange remove_point(const std::string& text, const std::string& path,
                                      const std::string& place, std::size_t index);

}  // namespace cavum::scenarios
