// Why a ledger does not take, tell or give what it was asked for; in words it stands in the Error that bears it.
#pragma once

#include <cstdint>

namespace cavum::records {

enum class LedgerError : std::uint8_t {
  lost,        ///< was here, and has to be restored
  malformed,   ///< cannot be read as what it should be
  unknown,     ///< nothing here bears this name, number or key
  twice,       ///< stands there, or is asked for, a second time
  used,        ///< good once
  ended,       ///< ran out, cancelled
  not_now,     ///< before or after the time within which it is good, or can be done
  contested,   ///< another ending or sitting of the same exam counts
  questioned,  ///< was filed with findings
  erased,
  damaged,        ///< does not hold
  another_key,    ///< of another school, or of a time before
  another_state,  ///< not what was seen before
  bad_signature,
  in_use,
};

}  // namespace cavum::records
