// Why a session cannot be had, beside what is wrong with any file (FileError).
#pragma once

#include "engine/base/named_enum.h"

namespace cavum {

#define CAVUM_SESSION_ERRORS(ERROR) ERROR(closed) ERROR(not_a_session)
CAVUM_NAMED_ENUM(SessionError, CAVUM_SESSION_ERRORS)

}  // namespace cavum
