#include "grading/cohort/judge_names.h"

#include <fmt/core.h>

#include <map>

#include "engine/base/error.h"
#include "engine/base/text.h"

namespace cavum::cohort {
namespace {

/// Without blanks, in lower case: ASCII, and the Latin letters of two bytes of UTF-8 from À to Þ.
std::string bare(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto byte = static_cast<unsigned char>(name[i]),
               next = static_cast<unsigned char>(i + 1 < name.size() ? name[i + 1] : 0);
    if (byte == 0xC2 && next == 0xA0) {  // a blank that does not break
      ++i;
    } else if (byte == 0xC3 && next >= 0x80 && next <= 0x9E && next != 0x97) {
      out += name[i];
      out += static_cast<char>(next + 0x20);
      ++i;
    } else if (byte > ' ') {
      out += byte >= 'A' && byte <= 'Z' ? static_cast<char>(byte + 0x20) : name[i];
    }
  }
  return out;
}

}  // namespace

void require_distinct_judges(const std::set<std::string>& names, const Message& where) {
  std::map<std::string, std::string> seen;
  for (const auto& name : names) {
    const auto [at, is_new] = seen.try_emplace(bare(name), name);
    if (!is_new)
      throw Error(where,
                  msg("names judges '{}' and '{}', which differ by case or blanks alone",
                      one_line(at->second), one_line(name)),
                  msg("write each judge in one way; two people need two names"));
  }
}

}  // namespace cavum::cohort
