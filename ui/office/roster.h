// A class list as somebody pastes it or a spreadsheet saves it: encoding and separator are found,
// each column is either known, used as one that is known, or passed over because a person said so.
// Nothing is dropped in silence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grading/records/class_list.h"
#include "ui/office/wire.h"

namespace cavum::office {

/// What errors call a list that was pasted.
inline constexpr char k_list[] = "the list";
/// The answer for a column that is not needed.
inline constexpr char k_pass_over[] = "pass over";

struct Roster {
  bool headed =
      false;  ///< a name that is known stands in the first line; else it may be a candidate
  std::string encoding;  ///< UTF-8, UTF-16 or Windows-1252
  char separator = ',';  ///< comma, semicolon, tab, bar, or what a first line `sep=` names
  std::size_t rows = 0;  ///< below the heading
  std::vector<RosterColumn> columns;
  std::vector<records::Person> people;  ///< when every column is answered, and nothing is wrong
  std::vector<Message> problems;  ///< why there are none, each mistake; empty: a column waits for
                                  ///< its answer, or all is well
  [[nodiscard]] bool ready() const noexcept { return !people.empty(); }
};
/// What is wrong with a list, each mistake.
[[nodiscard]] std::vector<Message> mistakes_of(const Error& wrong);
/// `bytes` as they were sent; `answers` by the columns' places, an empty text for none. Several
/// columns that are used as `name` are joined in their order, with ", " between them: surname and
/// first name. Throws nothing of what is wrong with the list: it says so.
[[nodiscard]] Roster read_roster(const std::string& bytes, const std::vector<std::string>& answers);

}  // namespace cavum::office
