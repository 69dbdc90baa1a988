#include "engine/language/pattern.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

namespace cavum {
namespace {

struct Gap {
  std::size_t argument;
  std::string form;  // after the colon
};
struct Parts {
  std::vector<std::string> literals{""};
  std::vector<Gap> gaps;
};

/// Length of a conversion of printf at the beginning; 0 where there is none. A space is no flag here: "5 % of".
std::size_t conversion(std::string_view text) {
  std::size_t i = 1;
  const auto skip = [&](std::string_view of) {
    while (i < text.size() && of.find(text[i]) != std::string_view::npos) ++i;
  };
  if (text.empty() || text.front() != '%') return 0;
  skip("-+0#");
  skip("0123456789*.");
  skip("hlzjtL");
  return i < text.size() && std::string_view("diouxXfFeEgGaAcs").find(text[i]) != std::string_view::npos ? i + 1 : 0;
}

bool is_printf(std::string_view message) {
  if (message.find('{') != std::string_view::npos) return false;
  for (std::size_t at = message.find('%'); at != std::string_view::npos; at = message.find('%', at + 1))
    if (conversion(message.substr(at)) > 0) return true;
  return false;
}

Parts printf_parts_of(std::string_view message) {
  Parts p;
  for (std::size_t i = 0; i < message.size();) {
    if (message.substr(i).starts_with("%%")) {
      p.literals.back() += '%';
      i += 2;
    } else if (const std::size_t n = conversion(message.substr(i)); n > 0) {
      p.gaps.push_back({p.gaps.size(), std::string(message.substr(i, n))});
      p.literals.emplace_back();
      i += n;
    } else {
      p.literals.back() += message[i++];
    }
  }
  return p;
}

Parts parts_of(std::string_view message) {
  if (is_printf(message)) return printf_parts_of(message);
  Parts p;
  for (std::size_t i = 0; i < message.size(); ++i) {
    const char c = message[i];
    if ((c == '{' || c == '}') && i + 1 < message.size() && message[i + 1] == c) {
      p.literals.back() += c;
      ++i;
    } else if (c == '{') {
      const std::size_t end = message.find('}', i);
      if (end == std::string_view::npos) throw std::invalid_argument("a gap without end");
      const std::string_view in = message.substr(i + 1, end - i - 1);
      const std::size_t colon = std::min(in.find(':'), in.size());
      const std::string number(in.substr(0, colon));
      if (!std::all_of(number.begin(), number.end(), [](unsigned char d) { return std::isdigit(d) != 0; }) || number.size() > 2)
        throw std::invalid_argument("a gap with a name");
      p.gaps.push_back(
          {number.empty() ? p.gaps.size() : static_cast<std::size_t>(std::stoi(number)), std::string(in.substr(std::min(colon + 1, in.size())))});
      p.literals.emplace_back();
      i = end;
    } else if (c == '}') {
      throw std::invalid_argument("an end without a gap");
    } else {
      p.literals.back() += c;
    }
  }
  return p;
}

}  // namespace

Pattern::Pattern(std::string_view message) : message_(message) {
  Parts p = parts_of(message);
  literals_ = std::move(p.literals);
  for (const Gap& g : p.gaps) arguments_.push_back(g.argument);
  for (std::size_t i = 0; i < literals_.size(); ++i) {
    if (literals_[i].size() > literals_[longest_].size()) longest_ = i;
    const auto letters = std::count_if(literals_[i].begin(), literals_[i].end(), [](unsigned char c) { return std::isalpha(c) != 0; });
    letters_ = std::max(letters_, static_cast<std::size_t>(letters));
    all_letters_ += static_cast<std::size_t>(letters);
  }
}

bool Pattern::match_from(std::size_t literal, std::string_view rest, std::vector<std::string_view>& found) const {
  const std::string& next = literals_[literal];
  if (literal + 1 == literals_.size()) {
    if (!rest.ends_with(next)) return false;
    found.push_back(rest.substr(0, rest.size() - next.size()));
    return true;
  }
  for (std::size_t at = rest.find(next); at != std::string_view::npos; at = rest.find(next, at + 1)) {
    found.push_back(rest.substr(0, at));
    if (match_from(literal + 1, rest.substr(at + next.size()), found)) return true;
    found.pop_back();
    if (next.empty()) return false;
  }
  return false;
}

bool Pattern::quoted(std::size_t argument) const {
  for (std::size_t i = 0; i < arguments_.size(); ++i)
    if (arguments_[i] == argument && literals_[i].ends_with('\'') && literals_[i + 1].starts_with('\'')) return true;
  return false;
}

std::optional<std::vector<std::string>> Pattern::match(std::string_view sentence) const {
  if (gaps() == 0) return sentence == literals_.front() ? std::optional(std::vector<std::string>{}) : std::nullopt;
  if (!sentence.starts_with(literals_.front()) || sentence.find(literals_[longest_]) == std::string_view::npos) return std::nullopt;
  std::vector<std::string_view> found;
  if (!match_from(1, sentence.substr(literals_.front().size()), found)) return std::nullopt;
  std::vector<std::string> texts(*std::max_element(arguments_.begin(), arguments_.end()) + 1);
  for (std::size_t i = 0; i < found.size(); ++i) texts[arguments_[i]] = found[i];
  return texts;
}

std::string Pattern::fill(std::string_view message, const std::vector<std::string>& texts) {
  const Parts p = parts_of(message);
  std::string out = p.literals.front();
  for (std::size_t i = 0; i < p.gaps.size(); ++i) {
    if (p.gaps[i].argument >= texts.size()) throw std::invalid_argument("a gap for an argument that there is not");
    out += texts[p.gaps[i].argument] + p.literals[i + 1];
  }
  return out;
}

std::vector<std::string> Pattern::arguments(std::string_view message) {
  Parts p = parts_of(message);
  std::stable_sort(p.gaps.begin(), p.gaps.end(), [](const Gap& a, const Gap& b) { return a.argument < b.argument; });
  std::vector<std::string> out;
  for (const Gap& g : p.gaps) out.push_back(std::to_string(g.argument) + ":" + g.form);
  return out;
}

}  // namespace cavum
