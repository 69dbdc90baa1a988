// Sentences in the reader's language. The English sentence stands in the code, and is what the catalogue is asked for (xgettext reads it there).
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/base/message.h"
#include "engine/language/shown.h"

namespace cavum {

/// Text of people and files (a name, a path, an identifier): shown as it stands, on one line. One that is written from right to left is isolated
/// (U+2068 … U+2069), so that the line around it keeps its order.
struct AsIs {
  std::string text;
};
inline constexpr char k_isolate[] = "\u2068", k_isolate_end[] = "\u2069";
[[nodiscard]] AsIs as_is(std::string_view text);
/// `text` made `safe`, part by part, with what as_is() isolated between `open` and `close`.
[[nodiscard]] std::string with_isolates(std::string_view text, std::string (*safe)(std::string_view), std::string_view open, std::string_view close);

namespace language_detail {

/// The translation of `english`; with `many`, of the form that `count` takes.
[[nodiscard]] std::string translated(std::string_view english);
[[nodiscard]] std::string translated(std::string_view one, std::string_view many, long long count);
/// Filled in; `english` where the translation does not take the arguments.
[[nodiscard]] std::string filled(const std::string& translation, std::string_view english, fmt::format_args arguments);

/// An argument as it is shown: words and numbers in words in the language, the rest as it stands.
template <class A>
decltype(auto) argument(A& a) {
  using T = std::remove_cvref_t<A>;
  static_assert(!std::is_floating_point_v<T>, "write a number with its digits: fixed(v, 2)");
  if constexpr (std::is_same_v<T, AsIs>)
    return std::string(a.text);
  else if constexpr (std::is_convertible_v<A&, std::string_view>)
    return shown(std::string_view(a));
  else
    return T(a);
}
template <class... A>
std::string fill(const std::string& translation, std::string_view english, A&&... arguments) {
  return filled(translation, english, fmt::make_format_args(arguments...));
}

}  // namespace language_detail

/// fmt::format in the reader's language: the compiler holds the arguments against the English sentence. Words among the arguments are translated as
/// shown() does, numbers written with fixed() get the language's decimal sign; what is nobody's word to translate is passed as_is().
template <class... A>
[[nodiscard]] std::string tr(fmt::format_string<A...> english, A&&... arguments) {
  const std::string_view text(fmt::string_view(english).data(), fmt::string_view(english).size());
  return remembered(language_detail::fill(language_detail::translated(text), text, language_detail::argument(arguments)...));
}

/// The form for `count` things: English `one` where that is 1, else `many`; in other languages as their catalogue says. Both take the same arguments.
template <class... A>
[[nodiscard]] std::string trn(fmt::format_string<A...> one, fmt::format_string<A...> many, long long count, A&&... arguments) {
  const std::string_view first(fmt::string_view(one).data(), fmt::string_view(one).size()),
      rest(fmt::string_view(many).data(), fmt::string_view(many).size());
  return remembered(
      language_detail::fill(language_detail::translated(first, rest, count), count == 1 ? first : rest, language_detail::argument(arguments)...));
}

namespace language_detail {
[[nodiscard]] std::string rendered(const Message& message);
}  // namespace language_detail
/// A message in the reader's language. A template, so that a literal is no message.
template <std::same_as<Message> M>
[[nodiscard]] std::string tr(const M& message) {
  return language_detail::rendered(message);
}

}  // namespace cavum

template <>
struct fmt::formatter<cavum::AsIs> : fmt::formatter<fmt::string_view> {
  template <class Context>
  auto format(const cavum::AsIs& a, Context& context) const {
    return fmt::formatter<fmt::string_view>::format({a.text.data(), a.text.size()}, context);
  }
};
