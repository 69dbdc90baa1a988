// Elements of SVG pictures: numbers without needless digits, words made safe for XML. `more`:
// further attributes.
#pragma once

#include <fmt/core.h>

#include <string>

#include "engine/base/text.h"

namespace cavum {

/// Two digits behind the point at the most.
[[nodiscard]] inline std::string svg_number(double v) {
  std::string s = fixed(v, 2);
  s.resize(s.find_last_not_of('0') + 1);
  if (s.back() == '.') s.pop_back();
  return s == "-0" ? "0" : s;
}
/// `anchor`: start, middle or end.
[[nodiscard]] inline std::string svg_text(double x, double y, const std::string& words,
                                          double size_px, const std::string& anchor = "start",
                                          const std::string& more = "") {
  return fmt::format("<text x='{}' y='{}' font-size='{}' text-anchor='{}' {}>{}</text>\n",
                     svg_number(x), svg_number(y), svg_number(size_px), anchor, more,
                     xml_text(words));
}
[[nodiscard]] inline std::string svg_rect(double x, double y, double width, double height,
                                          const std::string& fill, const std::string& more = "") {
  return fmt::format("<rect x='{}' y='{}' width='{}' height='{}' fill='{}' {}/>\n", svg_number(x),
                     svg_number(y), svg_number(width), svg_number(height), fill, more);
}
[[nodiscard]] inline std::string svg_path(const std::string& path, const std::string& stroke,
                                          double width, const std::string& more = "") {
  return fmt::format("<path fill='none' stroke='{}' stroke-width='{}' {} d='{}'/>\n", stroke,
                     svg_number(width), more, path);
}
[[nodiscard]] inline std::string svg_line(double x1, double y1, double x2, double y2,
                                          const std::string& stroke, double width,
                                          const std::string& more = "") {
  return svg_path(
      fmt::format("M{} {}L{} {}", svg_number(x1), svg_number(y1), svg_number(x2), svg_number(y2)),
      stroke, width, more);
}
[[nodiscard]] inline std::string svg_circle(double x, double y, double radius,
                                            const std::string& fill, const std::string& more) {
  return fmt::format("<circle cx='{}' cy='{}' r='{}' fill='{}' {}/>\n", svg_number(x),
                     svg_number(y), svg_number(radius), fill, more);
}
[[nodiscard]] inline std::string svg_group(double x, double y, const std::string& content) {
  return fmt::format("<g transform='translate({} {})'>{}</g>\n", svg_number(x), svg_number(y),
                     content);
}
/// A whole picture.
[[nodiscard]] inline std::string svg_root(double width, double height, const std::string& content,
                                          const std::string& more = "font-family='sans-serif'") {
  const std::string w = svg_number(width), h = svg_number(height);
  return fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{}' height='{}' viewBox='0 0 {} {}' {}>\n{}</svg>\n",
      w, h, w, h, more, content);
}
inline constexpr char k_svg_white[] = "<rect width='100%' height='100%' fill='white'/>\n";

}  // namespace cavum
