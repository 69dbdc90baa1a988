// Sentences in the reader's language. The English sentence stands in the code, and is what the
// catalogue is asked for (xgettext reads it there).
#pragma once

#include <fmt/core.h>

#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "engine/base/lines.h"
#include "engine/base/message.h"

namespace cavum {

/// Text of people and files (a name, a path, an identifier): shown as it stands, on one line. One
/// that is written from right to left is isolated (U+2068 … U+2069), so that the line around it
/// keeps its order.
[[nodiscard]] inline Name as_is(std::string_view text) { return {std::string(text)}; }
inline constexpr char k_isolate[] = "\u2068", k_isolate_end[] = "\u2069";
/// `text` made `safe`, part by part, with what as_is() isolated between `open` and `close`.
[[nodiscard]] std::string with_isolates(std::string_view text,
                                        std::string (*safe)(std::string_view),
                                        std::string_view open, std::string_view close);

namespace language_detail {

[[nodiscard]] std::string rendered(const Message& message);

template <class A>
Value value_of(A&& a) {
  static_assert(!std::is_convertible_v<A, std::string_view>,
                "say what the text is: as_is() of a name, a Term, a Message");
  static_assert(!std::is_floating_point_v<std::remove_cvref_t<A>>,
                "write a number with its digits: as_mm(v, 2), as_number(v, 2)");
  return message_detail::value_of(std::forward<A>(a));
}

}  // namespace language_detail

/// A message in the reader's language. A template, so that a literal is no message.
template <std::same_as<Message> M>
[[nodiscard]] std::string tr(const M& message) {
  return language_detail::rendered(message);
}
[[nodiscard]] std::string tr(const Lines& lines);
/// Texts that a file brings in the reader's language (a scenario's), by the English ones: an
/// Authored is said so. Those of several files add up; one that differs takes the place of the
/// earlier. Call it before other threads say anything.
void add_translations(const std::map<std::string, std::string>& texts);
/// The message msg() makes, in the reader's language.
template <class... A>
[[nodiscard]] std::string tr(fmt::format_string<message_detail::Text<A>...> english,
                             A&&... values) {
  return language_detail::rendered({fmt::string_view(english).data(),
                                    nullptr,
                                    0,
                                    {language_detail::value_of(std::forward<A>(values))...}});
}
/// The message msgn() makes.
template <class... A>
[[nodiscard]] std::string trn(fmt::format_string<message_detail::Text<A>...> one,
                              fmt::format_string<message_detail::Text<A>...> many,
                              std::int64_t count, A&&... values) {
  return language_detail::rendered({fmt::string_view(one).data(),
                                    fmt::string_view(many).data(),
                                    count,
                                    {language_detail::value_of(std::forward<A>(values))...}});
}

}  // namespace cavum
