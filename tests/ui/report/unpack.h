// Unpacks what a report carries, in a way of its own: base64 by hand, zstd, little-endian numbers, differences added up.
#pragma once

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace cavum::testing_report {

inline std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int n = 0;
  for (const char c : text) {
    if (c == '=') break;
    const auto digit = digits.find(c);
    EXPECT_NE(digit, std::string::npos);
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((n += 6) >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (n -= 8)));
  }
  return bytes;
}

/// The numbers of a packed array, whatever their type.
inline std::vector<long> unpack(const nlohmann::json& bin) {
  const std::vector<std::uint8_t> packed = from_base64(bin.at("zstd").get<std::string>());
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
  return nlohmann::json::parse(html.substr(begin, html.find("</script>", begin) - begin), nullptr, false);
}

}  // namespace cavum::testing_report
