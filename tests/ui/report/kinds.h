// Parts of a report's page by what they are (`data-kind`), not by what they say.
#pragma once

#include <cstddef>
#include <string>

namespace cavum::testing_report {

inline std::size_t times(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// The first element of that kind; empty: there is none.
inline std::string of_kind(const std::string& html, const std::string& kind) {
  const auto at = html.find(" data-kind='" + kind + "'");
  if (at == std::string::npos) return {};
  const auto open = html.rfind('<', at);
  const std::string end =
      "</" + html.substr(open + 1, html.find_first_of(" >", open) - open - 1) + ">";
  return html.substr(open, html.find(end, open) + end.size() - open);
}

/// The box with verdict, points and reasons; and the verdict in it: pass, fail or review.
inline std::string verdict_box(const std::string& html) {
  const auto at = html.find("<div class='verdict ");
  return at == std::string::npos ? "" : html.substr(at, html.find("</ul></div>", at) - at);
}
inline std::string verdict_of(const std::string& html) {
  const std::string box = verdict_box(html), open = "<div class='verdict ";
  return box.empty() ? "" : box.substr(open.size(), box.find('\'', open.size()) - open.size());
}

/// Whether all of `parts` stand in `text`, in that order.
template <class... Part>
bool holds(const std::string& text, const Part&... parts) {
  std::size_t at = 0;
  const auto next = [&](const std::string& part) {
    const auto found = text.find(part, at);
    if (found != std::string::npos) at = found + part.size();
    return found != std::string::npos;
  };
  return (next(parts) && ...);
}

}  // namespace cavum::testing_report
