// The list of those who get tickets: a table of candidates with what each is granted.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/base/csv.h"
#include "engine/base/error.h"
#include "scenarios/file/accommodations.h"

namespace cavum::records {

/// Mistakes in rows of a list; the command line prints each on a line of its own.
class ListMistakes : public Error {
 public:
  ListMistakes(const std::string& where, std::vector<Error> mistakes);
  [[nodiscard]] const std::vector<Error>& mistakes() const noexcept { return mistakes_; }

 private:
  std::vector<Error> mistakes_;
};

/// What is wrong with a list, row by row: it is told at once, so that it is put right at once.
class Mistakes {
 public:
  explicit Mistakes(std::string where) : where_(std::move(where)) {}
  /// Keeps what `check` throws as an Error; the first 20 as they are.
  template <class Check>
  void unless(const Check& check) {
    try {
      check();
    } catch (const Error& wrong) {
      ++number_;
      if (mistakes_.size() < k_most) mistakes_.push_back(wrong);
    }
  }
  /// Throws ListMistakes where there was one.
  void tell();

 private:
  static constexpr std::size_t k_most = 20;
  std::string where_;
  std::size_t number_ = 0;
  std::vector<Error> mistakes_;
};

struct Person {
  std::string id;         ///< how the school's other systems name the candidate
  std::string name = {};  ///< for people; may be empty
  scenarios::Grant grant =
      {};  ///< accommodations of this candidate: what is set goes before what the class is granted
  std::string station = {};  ///< name of the station where the candidate is to sit; empty: any
  std::size_t line = 0;      ///< of the table
};
/// A table (CSV) with a column `id` and, if wanted, `name`, `station`, `extra_time_percent`,
/// `extra_time_s`, `left_handed`, `high_contrast` (yes, ja, true, 1 or x; no, nein, false or 0; in
/// any case; empty: nothing said). Percent as spreadsheets write it: 25, 25%, 25 %, 25,0; above 0
/// and below 1 is refused, for 0.25 may mean 25. Nobody's accommodation is lost in silence: any
/// other column is refused, but for those that `passed_over` names. Throws Error(where:line, ...)
/// for that, for one without ids, with one twice, with one station twice, or with a value that no
/// scenario could grant; of the rows ListMistakes, up to 20 at once.
[[nodiscard]] std::vector<Person> parse_people(const std::string& text, const std::string& where,
                                               const std::vector<std::string>& passed_over = {});
/// The same of rows that were read before, the heading first.
[[nodiscard]] std::vector<Person> parse_people(const std::vector<CsvRow>& rows,
                                               const std::string& where,
                                               const std::vector<std::string>& passed_over = {});
/// Throws ListMistakes when rows have more or fewer fields than the heading.
void require_whole_rows(const std::vector<CsvRow>& rows, const std::string& where);
/// Names of the columns that it knows, `id` first.
[[nodiscard]] std::vector<std::string> people_columns();

/// What `person` says, and what `all` says where he does not.
[[nodiscard]] scenarios::Grant together(const scenarios::Grant& all,
                                        const scenarios::Grant& person);

}  // namespace cavum::records
