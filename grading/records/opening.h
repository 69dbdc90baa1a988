// What can be erased lies outside the tree. An entry names the hash of an opening, a text of a salt
// and a value; while the opening is there, it proves the value, and once it is gone, the hash tells
// nothing: nobody can try values without the salt. Every proof stays valid either way.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/base/shared_value.h"
#include "engine/base/where.h"

namespace cavum::records {

/// What openings hold is large, and stands in entries and in what they add up to: each value is
/// there once.
using SharedJson = Shared<nlohmann::json>;

struct Opening {
  std::string sha256;  ///< of `text`, hexadecimal: what an entry or a ticket names
  std::string text;    ///< {"salt":"32 hexadecimal digits","value":…}, keys in order, no spaces;
                       ///< empty where the value alone was read
  SharedJson value;    ///< null: erased, or not read
  /// The value where it is a text; else empty.
  [[nodiscard]] std::string words() const {
    return value->is_string() ? value->get<std::string>() : std::string();
  }
};
/// With 128 fresh random bits of salt.
[[nodiscard]] Opening make_opening(const nlohmann::json& value);
/// The value in an opening's text. Throws Error(`where`, ...) when the text is none, or its hash is
/// not `sha256` (hexadecimal).
[[nodiscard]] nlohmann::json opened_value(const std::string& text, const std::string& sha256,
                                          const Where& where);

/// What can be erased: of a filed session or a regrade its recording (a file), its result, and the
/// result that its station sealed instead; of an incident what was said.
enum class Part { motion, result, sealed, words };
/// Of an entry, by its number: what was erased of it, and the entry that says so.
using Erased = std::map<std::uint64_t, std::map<Part, std::uint64_t>>;

}  // namespace cavum::records
