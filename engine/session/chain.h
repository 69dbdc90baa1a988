// The chain of evidence: every chunk's hash covers the hash before it, so no second of an exam can
// be changed, dropped, added or moved without breaking all that follow. The canonical bytes of each
// hash are listed in docs/formats/session.md.
#pragma once

#include <map>
#include <span>
#include <string>

#include "engine/session/session.h"

namespace cavum {

/// Hash that the chain starts from: all of `meta`, and name, size and SHA-256 of every artifact
/// present before the first tick (the final tooth is left out: the seal covers it).
[[nodiscard]] Sha256 genesis_hash(const std::map<std::string, std::string>& meta,
                                  std::span<const Artifact> artifacts);

/// Facts of `meta` that say which station began the session: its public key, and its signature over
/// begin_message (hexadecimal).
inline constexpr char k_station_fact[] = "station_key", k_begun_fact[] = "begun_signature";
/// What the station signs on beginning: the hash that the chain would start from without that
/// signature.
[[nodiscard]] Bytes begin_message(std::map<std::string, std::string> meta,
                                  std::span<const Artifact> artifacts);

/// Hash of the events committed with one chunk, in their order.
[[nodiscard]] Sha256 events_hash(std::span<const EventRow> events);

/// Link of one chunk: covers prev_sha256, tick numbers, state hash, clocks and the four part
/// hashes.
[[nodiscard]] Sha256 chunk_hash(const ChunkRow& chunk);

/// What the station signs on closing: everything in the seal except the signature itself.
[[nodiscard]] Bytes seal_message(const Seal& seal);

}  // namespace cavum
