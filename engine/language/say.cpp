#include "engine/language/say.h"

#include <fmt/format.h>

#include "engine/base/text.h"
#include "engine/language/catalogue.h"

namespace cavum {

AsIs as_is(std::string_view text) {
  std::string line = one_line(text);
  // Hebrew, Arabic and their neighbours (U+0590 to U+08FF, presentation forms)
  const auto turns = [&line] {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const auto a = static_cast<unsigned char>(line[i]), b = static_cast<unsigned char>(line[i + 1]);
      if ((a >= 0xd6 && a <= 0xdf && !(a == 0xd6 && b < 0x90)) || (a == 0xe0 && b >= 0xa0 && b <= 0xa3) || (a == 0xef && b >= 0xac)) return true;
    }
    return false;
  };
  if (turns()) line = k_isolate + line + k_isolate_end;
  if (catalogue().kind() == Catalogue::Kind::pseudo) line = "\u27e8" + line + "\u27e9";
  return {std::move(line)};
}

std::string with_isolates(std::string_view text, std::string (*safe)(std::string_view), std::string_view open, std::string_view close) {
  constexpr std::size_t k_sign = std::char_traits<char>::length(k_isolate);
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t from = text.find(k_isolate, at), to = from == text.npos ? from : text.find(k_isolate_end, from);
    if (to == text.npos) return out + safe(text.substr(at));
    out += safe(text.substr(at, from - at));
    out.append(open).append(safe(text.substr(from + k_sign, to - from - k_sign))).append(close);
    at = to + k_sign;
  }
  return out;
}

namespace language_detail {

std::string translated(std::string_view english) {
  std::string text(english);
  if (catalogue().kind() == Catalogue::Kind::english) return text;
  return catalogue().find(text).value_or(text);
}

std::string translated(std::string_view one, std::string_view many, long long count) {
  const std::string a(one), b(many);
  std::string text = count == 1 ? a : b;
  if (catalogue().kind() == Catalogue::Kind::english) return text;
  return catalogue().find(a, b, count).value_or(text);
}

std::string filled(const std::string& translation, std::string_view english, fmt::format_args arguments) {
  try {
    return fmt::vformat(translation, arguments);
  } catch (const fmt::format_error&) {
    return fmt::vformat(fmt::string_view(english.data(), english.size()), arguments);
  }
}

}  // namespace language_detail

namespace {

class ReadersLocale final : public Locale {
 public:
  [[nodiscard]] std::string sentence(const char* english) const override { return catalogue().find(english).value_or(english); }
  [[nodiscard]] std::string sentence(const char* one, const char* many, std::int64_t count) const override {
    return catalogue().find(one, many, count).value_or(count == 1 ? one : many);
  }
  [[nodiscard]] std::string term(const std::string& english) const override { return catalogue().find(english).value_or(english); }
  [[nodiscard]] std::string authored(const std::string& english) const override { return shown(english); }
  [[nodiscard]] std::string name(const std::string& text) const override { return shown(text); }  // TODO: as_is() once no sentence is a name
  [[nodiscard]] char decimal_sign() const noexcept override { return catalogue().decimal_sign(); }
};

}  // namespace

std::string language_detail::rendered(const Message& message) {
  static const ReadersLocale k_locale;
  return remembered(render(message, k_locale));
}

}  // namespace cavum
