#include "ui/report/figures/packed_array.h"

#include <fmt/core.h>
#include <zstd.h>

#include <nlohmann/json.hpp>
#include <type_traits>

#include "engine/base/encoding.h"
#include "engine/base/error.h"

namespace cavum::report {
namespace {

constexpr int k_level = 9;  // of zstd: higher ones take seconds for a tooth and save little

template <class T>
nlohmann::json pack(std::span<const T> values, const char* type, bool delta) {
  using Unsigned = std::make_unsigned_t<T>;
  ByteWriter raw;
  Unsigned last = 0;
  for (const T v : values) {
    const auto u = static_cast<Unsigned>(v);
    raw.put(static_cast<Unsigned>(delta ? u - last : u));
    last = u;
  }
  const Bytes bytes(raw.bytes().begin(), raw.bytes().end());
  Bytes packed(ZSTD_compressBound(bytes.size()));
  const std::size_t n =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), k_level);
  if (ZSTD_isError(n) != 0)
    throw Error(msg("report"), msg("zstd refuses to pack {} bytes", bytes.size()),
                msg("free some memory"));
  packed.resize(n);
  return {{"type", type}, {"n", values.size()}, {"delta", delta}, {"zstd", to_base64(packed)}};
}

}  // namespace

nlohmann::json packed_array(std::span<const std::uint8_t> values, bool delta) {
  return pack(values, "u8", delta);
}
nlohmann::json packed_array(std::span<const std::int8_t> values, bool delta) {
  return pack(values, "i8", delta);
}
nlohmann::json packed_array(std::span<const std::uint16_t> values, bool delta) {
  return pack(values, "u16", delta);
}
nlohmann::json packed_array(std::span<const std::int16_t> values, bool delta) {
  return pack(values, "i16", delta);
}

}  // namespace cavum::report
