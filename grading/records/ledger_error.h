// Why a ledger does not take, tell or give what it was asked for; in words it stands in the Error
// that bears it.
#pragma once

#include "engine/base/named_enum.h"

namespace cavum::records {

// clang-format off
#define CAVUM_LEDGER_ERRORS(ERROR) \
  ERROR(lost)          /* was here, and has to be restored */ \
  ERROR(malformed)     /* cannot be read as what it should be */ \
  ERROR(unknown)       /* nothing here bears this name, number or key */ \
  ERROR(twice)         /* stands there, or is asked for, a second time */ \
  ERROR(used)          /* good once */ \
  ERROR(ended)         /* ran out, cancelled */ \
  ERROR(not_now)       /* before or after the time within which it is good, or can be done */ \
  ERROR(contested)     /* another ending or sitting of the same exam counts */ \
  ERROR(questioned)    /* was filed with findings */ \
  ERROR(erased) \
  ERROR(damaged)       /* does not hold */ \
  ERROR(another_key)   /* of another school, or of a time before */ \
  ERROR(another_state) /* not what was seen before */ \
  ERROR(bad_signature) \
  ERROR(in_use)
// clang-format on
CAVUM_NAMED_ENUM(LedgerError, CAVUM_LEDGER_ERRORS)

}  // namespace cavum::records
