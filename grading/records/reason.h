// Why something is entered, as a person says it.
#pragma once

#include <fmt/core.h>

#include <string>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::records {

/// The most bytes of a reason.
inline constexpr std::size_t k_longest_reason = 2000;
/// Throws Error for a reason that is empty, longer than that or no plain line.
inline void require_reason(const std::string& reason) {
  if (reason.size() > k_longest_reason || !is_seen_text(reason))
    throw Error(msg("the reason"),
                reason.size() > k_longest_reason ? msg("is longer than {} bytes", k_longest_reason)
                                                 : msg("is no line of text"),
                msg("say in one line of UTF-8 why, without names: it is kept for ever"));
}

}  // namespace cavum::records
