#include <array>
#include <string_view>
#include <utility>

#include "engine/language/catalogue.h"

namespace cavum {

std::string pseudo(std::string_view english) {
  constexpr std::array<std::pair<char, const char*>, 22> k_accents{
      {{'a', "á"}, {'b', "ƀ"}, {'c', "ç"}, {'d', "ð"}, {'e', "é"}, {'g', "ĝ"}, {'h', "ĥ"}, {'i', "î"}, {'l', "ļ"}, {'n', "ñ"}, {'o', "ô"},
       {'p', "þ"}, {'r', "ŕ"}, {'s', "š"}, {'t', "ţ"}, {'u', "û"}, {'y', "ý"}, {'z', "ž"}, {'A', "Â"}, {'E', "É"}, {'O', "Ö"}, {'T', "Ţ"}}};
  std::string out = "\u27e6";
  const bool printf_like = english.find('{') == std::string_view::npos;  // else a % is a sign: "{} %, the"
  bool gap = false, conversion = false;
  for (std::size_t i = 0; i < english.size(); ++i) {
    const char c = english[i];
    if (c == '\n') {  // each line is shown by itself
      out += i + 1 < english.size() ? "\u27e7\n\u27e6" : "\u27e7\n";
      continue;
    }
    if (printf_like && c == '%' && i + 1 < english.size() && english[i + 1] != ' ') conversion = true;
    if (c == '{') gap = !gap || i == 0 || english[i - 1] != '{';
    const char* accent = nullptr;
    for (const auto& [plain, with] : k_accents)
      if (plain == c && !gap && !conversion) accent = with;
    if (accent != nullptr)
      out += accent;
    else
      out += c;
    if (c == '}') gap = false;
    if (conversion && std::string_view("diouxXfFeEgGaAcs").find(c) != std::string_view::npos) conversion = false;
  }
  return english.ends_with('\n') ? out : out + "\u27e7";
}

}  // namespace cavum
