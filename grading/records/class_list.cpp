#include "grading/records/class_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "engine/base/text.h"
#include "grading/records/candidate_id.h"
#include "grading/records/ledger_error.h"

namespace cavum::records {
namespace {

std::string small_letters(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

using Put = void (*)(Person&, const std::string& field, const std::string& at);
struct Column {
  const char* name;
  Put put;
};

double number_of(const std::string& field, const std::string& at) {
  const auto number = number_in_field(field);
  if (!number)
    throw Error(at, msg("'{}' is no number", field),
                msg("write it with a decimal point, or leave it empty"));
  return *number;
}
/// As a person or a spreadsheet writes a percentage: 25, 25%, 25 %, 25,0.
double percent_of(const std::string& field, const std::string& at) {
  std::string text = field;
  if (text.ends_with('%')) {
    text.pop_back();
    for (const std::string_view blank : {"\u00a0", "\u202f"})  // no-break spaces
      if (text.ends_with(blank)) text.resize(text.size() - blank.size());
    text = without_blanks(text);
  }
  if (text.find('.') == std::string::npos)
    if (const auto comma = text.find(','); comma != std::string::npos) text[comma] = '.';
  const auto number = number_in_field(text);
  if (!number)
    throw Error(at, msg("'{}' is no percentage", field), msg("write it as 25, or leave it empty"));
  if (*number > 0 && *number < 1)
    throw Error(at, msg("'{}' is less than one percent", field),
                msg("write {} if the exam is to be longer by {} percent", as_number(100 * *number),
                    as_number(100 * *number)));
  return *number;
}
bool yes_of(const std::string& field, const std::string& at) {
  const std::string word = small_letters(field);
  for (const char* yes : {"yes", "ja", "true", "x", "1"})
    if (word == yes) return true;
  for (const char* no : {"no", "nein", "false", "0"})
    if (word == no) return false;
  throw Error(at, msg("'{}' is neither yes nor no", field),
              msg("write yes (or ja, x), no (or nein), or nothing"));
}

constexpr Column k_columns[] = {
    {"id", [](Person& p, const std::string& f, const std::string&) { p.id = f; }},
    {"name", [](Person& p, const std::string& f, const std::string&) { p.name = f; }},
    {"station", [](Person& p, const std::string& f, const std::string&) { p.station = f; }},
    {"extra_time_percent",
     [](Person& p, const std::string& f, const std::string& at) {
       p.grant.extra_time_percent = percent_of(f, at);
     }},
    {"extra_time_s", [](Person& p, const std::string& f,
                        const std::string& at) { p.grant.extra_time_s = number_of(f, at); }},
    {"left_handed", [](Person& p, const std::string& f,
                       const std::string& at) { p.grant.left_handed = yes_of(f, at); }},
    {"high_contrast", [](Person& p, const std::string& f, const std::string& at) {
       p.grant.high_contrast = yes_of(f, at);
     }}};

/// What each field of a row is put into; null: passed over.
std::vector<const Column*> columns_of(const std::vector<std::string>& heading,
                                      const std::string& at,
                                      const std::vector<std::string>& passed_over) {
  std::vector<const Column*> columns;
  std::string known;
  for (const Column& c : k_columns) known += (known.empty() ? "" : ", ") + std::string(c.name);
  for (const std::string& field : heading) {
    const auto* const found =
        std::find_if(std::begin(k_columns), std::end(k_columns),
                     [&](const Column& c) { return small_letters(field) == c.name; });
    const bool passed =
        std::find(passed_over.begin(), passed_over.end(), field) != passed_over.end();
    const bool is_known = found != std::end(k_columns) && !passed;
    if (!is_known && !passed)
      throw Error(LedgerError::unknown, Name{at},
                  msg("a ticket knows no column '{}'", one_line(field)),
                  msg("name it as one of {}, or say --ignore-column '{}' when it is not needed",
                      known, one_line(field)));
    if (is_known && std::find(columns.begin(), columns.end(), found) != columns.end())
      throw Error(LedgerError::twice, Name{at}, msg("has the column '{}' twice", found->name),
                  std::string_view(found->name) == "name"
                      ? msg("join surname and first name to one column in the spreadsheet")
                      : msg("leave one of them"));
    columns.push_back(is_known ? found : nullptr);
  }
  if (std::find(columns.begin(), columns.end(), &k_columns[0]) == columns.end())
    throw Error(LedgerError::malformed, Name{at}, msg("is no heading of candidates"),
                msg("begin with a line of column names, of which one is id: {}", known));
  return columns;
}

void require_all_fields(const CsvRow& row, std::size_t columns, const std::string& at) {
  if (row.fields.size() != columns)
    throw Error(at, msg("has {} fields for {} columns", row.fields.size(), columns),
                msg("complete the row"));
}

Person person_of(const CsvRow& row, const std::vector<const Column*>& columns,
                 const std::string& at) {
  require_all_fields(row, columns.size(), at);
  Person p;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (columns[c] != nullptr && !row.fields[c].empty())
      columns[c]->put(p, row.fields[c], fmt::format("{}: {}", at, columns[c]->name));
  if (p.id.empty())
    throw Error(at, msg("has no id"),
                msg("give each candidate the school's own number or address"));
  require_candidate_id(at + ": id", p.id);
  if (holds_unseen(p.id))
    throw Error(at + ": id", msg("holds a character that is not seen, such as a no-break space"),
                msg("type the number anew"));
  require_candidate_id(at + ": name", p.name);
  require_candidate_id(at + ": station", p.station);
  scenarios::require_sound(p.grant, at);
  p.line = row.line;
  return p;
}

}  // namespace

ListMistakes::ListMistakes(const std::string& where, std::vector<Error> mistakes)
    : Error(where, msg("has {} mistakes", mistakes.size()),
            msg("the first: {}", mistakes.at(0).message())),
      mistakes_(std::move(mistakes)) {}

void Mistakes::tell() {
  if (number_ > mistakes_.size())
    mistakes_.emplace_back(where_, msg("has {} mistakes more", number_ - mistakes_.size()),
                           msg("put these right first"));
  if (number_ > 0) throw ListMistakes(where_, std::move(mistakes_));
}

std::vector<std::string> people_columns() {
  std::vector<std::string> names;
  for (const Column& c : k_columns) names.emplace_back(c.name);
  return names;
}

std::vector<Person> parse_people(const std::string& text, const std::string& where,
                                 const std::vector<std::string>& passed_over) {
  return parse_people(parse_csv(text, where, {.uneven = true}), where, passed_over);
}

void require_whole_rows(const std::vector<CsvRow>& rows, const std::string& where) {
  Mistakes mistakes(where);
  for (const CsvRow& row : rows)
    mistakes.unless([&] {
      require_all_fields(row, rows[0].fields.size(), fmt::format("{}:{}", where, row.line));
    });
  mistakes.tell();
}

std::vector<Person> parse_people(const std::vector<CsvRow>& rows, const std::string& where,
                                 const std::vector<std::string>& passed_over) {
  if (rows.empty())
    throw Error(where + ":1", msg("is no heading of candidates"), msg("begin with id,name"));
  const auto columns =
      columns_of(rows[0].fields, fmt::format("{}:{}", where, rows[0].line), passed_over);
  std::vector<Person> people;
  std::set<std::string> seen, stations;
  Mistakes mistakes(where);
  for (std::size_t i = 1; i < rows.size(); ++i)
    mistakes.unless([&] {
      const std::string at = fmt::format("{}:{}", where, rows[i].line);
      Person p = person_of(rows[i], columns, at);
      if (!seen.insert(p.id).second)
        throw Error(at, msg("'{}' stands there a second time", p.id), msg("leave one of them"));
      if (!p.station.empty() && !stations.insert(p.station).second)
        throw Error(at + ": station", msg("'{}' is given to two candidates", p.station),
                    msg("give each a station of his own"));
      people.push_back(std::move(p));
    });
  mistakes.tell();
  if (people.empty())
    throw Error(where, msg("names no candidate"), msg("write one on each line below the heading"));
  return people;
}

scenarios::Grant together(const scenarios::Grant& all, const scenarios::Grant& person) {
  const auto first = [](const auto& own, const auto& common) { return own ? own : common; };
  return {first(person.extra_time_percent, all.extra_time_percent),
          first(person.extra_time_s, all.extra_time_s), first(person.left_handed, all.left_handed),
          first(person.high_contrast, all.high_contrast)};
}

}  // namespace cavum::records
