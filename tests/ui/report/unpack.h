// Unpacks what a report carries, in a way of its own: zstd, little-endian numbers, differences
// added up.
#pragma once

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/encoding.h"

namespace cavum::testing_report {

/// The numbers of a packed array, whatever their type.
inline std::vector<long> unpack(const nlohmann::json& bin) {
  const Bytes packed = from_base64(bin.at("zstd").get<std::string>()).value();
  const std::string type = bin.at("type");
  const std::size_t n = bin.at("n"), bytes = type.ends_with("16") ? 2 : 1;
  std::vector<std::uint8_t> raw(n * bytes + 1);
  const std::size_t got = ZSTD_decompress(raw.data(), raw.size(), packed.data(), packed.size());
  EXPECT_EQ(got, n * bytes) << ZSTD_getErrorName(got);
  const long wrap = bytes == 2 ? 65536 : 256;
  std::vector<long> values(n);
  long last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    long v = bytes == 2 ? raw[2 * i] + 256L * raw[2 * i + 1] : raw[i];
    if (bin.at("delta").get<bool>()) v = (last + v) % wrap;
    last = v;
    values[i] = type[0] == 'i' && v >= wrap / 2 ? v - wrap : v;
  }
  return values;
}

/// The JSON that stands in a report's HTML.
inline nlohmann::json data_in(const std::string& html) {
  const std::string open = "<script type=\"application/json\" id=\"cavum-data\">";
  const auto from = html.find(open);
  if (from == std::string::npos) return nullptr;
  const auto begin = from + open.size();
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin), nullptr,
                               false);
}

}  // namespace cavum::testing_report
