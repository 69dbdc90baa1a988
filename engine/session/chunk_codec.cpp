#include "engine/session/chunk_codec.h"

#include <zstd.h>
#include <zstd_errors.h>

#include <array>
#include <limits>
#include <new>

#include "engine/base/error.h"
#include "engine/session/session.h"

namespace cavum {
namespace {

constexpr int k_level = 3;
constexpr std::uint64_t k_largest_removed = 1u << 24;  // bytes unpacked, 4 to 11 per leaf

using InputWords = std::array<std::uint32_t, 10>;
using RecordWords = std::array<std::uint32_t, 11>;

[[noreturn]] void damaged(const Where& where, const Message& what) {
  throw Error(where, what, msg("the recording is damaged here: use an intact copy"));
}

std::uint32_t word(std::int32_t v) { return static_cast<std::uint32_t>(v); }
std::int32_t number(std::uint32_t v) { return static_cast<std::int32_t>(v); }

template <class T>
T narrow(std::uint32_t v, const Where& where) {
  if (v > std::numeric_limits<T>::max()) damaged(where, msg("a value is out of its range"));
  return static_cast<T>(v);
}

InputWords to_words(const TickInput& in) {
  return {word(in.tip_nm[0]),
          word(in.tip_nm[1]),
          word(in.tip_nm[2]),
          word(in.rotation_q30[0]),
          word(in.rotation_q30[1]),
          word(in.rotation_q30[2]),
          word(in.rotation_q30[3]),
          in.pedal_q16,
          in.flags,
          in.bur};
}

TickInput from_words(const InputWords& w, const Where& where) {
  TickInput in;
  in.tip_nm = {number(w[0]), number(w[1]), number(w[2])};
  in.rotation_q30 = {number(w[3]), number(w[4]), number(w[5]), number(w[6])};
  in.pedal_q16 = narrow<std::uint16_t>(w[7], where);
  in.flags = narrow<std::uint16_t>(w[8], where);
  in.bur = narrow<std::uint8_t>(w[9], where);
  return in;
}

RecordWords to_words(const TickRecord& r) {
  return {word(r.rendered_un[0]),
          word(r.rendered_un[1]),
          word(r.rendered_un[2]),
          word(r.model_un),
          word(r.penetration_nm),
          word(r.proxy_nm[0]),
          word(r.proxy_nm[1]),
          word(r.proxy_nm[2]),
          word(r.rpm),
          r.removed,
          r.notices};
}

TickRecord from_words(const RecordWords& w, const Where& where) {
  TickRecord r;
  r.rendered_un = {number(w[0]), number(w[1]), number(w[2])};
  r.model_un = number(w[3]);
  r.penetration_nm = number(w[4]);
  r.proxy_nm = {number(w[5]), number(w[6]), number(w[7])};
  r.rpm = number(w[8]);
  r.removed = w[9];
  r.notices = narrow<std::uint16_t>(w[10], where);
  return r;
}

// Small differences of either sign become small words, so that the upper byte planes are zeros.
std::uint32_t fold(std::uint32_t d) { return (d << 1) ^ (0u - (d >> 31)); }
std::uint32_t unfold(std::uint32_t f) { return (f >> 1) ^ (0u - (f & 1u)); }

Bytes compress(const Bytes& raw) {
  Bytes packed(ZSTD_compressBound(raw.size()));
  const auto n = ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), k_level);
  if (ZSTD_isError(n))
    throw Error(msg("recording"), Name{ZSTD_getErrorName(n)},
                msg("free some memory and try again"));
  packed.resize(n);
  return packed;
}

Bytes decompress(std::span<const std::uint8_t> packed, std::uint64_t least, std::uint64_t most,
                 const Where& where) {
  const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN)
    damaged(where, msg("the packed data have no valid beginning"));
  if (size < least || size > most)
    damaged(where, msg("the packed data claim {} bytes, which does not fit the ticks", size));
  if (ZSTD_findFrameCompressedSize(packed.data(), packed.size()) != packed.size())
    damaged(where, msg("the packed data are not one frame"));
  Bytes raw(size);
  const auto n = ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size());
  if (ZSTD_getErrorCode(n) == ZSTD_error_memory_allocation)
    throw std::bad_alloc();  // nothing is wrong with the recording
  if (ZSTD_isError(n) || n != size) damaged(where, msg("the packed data do not unpack"));
  return raw;
}

template <class Words, class T>
Bytes pack_columns(std::span<const T> ticks) {
  constexpr std::size_t columns = std::tuple_size_v<Words>;
  const std::size_t n = ticks.size();
  Bytes raw(n * columns * 4);
  Words before{}, before2{};
  for (std::size_t i = 0; i < n; ++i) {
    const Words now = to_words(ticks[i]);
    for (std::size_t c = 0; c < columns; ++c) {
      const std::uint32_t f = fold(now[c] - 2 * before[c] + before2[c]);
      for (std::size_t b = 0; b < 4; ++b)
        raw[(c * 4 + b) * n + i] = static_cast<std::uint8_t>(f >> (8 * b));
    }
    before2 = before;
    before = now;
  }
  return compress(raw);
}

template <class T, class Words>
std::vector<T> unpack_columns(std::span<const std::uint8_t> packed, std::int64_t ticks,
                              const Where& where) {
  constexpr std::size_t columns = std::tuple_size_v<Words>;
  if (ticks < 0 || ticks > k_chunk_ticks) damaged(where, msg("{} ticks in one chunk", ticks));
  const auto n = static_cast<std::size_t>(ticks);
  const Bytes raw = decompress(packed, n * columns * 4, n * columns * 4, where);
  std::vector<T> out;
  out.reserve(n);
  Words before{}, before2{};
  for (std::size_t i = 0; i < n; ++i) {
    Words now{};
    for (std::size_t c = 0; c < columns; ++c) {
      std::uint32_t f = 0;
      for (std::size_t b = 0; b < 4; ++b)
        f |= static_cast<std::uint32_t>(raw[(c * 4 + b) * n + i]) << (8 * b);
      now[c] = unfold(f) + 2 * before[c] - before2[c];
    }
    out.push_back(from_words(now, where));
    before2 = before;
    before = now;
  }
  return out;
}

std::uint16_t coordinate(const RemovedLeaf& leaf, int axis) {
  return static_cast<std::uint16_t>(axis == 0 ? leaf.x : axis == 1 ? leaf.y : leaf.z);
}

}  // namespace

Bytes pack_inputs(std::span<const TickInput> inputs) { return pack_columns<InputWords>(inputs); }
Bytes pack_records(std::span<const TickRecord> records) {
  return pack_columns<RecordWords>(records);
}

Bytes pack_removed(const RemovedTicks& removed) {
  ByteWriter raw;
  for (const auto count : removed.counts) raw.put_varint(count);
  for (int axis = 0; axis < 3; ++axis) {
    std::uint16_t before = 0;
    for (const auto& leaf : removed.leaves) {
      const std::uint16_t now = coordinate(leaf, axis);
      raw.put_signed_varint(static_cast<std::int16_t>(static_cast<std::uint16_t>(now - before)));
      before = now;
    }
  }
  for (const auto& leaf : removed.leaves) raw.put(leaf.tissue);
  return compress(raw.bytes());
}

std::vector<TickInput> unpack_inputs(std::span<const std::uint8_t> packed, std::int64_t ticks,
                                     const Where& where) {
  return unpack_columns<TickInput, InputWords>(packed, ticks, where);
}
std::vector<TickRecord> unpack_records(std::span<const std::uint8_t> packed, std::int64_t ticks,
                                       const Where& where) {
  return unpack_columns<TickRecord, RecordWords>(packed, ticks, where);
}

RemovedTicks unpack_removed(std::span<const std::uint8_t> packed, std::int64_t ticks,
                            const Where& where) {
  if (ticks < 0 || ticks > k_chunk_ticks) damaged(where, msg("{} ticks in one chunk", ticks));
  const Bytes raw = decompress(packed, static_cast<std::uint64_t>(ticks), k_largest_removed, where);
  ByteReader in(raw, where);
  RemovedTicks removed;
  std::uint64_t total = 0;
  for (std::int64_t i = 0; i < ticks; ++i) {
    const auto count = in.get_varint();
    if (count > raw.size() || (total += count) > raw.size() / 4)
      damaged(where, msg("more removed leaves than the data hold"));
    removed.counts.push_back(static_cast<std::uint32_t>(count));
  }
  removed.leaves.resize(total);
  for (int axis = 0; axis < 3; ++axis) {
    std::uint16_t now = 0;
    for (auto& leaf : removed.leaves) {
      const auto difference = in.get_signed_varint();
      if (difference < -32768 || difference > 32767)
        damaged(where, msg("a removed leaf lies outside every tooth"));
      now = static_cast<std::uint16_t>(now + static_cast<std::uint16_t>(difference));
      (axis == 0 ? leaf.x : axis == 1 ? leaf.y : leaf.z) = static_cast<std::int16_t>(now);
    }
  }
  for (auto& leaf : removed.leaves) leaf.tissue = in.get<std::uint8_t>();
  if (in.left() != 0) damaged(where, msg("data after the end"));
  return removed;
}

}  // namespace cavum
