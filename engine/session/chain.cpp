#include "engine/session/chain.h"

namespace cavum {
namespace {

void put_tag(ByteWriter& out, const char* tag) {
  for (; *tag != 0; ++tag) out.put(*tag);
}

void put_clocks(ByteWriter& out, const Clocks& clocks) {
  out.put(clocks.monotonic_ns);
  out.put(clocks.boot_ns);
  out.put(clocks.utc_ns);
}

}  // namespace

Sha256 genesis_hash(const std::map<std::string, std::string>& meta,
                    std::span<const Artifact> artifacts) {
  ByteWriter out;
  put_tag(out, "CVSTART1");
  out.put(static_cast<std::uint64_t>(meta.size()));
  for (const auto& [key, value] : meta) {
    out.put_string(key);
    out.put_string(value);
  }
  for (const auto& a : artifacts) {
    if (a.name == k_final_tooth) continue;
    out.put_string(a.name);
    out.put(static_cast<std::uint64_t>(a.bytes.size()));
    out.put_bytes(a.sha256);
  }
  return sha256(out.bytes());
}

Bytes begin_message(std::map<std::string, std::string> meta, std::span<const Artifact> artifacts) {
  meta.erase(k_begun_fact);
  ByteWriter out;
  put_tag(out, "CVBEGIN1");
  out.put_bytes(genesis_hash(meta, artifacts));
  return out.take();
}

Sha256 events_hash(std::span<const EventRow> events) {
  ByteWriter out;
  put_tag(out, "CVEVENT1");
  for (const auto& e : events) {
    out.put(e.seq);
    out.put(e.tick);
    const EventText text = encode(e.event);
    out.put_string(text.kind);
    out.put_string(text.detail_json);
  }
  return sha256(out.bytes());
}

Sha256 chunk_hash(const ChunkRow& chunk) {
  ByteWriter out;
  put_tag(out, "CVCHUNK1");
  out.put_bytes(chunk.prev_sha256);
  out.put(chunk.seq);
  out.put(chunk.first_tick);
  out.put(chunk.ticks);
  out.put(chunk.state_hash);
  put_clocks(out, chunk.clocks);
  for (const auto* part :
       {&chunk.inputs_sha256, &chunk.records_sha256, &chunk.removed_sha256, &chunk.events_sha256})
    out.put_bytes(*part);
  return sha256(out.bytes());
}

Bytes seal_message(const Seal& seal) {
  ByteWriter out;
  put_tag(out, "CVSEAL_1");
  out.put_bytes(seal.chain_sha256);
  out.put_bytes(seal.final_tooth_sha256);
  out.put_bytes(seal.result_sha256);
  out.put(seal.chunks);
  out.put(seal.ticks);
  out.put(seal.events);
  put_clocks(out, seal.clocks);
  out.put_bytes(seal.public_key);
  return out.take();
}

}  // namespace cavum
