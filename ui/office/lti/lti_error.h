// Why somebody from a learning platform is not let in, and why a platform is not asked.
#pragma once

#include <cstdint>

namespace cavum::office {

enum class LtiError : std::uint8_t {
  not_understood,  ///< no form, no token
  twice,           ///< says one thing twice
  incomplete,
  login,     ///< of no login of this office, or of another than this browser's
  too_late,  ///< also a token of the future
  used,
  platform,  ///< unknown, or another one
  algorithm,
  key,
  signature,
  audience,
  deployment,
  message,  ///< not a link's of LTI 1.3
  target,
  role,
  address,  ///< none of the platform's
};

}  // namespace cavum::office
