// SQLite on a disk that fails: at the n-th change to a file it refuses once (a full disk), or the
// power goes, and what was written since the last sync is on disk only in part, drawn at random.
// Between, it is the ordinary disk.
#pragma once

#include <cstdint>
#include <string>

namespace cavum::testing_ledger {

enum class InjectedFault { none, refused, power_cut };

/// One at a time. While it lives every new SQLite connection of this process goes through it.
class FaultyDisk {
 public:
  /// `at`: number of the change (write, truncate, sync or delete, from 1) at which it happens.
  FaultyDisk(InjectedFault fault, int at, std::uint64_t seed);
  ~FaultyDisk();
  FaultyDisk(const FaultyDisk&) = delete;
  FaultyDisk& operator=(const FaultyDisk&) = delete;
  [[nodiscard]] static bool happened();
  [[nodiscard]] static int changes();
};

}  // namespace cavum::testing_ledger
