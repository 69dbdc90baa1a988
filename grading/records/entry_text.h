// Entries as text: JSON with keys in order and no spaces, docs/formats/ledger.md. Kinds, members
// and the words of enums have their names here alone.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/base/where.h"
#include "grading/records/entry.h"

namespace cavum::records {

/// The text that is hashed, {"body":…,"kind":…,"seq":…,"utc_ns":…}, of an entry that says
/// something.
[[nodiscard]] std::string entry_text(const LedgerEntry& entry);
/// What a text says; openings have their hashes alone. Throws Error(`where`, ...), which names what
/// is missing, too long, of another type, or more than its kind has.
[[nodiscard]] LedgerEntry read_entry(const std::string& text, const Where& where);
/// The same of a text from elsewhere; an entry that says nothing where it cannot be read.
[[nodiscard]] LedgerEntry read_entry_or_none(const std::string& text) noexcept;

/// The name of an entry's kind.
[[nodiscard]] const char* kind_name(const Entry& entry);
/// Its parts that lie in openings.
[[nodiscard]] std::map<Part, Opening*> openings_of(Entry& entry);
[[nodiscard]] std::map<Part, const Opening*> openings_of(const Entry& entry);

/// Of Ticket, Begin, StationRequest and SignedRequest: as entries and files hold it.
template <class Value>
[[nodiscard]] nlohmann::json json_of(const Value& value);
/// Throws Error(`where`, ...) as read_entry() does.
template <class Value>
[[nodiscard]] Value value_in(const nlohmann::json& j, const Where& where);

/// Of Part, FirstSitting and Outcome: its word, and the value of a word. Throws Error(`where`, ...)
/// for another.
template <class Enum>
[[nodiscard]] const char* word_of(Enum value);
template <class Enum>
[[nodiscard]] Enum of_word(const std::string& word, const Where& where);

}  // namespace cavum::records
