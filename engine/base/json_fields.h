// Fields of JSON that somebody else wrote: what is missing, or of another type than it should be,
// counts as not there, instead of an exception that speaks of no file.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "engine/base/where.h"

namespace cavum {

/// The member `key` when `j` is an object that has it; else null.
[[nodiscard]] const nlohmann::json& member_of(const nlohmann::json& j, const char* key);
/// Text of a member; empty when it is none.
[[nodiscard]] std::string text_in(const nlohmann::json& j, const char* key);
/// A whole number of a member that is one: a fraction, or a number beyond its type's range, is
/// refused instead of being cut to something else. Of 64 bits.
template <class Whole>
[[nodiscard]] Whole require_whole(const nlohmann::json& j, const char* key, const Where& where);
/// A whole number of a member; 0 when it is none.
[[nodiscard]] std::int64_t whole_in(const nlohmann::json& j, const char* key);

}  // namespace cavum
