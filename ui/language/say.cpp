#include "ui/language/say.h"

#include <map>

#include "engine/base/pseudo.h"
#include "engine/base/text.h"
#include "ui/language/catalogue.h"

namespace cavum {

std::string with_isolates(std::string_view text, std::string (*safe)(std::string_view),
                          std::string_view open, std::string_view close) {
  constexpr std::size_t k_sign = std::char_traits<char>::length(k_isolate);
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = text.find(k_isolate, at),
                      to = from == text.npos ? from : text.find(k_isolate_end, from);
    if (to == text.npos) return out + safe(text.substr(at));
    out += safe(text.substr(at, from - at));
    out.append(open).append(safe(text.substr(from + k_sign, to - from - k_sign))).append(close);
    at = to + k_sign;
  }
  return out;
}

namespace {

/// A name among the words of a sentence.
std::string name_in_line(std::string_view text) {
  std::string line = one_line(text);
  // Hebrew, Arabic and their neighbours (U+0590 to U+08FF, presentation forms)
  const auto turns = [&line] {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const auto a = static_cast<unsigned char>(line[i]),
                 b = static_cast<unsigned char>(line[i + 1]);
      if ((a >= 0xd6 && a <= 0xdf && !(a == 0xd6 && b < 0x90)) ||
          (a == 0xe0 && b >= 0xa0 && b <= 0xa3) || (a == 0xef && b >= 0xac))
        return true;
    }
    return false;
  };
  if (turns()) line = k_isolate + line + k_isolate_end;
  if (catalogue().kind() == Catalogue::Kind::pseudo) line = "\u27e8" + line + "\u27e9";
  return line;
}

/// What files brought. Read by all threads.
std::map<std::string, std::string>& of_files() {
  static std::map<std::string, std::string> texts;
  return texts;
}

std::string sentence_of(const std::optional<std::string>& translated, const char* english) {
  return translated ? *translated : source_sentence(english);
}

class ReadersLocale final : public Locale {
 public:
  [[nodiscard]] std::string sentence(const char* english) const override {
    return sentence_of(catalogue().find(english), english);
  }
  [[nodiscard]] std::string sentence(const char* one, const char* many,
                                     std::int64_t count) const override {
    return sentence_of(catalogue().find(one, many, count), count == 1 ? one : many);
  }
  [[nodiscard]] std::string term(const std::string& english) const override {
    return catalogue().find(english).value_or(english);
  }
  [[nodiscard]] std::string authored(const std::string& english) const override {
    const auto own = of_files().find(english);
    return own != of_files().end() ? own->second : term(english);
  }
  [[nodiscard]] std::string name(const std::string& text) const override {
    return name_in_line(text);
  }
  [[nodiscard]] char decimal_sign() const noexcept override { return catalogue().decimal_sign(); }
};

const ReadersLocale k_readers;

}  // namespace

std::string language_detail::rendered(const Message& message) { return render(message, k_readers); }

void add_translations(const std::map<std::string, std::string>& texts) {
  for (const auto& [english, translated] : texts) of_files().insert_or_assign(english, translated);
}

std::string tr(const Lines& lines) { return render(lines, k_readers); }

}  // namespace cavum
