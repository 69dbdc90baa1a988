#include "ui/office/roster.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::office {
namespace {

constexpr std::size_t k_samples = 3;

void add_utf8(std::string& out, char32_t c) {
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += static_cast<char>(0xc0 | (c >> 6));
    out += static_cast<char>(0x80 | (c & 0x3f));
  } else if (c < 0x10000) {
    out += static_cast<char>(0xe0 | (c >> 12));
    out += static_cast<char>(0x80 | ((c >> 6) & 0x3f));
    out += static_cast<char>(0x80 | (c & 0x3f));
  } else {
    out += static_cast<char>(0xf0 | (c >> 18));
    out += static_cast<char>(0x80 | ((c >> 12) & 0x3f));
    out += static_cast<char>(0x80 | ((c >> 6) & 0x3f));
    out += static_cast<char>(0x80 | (c & 0x3f));
  }
}

/// What is no pair of surrogates becomes U+FFFD.
std::string from_utf16(const std::string& bytes, bool big_endian) {
  std::string out;
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<std::uint8_t>(bytes[at]),
               second = static_cast<std::uint8_t>(bytes[at + 1]);
    return static_cast<char32_t>(big_endian ? first << 8 | second : second << 8 | first);
  };
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    char32_t c = unit(at);
    if (c >= 0xd800 && c < 0xdc00 && at + 3 < bytes.size() && unit(at + 2) >= 0xdc00 &&
        unit(at + 2) < 0xe000) {
      c = 0x10000 + ((c - 0xd800) << 10) + (unit(at + 2) - 0xdc00);
      at += 2;
    }
    add_utf8(out, c >= 0xd800 && c < 0xe000 ? 0xfffd : c);
  }
  return out;
}

/// The upper 32 of Windows-1252 that are not Latin-1's; 0: none, refused later as a control
/// character.
constexpr std::array<char32_t, 32> k_windows{
    0x20ac, 0,      0x201a, 0x192,  0x201e, 0x2026, 0x2020, 0x2021, 0x2c6,  0x2030, 0x160,
    0x2039, 0x152,  0,      0x17d,  0,      0,      0x2018, 0x2019, 0x201c, 0x201d, 0x2022,
    0x2013, 0x2014, 0x2dc,  0x2122, 0x161,  0x203a, 0x153,  0,      0x17e,  0x178};

std::string from_windows(const std::string& bytes) {
  std::string out;
  for (const char byte : bytes) {
    const auto c = static_cast<std::uint8_t>(byte);
    add_utf8(out, c >= 0x80 && c < 0xa0 && k_windows[c - 0x80] != 0 ? k_windows[c - 0x80] : c);
  }
  return out;
}

bool is_utf8(const std::string& text) {
  const auto marks = [](const std::string& t) { return std::count(t.begin(), t.end(), '?'); };
  return marks(text) == marks(one_line(text));  // bytes that are no UTF-8 become question marks
}

std::string decoded(const std::string& bytes, std::string& encoding) {
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) {
    encoding = "UTF-16";
    return from_utf16(bytes, bytes.starts_with("\xfe"));
  }
  if (is_utf8(bytes)) {
    encoding = "UTF-8";
    return bytes;
  }
  encoding = "Windows-1252";
  return from_windows(bytes);
}

std::string small_letters_of(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

constexpr char k_name[] = "name";

/// For a column that is passed over: no name that is known, and no other column's.
std::string column_name(std::size_t at) { return fmt::format("column {}", at + 1); }

void read_columns(Roster& roster, std::vector<CsvRow>& rows,
                  const std::vector<std::string>& answers, std::vector<std::string>& passed_over) {
  const auto known = records::people_columns();
  for (std::size_t c = 0; c < rows[0].fields.size(); ++c) {
    std::string& heading = rows[0].fields[c];
    RosterColumn column{heading, "", false, {}};
    for (std::size_t r = 1; r < rows.size() && column.samples.size() < k_samples; ++r)
      if (c < rows[r].fields.size() && !rows[r].fields[c].empty())
        column.samples.push_back(rows[r].fields[c]);
    column.known = std::find(known.begin(), known.end(), small_letters_of(heading)) != known.end();
    if (column.known) column.use = small_letters_of(heading);
    roster.headed = roster.headed || column.known;
    if (c < answers.size() && (answers[c] == k_pass_over ||
                               std::find(known.begin(), known.end(), answers[c]) != known.end()))
      column.use = answers[c];
    if (column.use == k_pass_over) {
      heading = column_name(c);
      passed_over.push_back(heading);
    } else if (!column.use.empty()) {
      heading = column.use;
    }
    roster.columns.push_back(std::move(column));
  }
}

/// Surname and first name: what follows the first of several columns goes into it, and is passed
/// over by itself.
void join_names(std::vector<CsvRow>& rows, std::vector<std::string>& passed_over) {
  std::vector<std::size_t> names;
  for (std::size_t c = 0; c < rows[0].fields.size(); ++c)
    if (small_letters_of(rows[0].fields[c]) == k_name) names.push_back(c);
  for (std::size_t n = 1; n < names.size(); ++n) {
    rows[0].fields[names[n]] = column_name(names[n]);
    passed_over.push_back(rows[0].fields[names[n]]);
    for (std::size_t r = 1; r < rows.size(); ++r) {
      auto& fields = rows[r].fields;
      if (names[n] >= fields.size() || fields[names[n]].empty()) continue;
      fields[names[0]] += (fields[names[0]].empty() ? "" : ", ") + fields[names[n]];
    }
  }
}

}  // namespace

std::vector<Message> mistakes_of(const Error& wrong) {
  const auto* const several = dynamic_cast<const records::ListMistakes*>(&wrong);
  if (several == nullptr) return {wrong.message()};
  std::vector<Message> all;
  for (const Error& mistake : several->mistakes()) all.push_back(mistake.message());
  return all;
}

Roster read_roster(const std::string& bytes, const std::vector<std::string>& answers) {
  Roster roster;
  try {
    const std::string text = decoded(bytes, roster.encoding);
    CsvReader in(text, k_list, {.bars = true, .uneven = true});
    std::vector<CsvRow> rows;
    while (in.next_row()) rows.push_back({in.line(), {in.fields().begin(), in.fields().end()}});
    if (rows.empty())
      throw Error(msg("the list"), msg("is empty"),
                  msg("paste a line of column names, and a line for each candidate below"));
    roster.rows = rows.size() - 1;
    roster.separator = in.separator();
    std::vector<std::string> passed_over;
    read_columns(roster, rows, answers, passed_over);
    join_names(rows, passed_over);
    if (std::all_of(roster.columns.begin(), roster.columns.end(),
                    [](const RosterColumn& c) { return !c.use.empty(); }))
      roster.people = records::parse_people(rows, k_list, passed_over);
    else
      records::require_whole_rows(rows, k_list);
  } catch (const Error& wrong) {
    roster.problems = mistakes_of(wrong);
  }
  return roster;
}

}  // namespace cavum::office
