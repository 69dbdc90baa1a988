// Packs a second of motion. Every field of a tick becomes a column of 32-bit words; a column is
// stored as second differences (smooth motion leaves small numbers), its bytes are sorted by
// significance, and zstd does the rest. Any values survive exactly; differences wrap around.
// Layout: docs/formats/session.md.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/where.h"
#include "engine/physics/servo/tick.h"

namespace cavum {

/// Leaves removed during a chunk: `counts[i]` of tick i, and all leaves in the order of their
/// removal.
struct RemovedTicks {
  std::vector<std::uint32_t> counts;
  std::vector<RemovedLeaf> leaves;
  friend bool operator==(const RemovedTicks&, const RemovedTicks&) = default;
};

/// What a chunk holds once unpacked; the three vectors are of one length.
struct ChunkMotion {
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  RemovedTicks removed;
};

[[nodiscard]] Bytes pack_inputs(std::span<const TickInput> inputs);
[[nodiscard]] Bytes pack_records(std::span<const TickRecord> records);
[[nodiscard]] Bytes pack_removed(const RemovedTicks& removed);

/// Unpack `ticks` ticks (0..k_chunk_ticks). Throw Error(where, ...) on any bytes that the packers
/// do not write for that many ticks; memory stays below 300 MB whatever the bytes.
[[nodiscard]] std::vector<TickInput> unpack_inputs(std::span<const std::uint8_t> packed,
                                                   std::int64_t ticks, const Where& where);
[[nodiscard]] std::vector<TickRecord> unpack_records(std::span<const std::uint8_t> packed,
                                                     std::int64_t ticks, const Where& where);
[[nodiscard]] RemovedTicks unpack_removed(std::span<const std::uint8_t> packed, std::int64_t ticks,
                                          const Where& where);

/// A chunk is ended early once it holds this many removed leaves, so that it always unpacks.
inline constexpr std::size_t k_chunk_leaves = 1u << 20;

}  // namespace cavum
