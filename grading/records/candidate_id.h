// What may stand for a candidate on a command line or in a table: a pseudonym, a matriculation
// number, a mail address.
#pragma once

#include <fmt/core.h>

#include <string>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/where.h"

namespace cavum::records {

/// The most bytes: no mail address is longer.
inline constexpr std::size_t k_longest_candidate = 254;

/// True for what looks like a pseudonym of ours: C-XXXX-XXXX-XXXX.
inline bool is_pseudonym(const std::string& name) {
  return name.size() == 16 && name.starts_with("C-") && name[6] == '-' && name[11] == '-';
}

/// The pseudonym that somebody typed, in any case, with dashes, blanks or neither: "c7k3m q9wdxt20"
/// is C-7K3M-Q9WD-XT20. Empty where it can be none.
inline std::string pseudonym_typed(const std::string& text) {
  std::string letters;
  for (const char c : text) {
    if (c == '-' || c == ' ') continue;
    const bool small = c >= 'a' && c <= 'z';
    if (!small && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9')) return {};
    letters += small ? static_cast<char>(c - 'a' + 'A') : c;
  }
  if (letters.size() != 13 || letters.front() != 'C') return {};
  return fmt::format("C-{}-{}-{}", letters.substr(1, 4), letters.substr(5, 4),
                     letters.substr(9, 4));
}

/// Throws Error(`where`, ...) unless `id` is one line of UTF-8 of at most k_longest_candidate
/// bytes.
inline void require_candidate_id(const Where& where, const std::string& id) {
  if (id.size() > k_longest_candidate)
    throw Error(msg("{} {}…", where, one_line(id.substr(0, 20))),
                msg("is longer than a candidate's number or address ({} bytes)", id.size()),
                msg("use {} at most", k_longest_candidate));
  if (!is_plain_text(id))
    throw Error(where, msg("holds a control character or bytes that are no UTF-8"),
                msg("use letters and digits"));
}

}  // namespace cavum::records
