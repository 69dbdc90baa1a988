#include "engine/base/pseudo.h"

#include <array>
#include <cstdlib>
#include <utility>

namespace cavum {

std::string pseudo(std::string_view english) {
  constexpr std::array<std::pair<char, const char*>, 22> k_accents{
      {{'a', "á"}, {'b', "ƀ"}, {'c', "ç"}, {'d', "ð"}, {'e', "é"}, {'g', "ĝ"},
       {'h', "ĥ"}, {'i', "î"}, {'l', "ļ"}, {'n', "ñ"}, {'o', "ô"}, {'p', "þ"},
       {'r', "ŕ"}, {'s', "š"}, {'t', "ţ"}, {'u', "û"}, {'y', "ý"}, {'z', "ž"},
       {'A', "Â"}, {'E', "É"}, {'O', "Ö"}, {'T', "Ţ"}}};
  std::string out = "\u27e6";
  bool gap = false;
  for (std::size_t i = 0; i < english.size(); ++i) {
    const char c = english[i];
    if (c == '{') gap = !gap || i == 0 || english[i - 1] != '{';
    const char* accent = nullptr;
    for (const auto& [plain, with] : k_accents)
      if (plain == c && !gap) accent = with;
    if (accent != nullptr)
      out += accent;
    else
      out += c;
    if (c == '}') gap = false;
  }
  return out + "\u27e7";
}

std::string source_sentence(const char* english) {
  static const bool k_altered = std::getenv("CAVUM_ALTER_SENTENCES") != nullptr;
  return k_altered ? pseudo(english) : english;
}

}  // namespace cavum
