// Why a session cannot be had, beside what is wrong with any file (FileError).
#pragma once

#include <cstdint>

namespace cavum {

enum class SessionError : std::uint8_t { closed, not_a_session };

}  // namespace cavum
