#include "scenarios/file/condition.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "scenarios/file/expression.h"

namespace cavum::scenarios {
namespace {

using Text = std::string_view;

Text trimmed(Text t) {
  while (!t.empty() && (t.front() == ' ' || t.front() == '\t' || t.front() == '\n'))
    t.remove_prefix(1);
  while (!t.empty() && (t.back() == ' ' || t.back() == '\t' || t.back() == '\n'))
    t.remove_suffix(1);
  return t;
}

/// Place of an operator of `list` outside all brackets, the last one; npos without.
struct Found {
  std::size_t at = Text::npos, length = 0;
};
template <std::size_t N>
Found find_outside(Text t, const std::array<Text, N>& list) {
  Found found;
  int depth = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    depth += t[i] == '(' ? 1 : t[i] == ')' ? -1 : 0;
    if (depth != 0) continue;
    for (const Text op : list)
      if (t.substr(i, op.size()) == op) {
        found = {i, op.size()};
        i += op.size() - 1;
        break;
      }
  }
  return found;
}

constexpr std::array<Text, 1> k_or{"||"}, k_and{"&&"}, k_choice{"?"};
constexpr std::array<Text, 6> k_compare{"<=", ">=", "==", "!=", "<", ">"};  // the longer ones first

/// Without the brackets around the whole of it.
Text bare(Text t) {
  t = trimmed(t);
  while (t.size() >= 2 && t.front() == '(' && t.back() == ')') {
    int depth = 0;
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      depth += t[i] == '(' ? 1 : t[i] == ')' ? -1 : 0;
      if (depth == 0) return t;  // "(a) + (b)"
    }
    t = trimmed(t.substr(1, t.size() - 2));
  }
  return t;
}

std::optional<double> number_of(Text t) {
  double v = 0;
  const auto [end, error] = std::from_chars(t.data(), t.data() + t.size(), v);
  if (error != std::errc() || end != t.data() + t.size()) return std::nullopt;
  return v;
}

Outlook both(Outlook a, Outlook b) {
  if (a == Outlook::never || b == Outlook::never) return Outlook::never;
  return a == Outlook::always && b == Outlook::always ? Outlook::always : Outlook::perhaps;
}
Outlook either(Outlook a, Outlook b) {
  if (a == Outlook::always || b == Outlook::always) return Outlook::always;
  return a == Outlook::never && b == Outlook::never ? Outlook::never : Outlook::perhaps;
}

Outlook compare(ValueRange a, Text op, ValueRange b) {
  const auto of = [](bool always, bool never) {
    return always ? Outlook::always : never ? Outlook::never : Outlook::perhaps;
  };
  const bool one = a.low == a.high && b.low == b.high, apart = a.high < b.low || b.high < a.low;
  if (op == "<") return of(a.high < b.low, a.low >= b.high);
  if (op == ">") return of(a.low > b.high, a.high <= b.low);
  if (op == "<=") return of(a.high <= b.low, a.low > b.high);
  if (op == ">=") return of(a.low >= b.high, a.high < b.low);
  if (op == "==") return of(one && a.low == b.low, apart);
  return of(apart, one && a.low == b.low);
}

}  // namespace

bool is_condition(const std::string& text) {
  const Text t = bare(text);
  if (const Found choice = find_outside(t, k_choice); choice.at != Text::npos) {
    const Text rest = t.substr(choice.at + 1);
    const Found colon = find_outside(rest, std::array<Text, 1>{":"});
    return colon.at != Text::npos && is_condition(std::string(rest.substr(0, colon.at))) &&
           is_condition(std::string(rest.substr(colon.at + 1)));
  }
  for (const auto& joint : {k_or, k_and})
    if (const Found f = find_outside(t, joint); f.at != Text::npos)
      return is_condition(std::string(t.substr(0, f.at))) &&
             is_condition(std::string(t.substr(f.at + f.length)));
  if (find_outside(t, k_compare).at != Text::npos) return true;
  constexpr std::array<Text, 7> k_yes_or_no{"contact",    "cutting", "button_1", "button_2",
                                            "perforated", "0",       "1"};
  return std::find(k_yes_or_no.begin(), k_yes_or_no.end(), t) != k_yes_or_no.end();
}

namespace {

bool is_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '.';
}

/// What is divided by: the number, name, call or bracket that begins at `from`, with its sign.
Text divisor(Text t, std::size_t from) {
  std::size_t end = from;
  while (end < t.size() && (t[end] == ' ' || t[end] == '-' || t[end] == '+')) ++end;
  while (end < t.size() && is_name(t[end])) ++end;
  if (end < t.size() && t[end] == '(') {
    int depth = 0;
    do {
      depth += t[end] == '(' ? 1 : t[end] == ')' ? -1 : 0;
      ++end;
    } while (end < t.size() && depth > 0);
  }
  return trimmed(t.substr(from, end - from));
}

/// Its value when every quantity is 0.
double at_zero(Text t) {
  const std::string text(t);
  const auto names = names_in_expression(text);
  std::vector<double> values(names.size(), 0.0);
  return Expression(text, names, values).value();
}

std::optional<ConditionFault> division_fault(Text by) {
  if (by.empty() || at_zero(by) != 0.0) return std::nullopt;
  if (names_in_expression(std::string(by)).empty())
    return ConditionFault{ConditionFault::Kind::zero, msg("divides by 0"),
                          msg("divide by something else, or take that part out")};
  return ConditionFault{ConditionFault::Kind::zero_at_first,
                        msg("divides by '{}', which is 0 when an exam begins", by),
                        msg("multiply instead, or divide by max({}, 1)", by)};
}

}  // namespace

std::optional<ConditionFault> condition_fault(const std::string& text) {
  struct Level {
    bool of_a_function = false;
    int comparisons = 0;
  };
  std::vector<Level> levels(1);
  const Text t = text;
  char before = ' ';  // the last sign that is no space
  for (std::size_t i = 0; i < t.size(); ++i) {
    Level& level = levels.back();
    const char c = t[i];
    const Text two = t.substr(i, 2);
    if (c == '(') {
      levels.push_back({is_name(before), 0});
    } else if (c == ')' && levels.size() > 1) {
      levels.pop_back();
    } else if (two == "||" || two == "&&" || c == '?' || c == ':') {
      level.comparisons = 0;
      i += c == '|' || c == '&' ? 1 : 0;
    } else if (c == ',') {
      if (!level.of_a_function)
        return ConditionFault{ConditionFault::Kind::comma,
                              msg("has a comma, and only what follows it would count"),
                              msg("join conditions by && or ||, and write numbers as 0.5")};
      level.comparisons = 0;
    } else if (const auto op = std::find_if(k_compare.begin(), k_compare.end(),
                                            [&](Text o) { return t.substr(i, o.size()) == o; });
               op != k_compare.end()) {
      if (++level.comparisons > 1)
        return ConditionFault{ConditionFault::Kind::chain,
                              msg("is a chain of comparisons, which does not mean what it reads"),
                              msg("write for example \"depth_mm > 1 && depth_mm < 5\"")};
      i += op->size() - 1;
    } else if (c == '/') {
      if (auto fault = division_fault(divisor(t, i + 1))) return fault;
    }
    if (c != ' ' && c != '\t' && c != '\n') before = c;
  }
  return std::nullopt;
}

Outlook judge_condition(const std::string& text, const std::map<std::string, ValueRange>& ranges) {
  const Text t = bare(text);
  if (find_outside(t, k_choice).at != Text::npos) return Outlook::perhaps;
  const auto part = [&](std::size_t from, std::size_t n) {
    return judge_condition(std::string(t.substr(from, n)), ranges);
  };
  if (const Found f = find_outside(t, k_or); f.at != Text::npos)
    return either(part(0, f.at), part(f.at + f.length, Text::npos));
  if (const Found f = find_outside(t, k_and); f.at != Text::npos)
    return both(part(0, f.at), part(f.at + f.length, Text::npos));
  const auto range_of = [&](Text side) -> std::optional<ValueRange> {
    side = bare(side);
    if (const auto v = number_of(side)) return ValueRange{*v, *v};
    const auto known = ranges.find(std::string(side));
    return known != ranges.end() ? std::optional(known->second) : std::nullopt;
  };
  const Found f = find_outside(t, k_compare);
  if (f.at == Text::npos) {
    const auto value = range_of(t);
    return value ? compare(*value, "!=", {0, 0}) : Outlook::perhaps;
  }
  const auto left = range_of(t.substr(0, f.at)), right = range_of(t.substr(f.at + f.length));
  return left && right ? compare(*left, t.substr(f.at, f.length), *right) : Outlook::perhaps;
}

}  // namespace cavum::scenarios
