#include "engine/base/lines.h"

#include <algorithm>

#include "engine/base/text.h"

namespace cavum {
namespace {

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](unsigned char c) { return (c & 0xc0U) != 0x80U; }));
}

bool is_figure(const Message& m) {
  if (m.empty() || std::string_view(m.english()) != "{}" || m.values().size() != 1) return false;
  return std::holds_alternative<std::int64_t>(m.values().front()) ||
         std::holds_alternative<Number>(m.values().front());
}

template <class TextOf>
std::string laid_out(const std::vector<Lines::Line>& lines, const TextOf& text_of) {
  constexpr std::size_t k_between = 2;
  std::string out;
  for (std::size_t first = 0; first < lines.size();) {
    std::size_t end = first + 1;
    while (end < lines.size() && lines[first].cells.size() > 1 &&
           lines[end].indent == lines[first].indent &&
           lines[end].cells.size() == lines[first].cells.size())
      ++end;
    std::vector<std::vector<std::string>> rows;
    std::vector<std::size_t> widths(lines[first].cells.size());
    for (std::size_t i = first; i < end; ++i) {
      std::vector<std::string>& row = rows.emplace_back();
      for (std::size_t c = 0; c < lines[i].cells.size(); ++c) {
        row.push_back(one_line(text_of(lines[i].cells[c])));
        widths[c] = std::max(widths[c], characters(row.back()));
      }
    }
    for (std::size_t i = first; i < end; ++i) {
      std::string line(static_cast<std::size_t>(lines[i].indent), ' ');
      for (std::size_t c = 0; c < rows[i - first].size(); ++c) {
        const std::string& cell = rows[i - first][c];
        const std::string space(widths[c] - characters(cell), ' ');
        if (c > 0) line += std::string(k_between, ' ');
        line += is_figure(lines[i].cells[c]) ? space + cell : cell + space;
      }
      line.erase(line.find_last_not_of(' ') + 1);
      out += line + "\n";
    }
    first = end;
  }
  return out;
}

}  // namespace

std::string render(const Lines& lines, const Locale& locale) {
  return laid_out(lines.all(), [&](const Message& m) { return render(m, locale); });
}

std::string english_text(const Lines& lines) {
  return laid_out(lines.all(), [](const Message& m) { return english_text(m); });
}

}  // namespace cavum
